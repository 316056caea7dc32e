// SPDX-License-Identifier: MIT
//
// The report of a closed loop.
"use strict";

const loop = data.loop;
const pictures = loop.pictures || {};
const unit = pictures.unit || "N m";
const list = (value) => Array.isArray(value) ? value : [];

// One far-off row must not flatten all others: the frame ends a little beyond what all but one in 250 reach.
function frameOf(r) {
  const sizes = [...list(r.before), ...list(r.after), ...list(r.effect)].filter((y) => y !== null).map(Math.abs).sort((a, b) => a - b);
  return sizes.length ? 1.3 * sizes[Math.floor(0.996 * (sizes.length - 1))] : 0;
}

function beyondFrame(r) {
  const frame = frameOf(r);
  const beyond = list(r.before).filter((y, i) => Math.max(Math.abs(y), Math.abs(r.after[i] ?? 0)) > frame).length;
  return beyond ? `; ${beyond} of ${r.before.length} rows lie beyond the frame` : "";
}

function residualPoints(r) {
  const rows = [];
  const frame = frameOf(r);
  const add = (values, name, dots) => list(values).forEach((y, i) => {
    if (y === null || !isFinite(r.x[i]) || Math.abs(y) > frame) return;
    rows.push({x: r.x[i], y, curve: name, method: name, series: name, dots});
  });
  add(r.before, "before", true);
  add(r.after, "after", true);
  add(r.effect, "fitted effect", true);
  return rows;
}

function drawLoop() {
  list(pictures.residuals).forEach((r, i) => {
    const id = "residual-" + i;
    const look = {...lookFor(["before", "after", "fitted effect"], widthOf(id)), colors: ["#d1495b", "#0b6e75", "#edae49"]};
    const whole = list(r.x).length && ["before", "after", "effect"].every((k) => !r[k] || r[k].length === r.x.length);
    draw(id, whole ? residualPlot(residualPoints(r), look, [`${r.channel}, ${r.unit || ""}`, "residual, " + unit]) : null,
         {empty: "The arrays of this picture differ in length."});
  });
  const moves = list(pictures.movements).map((m) => ({name: String(m.name), before: m.mae_before, after: m.mae_after,
    method: m.test ? "held out" : "used for the fit"}));
  draw("movements", moves.length ? movementPlot(moves, {...lookFor(["held out", "used for the fit"], widthOf("movements")),
       colors: ["#d1495b", "#8aa4a8"]}, unit) : null);
  const found = new Set(list(loop.effects).map((e) => e.family));
  const bars = list(loop.candidates).filter((c) => isFinite(c.score)).slice(0, 20)
    .map((c) => ({name: c.family, x: Math.max(0, c.cv_gain || 0), p: c.p_adj, score: c.score, gain: c.cv_gain,
      label: "p = " + fig(c.p_adj), found: found.has(c.family)})).sort((a, b) => b.x - a.x || b.score - a.score);
  draw("evidence", bars.length ? barPlot(bars, lookFor([], widthOf("evidence")), "cross-validated gain, nats") : null);
  const map = pictures.alias_map || {};
  const cells = list(map.families).flatMap((a, i) => map.families.map((b, j) =>
    ({a, b, correlation: (map.correlation[i] || [])[j], size: Math.abs((map.correlation[i] || [])[j])})))
    .filter((c) => isFinite(c.size));
  draw("aliases", cells.length ? aliasPlot(cells, lookFor([], widthOf("aliases")), map.families) : null);
  const left = list((loop.leftover || {}).inputs);
  const leftover = list((loop.leftover || {}).curve).map((p) => ({x: p[0], y: p[1], curve: "leftover", method: "leftover", series: "l"}));
  draw("leftover", leftover.length ? curvePlot(leftover, lookFor(["leftover"], widthOf("leftover")),
       [list(loop.leftover.inputs).join(", "), "residual, " + unit], "What is left over") : null,
       {empty: left.length ? `It depends on ${left.join(" and ")}: no curve over one input shows it.` : "Nothing was left over."});
}

