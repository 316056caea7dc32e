// SPDX-License-Identifier: MIT
//
// The report of a closed loop: what is missing, how much it matters, how sure it is, what next; then
// the pictures, the model, the data, and last the figures for who wants to check them.
"use strict";

const words = data.words;
const picturesOf = (test) => data.pictures.filter(test);
const kFaces = {EFFECTS: ["Effects found", "found"], NONE: ["Nothing missing", "none"], UNKNOWN: ["Something unknown", "unknown"],
                CANNOT_TELL: ["Cannot tell", "mute"]};
const kGradeClass = {"very sure": "good", sure: "good", likely: "fair", provisional: "poor", "not physical": "poor",
                     "passes the test": "fair"};

const lookAt = (id) => ({...inkOf(), dark: darkTheme(), width: widthOf(id)});

let chosenTrace = 0;
function drawPicture(picture) {
  draw(picture.id, loopPlot(picture, {...lookAt(picture.id), height: picture.hero ? 236 : undefined}, chosenTrace));
}

function drawLoop() {
  for (const picture of data.pictures) {
    const holder = byId(picture.id);
    if (!holder) continue;
    if (picture.hero) drawPicture(picture);
    else drawLater(picture.id, () => drawPicture(picture));
  }
}

function pictureCard(picture, more, wide) {
  const section = card(picture.id, picture.title, picture.caption, wide);
  section.classList.add("picture");
  for (const one of more || []) section.insertBefore(one, section.querySelector(".plot"));
  return section;
}

function badge(text, kind) { return el("span", {class: "badge " + kind}, text); }

function effectCard(one, i) {
  const line = (text, kind) => text ? [el("p", {class: kind || undefined}, text)] : [];
  const picture = data.pictures.find((p) => p.family === one.family);
  return el("section", {class: "card effect"},
    el("div", {class: "effect-head"}, badge(one.grade, kGradeClass[one.grade] || "fair"),
       picture ? el("a", {href: "#" + picture.id, "aria-label": "picture of: " + one.noun}, "picture") : ""),
    el("h3", {}, one.title), el("p", {class: "amount"}, el("b", {}, one.amount), one.share ? " · " + one.share : ""),
    ...line(one.sure), ...line(one.bristles), ...one.doubts.flatMap((d) => line(d, "doubt")), ...line(one.rivals), ...line(one.settle));
}

function copyButton(label, text) {
  const button = el("button", {type: "button", onclick: async () => {
    try { await navigator.clipboard.writeText(text); button.textContent = "copied"; } catch (error) { button.textContent = "select and copy below"; }
    setTimeout(() => { button.textContent = label; }, 1600);
  }}, label);
  return button;
}

function reveal(label, content) {
  const box = el("pre", {class: "code", hidden: "hidden", tabindex: "0"}, content);
  const button = el("button", {type: "button", "aria-expanded": "false", onclick: () => {
    box.hidden = !box.hidden;
    button.setAttribute("aria-expanded", String(!box.hidden));
  }}, label);
  return [button, box];
}

function modelPart() {
  const model = data.model;
  if (!model.formula) return [];
  const lines = model.terms.map((t, i) => el("div", {class: "line"}, el("dt", {}, t.name),
    el("dd", {tabindex: "0"}, el("span", {class: "sign"}, i === 0 || t.formula.startsWith("-") ? "" : "+ "), formulaElement(t.formula, {periods: true}))));
  const [codeButton, codeBox] = reveal("C code", model.code);
  const [fullButton, fullBox] = reveal("all digits", model.formula);
  return [el("h2", {id: "model"}, "The model now"),
    el("p", {class: "soft"}, `${model.target} in ${model.unit} is the sum of these lines; ripples show their period.`),
    el("dl", {class: "formulas"}, lines),
    el("div", {class: "tools"}, copyButton("copy formula", model.formula), fullButton, copyButton("copy C", model.code), codeButton), fullBox, codeBox,
    el("h3", {class: "above"}, "Symbols, and the range in which the model has been seen"),
    dataTable([{name: "symbol", key: "name", show: (r) => formulaElement(r.name)}, {name: "is", key: "meaning"}, {name: "unit", key: "unit"},
      {name: "from", key: "low", number: true}, {name: "to", key: "high", number: true},
      ...(model.symbols.some((s) => s.recipe) ? [{name: "computed as", key: "recipe"}] : [])], model.symbols, {label: "symbols"})];
}

function dataPart() {
  const d = data.data;
  return [el("h2", {id: "data"}, "What was done to the data"),
    el("p", {}, `${d.rows} rows in ${counted(d.movements, "movement")}; they say as much as ${counted(d.stretches, "independent stretch").replace("stretchs", "stretches")}.`),
    el("div", {class: "grid"},
      el("div", {}, d.steps.length ? dataTable([{name: "step", key: "what"}, {name: "rows left", key: "rows", count: true}], d.steps, {label: "steps"}) : ""),
      el("div", {}, dataTable([{name: "column", key: "column"}, {name: "taken for", key: "meaning"}, {name: "unit", key: "unit"}], d.columns, {label: "columns"}))),
    ...listPart("Remarks", words.remarks)];
}

function listPart(title, lines) {
  return lines.length ? [el("h3", {class: "above"}, title), el("ul", {}, lines.map((line) => el("li", {}, line)))] : [];
}

