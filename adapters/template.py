#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A method in Python under tribench (docs/external_methods.md): fill in `fit`.

As it stands it fits a straight line by least squares, so that it can be run and tested.

PySR:    model = PySRRegressor(random_state=seed, ...); model.fit(X, y); model.equations_
         gives `equation` (already in this syntax) and `complexity`, row by row the front.
gplearn: est = SymbolicRegressor(random_state=seed, ...); est.fit(X, y); est._program prints in
         prefix form: mul(X0, 2.0); turn it into infix with the inputs' names.
Operon:  reg = SymbolicRegressor(random_state=seed, ...); reg.fit(X, y); the front is
         reg.pareto_front_; reg.get_model_string(tree, precision=17, names=names) prints it.
ParFam:  after fitting, the model's symbolic form through sympy: str(formula).replace("**", "^").
"""
import csv
import json
import pathlib
import sys


def read_request(path):
    """The request, and the training rows as {column: [numbers]}."""
    path = pathlib.Path(path)
    request = json.loads(path.read_text())
    with open(path.parent / request["train"], newline="") as file:
        rows = list(csv.DictReader(file))
    columns = {name: [float(row[name]) for row in rows] for name in rows[0]}
    return request, columns


def improved(train_error, evaluations=0):
    """Reports a better model while the search runs: the anytime trace."""
    print(json.dumps({"improved": {"train_error": train_error, "evaluations": evaluations}}),
          flush=True)


def fit(request, columns):
    """Returns a front: formulas from simple to complex. The last one stands for the method."""
    name = request["inputs"][0]["name"]
    x, y = columns[name], columns[request["target"]]
    n = len(x)
    mean_x, mean_y = sum(x) / n, sum(y) / n
    spread = sum((v - mean_x) ** 2 for v in x)
    slope = sum((u - mean_x) * (v - mean_y) for u, v in zip(x, y)) / spread if spread > 0 else 0.0
    offset = mean_y - slope * mean_x
    improved(sum((v - offset - slope * u) ** 2 for u, v in zip(x, y)) / n, 5 * n)
    return [repr(mean_y), f"{slope!r} * {name} + {offset!r}"]


def main():
    request, columns = read_request(sys.argv[1])
    print(json.dumps({"front": fit(request, columns)}), flush=True)


if __name__ == "__main__":
    main()
