// SPDX-License-Identifier: MIT
//
// node's part of `tribench report --pictures`: reads the run's data from the file named first and
// writes every picture, or those whose files are named after it, as SVG into the folder named second. Vega and the pictures stand before this
// in the same script.
"use strict";

const fs = require("fs");
const path = require("path");

const [dataFile, folder, ...only] = process.argv.slice(2);
const data = JSON.parse(fs.readFileSync(dataFile, "utf8"));
const methods = [...new Set(data.tables.flatMap((t) => t.rows.map((r) => r.method)))].sort();
const look = {ink: "#1d2129", soft: "#5d6673", line: "#dfe2e6", card: "#ffffff", dark: false,
              methods, colors: colorsOf(methods)};
const wide = new Set(["friction", "error", "heat"]);

const fileName = (...parts) => parts.join(".").replace(/[^A-Za-z0-9._+-]+/g, "_") + ".svg";

async function write(pictures, id, name) {
  if (only.length && !only.includes(name)) return;
  const spec = pictures[id]({...look, width: wide.has(id) ? 960 : 560});
  if (!spec) return;
  await writeSvg(spec, folder, name, fs, path);
}

async function main() {
  for (const operators of data.operators) {
    const choice = (problem) => ({problem, operators, hidden: new Set()});
    for (const id of kOverallPictures) await write(new RunPictures(data, choice("")), id, fileName("all", operators, id));
    for (const problem of data.problems) {
      for (const id of kProblemPictures) {
        await write(new RunPictures(data, choice(problem)), id, fileName(problem, operators, id));
      }
    }
  }
}

main().catch((error) => { console.error(String(error)); process.exit(1); });
