// SPDX-License-Identifier: MIT
//
// The pictures of a closed loop (reports/html/loop_page.hpp): data in, Vega specifications out, for
// the page and for files alike. Colours are Okabe and Ito's (2008), which colour-blind readers tell
// apart; what differs in colour differs in dash or place too.
"use strict";

const loopColours = (dark) => dark
  ? {before: "#f0a070", after: "#6cbcf0", levels: ["#6cbcf0", "#f0c75e", "#e29ac2"], low: "#6cbcf0", high: "#f0a070"}
  : {before: "#b8500a", after: "#0067a5", levels: ["#0067a5", "#946200", "#9c3f77"], low: "#0067a5", high: "#b8500a"};

const kGroupDashes = [[1, 0], [7, 4], [2, 3]];

// What a legend says: a line or a dot each, drawn in a square of side 2.
const kShapes = {line: "M-1,0L1,0", dot: "M-0.4,0A0.4,0.4,0,1,0,0.4,0A0.4,0.4,0,1,0,-0.4,0Z", square: "M-0.6,-0.6L0.6,-0.6L0.6,0.6L-0.6,0.6Z"};
const lineLegend = (entries) => entries.map((e) => ({...e, shape: kShapes.line}));
const dotLegend = (entries, shape) => entries.map((e) => ({...e, shape: kShapes[shape || "dot"]}));

function legendsOf(entries, look) {
  if (!entries.length) return {scales: [], legends: []};
  const domain = entries.map((e) => e.label);
  const scale = (name, range) => ({name: "legend" + name, type: "ordinal", domain, range});
  const longest = 46 + 6.6 * Math.max(...domain.map((d) => d.length));
  return {
    scales: [scale("Colour", entries.map((e) => e.colour)), scale("Shape", entries.map((e) => e.shape)),
             scale("Fill", entries.map((e) => e.shape === kShapes.line ? "transparent" : e.colour)), scale("Dash", entries.map((e) => e.dash || [1, 0]))],
    legends: [{orient: "bottom", direction: "horizontal", labelLimit: 260, columnPadding: 16, offset: 6, labelFontSize: 12, symbolSize: 420,
      columns: Math.max(1, Math.min(domain.length, Math.floor((look.width - 50) / longest))), symbolStrokeWidth: 2,
      fill: "legendFill", stroke: "legendColour", shape: "legendShape", strokeDash: "legendDash"}]};
}

const finite = (value) => typeof value === "number" && isFinite(value);

// Rows for Vega of one key of the series, with its colour and dash.
function lineRows(series, key, colour, dash, name) {
  return series.x.map((x, i) => ({x, y: series[key][i], colour, dash, name,
    low: series.band && key === "after" ? series[key][i] - series.band[i] : undefined,
    high: series.band && key === "after" ? series[key][i] + series.band[i] : undefined})).filter((r) => finite(r.y));
}

function dotRows(series, colour, name) {
  return series.x.map((x, i) => ({x, y: series.measured[i], low: series.measured[i] - (series.spread ? series.spread[i] : 0),
    high: series.measured[i] + (series.spread ? series.spread[i] : 0), colour, name, rows: series.rows && series.rows[i]}))
    .filter((r) => finite(r.y));
}

// Axis limits that a few far-off intervals do not decide: what the middles reach, and the intervals as far as
// they are no wider than all of that.
function limitsOf(dots, lines) {
  const middles = dots.concat(lines).map((r) => r.y);
  let low = Math.min(...middles), high = Math.max(...middles);
  const room = high - low || Math.abs(high) || 1;
  for (const r of dots) {
    if (r.low > low - 0.5 * room) low = Math.min(low, r.low);
    if (r.high < high + 0.5 * room) high = Math.max(high, r.high);
  }
  const more = 0.04 * (high - low || 1);
  return [low - more, high + more];
}

