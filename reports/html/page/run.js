// SPDX-License-Identifier: MIT
//
// The report of a run.
"use strict";

const allMethods = [...new Set(data.tables.flatMap((t) => t.rows.map((r) => r.method)))].sort();
const state = {problem: data.problems[0], operators: data.operators[0], hidden: new Set()};
const tableHere = () => data.tables.find((t) => t.problem === state.problem && t.operators === state.operators);

// The unit of a problem's target, as the titles of its curves have it.
function unitOf(problem) {
  const curve = data.curves.find((c) => c.problem === problem && / in /.test(c.y_name));
  return curve ? curve.y_name.split(" in ").pop() : "";
}
const inUnit = (problem) => unitOf(problem) ? ` (${unitOf(problem)})` : "";
const withUnit = (key) => (r) => r[key] === null || r[key] === undefined ? "–" : `${fig(r[key])} ${unitOf(r.problem)}`.trim();

function chooser(key, values, label) {
  const box = el("select", {"aria-label": label, id: "choose-" + key,
                            onchange: (e) => { state[key] = e.target.value; drawProblem(); }},
                 values.map((v) => el("option", {value: v}, v)));
  return el("label", {}, el("span", {class: "soft"}, label + " "), box);
}

function standingCell(row) {
  const kind = row.standing === "best" || row.standing === "equivalent" ? "good" : "";
  return el("span", {class: kind}, row.standing_text);
}

function share(number, of) {
  return number > 0 ? el("span", {class: "bad"}, `${number}/${of}`) : "0";
}

function methodTable(table) {
  const any = (key) => table.rows.some((row) => row[key] !== null && row[key] !== undefined);
  const columns = [
    {name: "method", key: "method"}, {name: "MAE test" + inUnit(table.problem), key: "mae", number: true},
    {name: "lowest", key: "low", number: true}, {name: "highest", key: "high", number: true},
    {name: "against the best", key: "ratio", show: standingCell}];
  if (any("truth")) columns.push({name: "to the truth" + inUnit(table.problem), key: "truth", number: true});
  if (any("relative")) columns.push({name: "relative %", key: "relative", number: true});
  columns.push(
    {name: "complexity", key: "complexity", count: true}, {name: "CPU s", key: "cpu", number: true},
    {name: "proved free", key: "proved", count: true, show: (r) => `${r.proved}/${r.looked_at}`},
    {name: "singular", key: "refuted", count: true, show: (r) => share(r.refuted, r.looked_at)},
    {name: "failed", key: "failed", count: true, show: (r) => share(r.failed, r.cells)});
  return dataTable(columns, table.rows, {label: `methods on ${table.problem}, ${table.operators}`});
}

// The formula of each method's middle seed, as mathematics.
function formulaList(table) {
  const lines = table.rows.filter((r) => r.formula).map((r) => el("div", {class: "line"},
    el("dt", {}, r.method, el("span", {class: "soft"}, ` seed ${r.seed}`)),
    el("dd", {title: r.formula, tabindex: "0"}, formulaElement(r.formula))));
  return lines.length ? el("details", {open: "open"}, el("summary", {}, "Formulas of the middle seeds"),
                           el("dl", {class: "formulas"}, lines)) : "";
}

function winnersTable() {
  const rows = data.tables.map((t) => {
    const best = t.rows.find((r) => r.standing === "best") || {};
    return {problem: t.problem, operators: t.operators, method: best.method || "none", mae: best.mae, ceiling: t.ceiling,
            complexity: best.complexity, refuted: best.refuted || 0, looked_at: best.looked_at || 0, sure: t.certainty};
  });
  const columns = [
    {name: "problem", key: "problem"}, {name: "operators", key: "operators"},
    {name: "best method", key: "method", show: (r) => el("b", {}, r.method)},
    {name: "MAE test", key: "mae", number: true, show: withUnit("mae")}];
  if (rows.some((r) => r.ceiling !== null)) columns.push({name: "noise ceiling", key: "ceiling", number: true, show: withUnit("ceiling")});
  columns.push({name: "complexity", key: "complexity", count: true},
    {name: "singular", key: "refuted", count: true, show: (r) => share(r.refuted, r.looked_at)},
    {name: "how sure", key: "sure"});
  return dataTable(columns, rows, {label: "who wins where"});
}

