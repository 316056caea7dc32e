// SPDX-License-Identifier: MIT
//
// The report of a run.
"use strict";

const allMethods = [...new Set(data.tables.flatMap((t) => t.rows.map((r) => r.method)))].sort();
const state = {problem: data.problems[0], operators: data.operators[0]};
const here = (row) => row.problem === state.problem && (row.operators === state.operators || row.operators === "-");
const tableHere = () => data.tables.find((t) => t.problem === state.problem && t.operators === state.operators);

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

function share(count, of) {
  return count > 0 ? el("span", {class: "bad"}, `${count}/${of}`) : "0";
}

function methodTable(table) {
  const any = (key) => table.rows.some((row) => row[key] !== null && row[key] !== undefined);
  const columns = [
    {name: "method", key: "method"}, {name: "MAE test", key: "mae", number: true},
    {name: "lowest", key: "low", number: true}, {name: "highest", key: "high", number: true},
    {name: "against the best", key: "ratio", show: standingCell}];
  if (any("truth")) columns.push({name: "to the truth", key: "truth", number: true});
  if (any("relative")) columns.push({name: "relative %", key: "relative", number: true});
  columns.push(
    {name: "complexity", key: "complexity", number: true}, {name: "CPU s", key: "cpu", number: true},
    {name: "proved free", key: "proved", number: true, show: (r) => `${r.proved}/${r.ok}`},
    {name: "singular", key: "refuted", number: true, show: (r) => share(r.refuted, r.ok)},
    {name: "failed", key: "failed", number: true, show: (r) => share(r.failed, r.cells)},
    {name: "formula of the middle seed", key: "formula", show: (r) => r.formula ? formulaElement(r.formula) : "–"});
  return dataTable(columns, table.rows, {label: `methods on ${table.problem}, ${table.operators}`});
}

function winnersTable() {
  const rows = data.tables.map((t) => {
    const best = t.rows.find((r) => r.standing === "best") || {};
    return {problem: t.problem, operators: t.operators, method: best.method || "none", mae: best.mae,
            complexity: best.complexity, refuted: best.refuted || 0, ok: best.ok || 0, sure: t.certainty};
  });
  return dataTable([
    {name: "problem", key: "problem"}, {name: "operators", key: "operators"},
    {name: "best method", key: "method", show: (r) => el("b", {}, r.method)},
    {name: "MAE test", key: "mae", number: true}, {name: "complexity", key: "complexity", number: true},
    {name: "singular", key: "refuted", number: true, show: (r) => share(r.refuted, r.ok)},
    {name: "how sure", key: "sure"}], rows, {label: "who wins where"});
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
}

function drawFronts(look) {
  const points = data.fronts.filter(here).map((f) => ({...f, x: f.complexity, y: f.mae, series: f.method}))
    .filter((f) => f.y > 0).sort((a, b) => a.x - b.x);
  draw("front", points.length ? frontPlot(points, look("front")) : null, {onclick: showRecord,
    empty: "No front was written for this problem."});
}

function curvesOf(picture) {
  return data.curves.filter((c) => c.picture === picture && c.problem === state.problem &&
                            (c.method === "" || c.operators === state.operators || c.operators === "-"))
    .flatMap((c) => c.x.map((x, i) => ({x, y: c.y[i], curve: c.curve, method: c.method || "data",
      series: c.method + "|" + c.curve, axes: [c.x_name, c.y_name]})));
}

function drawCurve(id, picture, description, look, dots) {
  const points = curvesOf(picture);
  if (!points.length) return draw(id, null, {empty: "The run holds no curves of this kind."});
  const axes = points[0].axes;
  points.forEach((p) => { delete p.axes; if (dots && p.method !== "data") p.dots = true; });
  draw(id, curvePlot(points, look(id), axes, description));
}

