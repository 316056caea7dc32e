// SPDX-License-Identifier: MIT
//
// One function a picture: data in, a Vega specification out. Nothing is drawn here.
"use strict";

const kPalette = ["#0b6e75", "#d1495b", "#edae49", "#5b5ea6", "#66a182", "#8d5a97", "#2e86ab",
                  "#c97b3d", "#7a8450", "#a23b72", "#4f6d7a", "#b8a12f"];

const colorsOf = (methods) => methods.map((m, i) => kPalette[i % kPalette.length]);

// look: what a picture takes from where it stands: ink, soft, line and card (colours), dark, width
// in pixels, methods and their colours, shown: the methods of the legend (all where undefined).
function plotConfig(c) {
  return {
    background: null,
    axis: {labelColor: c.soft, titleColor: c.ink, gridColor: c.line, domainColor: c.soft,
           tickColor: c.soft, titleFontWeight: 500, labelFontSize: 11, titleFontSize: 12,
           gridOpacity: 0.8},
    legend: {labelColor: c.ink, titleColor: c.ink, labelFontSize: 11, symbolSize: 70},
    title: {color: c.ink}, text: {fill: c.ink}};
}

// A method under the pointer, or its name in the legend, stands out and the others fade.
const kHovered = {name: "hovered", value: null, on: [
  {events: "mouseover", update: "datum && isString(datum.method) ? datum.method : datum && isString(datum.value) ? datum.value : null"},
  {events: "mouseout", update: "null"}]};
const faded = (shown) => [{test: "hovered && hovered !== datum.method", value: 0.1}, {value: shown}];
const kHoverLegend = {labels: {interactive: true}, symbols: {interactive: true}};

// The frame that every picture shares: size, scales, axes, a colour for each method.
function frame(o) {
  const height = o.height || 330;
  const scale = (name, range, axis) => ({
    name, range, type: axis.type || "linear", nice: axis.nice !== false, zero: axis.zero === true,
    domain: axis.domain || {data: axis.data || "points", fields: axis.fields}});
  const ticks = (orient, axis, name) => ({
    orient, scale: name, title: axis.title, grid: true, tickCount: 6, values: axis.values,
    format: axis.format, labelOverlap: true, labelFlush: orient === "bottom"});
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", description: o.description,
    width: o.width || 480, height, padding: 5, autosize: {type: "fit", contains: "padding"},
    config: plotConfig(o), data: o.data, signals: [kHovered],
    scales: [scale("x", "width", o.x), scale("y", "height", o.y),
             {name: "color", type: "ordinal", domain: o.methods, range: o.colors}],
    axes: [ticks("bottom", o.x, "x"), ticks("left", o.y, "y")],
    legends: o.legend === false ? []
      : [{fill: "color", orient: "bottom", direction: "horizontal", columns: Math.max(2, Math.floor(o.width / 125)),
          symbolType: "circle", values: o.shown, encode: kHoverLegend}],
    marks: o.marks};
}

// Of a logarithmic axis from low to high: powers of ten, or fewer of them, or 1, 2 and 5 between.
function logTicks(low, high) {
  const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high));
  const step = Math.max(1, Math.ceil((last - first) / 6));
  const ticks = [];
  for (let p = first; p <= last; p += step) {
    for (const digit of last - first > 3 ? [1] : [1, 2, 5]) ticks.push(digit * 10 ** p);
  }
  return ticks.filter((x) => x >= low * 0.999 && x <= high * 1.001);
}

// A logarithmic axis over the values, a little wider than they are.
function logAxis(title, values, extra) {
  let low = Infinity, high = 0;
  for (const x of values) { low = Math.min(low, x); high = Math.max(high, x); }
  const room = Math.max(1.06, (high / low) ** 0.04);
  low /= room; high *= room;
  return {title, type: "log", nice: false, domain: [low, high], values: logTicks(low, high), format: "~g", ...extra};
}

const grouped = (from, marks) => ({
  type: "group", from: {facet: {name: "series", data: from, groupby: "series"}}, marks});

const lineMark = (extra, shown = 1) => ({
  type: "line", from: {data: "series"},
  encode: {update: {strokeOpacity: faded(shown)}, enter: Object.assign({x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
    stroke: {scale: "color", field: "method"}, strokeWidth: {value: 2},
    defined: {signal: "isValid(datum.y) && isFinite(datum.y)"}}, extra || {})}});

function curvePlot(points, look, axes, description) {
  const measured = points.filter((p) => p.curve.startsWith("measured") || p.dots);
  const lines = points.filter((p) => !(p.curve.startsWith("measured") || p.dots));
  return frame({...look, description,
    data: [{name: "points", values: points}, {name: "measured", values: measured},
           {name: "lines", values: lines}],
    x: {title: axes[0], fields: ["x"]}, y: {title: axes[1], fields: ["y"]},
    marks: [
      {type: "symbol", from: {data: "measured"}, encode: {enter: {x: {scale: "x", field: "x"},
        y: {scale: "y", field: "y"}, size: {value: 14},
        fill: {signal: `datum.method === 'data' ? '${look.soft}' : scale('color', datum.method)`},
        tooltip: {signal: "datum"}}, update: {opacity: faded(0.55)}}},
      grouped("lines", [{type: "line", from: {data: "series"}, encode: {update: {strokeOpacity: faded(1)}, enter: {
        x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
        stroke: {signal: `datum.method === 'data' ? '${look.ink}' : scale('color', datum.method)`},
        strokeDash: {signal: "datum.method === 'data' ? [5, 4] : [1, 0]"},
        strokeWidth: {value: 1.8}, tooltip: {signal: "datum"},
        defined: {signal: "isValid(datum.y) && isFinite(datum.y)"}}}}])]});
}

// A picture as a file, in node; prints its name.
async function writeSvg(spec, folder, name, fs, path) {
  // Without a label a mark and with two decimals in its coordinates a file has a third of the size.
  const still = {...spec, background: "white", config: {...spec.config, aria: false}};
  const view = new vega.View(vega.parse(still), {renderer: "none", logLevel: vega.Error});
  const svg = (await view.toSVG()).replace(/<[^>]*>/g, (tag) => tag.replace(/(\.[0-9]{2})[0-9]+/g, "$1"))
    .replace("<g ", `<title>${spec.description.replace(/[<&]/g, "")}</title><g `);
  const file = path.join(folder, name);
  fs.writeFileSync(file + ".partial", svg);  // whole or not at all, as every file of a run
  fs.renameSync(file + ".partial", file);
  console.log(name);
}
