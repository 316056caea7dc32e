// SPDX-License-Identifier: MIT
//
// node's part of `tribench loop --pictures`: reads the page's data from the file named first and writes every
// picture as SVG into the folder named second. Vega and the pictures stand before this in the same script.
"use strict";

async function writeLoopPictures() {
  const fs = require("fs");
  const path = require("path");
  const [dataFile, folder] = process.argv.slice(2);
  const data = JSON.parse(fs.readFileSync(dataFile, "utf8"));
  const look = {ink: "#1d2129", soft: "#5d6673", line: "#dfe2e6", card: "#ffffff", dark: false, width: 640};
  for (const picture of data.pictures) await writeSvg(loopPlot(picture, look), folder, picture.id + ".svg", fs, path);
}

writeLoopPictures().catch((error) => { console.error(String(error)); process.exit(1); });
