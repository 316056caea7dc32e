// SPDX-License-Identifier: MIT
//
// What the run's page and the loop's page share: elements, plots with tooltips, tables that sort
// and filter, the theme.
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
window.pageErrors = [];
window.addEventListener("error", (event) => window.pageErrors.push(String(event.message)));

function el(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key === "onclick" || key === "oninput" || key === "onchange") element[key] = value;
    else if (value !== undefined && value !== false) element.setAttribute(key, value);
  }
  for (const child of children.flat()) if (child !== null && child !== undefined) element.append(child);
  return element;
}

const byId = (id) => document.getElementById(id);

// A measured figure with so many significant digits, as leaderboard.md has it.
function fig(value, digits = 3) {
  if (value === null || value === undefined) return "–";
  if (!isFinite(value)) return "∞";
  if (value === 0) return "0";
  const rounded = Math.abs(Number(value.toPrecision(digits)));
  return rounded >= 1e6 || rounded < 1e-4 ? value.toExponential(digits - 1)
                                          : value.toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(rounded))));
}

// A count, or a figure that is shown as it was given.
function count(value) {
  if (value === null || value === undefined) return "–";
  return Math.abs(value) >= 1e6 ? value.toExponential(2) : String(value);
}

const counted = (number, noun) => `${number} ${noun}${number === 1 ? "" : "s"}`;

function darkTheme() { return document.documentElement.dataset.theme === "dark"; }

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  if (window.drawAll) window.drawAll();
}

function themeButton() {
  return el("button", {type: "button", onclick: () => setTheme(darkTheme() ? "light" : "dark")},
            "light / dark");
}

function inkOf() {
  const style = getComputedStyle(document.documentElement);
  const ink = {};
  for (const name of ["ink", "soft", "line", "card"]) ink[name] = style.getPropertyValue("--" + name).trim();
  return ink;
}

// Colours belong to methods through the whole page.
function lookFor(methods, width) {
  return {...inkOf(), dark: darkTheme(), width, methods, colors: colorsOf(methods)};
}

const kHidden = new Set(["series", "x", "y", "dots", "chosen", "level", "formula", "last", "from", "to"]);

function tipContent(datum) {
  const box = el("div");
  for (const [key, value] of Object.entries(datum)) {
    if (kHidden.has(key) || typeof value === "object" || value === "" || key.startsWith("Symbol")) continue;
    box.append(el("div", {}, el("span", {class: "soft"}, key + " "),
                  typeof value === "number" ? fig(value, 4) : String(value)));
  }
  if (datum.x !== undefined && typeof datum.x === "number") {
    box.append(el("div", {class: "soft"}, `x ${fig(datum.x, 4)}   y ${fig(datum.y, 4)}`));
  }
  if (datum.formula) box.append(formulaElement(datum.formula));
  return box;
}

function showTip(handler, event, item, datum) {
  const tip = byId("tip");
  if (!datum || typeof datum !== "object") { tip.style.display = "none"; return; }
  tip.replaceChildren(tipContent(datum));
  tip.style.display = "block";
  const x = Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8);
  const y = event.clientY + 14 + tip.offsetHeight > innerHeight ? event.clientY - tip.offsetHeight - 10
                                                                 : event.clientY + 14;
  tip.style.left = Math.max(4, x) + "px";
  tip.style.top = Math.max(4, y) + "px";
}

// Draws a specification into its card.
function draw(id, spec, options) {
  const holder = byId(id);
  if (!holder) return;
  holder.replaceChildren();
  holder.style.minHeight = "";
  const rows = byId(id + "-rows");
  if (rows) rows.hidden = !spec;
  if (!spec) {
    holder.append(el("p", {class: "empty"}, (options && options.empty) || "No data for this picture."));
    return;
  }
  const view = new vega.View(vega.parse(spec), {renderer: "svg", logLevel: vega.Error});
  view.tooltip(showTip).initialize(holder).hover().run();
  holder.setAttribute("role", "img");
  holder.setAttribute("aria-label", spec.description);
  if (options && options.onclick) view.addEventListener("click", (e, item) => item && item.datum && options.onclick(item.datum));
  if (rows) {
    rows.spec = spec;
    if (rows.open) fillRows(rows);
  }
}

// Pictures are drawn when they come near the screen: `waiting` holds those that have not.
const waiting = new Map();
const kNear = "300px";
const watcher = "IntersectionObserver" in window ? new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) drawNow(entry.target.id);
}, {rootMargin: kNear}) : null;

function drawNow(id) {
  const action = waiting.get(id);
  if (!action) return;
  waiting.delete(id);
  watcher.unobserve(byId(id));
  action();
}

function drawLater(id, action) {
  if (!watcher) { action(); return; }
  waiting.set(id, action);
  watcher.unobserve(byId(id));
  watcher.observe(byId(id));
}

