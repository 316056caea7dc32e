// SPDX-License-Identifier: MIT
//
// The pictures of a run: its data in, Vega specifications out, for the page and for files alike.
"use strict";

function frontPlot(points, look) {
  return frame({...look, description: "Accuracy against complexity: each point is a formula",
    data: [{name: "points", values: points}],
    x: {title: "complexity", fields: ["x"], zero: true},
    y: logAxis("MAE on test movements", points.map((p) => p.y)),
    marks: [
      grouped("points", [lineMark({interpolate: {value: "step-after"}, strokeWidth: {value: 1.3}}, 0.55)]),
      {type: "symbol", name: "dots", from: {data: "points"}, encode: {
        enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
          fill: {scale: "color", field: "method"}, cursor: {value: "pointer"},
          shape: {signal: "datum.singularity === 'refuted' ? 'cross' : 'circle'"},
          stroke: {value: look.ink}, strokeWidth: {signal: "datum.chosen ? 1.6 : 0"},
          size: {signal: "datum.chosen ? 110 : 55"}, tooltip: {signal: "datum"}},
        hover: {size: {value: 160}}, update: {size: {signal: "datum.chosen ? 110 : 55"}, opacity: faded(1)}}}]});
}

// One panel a method, all with the same axes; `common` (measured points, the true law) stands in
// each of them.
function panelPlot(points, common, look, axes, description, yDomain) {
  const methods = [...new Set(points.map((p) => p.method))];
  const columns = Math.min(Math.max(1, Math.floor(look.width / 225)), methods.length);
  const width = Math.floor(look.width / columns) - 40, height = 130;
  const extent = (values) => values.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  const wider = ([a, b]) => [a - 0.03 * (b - a), b + 0.03 * (b - a)];
  const everything = points.concat(common);
  const dots = (data, fill) => ({type: "symbol", from: {data}, encode: {enter: {x: {scale: "x", field: "x"},
    y: {scale: "y", field: "y"}, size: {value: 11}, opacity: {value: 0.6}, fill, tooltip: {signal: "datum"}}}});
  const lines = (facet, data, stroke, dash) => ({type: "group",
    from: {facet: {name: facet, data, groupby: "series"}}, marks: [{type: "line", from: {data: facet},
      encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}, stroke,
        strokeWidth: {value: dash ? 1.3 : 1.9}, strokeDash: {value: dash ? [5, 4] : [1, 0]},
        tooltip: {signal: "datum"}, defined: {signal: "isValid(datum.y) && isFinite(datum.y)"}}}}]});
  const color = {scale: "color", field: "method"};
  const axis = (orient, scale, gridScale) => ({orient, scale, grid: true, gridScale, tickCount: 4, labelFontSize: 10,
                                               labelFlush: orient === "bottom", labelOverlap: true});
  const isDot = (p) => p.dots || p.curve.startsWith("measured");
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", description, config: plotConfig(look), padding: 5,
    autosize: "pad", layout: {columns, padding: {row: 12, column: 10}, bounds: "full", align: "all"},
    title: {text: `${axes[1]} against ${axes[0]}`, anchor: "start", fontSize: 11, fontWeight: 500, offset: 8},
    data: [{name: "points", values: points}, {name: "commonDots", values: common.filter(isDot)},
           {name: "commonLines", values: common.filter((p) => !isDot(p))}],
    scales: [
      {name: "x", domain: wider(extent(everything.map((p) => p.x))), range: [0, width], zero: false},
      {name: "y", domain: yDomain || extent(everything.map((p) => p.y)), range: [height, 0], nice: !yDomain, zero: false},
      {name: "color", type: "ordinal", domain: look.methods, range: look.colors}],
    marks: [{type: "group", from: {facet: {name: "panel", data: "points", groupby: "method"}},
      title: {text: {signal: "parent.method"}, frame: "group", anchor: "start", fontSize: 12, offset: 5},
      encode: {update: {width: {value: width}, height: {value: height}}},
      axes: [axis("bottom", "x", "y"), axis("left", "y", "x")],
      data: [{name: "panelDots", source: "panel", transform: [{type: "filter", expr: "datum.dots === true"}]},
             {name: "panelLines", source: "panel", transform: [{type: "filter", expr: "datum.dots !== true"}]}],
      marks: [{type: "group", encode: {update: {width: {value: width}, height: {value: height}, clip: {value: true}}},
        marks: [dots("commonDots", {value: look.soft}), lines("law", "commonLines", {value: look.ink}, true),
                dots("panelDots", color), lines("series", "panelLines", color, false)]}]}]};
}

