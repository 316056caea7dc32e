#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Operon under tribench. Parameters: any of SymbolicRegressor's. Settings: its defaults, with the
symbols of the operator set. pip install pyoperon.
"""
from protocol import answer, library, read_request, version

SYMBOLS = {"+": "add", "-": "sub", "*": "mul", "/": "div", "exp": "exp", "log": "log",
           "sqrt": "sqrt", "abs": "abs", "sin": "sin", "cos": "cos", "tanh": "tanh", "atan": "atan", "^": "pow"}


def main():
    request, names, X, y = read_request()
    library("pyoperon", "pip install pyoperon")
    import numpy as np
    from pyoperon.sklearn import SymbolicRegressor
    symbols = [SYMBOLS[o] for o in request["operators"] if o in SYMBOLS]
    settings = {"allowed_symbols": ",".join([*symbols, "constant", "variable"]),
                "random_state": request["seed"], "n_threads": request["threads"],
                "objectives": ["r2", "length"], **request["parameters"]}
    search = SymbolicRegressor(**settings)
    search.fit(np.array(X), np.array(y))
    found = sorted(search.pareto_front_, key=lambda each: each["complexity"])
    front = [search.get_model_string(each["tree"], 17, names) for each in found]
    best = search.get_model_string(search.model_, 17, names)
    if best not in front:
        front.append(best)
    answer(front, "its defaults, objectives r2 and length",
           f"pyoperon {version('pyoperon')}", front.index(best))


if __name__ == "__main__":
    main()
