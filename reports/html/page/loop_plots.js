// SPDX-License-Identifier: MIT
//
// The pictures of a closed loop: data in, a Vega specification out.
"use strict";

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
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: 5,
    description: title, width: look.width, height: Math.max(60, values.length * 26),
    autosize: {type: "fit-x", contains: "padding"}, data: [{name: "values", values}],
    scales: [{name: "x", domain: {data: "values", field: "x"}, zero: true, nice: true, range: "width"},
             {name: "y", type: "band", domain: {data: "values", field: "name"}, range: "height", padding: 0.2}],
    axes: [{orient: "bottom", scale: "x", title, grid: true}, {orient: "left", scale: "y"}],
    marks: [{type: "rect", from: {data: "values"}, encode: {enter: {x: {scale: "x", value: 0},
      x2: {scale: "x", field: "x"}, y: {scale: "y", field: "name"}, height: {scale: "y", band: 1},
      fill: {signal: `datum.found ? '${kPalette[0]}' : '${look.soft}'`}, tooltip: {signal: "datum"}}}},
      {type: "text", from: {data: "values"}, encode: {enter: {x: {scale: "x", field: "x", offset: 6},
        y: {scale: "y", field: "name", band: 0.5}, baseline: {value: "middle"}, fontSize: {value: 10},
        fill: {value: look.ink}, text: {field: "label"}}}}]};
}

function aliasPlot(values, look, families) {
  return {
    $schema: "https://vega.github.io/schema/vega/v5.json", config: plotConfig(look), padding: 5,
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
