// SPDX-License-Identifier: MIT
//
// One function a picture: data in, a Vega specification out. Nothing is drawn here.
"use strict";

const kPalette = ["#0b6e75", "#d1495b", "#edae49", "#5b5ea6", "#66a182", "#8d5a97", "#2e86ab",
                  "#c97b3d", "#7a8450", "#a23b72", "#4f6d7a", "#b8a12f"];

function inkOf() {
  const style = getComputedStyle(document.documentElement);
  return {ink: style.getPropertyValue("--ink").trim(), soft: style.getPropertyValue("--soft").trim(),
          line: style.getPropertyValue("--line").trim(), card: style.getPropertyValue("--card").trim()};
}

function plotConfig() {
  const c = inkOf();
  return {
    background: null,
    axis: {labelColor: c.soft, titleColor: c.ink, gridColor: c.line, domainColor: c.soft,
           tickColor: c.soft, titleFontWeight: 500, labelFontSize: 11, titleFontSize: 12,
           gridOpacity: 0.8},
    legend: {labelColor: c.ink, titleColor: c.ink, labelFontSize: 11, symbolSize: 70},
    title: {color: c.ink}, text: {fill: c.ink}};
}

// The frame that every picture shares: size, scales, axes, a colour for each method.
function frame(o) {
  const height = o.height || 300;
  const scale = (name, range, axis) => ({
    name, range, type: axis.type || "linear", nice: axis.nice !== false, zero: axis.zero === true,
    domain: axis.domain || {data: axis.data || "points", fields: axis.fields}});
  const ticks = (orient, axis, name) => ({
    orient, scale: name, title: axis.title, grid: true, tickCount: axis.type === "log" ? 5 : 6,
    format: axis.format, labelOverlap: true, labelFlush: orient === "bottom"});
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", description: o.description,
    width: o.width || 480, height, padding: 5, autosize: {type: "fit", contains: "padding"},
    config: plotConfig(), data: o.data,
    scales: [scale("x", "width", o.x), scale("y", "height", o.y),
             {name: "color", type: "ordinal", domain: o.methods, range: o.colors}],
    axes: [ticks("bottom", o.x, "x"), ticks("left", o.y, "y")],
    legends: o.legend === false ? []
      : [{fill: "color", orient: "bottom", direction: "horizontal", columns: 4, symbolType: "circle"}],
    marks: o.marks};
}

const grouped = (from, marks) => ({
  type: "group", from: {facet: {name: "series", data: from, groupby: "series"}}, marks});

const lineMark = (extra) => ({
  type: "line", from: {data: "series"},
  encode: {enter: Object.assign({x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
    stroke: {scale: "color", field: "method"}, strokeWidth: {value: 2},
    defined: {signal: "isValid(datum.y) && isFinite(datum.y)"}}, extra || {})}});

function frontPlot(points, look) {
  return frame({...look, description: "Accuracy against complexity: each point is a formula",
    data: [{name: "points", values: points}],
    x: {title: "complexity", fields: ["x"], zero: true},
    y: {title: "mean absolute error on test movements", fields: ["y"], type: "log"},
    marks: [
      grouped("points", [lineMark({interpolate: {value: "step-after"}, strokeWidth: {value: 1.3},
                                   strokeOpacity: {value: 0.55}})]),
      {type: "symbol", name: "dots", from: {data: "points"}, encode: {
        enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
          fill: {scale: "color", field: "method"}, cursor: {value: "pointer"},
          shape: {signal: "datum.singularity === 'refuted' ? 'cross' : 'circle'"},
          stroke: {value: look.ink}, strokeWidth: {signal: "datum.chosen ? 1.6 : 0"},
          size: {signal: "datum.chosen ? 110 : 55"}, tooltip: {signal: "datum"}},
        hover: {size: {value: 160}}, update: {size: {signal: "datum.chosen ? 110 : 55"}}}}]});
}

function curvePlot(points, look, axes, description) {
  const measured = points.filter((p) => p.curve.startsWith("measured") || p.dots);
  const lines = points.filter((p) => !(p.curve.startsWith("measured") || p.dots));
  return frame({...look, description,
    data: [{name: "points", values: points}, {name: "measured", values: measured},
           {name: "lines", values: lines}],
    x: {title: axes[0], fields: ["x"]}, y: {title: axes[1], fields: ["y"]},
    marks: [
      {type: "symbol", from: {data: "measured"}, encode: {enter: {x: {scale: "x", field: "x"},
        y: {scale: "y", field: "y"}, size: {value: 14}, opacity: {value: 0.55},
        fill: {signal: `datum.method === 'data' ? '${look.soft}' : scale('color', datum.method)`},
        tooltip: {signal: "datum"}}}},
      grouped("lines", [{type: "line", from: {data: "series"}, encode: {enter: {
        x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
        stroke: {signal: `datum.method === 'data' ? '${look.ink}' : scale('color', datum.method)`},
        strokeDash: {signal: "datum.method === 'data' ? [5, 4] : [1, 0]"},
        strokeWidth: {value: 1.8}, tooltip: {signal: "datum"},
        defined: {signal: "isValid(datum.y) && isFinite(datum.y)"}}}}])]});
}

