#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""earth under tribench: multivariate adaptive regression splines (Friedman 1991), in R. Parameters: the
numbers of earth() (degree, nk, penalty ...). Settings: its defaults. Hinges max(0, a) are
(a + abs(a))/2. The front is its backward pass, at most so many terms each; chosen is what it chooses (GCV).
Debian: r-cran-earth.
"""
import json
import pathlib
import subprocess
import sys

from protocol import answer, read_request, unsupported

# One line a model: {"terms": [[coefficient, [[direction, cut] an input]], ...]}; the choice comes first.
R = r"""
suppressMessages(library(earth))
asked <- commandArgs(TRUE)
rows <- read.csv(asked[1], check.names = FALSE)
y <- rows[[asked[2]]]; x <- as.matrix(rows[strsplit(asked[3], ",")[[1]]])
given <- c(list(x = x, y = y), eval(parse(text = asked[4])))
whole <- do.call(earth, given)
told <- function(model) {
  chosen <- model$selected.terms
  term <- function(k) sprintf("[%.17g, [%s]]", model$coefficients[k], paste(sprintf("[%d, %.17g]",
    as.integer(model$dirs[chosen[k], ]), model$cuts[chosen[k], ]), collapse = ", "))
  cat(sprintf('{"terms": [%s]}\n', paste(sapply(seq_along(chosen), term), collapse = ", ")))
}
cat(sprintf('{"version": "%s"}\n', packageVersion("earth")))
told(whole)
for (terms in seq_len(nrow(whole$dirs))) told(update(whole, nprune = terms))
"""


def formula(terms, names):
    """A sum of products of inputs (direction 2) and hinges (1: input less cut, -1: cut less input)."""
    texts = []
    for coefficient, factors in terms:
        text = repr(float(coefficient))
        for name, (direction, cut) in zip(names, factors):
            a = f"({name} - ({cut!r}))" if direction == 1 else f"({cut!r} - {name})"
            if direction != 0:
                text += f"*{name}" if direction == 2 else f"*(({a} + abs{a})/2)"
        texts.append(text)
    return " + ".join(texts)


def main():
    request, names, _, _ = read_request()
    if not {"+", "-", "*", "/", "abs"} <= set(request["operators"]):
        unsupported("earth writes + - * / abs")
    settings = ", ".join(f"{name} = {each!r}" for name, each in request["parameters"].items())
    train = str(pathlib.Path(sys.argv[1]).parent / request["train"])
    command = ["Rscript", "-", train, request["target"], ",".join(names), f"list({settings})"]
    try:
        ended = subprocess.run(command, input=R, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        unsupported("no Rscript; install it: apt install r-cran-earth")
    if "no package called" in ended.stderr:
        unsupported("R has no package earth; install it: apt install r-cran-earth")
    said, chosen, *models = [json.loads(line) for line in ended.stdout.splitlines()]
    best = formula(chosen["terms"], names)
    front = list(dict.fromkeys([*(formula(model["terms"], names) for model in models), best]))
    answer(front, "its defaults", f"earth {said['version']}", front.index(best))


if __name__ == "__main__":
    main()