function showRecord(datum) {
  const box = byId("record");
  box.replaceChildren(el("h3", {}, "Record"));
  for (const [key, value] of Object.entries(datum)) {
    if (kHidden.has(key) || value === null || typeof value === "object") continue;
    box.append(el("div", {}, el("span", {class: "soft"}, key + ": "), String(value)));
  }
  if (datum.formula) box.append(formulaElement(datum.formula), el("div", {class: "code"}, datum.formula));
  box.hidden = false;
  box.scrollIntoView({block: "nearest"});
}

// Buttons that take methods out of every picture.
function methodButtons() {
  return allMethods.map((method, i) => {
    const button = el("button", {type: "button", class: "chip", "aria-pressed": "true"},
                      el("span", {class: "dot", style: `background:${kPalette[i % kPalette.length]}`}), method);
    button.onclick = () => {
      const shown = state.hidden.delete(method);
      if (!shown) state.hidden.add(method);
      button.setAttribute("aria-pressed", String(shown));
      drawPictures();
    };
    return button;
  });
}

const kEmpty = {front: "No front was written for this problem.", friction: "The run holds no curves of this kind.",
  error: "The run holds no curves of this kind.", profile: "The run holds no curves of this kind.",
  trace_evaluations: "No trace was written.", trace_cpu: "No trace was written.",
  singular: "No formula of this problem was found singular inside the input box."};

function drawPictures() {
  const pictures = new RunPictures(data, state);
  for (const id of kProblemPictures.concat(kOverallPictures)) {
    if (!byId(id)) continue;  // a part that this run does not have
    const click = id === "front" || id === "singular" ? showRecord : undefined;
    drawLater(id, () => draw(id, pictures[id](lookFor(allMethods, widthOf(id))), {onclick: click, empty: kEmpty[id]}));
  }
}

function drawProblem() {
  const table = tableHere();
  byId("problem-title").textContent = `${state.problem}, operators ${state.operators}`;
  byId("problem-reading").textContent = table ? table.reading : "No cell of this problem has ended.";
  byId("problem-ceiling").textContent = table ? table.yardsticks : "";
  byId("problem-table").replaceChildren(table ? methodTable(table) : "", table ? formulaList(table) : "");
  byId("record").hidden = true;
  const ranking = data.rankings.find((r) => r.operators === state.operators);
  byId("rank-reading").textContent = ranking ? ranking.reading : "";
  byId("sensitivity").replaceChildren(...sensitivityPart());
  drawPictures();
}

function changedPart() {
  const changed = data.changed;
  if (!changed) return [];
  const lists = [["newly failed", changed.newly_failed], ["fail no longer", changed.newly_fine],
                 ["newly singular", changed.newly_singular]].filter(([, cells]) => cells.length)
    .map(([name, cells]) => el("p", {}, name + ": ", el("code", {}, cells.slice(0, 10).join("  ") +
      (cells.length > 10 ? `  and ${cells.length - 10} more` : ""))));
  const rows = changed.quality.filter((r) => r.verdict === "worse" || r.verdict === "better")
    .map((r) => ({...r, problem: r.problem || "all"}));
  const day = (started) => started ? started.slice(0, 10) : "no date";
  const face = changed.regression ? ["Worse", "bad-badge"] : rows.some((r) => r.verdict === "better") ? ["Better", "good"] : ["No loss", "good"];
  return [el("section", {class: "card compared", id: "changed"},
    el("div", {class: "verdict"}, el("span", {class: "badge " + face[1]}, face[0]),
       el("span", {class: "soft"}, `${changed.base} (${day(changed.base_started)}) → ${data.name} (${day(changed.started)})`)),
    el("p", {class: "next"}, changed.sentence), ...lists,
    ...(rows.length ? [dataTable([{name: "method", key: "method"}, {name: "operators", key: "operators"},
      {name: "problem", key: "problem"}, {name: "new / base", key: "ratio", number: true},
      {name: "lowest", key: "low", number: true}, {name: "highest", key: "high", number: true},
      {name: "p", key: "p", number: true}, {name: "verdict", key: "verdict"}], rows, {label: "what changed"})] : []))];
}

