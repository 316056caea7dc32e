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

function fig(value, digits) {
  if (value === null || value === undefined) return "–";
  if (!isFinite(value)) return "∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e6 || size < 1e-4 ? value.toExponential((digits || 3) - 1)
                                     : String(Number(value.toPrecision(digits || 3)));
}

function darkTheme() { return document.documentElement.dataset.theme === "dark"; }

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  if (window.drawAll) window.drawAll();
}

function themeButton() {
  return el("button", {type: "button", onclick: () => setTheme(darkTheme() ? "light" : "dark")},
            "light / dark");
}

// Colours belong to methods through the whole page.
function lookFor(methods, width) {
  return {...inkOf(), dark: darkTheme(), width, methods, order: methods,
          colors: methods.map((m, i) => kPalette[i % kPalette.length])};
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

// Draws a specification into a card; `rows` are shown as a table for those who cannot see it.
function draw(id, spec, options) {
  const holder = byId(id);
  if (!holder) return;
  holder.replaceChildren();
  if (!spec) {
    holder.append(el("p", {class: "empty"}, (options && options.empty) || "No data for this picture."));
    return;
  }
  const view = new vega.View(vega.parse(spec), {renderer: "svg", logLevel: vega.Error});
  view.tooltip(showTip).initialize(holder).hover().run();
  holder.setAttribute("role", "img");
  holder.setAttribute("aria-label", spec.description);
  if (options && options.onclick) view.addEventListener("click", (e, item) => item && item.datum && options.onclick(item.datum));
}

function card(id, title, text, wide) {
  return el("section", {class: wide ? "card wide" : "card"}, el("h3", {}, title),
            el("p", {}, text), el("div", {class: "plot", id}));
}

// A formula's text, cut for a cell; the whole stands in its title.
function formulaText(text) {
  const short = text.length > 80 ? text.slice(0, 77) + "…" : text;
  return el("code", {title: text}, short);
}

const widthOf = (id) => Math.max(260, Math.floor(byId(id).getBoundingClientRect().width) - 4);

// columns: [{name, key, number, show}]; rows: objects. Sorts by a header's button, filters by text.
function dataTable(columns, rows, options) {
  const limit = (options && options.limit) || 500;
  let order = null, ascending = true, wanted = "";
  const body = el("tbody");
  const count = el("span", {class: "soft", "aria-live": "polite"});
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
        line.append(el("td", {class: c.number ? "number" : undefined},
                       c.show ? c.show(row) : c.number ? fig(row[c.key]) : String(row[c.key] ?? "")));
      }
      return line;
    }));
    count.textContent = total > limit ? `${limit} of ${total} rows shown` : `${total} rows`;
  };
  const heads = columns.map((c) => {
    const head = el("th", {scope: "col", class: c.number ? "number" : undefined});
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
  return el("div", {}, el("div", {class: "tools"}, filter, count),
            el("div", {class: "table-box"}, el("table", {"aria-label": options.label},
               el("thead", {}, el("tr", {}, heads)), body)));
}

function provenanceTable(entries) {
  return el("div", {class: "table-box"}, el("table", {"aria-label": "provenance"},
    el("tbody", {}, entries.map(([key, value]) =>
      el("tr", {}, el("th", {scope: "row"}, key), el("td", {}, el("code", {}, value)))))));
}
