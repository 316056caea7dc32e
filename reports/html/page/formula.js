// SPDX-License-Identifier: MIT
//
// A formula in print form (+ - * / ^, numbers, names, functions) as TeX for reading: constants
// folded and rounded to four digits, coefficients in front. The text beside it keeps every digit.
"use strict";

// The formula as a tree: {num}, {name}, {call, arg}, {op: "+" | "*" | "/" | "^", a, b}; a minus is
// a factor -1.
function parseFormula(text) {
  let at = 0;
  const skip = () => { while (text[at] === " ") ++at; };
  const peek = () => { skip(); return text[at]; };
  const fail = () => { throw new Error("no formula"); };
  const minus = (tree) => ({op: "*", a: {num: -1}, b: tree});

  function number() {
    const match = /^[0-9.]+(e[+-]?[0-9]+)?/i.exec(text.slice(at)) || fail();
    at += match[0].length;
    return {num: Number(match[0])};
  }
  function closed() {
    ++at;
    const inner = sum();
    if (peek() !== ")") fail();
    ++at;
    return inner;
  }
  function atom() {
    if (peek() === "(") return closed();
    const match = /^[A-Za-z_][A-Za-z0-9_]*/.exec(text.slice(at));
    if (!match) return number();
    at += match[0].length;
    return peek() === "(" ? {call: match[0], arg: closed()} : {name: match[0]};
  }
  function power() {
    const base = atom();
    if (peek() !== "^") return base;
    ++at;
    return {op: "^", a: base, b: factor()};
  }
  function factor() {
    if (peek() !== "-") return power();
    ++at;
    return minus(factor());
  }
  function product() {
    let left = factor();
    for (let op = peek(); op === "*" || op === "/"; op = peek()) {
      ++at;
      left = {op, a: left, b: factor()};
    }
    return left;
  }
  function sum() {
    let left = product();
    for (let op = peek(); op === "+" || op === "-"; op = peek()) {
      ++at;
      const right = product();
      left = {op: "+", a: left, b: op === "-" ? minus(right) : right};
    }
    return left;
  }
  const whole = sum();
  skip();
  if (at !== text.length) fail();
  return whole;
}

const kFolded = {sqrt: Math.sqrt, exp: Math.exp, log: Math.log, abs: Math.abs, sgn: Math.sign, sin: Math.sin,
                 cos: Math.cos, tanh: Math.tanh, atan: Math.atan};

// Constants folded where that gives a number that is finite.
function folded(tree) {
  if (tree.call) {
    const arg = folded(tree.arg);
    const value = "num" in arg && kFolded[tree.call] ? kFolded[tree.call](arg.num) : NaN;
    return isFinite(value) ? {num: value} : {call: tree.call, arg};
  }
  if (!tree.op) return tree;
  const a = folded(tree.a), b = folded(tree.b);
  if ("num" in a && "num" in b) {
    const value = tree.op === "+" ? a.num + b.num : tree.op === "*" ? a.num * b.num
                : tree.op === "/" ? a.num / b.num : a.num ** b.num;
    if (isFinite(value)) return {num: value};
  }
  if (tree.op === "^" && b.num === 1) return a;
  return {op: tree.op, a, b};
}