function sensitivityPart() {
  const found = (data.sensitivity || []).find((s) => s.operators === state.operators);
  if (!found) return [];
  return [el("h3", {}, "Would the ranking be another one?"), el("p", {}, found.reading),
    dataTable([{name: "made with", key: "what"}, {name: "rankings", key: "count", count: true},
      {name: "leader", key: "leader"}, {name: "agreement (Kendall's tau, least)", key: "tau", number: true}],
      found.rows, {label: "sensitivity of the ranking"})];
}

function failuresPart() {
  const parts = [];
  const rows = data.failures.map((f) => ({...f, first: f.cells.join(", ")}));
  parts.push(rows.length ? dataTable([
    {name: "method", key: "method"}, {name: "reason", key: "reason"}, {name: "cells", key: "count", count: true},
    {name: "first of them", key: "first", show: (r) => el("code", {}, r.first)}], rows, {label: "failures"})
    : el("p", {}, "No cell failed."));
  if (data.missing.length) {
    parts.push(el("p", {class: "bad"}, `${data.counts.missing} planned cells are missing:`),
               el("p", {}, el("code", {}, data.missing.join("  "))));
  }
  for (const complaint of data.complaints) parts.push(el("p", {class: "bad"}, complaint));
  return parts;
}

function referencePart() {
  if (!data.reference.length) return [];
  const rows = data.reference.flatMap((p) => p.rows);
  const remarks = data.reference.map((p) => el("details", {}, el("summary", {}, `${p.table}: ${p.problem}`),
    el("ul", {}, p.remarks.map((r) => el("li", {}, r)))));
  return [el("h2", {id: "reference"}, "Published figures beside ours"),
    dataTable([{name: "table", key: "table"}, {name: "problem", key: "problem"},
      {name: "published", key: "published_method"}, {name: "its MAE", key: "published_mae", count: true},
      {name: "its complexity", key: "published_complexity", count: true},
      {name: "ours", key: "method"}, {name: "operators", key: "operators"}, {name: "our MAE", key: "mae", number: true},
      {name: "over seeds", key: "low", show: (r) => r.low === null ? "" : `${fig(r.low)} … ${fig(r.high)}`},
      {name: "noise ceiling", key: "ceiling", number: true}, {name: "law refitted", key: "refitted", number: true},
      {name: "against the ceiling", key: "against_ceiling"}, {name: "against the law refitted", key: "against_refitted"},
      {name: "our complexity", key: "complexity", count: true}, {name: "singular", key: "singular", count: true}],
      rows, {label: "published figures beside ours"}),
    el("p", {class: "soft", style: "margin-top:.8rem"}, "What the figures say, and what is known of a difference:"), ...remarks];
}

const percent = (share) => share === null ? "-" : `${(100 * share).toFixed(1)} %`;