window.drawEverything = () => [...waiting.keys()].forEach(drawNow);

// On paper pictures have the paper's width, whatever the window's.
let printing = false;
function setPrinting(on) {
  printing = on;
  if (!window.drawAll) return;
  window.drawAll();
  if (on) window.drawEverything();
}
addEventListener("beforeprint", () => setPrinting(true));
addEventListener("afterprint", () => setPrinting(false));

// The values of a picture as a table, for who cannot see it or wants the numbers.
function fillRows(rows) {
  const values = rows.spec.data.flatMap((d) => d.values || []);
  const keys = [...new Set(values.flatMap((v) => Object.keys(v)))]
    .filter((k) => !kHidden.has(k) || k === "x" || k === "y" || k === "formula")
    .filter((k) => values.some((v) => v[k] !== null && typeof v[k] !== "object"));
  const columns = keys.map((k) => ({name: k, key: k, number: values.some((v) => typeof v[k] === "number"),
    show: k === "formula" ? (r) => formulaText(r.formula) : undefined}));
  rows.lastChild.replaceChildren(dataTable(columns, values, {label: "values of " + rows.title, limit: 200}));
}

function card(id, title, text, wide) {
  const rows = el("details", {id: id + "-rows", class: "rows", title: title.toLowerCase()}, el("summary", {}, "values"), el("div"));
  rows.addEventListener("toggle", () => { if (rows.open && rows.spec) fillRows(rows); });
  return el("section", {class: wide ? "card wide" : "card"}, el("h3", {}, title),
            el("p", {}, text), el("div", {class: "plot", id, style: "min-height:20rem"}), rows);
}

// A formula's text, cut for a cell; the whole stands in its title.
function formulaText(text) {
  const short = text.length > 80 ? text.slice(0, 77) + "…" : text;
  return el("code", {title: text}, short);
}

function widthOf(id) {
  if (printing) return byId(id).closest(".wide") ? 700 : 360;
  return Math.max(260, Math.floor(byId(id).getBoundingClientRect().width) - 4);
}

// columns: [{name, key, number or count, show}]; rows: objects. Sorts by a header's button, filters by text.
function dataTable(columns, rows, options) {
  const limit = (options && options.limit) || 500;
  let order = null, ascending = true, wanted = "";
  const body = el("tbody");
  const tally = el("span", {class: "soft", "aria-live": "polite"});
  const text = (row) => columns.map((c) => String(row[c.key] ?? "")).join(" ").toLowerCase();
  const fill = () => {
    let shown = rows.filter((row) => !wanted || text(row).includes(wanted));
    const total = shown.length;
    if (order) {
      const key = order.key, sign = ascending ? 1 : -1;
      shown = [...shown].sort((a, b) => {
        const x = a[key] ?? null, y = b[key] ?? null;
        if (x === null || y === null) return x === y ? 0 : x === null ? 1 : -1;
        return sign * (typeof x === "number" && typeof y === "number" ? x - y
                                                                     : String(x).localeCompare(String(y), "en", {numeric: true}));
      });
    }
    body.replaceChildren(...shown.slice(0, limit).map((row) => {
      const line = el("tr", {class: row.standing === "best" ? "best" : undefined});
      for (const c of columns) {
        line.append(el("td", {class: c.number || c.count ? "number" : undefined, "data-label": c.name},
                       c.show ? c.show(row) : c.count ? count(row[c.key]) : c.number ? fig(row[c.key]) : String(row[c.key] ?? "")));
      }
      return line;
    }));
    tally.textContent = total > limit ? `${limit} of ${total} rows shown` : counted(total, "row");
  };
  const heads = columns.map((c) => {
    const head = el("th", {scope: "col", class: c.number || c.count ? "number" : undefined});
    head.append(el("button", {type: "button", onclick: () => {
      ascending = order === c ? !ascending : true;
      order = c;
      heads.forEach((h) => h.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
      fill();
    }}, c.name));
    return head;
  });
  const filter = el("input", {type: "search", placeholder: "filter rows", "aria-label": "filter rows of " + options.label,
                              oninput: (e) => { wanted = e.target.value.toLowerCase(); fill(); }});
  fill();
  return el("div", {}, el("div", {class: rows.length > 3 ? "tools" : "tools few"}, filter, tally),
            el("div", {class: "table-box"}, el("table", {"aria-label": options.label},
               el("thead", {}, el("tr", {}, heads)), body)));
}

function provenanceTable(entries) {
  return el("div", {class: "table-box"}, el("table", {"aria-label": "provenance"},
    el("tbody", {}, entries.map(([key, value]) =>
      el("tr", {}, el("th", {scope: "row"}, key), el("td", {}, el("code", {}, value)))))));
}