// options.periods: sines of a multiple of one name show its period in place of the wave number.
function formulaToTex(text, options) {
  const greek = new Set(["alpha", "beta", "gamma", "delta", "theta", "mu", "nu", "rho", "sigma",
                         "tau", "phi", "omega", "lambda", "kappa", "eta"]);
  const inBrackets = (tex) => `\\left(${tex}\\right)`;

  function number(value) {
    const parts = String(Number(value.toPrecision(4))).split("e");
    return parts.length === 1 ? parts[0] : `${parts[0]}\\cdot 10^{${Number(parts[1])}}`;
  }
  function name(word) {
    if (word.startsWith("sgn_")) return `\\operatorname{sgn}(${name(word.slice(4))})`;
    const [head, ...rest] = word.split("_");
    const base = head === "qd" ? "\\dot q" : head === "qdd" ? "\\ddot q"
               : greek.has(head) ? `\\${head}` : head.length === 1 ? head : `\\mathrm{${head}}`;
    return rest.length ? `${base}_{\\mathrm{${rest.join("\\_")}}}` : base;
  }

  // A product as a coefficient, what is above and what is below the line.
  function factors(tree, out, below) {
    if (tree.op === "*" || tree.op === "/") {
      factors(tree.a, out, below);
      factors(tree.b, out, below !== (tree.op === "/"));
    } else if ("num" in tree && (tree.num !== 0 || !below)) {
      if (below) out.divisor *= tree.num;
      else out.number *= tree.num;
    } else {
      (below ? out.under : out.over).push(tree);
    }
    return out;
  }
  // v / 0.05 shows its 0.05, which is somebody's parameter; 3 v / 0.05 is 60 v.
  function coefficient(tree) {
    const parts = factors(tree, {number: 1, divisor: 1, over: [], under: []}, false);
    if (parts.divisor === 1) return parts;
    const keep = Math.abs(parts.number) === 1 && parts.over.length && !parts.under.length && parts.divisor > 0;
    if (keep) parts.under.push({num: parts.divisor});
    else parts.number /= parts.divisor;
    return parts;
  }
  const join = (pieces) => pieces.reduce((a, b) => `${a}${/^[0-9.]/.test(b) ? "\\cdot " : "\\,"}${b}`);
  const factorTex = (tree) => tree.op === "+" ? inBrackets(sum(tree)) : piece(tree);

  // With its sign apart.
  function product(tree) {
    const parts = coefficient(tree);
    const size = Math.abs(parts.number);
    const over = parts.over.map(factorTex);
    if (size !== 1 || !over.length) over.unshift(number(size));
    const top = join(over);
    const negative = parts.number < 0;
    if (!parts.under.length) return {negative, tex: top};
    const bottom = parts.under.length === 1 ? piece(parts.under[0]) : join(parts.under.map(factorTex));
    return {negative, tex: `\\frac{${top}}{${bottom}}`};
  }
  function terms(tree) {
    return tree.op === "+" ? terms(tree.a).concat(terms(tree.b)) : [tree];
  }
  function sum(tree) {
    const all = terms(tree);
    const constant = all.filter((t) => "num" in t).reduce((total, t) => total + t.num, 0);
    const rest = all.filter((t) => !("num" in t)).map(product);
    if (constant !== 0 || !rest.length) rest.push({negative: constant < 0, tex: number(Math.abs(constant))});
    return rest.map((t, i) => i === 0 ? (t.negative ? "-" : "") + t.tex : ` ${t.negative ? "-" : "+"} ${t.tex}`).join("");
  }
  function periodOf(tree) {
    const parts = coefficient(tree);
    const known = options && options.periods && parts.over.length === 1 && parts.over[0].name && !parts.under.length;
    return known && Math.abs(parts.number) > 12 ? `\\frac{2\\pi\\,${name(parts.over[0].name)}}{${number(2 * Math.PI / Math.abs(parts.number))}}` : null;
  }
  function call(word, arg) {
    if (word === "sqrt") return `\\sqrt{${sum(arg)}}`;
    if (word === "abs") return `\\left|${sum(arg)}\\right|`;
    if (word === "exp") return `e^{${sum(arg)}}`;
    if (word === "sgn") return `\\operatorname{sgn}${inBrackets(sum(arg))}`;
    const wave = word === "sin" || word === "cos" ? periodOf(arg) : null;
    return `\\${word === "atan" ? "arctan" : word}${inBrackets(wave || sum(arg))}`;
  }
  function piece(tree) {
    if ("num" in tree) return tree.num < 0 ? inBrackets(number(tree.num)) : number(tree.num);
    if (tree.name) return name(tree.name);
    if (tree.call) return call(tree.call, tree.arg);
    if (tree.op === "^") {
      const plain = tree.a.name || (tree.a.call && tree.a.call !== "exp") || tree.a.num >= 0;
      return `${plain ? piece(tree.a) : inBrackets(sum(tree.a))}^{${sum(tree.b)}}`;
    }
    return sum(tree);
  }
  return sum(folded(parseFormula(text)));
}

// The formula as an element: mathematics where it can be read, else its text.
function formulaElement(text, options) {
  const element = document.createElement("span");
  element.className = "formula";
  try {
    katex.render(formulaToTex(text, options), element, {throwOnError: true, output: "htmlAndMathml"});
  } catch (error) {
    element.textContent = text;
    element.classList.add("plain");
  }
  return element;
}