// Points with their spread, lines with their bands: what friction, effects and residuals share.
function binnedPlot(picture, look, dots, lines, entries) {
  const {scales, legends} = legendsOf(entries, look);
  const spec = frame({...look, height: look.width < 360 ? 240 + 20 * entries.length : look.height || 280, description: picture.title, methods: [], colors: [], legend: false,
    data: [{name: "points", values: dots.concat(lines).map((r) => ({x: r.x}))}, {name: "dots", values: dots}, {name: "lines", values: lines},
           {name: "marks", values: (picture.marks || []).map((x) => ({x}))}],
    x: {title: picture.x, fields: ["x"], nice: false}, y: {title: picture.y, domain: limitsOf(dots, lines), nice: false, fields: []},
    marks: [
      {type: "rule", from: {data: "marks"}, encode: {enter: {x: {scale: "x", field: "x"}, y: {signal: "height"}, y2: {signal: "height - 6"},
        stroke: {value: look.soft}, strokeOpacity: {value: 0.7}}}},
      {type: "rule", clip: true, encode: {enter: {x: {value: 0}, x2: {signal: "width"}, y: {scale: "y", value: 0},
        stroke: {value: look.soft}, strokeWidth: {value: 1}, strokeOpacity: {signal: "inrange(0, domain('y')) ? 0.7 : 0"}}}},
      {type: "group", clip: true, encode: {enter: {width: {signal: "width"}, height: {signal: "height"}}}, marks: [
        {type: "group", from: {facet: {name: "band", data: "lines", groupby: "name"}}, marks: [{type: "area", from: {data: "band"},
          encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "low"}, y2: {scale: "y", field: "high"},
            fill: {field: "colour"}, fillOpacity: {value: look.dark ? 0.28 : 0.2}, defined: {signal: "isValid(datum.low)"}}}}]},
        {type: "rule", from: {data: "dots"}, encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "low"},
          y2: {scale: "y", field: "high"}, stroke: {field: "colour"}, strokeOpacity: {value: 0.45}, strokeWidth: {value: 1.2}}}},
        {type: "symbol", from: {data: "dots"}, encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}, size: {value: 22},
          fill: {field: "colour"}, tooltip: {signal: "datum"}}}},
        {type: "group", from: {facet: {name: "line", data: "lines", groupby: "name"}}, marks: [{type: "line", from: {data: "line"},
          encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}, stroke: {field: "colour"}, strokeDash: {field: "dash"},
            strokeWidth: {value: 2.1}, tooltip: {signal: "datum"}}}}]}]}]});
  spec.scales = spec.scales.filter((s) => s.name !== "color").concat(scales);
  spec.scales[0].padding = 6;  // pixels: no point is cut in half
  spec.legends = legends;
  return spec;
}

// A direction's bins are a line of their own: nothing is known between them.
function frictionPlot(picture, look) {
  const c = loopColours(look.dark);
  const levels = [...new Set(picture.series.map((s) => s.name))];
  const many = levels.length > 1;
  const dots = [], lines = [];
  picture.series.forEach((s, i) => {
    const colour = many ? c.levels[levels.indexOf(s.name) % c.levels.length] : look.ink;
    dots.push(...dotRows(s, colour, many ? s.name : "measured"));
    if (picture.changed) lines.push(...lineRows(s, "before", many ? colour : c.before, [6, 4], "base " + i));
    lines.push(...lineRows(s, "after", many ? colour : c.after, [1, 0], "model " + i));
  });
  const base = {label: "base", colour: many ? look.ink : c.before, dash: [6, 4]};
  const model = {label: picture.changed ? "new model" : "model", colour: many ? look.ink : c.after};
  return binnedPlot(picture, look, dots, lines, [
    ...dotLegend(many ? levels.map((label, i) => ({label, colour: c.levels[i % c.levels.length]})) : [{label: "measured", colour: look.ink}]),
    ...lineLegend(picture.changed ? [base, model] : [model])]);
}

function effectPlot(picture, look) {
  const c = loopColours(look.dark);
  const many = picture.series.length > 1;
  const colourOf = (i) => many ? c.levels[i % c.levels.length] : c.after;
  const dots = picture.series.flatMap((s, i) => dotRows(s, many ? colourOf(i) : look.ink, s.name || "measured"));
  const lines = picture.series.flatMap((s, i) => lineRows(s, "after", colourOf(i), kGroupDashes[i % 3], s.name || "effect"));
  return binnedPlot(picture, look, dots, lines, [
    ...dotLegend(many ? [] : [{label: "measured", colour: look.ink}]),
    ...lineLegend(many ? picture.series.map((s, i) => ({label: s.name, colour: colourOf(i), dash: kGroupDashes[i % 3]}))
                       : [{label: "fitted effect", colour: c.after}])]);
}

function inputPlot(picture, look) {
  const c = loopColours(look.dark);
  const colourOf = (i) => c.levels[i % c.levels.length];
  const dots = picture.series.flatMap((s, i) => dotRows(s, colourOf(i), s.name));
  const after = picture.series.flatMap((s, i) => lineRows(s, "measured", colourOf(i), kGroupDashes[i % 3], s.name));
  const before = picture.changed
    ? picture.series.flatMap((s, i) => lineRows(s, "before", look.soft, kGroupDashes[i % 3], "before " + s.name)) : [];
  return binnedPlot(picture, look, dots, before.concat(after),
    lineLegend(picture.series.map((s, i) => ({label: s.name, colour: colourOf(i), dash: kGroupDashes[i % 3]})).filter((s) => s.label)
      .concat(picture.changed ? [{label: "before", colour: look.soft}] : [])));
}