function effectsTable() {
  const rows = list(loop.effects).map((e) => ({...e, interval: list(e.params).map((p) =>
    `${p.name} = ${fig(p.value)} (${fig(p.lo)} … ${fig(p.hi)})`).join(", "),
    alias: list(e.alias).map((a) => a.family + (a.exact ? " (exactly)" : "")).join(", ")}));
  return dataTable([{name: "order", key: "order", count: true}, {name: "effect", key: "family"},
    {name: "term", key: "atom", show: (r) => el("code", {}, r.atom || "")}, {name: "parameters, 95 %", key: "interval"},
    {name: "rms, " + unit, key: "rms_contribution", number: true}, {name: "p", key: "p_adj", number: true},
    {name: "evidence, nats", key: "cv_gain", number: true}, {name: "could also be", key: "alias"}], rows, {label: "effects"});
}

// What the data cannot say, bursts, remarks: a list each where there is one.
function listCards() {
  return list(data.lists).filter((part) => part.lines.length).map((part) => el("section", {class: "card"},
    el("h3", {}, part.title), el("ul", {}, part.lines.map((line) => el("li", {}, line)))));
}

function nextMovements() {
  const rows = list(loop.next_movements).map((m, i) => ({...m, order: i + 1}));
  return rows.length ? [el("h2", {id: "next"}, "Next movements"),
    el("p", {class: "soft"}, "Those at which the explanations left differ most, best first; next_movements.csv has them with durations and tones."),
    dataTable([{name: "order", key: "order", count: true}, {name: "movement", key: "kind"},
      {name: "velocity", key: "velocity", number: true}, {name: "from", key: "from", number: true},
      {name: "to", key: "to", number: true}, {name: "load factor", key: "load_factor", number: true},
      {name: "tells apart", key: "between"}, {name: "by, noise variances", key: "separation", number: true}], rows,
      {label: "next movements"})] : [];
}

function closedShare(error) {
  const low = Math.round(100 * error.closed_fraction);
  const high = Math.round(100 * (error.closed_fraction_high ?? error.closed_fraction));
  return high > low ? `${low} … ${high} %` : low + " %";
}

function buildLoop() {
  const error = loop.error || {};
  const known = (value) => typeof value === "number" && isFinite(value);  // null is neither
  const fact = (value, label) => el("div", {class: "fact"}, el("b", {}, value), el("span", {class: "soft"}, label));
  byId("top").append(el("h1", {}, data.title), el("p", {class: "reading"}, el("b", {}, data.verdict)),
    ...data.sentences.map((s) => el("p", {}, s.replace(/\*\*/g, ""))),
    el("div", {class: "facts"}, fact(fig(error.mae_before), "MAE before, " + unit),
      fact(fig(error.mae_after), "MAE after, " + unit),
      ...(known(error.ceiling) ? [fact(known(error.attainable) && fig(error.attainable) !== fig(error.ceiling)
        ? `${fig(error.ceiling)} … ${fig(error.attainable)}` : fig(error.ceiling), "the noise lies here, " + unit)] : []),
      ...(known(error.closed_fraction) ? [fact(closedShare(error), "of the gap to the noise closed")] : []),
      fact(count(error.test_movements), "held-out movements")));
  byId("nav").append(el("a", {href: "#residuals"}, "residuals"), el("a", {href: "#effects"}, "effects"),
                     el("a", {href: "#model"}, "model"), el("span", {class: "push"}, themeButton()));
  byId("main").append(
    el("h2", {id: "residuals"}, "Residuals"),
    el("div", {class: "grid"}, list(pictures.residuals).map((r, i) =>
      card("residual-" + i, "Against " + r.channel, "Residual before and after; the fitted effect is what the refitted model says beyond the base" + beyondFrame(r) + "."))),
    el("h2", {id: "effects"}, "Effects"), effectsTable(),
    el("div", {class: "grid", style: "margin-top:1rem"},
      card("movements", "Error of each movement", "Below the dashed line: better than before."),
      card("evidence", "Candidates", "What each would have gained by itself on movements left out; coloured: added. p is corrected for the search."),
      card("aliases", "What could be mistaken for what", "Absolute correlation of two effects in these data, base removed."),
      card("leftover", "Left over", "Structure that none of the effects explains."), listCards()),
    ...nextMovements(),
    el("h2", {id: "model"}, "The model now"), loop.formula ? el("div", {class: "card"}, formulaElement(loop.formula),
      el("div", {class: "code"}, loop.formula)) : el("p", {}, "No formula."));
  window.drawAll = drawLoop;
  drawLoop();
  let resized = 0;
  addEventListener("resize", () => { clearTimeout(resized); if (!printing) resized = setTimeout(drawLoop, 150); });
  document.documentElement.dataset.ready = "yes";
}

buildLoop();