function drawTrace(id, axis, look) {
  const points = data.traces.filter((t) => here(t) && t.axis === id.slice(6)).flatMap((t) =>
    t.x.map((x, i) => ({x, y: t.middle[i], low: t.low[i], high: t.high[i], method: t.method, series: t.method})))
    .filter((p) => p.y > 0 && p.low > 0 && isFinite(p.high));
  draw(id, points.length ? tracePlot(points, look(id), axis) : null, {empty: "No trace was written."});
}

function drawShares(id, list, title, description, look) {
  const points = list.filter((s) => s.operators === state.operators)
    .flatMap((s) => s.x.map((x, i) => ({x, y: s.share[i], method: s.method, series: s.method})));
  draw(id, points.length ? sharePlot(points, look(id), title, description) : null);
}

function drawSingular(look) {
  const found = data.singular.filter(here);
  const axes = [...new Set(found.flatMap((s) => Object.keys(s.point)))].filter((a) => !a.startsWith("sgn_")).slice(0, 2);
  const points = found.map((s) => ({...s, x: s.point[axes[0]], y: s.point[axes[1]], witness: JSON.stringify(s.point)}))
    .filter((p) => isFinite(p.x));
  draw("singular", points.length ? singularPlot(points, look("singular"), axes) : null,
       {onclick: showRecord, empty: "No formula of this problem was found singular inside the input box."});
}

function drawProblem() {
  const look = (id) => lookFor(allMethods, widthOf(id));
  const table = tableHere();
  byId("problem-title").textContent = `${state.problem}, operators ${state.operators}`;
  byId("problem-reading").textContent = table ? table.reading : "No cell of this problem has ended.";
  byId("problem-table").replaceChildren(table ? methodTable(table) : "");
  byId("record").hidden = true;
  drawFronts(look);
  drawCurve("friction", "friction", "Friction against velocity", look);
  drawCurve("error", "error", "Error against velocity", look, true);
  drawCurve("profile", "profile", "Prediction along a sinusoidal velocity profile", look);
  drawTrace("trace-evaluations", "evaluations (node-rows)", look);
  drawTrace("trace-cpu", "CPU seconds", look);
  drawSingular(look);
  drawShares("profiles", data.profiles, "error as a factor to the best of its cell",
             "Performance profile: share of cells within a factor of the best error", look);
  drawShares("ecdf", data.ecdf, "evaluations (node-rows)",
             "Share of targets reached against evaluations", look);
  const ranking = data.rankings.find((r) => r.operators === state.operators);
  byId("rank-reading").textContent = ranking ? ranking.reading : "";
  draw("ranks", ranking && ranking.methods.length > 1 ? rankPlot(ranking, look("ranks")) : null);
  const heat = data.tables.filter((t) => t.operators === state.operators).flatMap((t) =>
    t.rows.map((r) => ({problem: t.problem, method: r.method, ratio: r.ratio, mae: r.mae, standing: r.standing})));
  draw("heat", heat.length ? heatPlot(heat, look("heat")) : null);
}