// Ours among published results on the same tables.
function rankParts(suite) {
  if (!suite.ranks.tables.length) return suite.results_note ? [el("p", {class: "soft"}, suite.results_note)] : [];
  const parts = [el("h4", {}, "Among published results"), el("p", {class: "soft"}, suite.results_note)];
  if (suite.ranks.methods.length) {
    parts.push(el("p", {}, "Ranks by R2 on unseen rows: each of ours among the published methods and itself, those among themselves; "
      + "ours in CPU seconds, theirs as published."));
    parts.push(dataTable([{name: "method", key: "method", show: (r) => r.operators ? el("strong", {}, r.method) : r.method},
      {name: "operators", key: "operators", show: (r) => r.operators || "published"},
      {name: "median rank", key: "rank_median", number: true}, {name: "mean", key: "rank_mean", number: true},
      {name: "median among formulas", key: "symbolic_rank_median", number: true},
      {name: "seconds a fit", key: "seconds", number: true}],
      suite.ranks.methods, {label: `ranks on ${suite.name}`}));
  }
  parts.push(dataTable([{name: "table", key: "problem"}, {name: "method", key: "method"},
    {name: "operators", key: "operators"}, {name: "R2 on unseen rows", key: "r2", number: true},
    {name: "rank among formulas", key: "symbolic_rank", count: true}, {name: "among all", key: "rank", count: true},
    {name: "best published formula", key: "best_formula"}, {name: "best published", key: "best"}],
    suite.ranks.tables, {label: `published results of ${suite.name}`}));
  return parts;
}

function suitePart() {
  if (!data.suites.length) return [];
  const shareColumn = (name, of) => ({name, key: name, show: (r) => percent(of(r))});
  const parts = data.suites.flatMap((suite) => [
    el("h3", {}, `${suite.name}: ${suite.summary}`),
    el("p", {}, `Recovered: at most ${fig(suite.recovered_below)} of the variance on unseen rows is left.`),
    dataTable([{name: "method", key: "method"}, {name: "operators", key: "operators"},
      shareColumn("recovered", (r) => r.recovered),
      {name: "95 %", key: "low", show: (r) => `${percent(r.low)} … ${percent(r.high)}`},
      shareColumn("R2 >= 0.999", (r) => r.r2_at_least[0]), shareColumn("0.99", (r) => r.r2_at_least[1]),
      shareColumn("0.9", (r) => r.r2_at_least[2]), {name: "median R2", key: "r2_median", number: true},
      {name: "CPU s", key: "fit_cpu_s", number: true}, {name: "wall s", key: "fit_wall_s", number: true},
      {name: "evaluations", key: "evaluations", number: true},
      shareColumn("small laws", (r) => r.recovered_by_size[0]), shareColumn("middle", (r) => r.recovered_by_size[1]),
      shareColumn("large", (r) => r.recovered_by_size[2])], suite.rows, {label: `recovered of ${suite.name}`}),
    el("p", {class: "soft"}, suite.reference_note), ...rankParts(suite),
    el("details", {}, el("summary", {}, `Recovered by no method: ${suite.never_solved.length}`),
      el("p", {}, el("code", {}, suite.never_solved.join("  "))))]);
  return [el("h2", {id: "suites"}, "Suites"),
    el("div", {class: "grid"}, card("suite", "Recovered against time", "Ours with 95 % intervals over problems; dashed: published.", true)),
    ...parts];
}

function recordsPart() {
  const rows = data.records.rows.map((values) => Object.fromEntries(data.records.columns.map((c, i) => [c, values[i]])));
  const number = new Set(["mae_test", "mae_train", "fit_cpu_s", "r2_test"]);
  const counts = new Set(["seed", "complexity", "nodes", "evaluations"]);
  const long = new Set(["formula", "witness", "note", "reason"]);
  const columns = data.records.columns.map((c) => ({name: c, key: c, number: number.has(c), count: counts.has(c),
    show: long.has(c) ? (r) => r[c] ? formulaText(r[c]) : "" : undefined}));
  const note = data.records.total > rows.length
    ? `${rows.length} of ${data.records.total} records: failed and singular ones first, then one a method; all are in results.csv.` : "";
  const table = dataTable(columns, rows, {label: "records", limit: 200});
  table.classList.add("records");
  return [el("p", {class: "soft"}, note), table];
}

function fact(value, label, bad) {
  return el("div", {class: "fact"}, el("b", {class: bad ? "bad" : undefined}, value), el("span", {class: "soft"}, label));
}

// Only where some problem of the run has such curves: a law of a suite has no velocity profile.
function curveCard(picture, ...words) {
  return data.curves.some((c) => c.picture === picture) ? card(picture, ...words) : null;
}