// Two bars with their figures, the noise as a band, the interval of the second.
function errorPlot(picture, look) {
  const c = loopColours(look.dark);
  const bars = picture.changed ? [{name: "before", x: picture.before, colour: c.before}, {name: "after", x: picture.after, colour: c.after}]
                               : [{name: "error", x: picture.after, colour: c.after}];
  for (const bar of bars) bar.label = bar.name === "before" ? picture.before_text : picture.after_text;
  const noise = finite(picture.ceiling) ? [{low: picture.ceiling, high: finite(picture.attainable) ? picture.attainable : picture.ceiling}] : [];
  const interval = picture.changed && finite(picture.low) && finite(picture.high) ? [{low: Math.max(0, picture.low), high: picture.high, name: "after"}] : [];
  const top = Math.max(...bars.map((b) => b.x), ...noise.map((n) => n.high), ...interval.map((n) => n.high));
  const noiseColour = look.dark ? "#7f9a8e" : "#8fae97";
  const {scales, legends} = legendsOf(dotLegend(noise.length ? [{label: "where the noise lies", colour: noiseColour}] : [], "square"), look);
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: 5, description: picture.title,
    width: look.width, height: picture.changed ? 84 : 46, autosize: {type: "fit-x", contains: "padding"},
    data: [{name: "bars", values: bars}, {name: "noise", values: noise}, {name: "interval", values: interval}],
    scales: [{name: "x", domain: [0, top * (1 + 80 / Math.max(120, look.width - 150))], range: "width"},
             {name: "y", type: "band", domain: bars.map((b) => b.name), range: "height", padding: 0.28}, ...scales],
    axes: [{orient: "bottom", scale: "x", title: picture.x, tickCount: 5, grid: true, labelOverlap: true, labelFlush: true}, {orient: "left", scale: "y", domain: false, ticks: false, labelFontSize: 13, labelPadding: 6}],
    legends,
    marks: [
      {type: "rect", from: {data: "noise"}, encode: {enter: {x: {scale: "x", field: "low"}, x2: {signal: "max(scale('x', datum.high), scale('x', datum.low) + 3)"},
        y: {value: 0}, y2: {signal: "height"}, fill: {value: noiseColour}, fillOpacity: {value: 0.42}, tooltip: {signal: "datum"}}}},
      {type: "rect", from: {data: "bars"}, encode: {enter: {x: {scale: "x", value: 0}, x2: {scale: "x", field: "x"}, y: {scale: "y", field: "name"},
        height: {scale: "y", band: 1}, fill: {field: "colour"}, fillOpacity: {value: 0.88}, tooltip: {signal: "datum"}}}},
      {type: "rule", from: {data: "interval"}, encode: {enter: {x: {scale: "x", field: "low"}, x2: {scale: "x", field: "high"},
        y: {scale: "y", field: "name", band: 0.5}, stroke: {value: look.ink}, strokeWidth: {value: 2}, tooltip: {signal: "datum"}}}},
      {type: "text", from: {data: "bars"}, encode: {enter: {x: {signal: `max(scale('x', datum.x), datum.name === 'after' && length(data('interval')) ? scale('x', data('interval')[0].high) : 0) + 6`},
        y: {scale: "y", field: "name", band: 0.5}, baseline: {value: "middle"}, fontSize: {value: 14}, fontWeight: {value: 600},
        fill: {value: look.ink}, text: {field: "label"}}}}]};
}

// A line ends where rows were left out: a step of time five times the usual one.
function withGaps(rows) {
  const steps = rows.slice(1).map((r, i) => r.x - rows[i].x).sort((a, b) => a - b);
  const most = 5 * (steps[Math.floor(steps.length / 2)] || Infinity);
  return rows.flatMap((r, i) => i > 0 && r.x - rows[i - 1].x > most ? [{x: rows[i - 1].x}, r] : [r]);
}