function failuresPart() {
  const parts = [];
  const rows = data.failures.map((f) => ({...f, first: f.cells.join(", ")}));
  parts.push(rows.length ? dataTable([
    {name: "method", key: "method"}, {name: "reason", key: "reason"}, {name: "cells", key: "count", number: true},
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
  return [el("h2", {id: "reference"}, "Published figures beside ours"),
    dataTable([{name: "table", key: "table"}, {name: "problem", key: "problem"},
      {name: "method", key: "published_method"}, {name: "published MAE", key: "published_mae", number: true},
      {name: "ours", key: "method"}, {name: "operators", key: "operators"}, {name: "our MAE", key: "mae", number: true},
      {name: "lowest", key: "low", number: true}, {name: "highest", key: "high", number: true},
      {name: "published complexity", key: "published_complexity", number: true},
      {name: "our complexity", key: "complexity", number: true}, {name: "note", key: "note"}],
      data.reference, {label: "published figures beside ours"})];
}

function recordsPart() {
  const rows = data.records.rows.map((values) => Object.fromEntries(data.records.columns.map((c, i) => [c, values[i]])));
  const number = new Set(["seed", "mae_test", "mae_train", "complexity", "nodes", "fit_cpu_s", "evaluations", "r2_test"]);
  const columns = data.records.columns.map((c) => ({name: c, key: c, number: number.has(c),
    show: c === "formula" ? (r) => formulaText(r.formula) : undefined}));
  const note = data.records.total > rows.length
    ? `${rows.length} of ${data.records.total} records: failed and singular ones first, then one a method; all are in results.csv.` : "";
  return [el("p", {class: "soft"}, note), dataTable(columns, rows, {label: "records", limit: 200})];
}

function fact(value, label, bad) {
  return el("div", {class: "fact"}, el("b", {class: bad ? "bad" : undefined}, value), el("span", {class: "soft"}, label));
}

function build() {
  const c = data.counts;
  byId("top").append(el("h1", {}, data.name), el("p", {class: "soft"}, data.made_with),
    el("div", {class: "facts"}, fact(String(c.cells), "cells"), fact(String(c.failed), "failed", c.failed > 0),
      fact(String(c.missing), "missing", c.missing > 0), fact(String(data.problems.length), "problems"),
      fact(String(allMethods.length), "methods"), fact(c.cpu, "CPU time in fits")));
  byId("nav").append(
    ...[["#wins", "who wins"], ["#problem", "problem"], ["#overall", "all problems"], ["#failed", "failed"],
        ["#records", "records"], ["#provenance", "provenance"]].map(([h, t]) => el("a", {href: h}, t)),
    el("span", {class: "push"}, chooser("problem", data.problems, "problem"),
       chooser("operators", data.operators, "operators"), themeButton()));
  byId("main").append(
    el("h2", {id: "wins"}, "Who wins where"), winnersTable(),
    el("h2", {id: "problem"}, el("span", {id: "problem-title"})),
    el("p", {class: "reading", id: "problem-reading"}), el("div", {id: "problem-table"}),
    el("div", {class: "card", id: "record", hidden: "hidden"}),
    el("div", {class: "grid", style: "margin-top:1rem"},
      card("front", "Accuracy and complexity", "Each point is a formula no other beats in both; ringed: chosen; cross: singular. Hover shows the formula, click its record."),
      card("friction", "Friction against velocity", "Dashed: the true law where it is known; dots: measured."),
      card("error", "Error against velocity", "Prediction minus measured on test movements."),
      card("profile", "Sinusoidal velocity profile", "What each model predicts along the profile."),
      card("trace-evaluations", "Error against evaluations", "Median over seeds of the best training error so far; band: lowest to highest."),
      card("trace-cpu", "Error against CPU time", "The same against seconds of the fit."),
      card("singular", "Singularities in the input box", "Points where a formula has no finite value.", true)),
    el("h2", {id: "overall"}, "All problems"), el("p", {class: "reading", id: "rank-reading"}),
    el("div", {class: "grid"},
      card("heat", "Factor to the best", "Median error divided by the best of the problem.", true),
      card("ranks", "Mean ranks", "Bars join what Nemenyi's test cannot tell apart at 5 %."),
      card("profiles", "Performance profile", "Share of cells with an error within a factor of the best one of the same problem and seed; failed cells never arrive."),
      card("ecdf", "Targets reached", "Share of targets (2, 1.5, 1.2, 1.1, 1.05 and 1.01 times the best training error of the problem and seed) reached after so many evaluations.", true)),
    ...referencePart(),
    el("h2", {id: "failed"}, "What failed"), ...failuresPart(),
    el("h2", {id: "records"}, "Records"), ...recordsPart(),
    el("h2", {id: "provenance"}, "Provenance"), provenanceTable(data.provenance));
  window.drawAll = drawProblem;
  drawProblem();
  let waiting = 0;
  addEventListener("resize", () => { clearTimeout(waiting); waiting = setTimeout(drawProblem, 150); });
  document.documentElement.dataset.ready = "yes";
}

build();
