// SPDX-License-Identifier: MIT
//
// A formula in print form (+ - * / ^, numbers, names, functions) as TeX, constants rounded to four
// digits for reading. The text beside it keeps every digit.
"use strict";

function formulaToTex(text) {
  let at = 0;
  const greek = new Set(["alpha", "beta", "gamma", "delta", "theta", "mu", "nu", "rho", "sigma",
                         "tau", "phi", "omega", "lambda", "kappa", "eta"]);
  const skip = () => { while (text[at] === " ") ++at; };
  const peek = () => { skip(); return text[at]; };
  const wrap = (piece, level) => piece.level >= level ? piece.tex : `\\left(${piece.tex}\\right)`;

  function number() {
    const match = /^[0-9.]+(e[+-]?[0-9]+)?/i.exec(text.slice(at));
    if (!match) throw new Error("no formula");
    at += match[0].length;
    const rounded = String(Number(Number(match[0]).toPrecision(4)));
    const parts = rounded.split("e");
    return parts.length === 1 ? {tex: rounded, level: 4}
                              : {tex: `${parts[0]}\\cdot 10^{${Number(parts[1])}}`, level: 1};
  }
  function name(word) {
    if (word.startsWith("sgn_")) return `\\operatorname{sgn}(${name(word.slice(4))})`;
    const [head, ...rest] = word.split("_");
    const base = head === "qd" ? "\\dot q" : head === "qdd" ? "\\ddot q"
               : greek.has(head) ? `\\${head}` : head.length === 1 ? head : `\\mathrm{${head}}`;
    return rest.length ? `${base}_{\\mathrm{${rest.join("\\_")}}}` : base;
  }
  function call(word, inner) {
    if (word === "sqrt") return `\\sqrt{${inner}}`;
    if (word === "abs") return `\\left|${inner}\\right|`;
    if (word === "exp") return `e^{${inner}}`;
    if (word === "sgn") return `\\operatorname{sgn}\\left(${inner}\\right)`;
    return `\\${word}\\left(${inner}\\right)`;
  }
  function atom() {
    const c = peek();
    if (c === "(") {
      ++at;
      const inner = sum();
      if (peek() !== ")") throw new Error("no formula");
      ++at;
      return inner;
    }
    const match = /^[A-Za-z_][A-Za-z0-9_]*/.exec(text.slice(at));
    if (!match) return number();
    at += match[0].length;
    if (peek() !== "(") return {tex: name(match[0]), level: 4};
    ++at;
    const inner = sum();
    ++at;
    return {tex: call(match[0], inner.tex), level: match[0] === "exp" ? 3 : 4};
  }
  function power() {
    const base = atom();
    if (peek() !== "^") return base;
    ++at;
    return {tex: `${wrap(base, 4)}^{${factor().tex}}`, level: 3};
  }
  // A piece with a minus in front knows what stands behind it, so that signs can be taken out of
  // products and sums: 2 (-3) x is -6 x to a reader, a + (-b) is a - b.
  const negative = (piece) => piece.negated || {tex: `-${wrap(piece, 1)}`, level: 0.5, negated: piece};
  function factor() {
    if (peek() !== "-") return power();
    ++at;
    return negative(factor());
  }
  // Numbers side by side would read as one.
  const times = (a, b) => `${a}${/^[0-9.]/.test(b) ? "\\cdot " : "\\,"}${b}`;
  function product() {
    let left = factor();
    for (;;) {
      const op = peek();
      if (op !== "*" && op !== "/") return left;
      ++at;
      const right = factor();
      const minus = Boolean(left.negated) !== Boolean(right.negated);
      const a = left.negated || left, b = right.negated || right;
      left = op === "/" ? {tex: `\\frac{${a.tex}}{${b.tex}}`, level: 2}
                        : {tex: times(wrap(a, 1), wrap(b, 1)), level: 1};
      if (minus) left = negative(left);
    }
  }
  function sum() {
    let left = product();
    for (;;) {
      const op = peek();
      if (op !== "+" && op !== "-") return left;
      ++at;
      const right = product();
      const minus = (op === "-") !== Boolean(right.negated);
      left = {tex: `${left.tex} ${minus ? "-" : "+"} ${wrap(right.negated || right, 1)}`, level: 0};
    }
  }
  const whole = sum();
  skip();
  if (at !== text.length) throw new Error("no formula");
  return whole.tex;
}

// The formula as an element: mathematics where it can be read, else its text.
function formulaElement(text) {
  const element = document.createElement("span");
  element.className = "formula";
  try {
    katex.render(formulaToTex(text), element, {throwOnError: true, output: "htmlAndMathml"});
  } catch (error) {
    element.textContent = text;
    element.classList.add("plain");
  }
  return element;
}