// Drag along the time axis to look closer, twice click to see all.
function tracePlot(picture, look, chosen) {
  const c = loopColours(look.dark);
  const trace = picture.traces[chosen || 0];
  const full = [trace.x[0], trace.x[trace.x.length - 1]];
  const rows = trace.x.map((x, i) => ({x, measured: trace.measured[i], before: trace.before[i], after: trace.after[i],
    rb: trace.measured[i] - trace.before[i], ra: trace.measured[i] - trace.after[i]}));
  const shown = withGaps(rows);
  const upper = 210, lower = 90, gap = 26;
  const domain = (keys) => {
    const values = rows.flatMap((r) => keys.map((k) => r[k])).filter(finite);
    const low = values.reduce((a, b) => Math.min(a, b), Infinity), high = values.reduce((a, b) => Math.max(a, b), -Infinity);
    return [low - 0.04 * (high - low), high + 0.04 * (high - low)];
  };
  const line = (key, scale, colour, width, dash) => ({type: "line", from: {data: "rows"}, encode: {enter: {stroke: {value: colour},
    strokeWidth: {value: width}, strokeDash: {value: dash || [1, 0]}, defined: {signal: `isValid(datum.${key})`}}, update: {x: {scale: "x", field: "x"}, y: {scale, field: key}}}});
  const entries = [{label: "measured", colour: look.ink}, ...(picture.changed ? [{label: "base", colour: c.before, dash: [6, 4]}] : []),
                   {label: picture.changed ? "new model" : "model", colour: c.after}];
  const {scales, legends} = legendsOf(lineLegend(entries), look);
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: 5, description: picture.title,
    width: look.width, height: upper + gap + lower, autosize: {type: "fit-x", contains: "padding"},
    signals: [
      {name: "brush", value: [0, 0], on: [{events: "pointerdown", update: "[x(), x()]"},
        {events: "[pointerdown, window:pointerup] > window:pointermove", update: "[brush[0], clamp(x(), 0, width)]"}]},
      {name: "domain", value: full, on: [
        {events: "window:pointerup", update: "abs(brush[1] - brush[0]) > 8 ? [invert('x', min(brush[0], brush[1])), invert('x', max(brush[0], brush[1]))] : domain"},
        {events: "dblclick", update: `[${full[0]}, ${full[1]}]`}]}],

    data: [{name: "rows", values: shown}],
    scales: [{name: "x", domain: {signal: "domain"}, range: "width", zero: false, nice: false},
             {name: "y", domain: domain(["measured", "after", ...(picture.changed ? ["before"] : [])]), range: [upper, 0], zero: false},
             {name: "r", domain: domain(["ra", ...(picture.changed ? ["rb"] : [])]), range: [upper + gap + lower, upper + gap], zero: false}, ...scales],
    axes: [{orient: "bottom", scale: "x", title: trace.x_title, grid: true, tickCount: 7, labelOverlap: true, labelFlush: true},
           {orient: "left", scale: "y", title: picture.y, grid: true, tickCount: 5},
           {orient: "left", scale: "r", title: picture.residual, grid: true, tickCount: 3}],
    legends,
    marks: [
      {type: "group", clip: true, encode: {enter: {width: {signal: "width"}, height: {signal: "height"}}}, marks: [
        line("measured", "y", look.ink, 1.2), ...(picture.changed ? [line("before", "y", c.before, 1.5, [6, 4])] : []), line("after", "y", c.after, 1.7),
        ...(picture.changed ? [line("rb", "r", c.before, 1.1)] : []), line("ra", "r", c.after, 1.2),
        {type: "rect", encode: {update: {x: {signal: "brush[0]"}, x2: {signal: "brush[1]"}, y: {value: 0}, y2: {signal: "height"},
          fill: {value: look.soft}, fillOpacity: {signal: "abs(brush[1] - brush[0]) > 8 ? 0.12 : 0"}}}}]}]};
}

function mapPlot(picture, look) {
  const c = loopColours(look.dark);
  const cells = picture.cells.map((r) => ({x0: r[0], x1: r[1], y0: r[2], y1: r[3], value: r[4], rows: r[5]}));
  const size = Math.max(...cells.map((r) => Math.abs(r.value)));
  const spec = frame({...look, height: look.height || 300, description: picture.title, methods: [], colors: [], legend: false, data: [{name: "points", values: cells}],
    x: {title: picture.x, fields: ["x0", "x1"], nice: false}, y: {title: picture.y, fields: ["y0", "y1"], nice: false},
    marks: [{type: "rect", from: {data: "points"}, encode: {enter: {x: {scale: "x", field: "x0"}, x2: {signal: "max(scale('x', datum.x1), scale('x', datum.x0) + 2)"},
      y: {scale: "y", field: "y0"}, y2: {signal: "min(scale('y', datum.y1), scale('y', datum.y0) - 2)"}, fill: {scale: "value", field: "value"}, tooltip: {signal: "datum"}}}}]});
  spec.scales = spec.scales.filter((s) => s.name !== "color").concat([{name: "value", domain: [-size, 0, size],
    range: [c.low, look.dark ? "#2a3038" : "#f2f2ee", c.high], interpolate: "lab"}]);
  spec.legends = [{fill: "value", type: "gradient", orient: "bottom", direction: "horizontal", title: picture.z, gradientLength: Math.min(260, look.width - 60)}];
  return spec;
}