function problemPart() {
  return [el("h2", {id: "problem"}, el("span", {id: "problem-title"})),
    el("p", {class: "reading", id: "problem-reading"}), el("p", {class: "soft", id: "problem-ceiling"}),
    el("div", {id: "problem-table"}), el("div", {class: "card", id: "record", hidden: "hidden"}),
    el("div", {class: "tools chips", role: "group", "aria-label": "methods in the pictures"},
       el("span", {class: "soft"}, "in the pictures:"), ...methodButtons()),
    el("div", {class: "grid"},
      card("front", "Accuracy and complexity", "Each point is a formula no other beats in both; ringed: chosen; cross: singular. Hover shows the formula, click its record."),
      curveCard("profile", "Sinusoidal velocity profile", "What each model predicts along the profile; dashed: the true law where it is known."),
      curveCard("friction", "Friction against velocity", "One panel a method. Lines: the model, at three loads where the load is an input; dashed: the true law; dots: measured.", true),
      curveCard("error", "Error against velocity", "Prediction minus measured on test movements, one panel a method. Points beyond five times the best method's errors are cut off.", true),
      card("trace_evaluations", "Error against evaluations", "Median over seeds of the best training error so far; band: lowest to highest."),
      card("trace_cpu", "Error against CPU time", "The same against seconds of the fit."),
      card("singular", "Singularities in the input box", "Points where a formula has no finite value. Hover shows the formula and the witness.", true))];
}

function overallPart() {
  return [el("h2", {id: "overall"}, "All problems"), el("p", {class: "reading", id: "rank-reading"}),
    el("div", {class: "grid"},
      card("heat", "Factor to the best", "Median error divided by the best of the problem.", true),
      card("ranks", "Mean ranks", "Bands: half a critical difference to either side. Bars at the right join what Nemenyi's test cannot tell apart at 5 %."),
      card("profiles", "Performance profile", "Share of cells with an error within a factor of the best one of the same problem and seed; failed cells never arrive."),
      card("ecdf", "Targets reached", "Share of targets (2, 1.5, 1.2, 1.1, 1.05 and 1.01 times the best training error of the problem and seed) reached after so many evaluations.", true)),
    el("div", {id: "sensitivity", style: "margin-top:1rem"})];
}

function build() {
  const c = data.counts;
  byId("top").append(el("h1", {}, data.name), el("p", {class: "soft"}, data.made_with),
    el("div", {class: "facts"}, fact(String(c.cells), "cells"), fact(String(c.failed), "failed", c.failed > 0),
      fact(String(c.missing), "missing", c.missing > 0), fact(String(data.problems.length), "problems"),
      fact(String(allMethods.length), "methods"), fact(c.cpu, "CPU time in fits")));
  const parts = [["#wins", "who wins"], ["#problem", "problem"], ["#overall", "all problems"]];
  if (data.suites.length) parts.push(["#suites", "suites"]);
  if (data.reference.length) parts.push(["#reference", "published"]);
  parts.push(["#failed", "failed"], ["#records", "records"], ["#provenance", "provenance"]);
  byId("nav").append(...parts.map(([h, t]) => el("a", {href: h}, t)),
    el("span", {class: "push"}, chooser("problem", data.problems, "problem"),
       chooser("operators", data.operators, "operators"), themeButton()));
  byId("main").append(
    ...changedPart(), el("h2", {id: "wins"}, "Who wins where"), winnersTable(), ...problemPart(), ...overallPart(),
    ...suitePart(), ...referencePart(),
    el("h2", {id: "failed"}, "What failed"), ...failuresPart(),
    el("h2", {id: "records"}, "Records"), ...recordsPart(),
    el("h2", {id: "provenance"}, "Provenance"), provenanceTable(data.provenance));
  window.drawAll = drawPictures;
  drawProblem();
  let resized = 0;
  addEventListener("resize", () => { clearTimeout(resized); if (!printing) resized = setTimeout(drawPictures, 150); });
  document.documentElement.dataset.ready = "yes";
}

build();