function tracePlot(points, look, axis) {
  const starts = [...new Map(points.map((p) => [p.series, p]).reverse()).values()];
  return frame({...look, description: "Best training error so far against " + axis,
    data: [{name: "points", values: points}, {name: "starts", values: starts}],
    x: logAxis(axis, points.map((p) => p.x), {format: "~e"}),
    y: logAxis("mean squared training error", points.flatMap((p) => [p.low, p.high])),
    marks: [grouped("points", [
      {type: "area", from: {data: "series"}, encode: {enter: {x: {scale: "x", field: "x"},
        y: {scale: "y", field: "low"}, y2: {scale: "y", field: "high"},
        fill: {scale: "color", field: "method"}, fillOpacity: {value: 0.13}}}},
      lineMark({tooltip: {signal: "datum"}})]),
      {type: "symbol", from: {data: "starts"}, encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
        size: {value: 40}, fill: {scale: "color", field: "method"}, tooltip: {signal: "datum"}}}}]});
}

function sharePlot(points, look, title, description, format, what) {
  return frame({...look, description, data: [{name: "points", values: points}],
    x: logAxis(title, points.map((p) => p.x), {format}),
    y: {title: what, domain: [0, 1], format: "%"},
    marks: [grouped("points", [lineMark({interpolate: {value: "step-after"},
                                         tooltip: {signal: "datum"}})])]});
}

// Share recovered against the time of a problem: ours with their intervals, published ones as lines.
function suitePlot(view, rows, look) {
  const published = view.references.map((r) => ({...r, x: r.seconds, y: r.recovered, series: r.method}));
  const last = [...new Map(published.map((p) => [p.series, p])).values()];
  const at = {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}};
  return frame({...look, description: "Share of the suite recovered against wall seconds of a problem",
    data: [{name: "points", values: rows}, {name: "published", values: published}, {name: "last", values: last}],
    x: logAxis("wall seconds of a problem (median)", rows.concat(published).map((p) => p.x), {format: "~g"}),
    y: {title: "recovered", domain: [0, 1], format: "%"},
    marks: [
      grouped("published", [{type: "line", from: {data: "series"}, encode: {enter: {...at, stroke: {value: look.soft},
        strokeDash: {value: [5, 4]}, strokeWidth: {value: 1.3}, tooltip: {signal: "datum"}}}}]),
      {type: "text", from: {data: "last"}, encode: {enter: {...at, dx: {value: -4}, dy: {value: -6}, align: {value: "right"},
        text: {field: "series"}, fill: {value: look.soft}, fontSize: {value: 10}}}},
      {type: "rule", from: {data: "points"}, encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "low"},
        y2: {scale: "y", field: "high"}, stroke: {scale: "color", field: "method"}, strokeWidth: {value: 2}}}},
      {type: "symbol", from: {data: "points"}, encode: {enter: {...at, size: {value: 90},
        fill: {scale: "color", field: "method"}, tooltip: {signal: "datum"}}}}]});
}