function detailsPart() {
  const d = data.details;
  const parts = [el("p", {}, "Evidence is the log likelihood gained on movements left out (nats; 3 is a lot). p is the chance that noise alone looks " +
    "like this anywhere in the search; an effect is claimed below " + fig(d.alpha) + ". Repeats are searches with some movements left out. Errors: " + d.how + "." +
    (d.closed ? " Of the gap to the noise " + d.closed + " is closed." : "") + (d.ceiling_note ? " No share of the gap: " + d.ceiling_note + "." : ""))];
  if (d.effects.length) parts.push(dataTable([{name: "effect", key: "effect"}, {name: "in files", key: "family"}, {name: "parameters, 95 %", key: "parameters"},
    {name: "p", key: "p", number: true}, {name: "evidence", key: "gain", number: true}, {name: "±", key: "gain_error", number: true},
    {name: "notes", key: "notes"}], d.effects, {label: "effects in figures"}));
  if (d.candidates.length) parts.push(el("h3", {class: "above"}, "Considered first"), dataTable([{name: "effect", key: "candidate"}, {name: "p", key: "p", number: true},
    {name: "score", key: "score", number: true}, {name: "evidence", key: "gain", number: true},
    {name: `seen from (${data.unit})`, key: "detectable", number: true}], d.candidates, {label: "candidates"}));
  if (d.next.length) parts.push(el("h3", {class: "above"}, "Next movements"), dataTable([{name: "movement", key: "kind"}, {name: "velocity", key: "velocity", number: true},
    {name: "from", key: "from", number: true}, {name: "to", key: "to", number: true}, {name: "load factor", key: "load", number: true},
    {name: "tells apart", key: "between"}, {name: "by, noise variances", key: "separation", number: true}], d.next, {label: "next movements"}));
  return el("details", {id: "details"}, el("summary", {}, "Figures and tests"), ...parts);
}

function traceChooser(picture) {
  if (picture.traces.length < 2) return [];
  return [el("label", {class: "soft"}, el("select", {"aria-label": "movement", onchange: (e) => { chosenTrace = Number(e.target.value); drawPicture(picture); }},
    picture.traces.map((t, i) => el("option", {value: i}, t.name))))];
}

// What stands beside the bars: what to do next, or what would have been seen.
function nextCard() {
  const lines = [el("h3", {}, "What next"), el("p", {class: "next"}, words.next)];
  if (words.needed.length > 1) lines.push(el("ul", {}, words.needed.slice(1).map((n) => el("li", {}, n + "."))));
  if (words.unused) lines.push(el("p", {class: "next"}, words.unused));
  if (words.detectable) lines.push(el("p", {class: "next"}, words.detectable));
  if (words.leftover && words.cards.length) lines.push(el("p", {class: "next"}, words.leftover));
  return el("section", {class: "card answer"}, lines);
}

function section(id, title, pictures, more) {
  if (!pictures.length) return [];
  return [el("h2", {id}, title), ...(more || []), el("div", {class: "grid"}, pictures.map((p) => pictureCard(p)))];
}

function buildLoop() {
  const [face, kind] = kFaces[data.verdict] || [data.verdict, "mute"];
  const heroes = picturesOf((p) => p.id === "error" || p.id === "friction");
  // Where something unknown is left its picture stands on the first screen.
  const left = picturesOf((p) => p.leftover);
  if (data.verdict === "UNKNOWN" && left.length) heroes.push(left[0]);
  for (const p of heroes) p.hero = true;
  byId("top").append(el("div", {class: "verdict"}, badge(face, kind), el("span", {class: "soft"}, data.title)),
    el("h1", {class: words.headline.length > 120 ? "headline long" : "headline"}, words.headline), el("p", {class: "matters"}, words.error.replace("->", "→")));
  const error = data.pictures.find((p) => p.id === "error");
  const rest = heroes.filter((p) => p !== error);
  byId("main").append(
    el("div", {class: "hero columns-" + rest.length},
      el("div", {class: "answers"}, error ? pictureCard(error) : "", nextCard()), ...rest.map((p) => pictureCard(p))),
    el("div", {class: "effects"}, words.cards.map(effectCard)));
  const here = (test) => picturesOf((p) => !p.hero && test(p));
  const parts = [
    ["effects", "The effects, each in its own coordinate", here((p) => p.kind === "effect")],
    ["unexplained", "Still unexplained", here((p) => p.leftover)]];
  for (const [id, title, pictures] of parts) byId("main").append(...section(id, title, pictures));
  const trace = data.pictures.find((p) => p.id === "trace");
  if (trace) byId("main").append(el("h2", {id: "movement"}, "A movement"), pictureCard(trace, traceChooser(trace), true));
  byId("main").append(...modelPart(), ...section("inputs", "What is left, input by input", here((p) => p.kind === "input" && !p.leftover)),
    ...section("checks", "Behind the answer", here((p) => ["movements", "evidence", "aliases"].includes(p.kind))),
    ...listPart("What these data cannot show", words.untestable), ...listPart("What these data cannot tell apart", words.aliased),
    ...listPart("Bursts, left out of every fit and no friction", words.bursts), ...dataPart(), el("h2", {}, "Details"), detailsPart());
  const links = [["effects", "effects"], ["movement", "a movement"], ["model", "model and code"], ["inputs", "what is left"], ["data", "data"], ["details", "details"]];
  byId("nav").append(...links.filter(([id]) => byId(id)).map(([id, text]) => el("a", {href: "#" + id}, text)),
                     el("span", {class: "push"}, themeButton()));
  window.drawAll = drawLoop;
  drawLoop();
  let resized = 0;
  addEventListener("resize", () => { clearTimeout(resized); if (!printing) resized = setTimeout(drawLoop, 150); });
  document.documentElement.dataset.ready = "yes";
}

buildLoop();