function tracePlot(points, look, axis) {
  return frame({...look, description: "Best training error so far against " + axis,
    data: [{name: "points", values: points}],
    x: {title: axis, fields: ["x"], type: "log", nice: false, format: "~e"},
    y: {title: "best training error", fields: ["low", "high"], type: "log", format: "~g"},
    marks: [grouped("points", [
      {type: "area", from: {data: "series"}, encode: {enter: {x: {scale: "x", field: "x"},
        y: {scale: "y", field: "low"}, y2: {scale: "y", field: "high"},
        fill: {scale: "color", field: "method"}, fillOpacity: {value: 0.13}}}},
      lineMark({tooltip: {signal: "datum"}})])]});
}

function sharePlot(points, look, title, description) {
  return frame({...look, description, data: [{name: "points", values: points}],
    x: {title, fields: ["x"], type: "log", nice: false, format: "~g"},
    y: {title: "share of cells", domain: [0, 1], format: "%"},
    marks: [grouped("points", [lineMark({interpolate: {value: "step-after"},
                                         tooltip: {signal: "datum"}})])]});
}

function rankPlot(ranking, look) {
  const values = ranking.methods.map((method, i) => ({method, rank: ranking.ranks[i], y: i}));
  const cd = ranking.critical_difference;
  const tied = [];
  values.forEach((a, i) => {
    let last = i;
    values.forEach((b, j) => { if (j > i && b.rank - a.rank < cd) last = j; });
    if (last > i && !tied.some((t) => t.last >= last)) tied.push({from: a.rank, to: values[last].rank, last});
  });
  tied.forEach((t, i) => { t.level = i; });
  const rows = values.length, step = 24, top = 30 + 9 * tied.length;
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(), padding: 5,
    description: "Mean ranks over problems; bars join methods that are not distinguishable",
    width: look.width, height: top + rows * step, autosize: {type: "fit-x", contains: "padding"},
    data: [{name: "values", values}, {name: "tied", values: tied},
           {name: "cd", values: isFinite(cd) && cd !== null ? [{from: 1, to: 1 + cd}] : []}],
    scales: [{name: "x", domain: [1, Math.max(2, ranking.methods.length)], range: "width"},
             {name: "color", type: "ordinal", domain: look.methods, range: look.colors}],
    axes: [{orient: "bottom", scale: "x", title: "mean rank (1 is best)", grid: true, tickMinStep: 1}],
    marks: [
      {type: "rule", from: {data: "cd"}, encode: {enter: {x: {scale: "x", field: "from"},
        x2: {signal: "min(width, scale('x', datum.to))"}, y: {value: 8}, strokeWidth: {value: 3}, stroke: {value: look.soft}}}},
      {type: "text", from: {data: "cd"}, encode: {enter: {x: {value: 0}, y: {value: 20},
        text: {value: "critical difference " + (isFinite(cd) && cd !== null ? cd.toFixed(2) : "")},
        fontSize: {value: 11}, fill: {value: look.soft}}}},
      {type: "rule", from: {data: "tied"}, encode: {enter: {x: {scale: "x", field: "from", offset: -4},
        x2: {scale: "x", field: "to", offset: 4}, y: {signal: "28 + 9 * datum.level"},
        strokeWidth: {value: 4}, strokeCap: {value: "round"}, stroke: {value: look.ink}}}},
      {type: "rule", from: {data: "values"}, encode: {enter: {x: {value: 0},
        x2: {scale: "x", field: "rank"}, y: {signal: `${top} + (datum.y + .5) * ${step}`},
        stroke: {scale: "color", field: "method"}, strokeOpacity: {value: 0.4}, strokeWidth: {value: 6}}}},
      {type: "symbol", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "rank"},
        y: {signal: `${top} + (datum.y + .5) * ${step}`}, size: {value: 110},
        fill: {scale: "color", field: "method"}, tooltip: {signal: "datum"}}}},
      {type: "text", from: {data: "values"}, encode: {enter: {
        x: {signal: "scale('x', datum.rank) > width * 0.6 ? scale('x', datum.rank) - 10 : scale('x', datum.rank) + 10"},
        align: {signal: "scale('x', datum.rank) > width * 0.6 ? 'right' : 'left'"},
        y: {signal: `${top} + (datum.y + .5) * ${step}`}, baseline: {value: "middle"},
        text: {signal: "datum.method + '  ' + format(datum.rank, '.2f')"}, fontSize: {value: 12},
        fill: {value: look.ink}}}}]};
}