// Mean ranks with half a critical difference to either side: two methods whose intervals do not
// overlap can be told apart. Bars at the right join the methods that cannot.
function rankPlot(ranking, look) {
  const cd = ranking.critical_difference;
  const count = ranking.methods.length;
  const inside = (rank) => Math.min(count, Math.max(1, rank));
  const values = ranking.methods.map((method, i) => ({method, rank: ranking.ranks[i], y: i,
    low: inside(ranking.ranks[i] - cd / 2), high: inside(ranking.ranks[i] + cd / 2)}));
  const tied = [];
  values.forEach((a, i) => {
    let last = i;
    values.forEach((b, j) => { if (j > i && b.rank - a.rank < cd) last = j; });
    if (last > i && !tied.some((t) => t.last >= last)) tied.push({from: i, last, level: tied.length});
  });
  const step = 24, gutter = 12 + 9 * tied.length;
  const y = (row) => `(${row} + .5) * ${step}`;
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: {left: 5, top: 5, bottom: 5, right: 5 + gutter},
    description: "Mean ranks over problems with intervals of the critical difference; bars join methods that are not distinguishable",
    width: look.width, height: count * step, autosize: {type: "fit-x", contains: "padding"},
    data: [{name: "values", values}, {name: "tied", values: cd === null ? [] : tied}],
    scales: [{name: "x", domain: [1, Math.max(2, count)], range: "width", zero: false},
             {name: "y", type: "band", domain: ranking.methods, range: "height"},
             {name: "color", type: "ordinal", domain: look.methods, range: look.colors}],
    axes: [{orient: "bottom", scale: "x", title: "mean rank (1 is best)", grid: true, tickMinStep: 1},
           {orient: "left", scale: "y", domain: false, ticks: false, labelColor: look.ink, labelFontSize: 12}],
    marks: [
      {type: "rule", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "low"},
        x2: {scale: "x", field: "high"}, y: {signal: y("datum.y")}, stroke: {scale: "color", field: "method"},
        strokeOpacity: {value: cd === null ? 0 : 0.35}, strokeWidth: {value: 7}, strokeCap: {value: "round"}}}},
      {type: "symbol", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "rank"},
        y: {signal: y("datum.y")}, size: {value: 100},
        fill: {scale: "color", field: "method"}, tooltip: {signal: "datum"}}}},
      {type: "text", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "rank"},
        align: {value: "center"}, dy: {value: -7}, y: {signal: y("datum.y")}, fontSize: {value: 10},
        text: {signal: "format(datum.rank, '.2f')"}, fill: {value: look.ink}}}},
      {type: "rule", from: {data: "tied"}, encode: {enter: {x: {signal: "width + 10 + 9 * datum.level"},
        y: {signal: y("datum.from") + " - 6"}, y2: {signal: y("datum.last") + " + 6"},
        strokeWidth: {value: 4}, strokeCap: {value: "round"}, stroke: {value: look.ink}}}}]};
}

function heatPlot(values, look, methods) {
  const problems = [...new Set(values.map((v) => v.problem))];
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: 5,
    description: "Median error of each method on each problem, as a factor to the best",
    width: look.width, height: Math.max(80, problems.length * 26),
    autosize: {type: "fit-x", contains: "padding"}, data: [{name: "values", values}],
    scales: [{name: "x", type: "band", domain: methods, range: "width", padding: 0.04},
             {name: "y", type: "band", domain: problems, range: "height", padding: 0.04},
             {name: "color", type: "log", domain: [1, 10], clamp: true, interpolate: "hcl",
              range: look.dark ? ["#176b70", "#2a2f36"] : ["#5fb8bd", "#f4f1ea"]}],
    axes: [{orient: "top", scale: "x", labelAngle: -28, labelAlign: "left", domain: false, ticks: false},
           {orient: "left", scale: "y", domain: false, ticks: false}],
    marks: [
      {type: "rect", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "method"},
        y: {scale: "y", field: "problem"}, width: {scale: "x", band: 1}, height: {scale: "y", band: 1},
        fill: {signal: `isValid(datum.ratio) ? scale('color', datum.ratio) : '${look.dark ? "#5c2a2a" : "#f3c9c5"}'`},
        tooltip: {signal: "datum"}}}},
      {type: "text", from: {data: "values"}, encode: {enter: {
        x: {scale: "x", field: "method", band: 0.5}, y: {scale: "y", field: "problem", band: 0.5},
        align: {value: "center"}, baseline: {value: "middle"}, fontSize: {value: 11},
        fontWeight: {signal: "datum.standing === 'best' ? 700 : 400"}, fill: {value: look.ink},
        text: {signal: "isValid(datum.ratio) ? (datum.ratio < 10 ? format(datum.ratio, '.2f') : format(datum.ratio, '.2~s')) : 'failed'"}}}}]};
}