function movementsPlot(picture, look) {
  const c = loopColours(look.dark);
  const groups = [...new Set(picture.points.map((p) => p.group))];
  const colourOf = (g) => g === "held out" ? c.after : look.soft;
  const values = picture.points.map((p) => ({...p, colour: colourOf(p.group)}));
  const {scales, legends} = legendsOf(dotLegend(groups.map((label) => ({label, colour: colourOf(label)}))), look);
  const spec = frame({...look, height: 260, description: picture.title, methods: [], colors: [], legend: false, data: [{name: "points", values}],
    x: {title: picture.x, fields: ["x", "y"], zero: true}, y: {title: picture.y, fields: ["x", "y"], zero: true},
    marks: [
      {type: "rule", encode: {enter: {x: {value: 0}, y: {signal: "height"}, x2: {signal: "width"}, y2: {value: 0}, stroke: {value: look.soft}, strokeDash: {value: [4, 4]}}}},
      {type: "symbol", from: {data: "points"}, encode: {enter: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}, size: {value: 50},
        fill: {field: "colour"}, fillOpacity: {value: 0.75}, tooltip: {signal: "datum"}}}}]});
  spec.scales = spec.scales.filter((s) => s.name !== "color").concat(scales);
  spec.legends = legends;
  return spec;
}

const nameRoom = (width) => Math.min(250, Math.floor(width * 0.42));

function evidencePlot(picture, look) {
  const c = loopColours(look.dark);
  const bars = [...picture.bars].sort((a, b) => b.x - a.x);
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: 5, description: picture.title,
    width: look.width, height: Math.max(60, bars.length * 22), autosize: {type: "fit-x", contains: "padding"}, data: [{name: "bars", values: bars}],
    scales: [{name: "x", domain: {data: "bars", field: "x"}, zero: true, nice: true, range: "width"},
             {name: "y", type: "band", domain: bars.map((b) => b.name), range: "height", padding: 0.25}],
    axes: [{orient: "bottom", scale: "x", title: picture.x, grid: true, tickCount: 5, labelOverlap: true, labelFlush: true},
           {orient: "left", scale: "y", labelLimit: nameRoom(look.width), domain: false, ticks: false}],
    marks: [{type: "rect", from: {data: "bars"}, encode: {enter: {x: {scale: "x", value: 0}, x2: {scale: "x", field: "x"}, y: {scale: "y", field: "name"},
      height: {scale: "y", band: 1}, fill: {signal: `datum.found ? '${c.after}' : '${look.soft}'`}, tooltip: {signal: "datum"}}}}]};
}

function aliasesPlot(picture, look) {
  const values = picture.cells.map(([i, j, size]) => ({a: picture.names[i], b: picture.names[j], size}));
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: 5, description: picture.title,
    width: look.width, height: picture.names.length * 22, autosize: {type: "fit-x", contains: "padding"}, data: [{name: "cells", values}],
    scales: [{name: "x", type: "band", domain: picture.names, range: "width", padding: 0.05},
             {name: "y", type: "band", domain: picture.names, range: "height", padding: 0.05},
             {name: "size", domain: [0, 1], range: look.dark ? ["#22272e", "#6cbcf0"] : ["#f4f4f0", "#0067a5"], interpolate: "lab"}],
    axes: [{orient: "left", scale: "y", domain: false, ticks: false, labelLimit: nameRoom(look.width)}],
    legends: [{fill: "size", type: "gradient", orient: "bottom", direction: "horizontal", title: "correlation", gradientLength: Math.min(220, look.width - 60)}],
    marks: [{type: "rect", from: {data: "cells"}, encode: {enter: {x: {scale: "x", field: "a"}, y: {scale: "y", field: "b"}, width: {scale: "x", band: 1},
      height: {scale: "y", band: 1}, fill: {scale: "size", field: "size"}, tooltip: {signal: "datum"}}}}]};
}

const kLoopPlots = {error: errorPlot, friction: frictionPlot, effect: effectPlot, input: inputPlot, map: mapPlot, trace: tracePlot,
                    movements: movementsPlot, evidence: evidencePlot, aliases: aliasesPlot};

// A picture of the page's data as a specification.
const loopPlot = (picture, look, chosen) => kLoopPlots[picture.kind](picture, look, chosen);