function heatPlot(values, look) {
  const problems = [...new Set(values.map((v) => v.problem))];
  const methods = look.order;
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(), padding: 5,
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

function singularPlot(points, look, axes) {
  const flat = axes.length < 2;
  const spec = frame({...look, description: "Where in the input box a formula has no finite value",
    data: [{name: "points", values: points}],
    x: {title: axes[0], fields: ["x"]}, y: flat ? {domain: look.methods, title: ""}
                                                : {title: axes[1], fields: ["y"]},
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

function residualPlot(points, look, axes) {
  const spec = curvePlot(points, look, axes, "Residual before and after, with the fitted effect");
  spec.marks[0].encode.enter.opacity = {value: 0.45};
  return spec;
}

function movementPlot(values, look, unit) {
  const spec = frame({...look, height: 260, description: "Error of each movement before and after",
    data: [{name: "points", values}],
    x: {title: "MAE before, " + unit, fields: ["before", "after"], zero: true},
    y: {title: "MAE after, " + unit, fields: ["before", "after"], zero: true},
    marks: [
      {type: "rule", encode: {enter: {x: {value: 0}, y: {signal: "height"}, x2: {signal: "width"},
        y2: {value: 0}, stroke: {value: look.soft}, strokeDash: {value: [4, 4]}}}},
      {type: "symbol", from: {data: "points"}, encode: {enter: {x: {scale: "x", field: "before"},
        y: {scale: "y", field: "after"}, size: {value: 60}, fill: {scale: "color", field: "method"},
        fillOpacity: {value: 0.75}, tooltip: {signal: "datum"}}}}]});
  spec.axes[1].title = "MAE after, " + unit;
  return spec;
}

function barPlot(values, look, title) {
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(), padding: 5,
    description: title, width: look.width, height: Math.max(60, values.length * 26),
    autosize: {type: "fit-x", contains: "padding"}, data: [{name: "values", values}],
    scales: [{name: "x", domain: {data: "values", field: "x"}, zero: true, nice: true, range: "width"},
             {name: "y", type: "band", domain: {data: "values", field: "name"}, range: "height", padding: 0.2}],
    axes: [{orient: "bottom", scale: "x", title, grid: true}, {orient: "left", scale: "y"}],
    marks: [{type: "rect", from: {data: "values"}, encode: {enter: {x: {scale: "x", value: 0},
      x2: {scale: "x", field: "x"}, y: {scale: "y", field: "name"}, height: {scale: "y", band: 1},
      fill: {signal: `datum.found ? '${kPalette[0]}' : '${look.soft}'`}, tooltip: {signal: "datum"}}}}]};
}

function aliasPlot(values, look, families) {
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(), padding: 5,
    description: "How alike two effects are in these data", width: look.width,
    height: families.length * 26, autosize: {type: "fit-x", contains: "padding"},
    data: [{name: "values", values}],
    scales: [{name: "x", type: "band", domain: families, range: "width", padding: 0.04},
             {name: "y", type: "band", domain: families, range: "height", padding: 0.04},
             {name: "color", domain: [0, 1], interpolate: "hcl",
              range: look.dark ? ["#22272e", "#b5523a"] : ["#f7f5f0", "#d1495b"]}],
    axes: [{orient: "top", scale: "x", labelAngle: -28, labelAlign: "left", domain: false, ticks: false},
           {orient: "left", scale: "y", domain: false, ticks: false}],
    marks: [
      {type: "rect", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "a"},
        y: {scale: "y", field: "b"}, width: {scale: "x", band: 1}, height: {scale: "y", band: 1},
        fill: {scale: "color", field: "size"}, tooltip: {signal: "datum"}}}},
      {type: "text", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "a", band: 0.5},
        y: {scale: "y", field: "b", band: 0.5}, align: {value: "center"}, baseline: {value: "middle"},
        fontSize: {value: 10}, fill: {value: look.ink}, text: {signal: "format(datum.size, '.2f')"}}}}]};
}