// axes: the inputs' names, one or two; with one the methods stand above each other. box: the range
// of the first, where it is known.
function singularPlot(points, look, axes, box) {
  const flat = axes.length < 2;
  const most = points.reduce((m, p) => Math.max(m, Math.abs(p.y)), 0) * 1.1 || 1;
  const spec = frame({...look, description: "Where in the input box a formula has no finite value",
    data: [{name: "points", values: points}], height: flat ? 120 : 300,
    x: {title: axes[0], fields: ["x"], domain: box, nice: !box},
    y: flat ? {domain: look.methods, title: ""} : {title: axes[1], domain: [-most, most]},
    marks: [{type: "symbol", from: {data: "points"}, encode: {enter: {x: {scale: "x", field: "x"},
      y: flat ? {scale: "y", field: "method", band: 0.5} : {scale: "y", field: "y"},
      shape: {value: "cross"}, size: {value: 70}, angle: {value: 45}, cursor: {value: "pointer"},
      fill: {scale: "color", field: "method"}, tooltip: {signal: "datum"}}}}]});
  if (flat) {
    spec.scales[1] = {name: "y", type: "band", range: "height",
                      domain: [...new Set(points.map((p) => p.method))]};
  }
  return spec;
}

// What of a run's data a choice {problem, operators, hidden: Set of methods} shows.
class RunPictures {
  constructor(data, choice) {
    this.data = data;
    this.choice = choice;
    this.table = data.tables.find((t) => t.problem === choice.problem && t.operators === choice.operators);
  }

  shows(method) { return !this.choice.hidden.has(method); }
  here(row) {
    const own = row.operators === this.choice.operators || row.operators === "-";
    return own && row.problem === this.choice.problem && (!row.method || this.shows(row.method));
  }

  front(look) {
    const points = this.data.fronts.filter((f) => this.here(f)).map((f) => ({...f, x: f.complexity, y: f.mae, series: f.method}))
      .filter((f) => f.y > 0).sort((a, b) => a.x - b.x);
    return points.length ? frontPlot(points, this.legend(look, points)) : null;
  }

  // A legend names who is in the picture.
  legend(look, points) {
    const present = new Set(points.map((p) => p.method));
    return {...look, shown: look.methods.filter((m) => present.has(m))};
  }

  curves(picture) {
    const place = new Map((this.table ? this.table.rows : []).map((row, i) => [row.method, i]));
    return this.data.curves.filter((c) => c.picture === picture && c.problem === this.choice.problem &&
                                   (c.method === "" || (this.shows(c.method) && (c.operators === this.choice.operators || c.operators === "-"))))
      .sort((a, b) => (place.get(a.method) ?? 0) - (place.get(b.method) ?? 0))
      .flatMap((c) => c.x.map((x, i) => ({x, y: c.y[i], curve: c.curve, method: c.method || "data",
        series: c.method + "|" + c.curve, axes: [c.x_name, c.y_name]})));
  }

  panels(picture, description, look, dots) {
    const all = this.curves(picture);
    if (!all.some((p) => p.method !== "data")) return null;
    const axes = dots ? [all[0].axes[0], "error of " + all[0].axes[1]] : all[0].axes;
    all.forEach((p) => { delete p.axes; if (dots && p.method !== "data") p.dots = true; });
    const points = all.filter((p) => p.method !== "data");
    return panelPlot(points, all.filter((p) => p.method === "data"), look, axes, description,
                     dots ? this.errorDomain(points) : undefined);
  }

  // Wide enough for the methods within five times the best error; others are cut off at the frame.
  errorDomain(points) {
    const near = new Set((this.table ? this.table.rows : []).filter((r) => r.ratio !== null && r.ratio <= 5).map((r) => r.method));
    let most = 0;
    for (const p of points) if (!near.size || near.has(p.method)) most = Math.max(most, Math.abs(p.y));
    return most > 0 ? [-1.05 * most, 1.05 * most] : undefined;
  }

  friction(look) { return this.panels("friction", "Friction against velocity, one panel a method", look, false); }
  error(look) { return this.panels("error", "Error against velocity, one panel a method", look, true); }

  profile(look) {
    const points = this.curves("profile");
    if (!points.length) return null;
    const axes = points[0].axes;
    points.forEach((p) => { delete p.axes; });
    return curvePlot(points, this.legend(look, points), axes, "Prediction along a sinusoidal velocity profile");
  }

  trace(axis, title, look) {
    const points = this.data.traces.filter((t) => this.here(t) && t.axis === axis).flatMap((t) =>
      t.x.map((x, i) => ({x, y: t.middle[i], low: t.low[i], high: t.high[i], method: t.method, series: t.method})))
      .filter((p) => p.y > 0 && p.low > 0 && p.high !== null);
    return points.length ? tracePlot(points, this.legend(look, points), title) : null;
  }

  shares(list, title, description, format, what, look) {
    const points = list.filter((s) => s.operators === this.choice.operators && this.shows(s.method))
      .flatMap((s) => s.x.map((x, i) => ({x, y: s.share[i], method: s.method, series: s.method})));
    return points.length ? sharePlot(points, this.legend(look, points), title, description, format, what) : null;
  }

  profiles(look) {
    return this.shares(this.data.profiles, "error as a factor to the best of its cell",
                       "Performance profile: share of cells within a factor of the best error", "~g", "share of cells", look);
  }

  ecdf(look) {
    return this.shares(this.data.ecdf, "evaluations (node-rows)", "Share of targets reached against evaluations",
                       "~e", "share of targets", look);
  }

  singular(look) {
    const found = this.data.singular.filter((s) => this.here(s));
    const axes = [...new Set(found.flatMap((s) => Object.keys(s.point)))].filter((a) => !a.startsWith("sgn_")).slice(0, 2);
    const points = found.map((s) => ({...s, x: s.point[axes[0]], y: s.point[axes[1]], witness: JSON.stringify(s.point)}))
      .filter((p) => isFinite(p.x));
    return points.length ? singularPlot(points, this.legend(look, points), axes, this.range(axes[0])) : null;
  }

  // The input's range: friction curves run over the whole box.
  range(input) {
    const curve = this.data.curves.find((c) => c.picture === "friction" && c.problem === this.choice.problem &&
                                               c.method !== "" && c.x_name.startsWith(input + " in "));
    return curve ? [curve.x[0], curve.x[curve.x.length - 1]] : undefined;
  }

  ranks(look) {
    const ranking = this.data.rankings.find((r) => r.operators === this.choice.operators);
    return ranking && ranking.methods.length > 1 ? rankPlot(ranking, look) : null;
  }

  heat(look) {
    const values = this.data.tables.filter((t) => t.operators === this.choice.operators).flatMap((t) =>
      t.rows.filter((r) => this.shows(r.method))
        .map((r) => ({problem: t.problem, method: r.method, ratio: r.ratio, mae: r.mae, standing: r.standing})));
    const present = new Set(values.map((v) => v.method));
    return values.length ? heatPlot(values, look, look.methods.filter((m) => present.has(m))) : null;
  }

  // The first suite of the run: one is what people run.
  suite(look) {
    const view = this.data.suites[0];
    if (!view) return null;
    const rows = view.rows.filter((r) => this.shows(r.method) && r.fit_wall_s > 0)
      .map((r) => ({...r, x: r.fit_wall_s, y: r.recovered}));
    return rows.length ? suitePlot(view, rows, this.legend(look, rows)) : null;
  }

  trace_evaluations(look) { return this.trace("evaluations", "evaluations (node-rows)", look); }
  trace_cpu(look) { return this.trace("cpu", "CPU seconds", look); }
}

// The pictures of one problem, and those of all problems together, by the name of their method above.
const kProblemPictures = ["front", "friction", "error", "profile", "trace_evaluations", "trace_cpu", "singular"];
const kOverallPictures = ["heat", "ranks", "profiles", "ecdf", "suite"];
