#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""PySR (Python and Julia) under tribench. Parameters: any of PySRRegressor's. Settings: its defaults,
with the operators of the operator set; deterministic in one process. pip install pysr.
"""
from protocol import answer, library, read_request, version

BINARY = ("+", "-", "*", "/", "^")
UNARY = ("exp", "log", "sqrt", "abs", "sin", "cos", "tanh", "atan")


def main():
    request, names, X, y = read_request()
    pysr = library("pysr", "pip install pysr (it fetches Julia when first used)")
    import numpy as np
    settings = {
        "binary_operators": [o for o in BINARY if o in request["operators"]],
        "unary_operators": [o for o in UNARY if o in request["operators"]],
        "random_state": request["seed"], "deterministic": True, "parallelism": "serial",
        "progress": False, "verbosity": 0, "temp_equation_file": True,
        "timeout_in_seconds": request["seconds"], **request["parameters"]}
    search = pysr.PySRRegressor(**settings)
    search.fit(np.array(X), np.array(y), variable_names=names)
    table = search.equations_
    front = [str(text).replace("**", "^") for text in table["equation"]]
    chosen = list(table["equation"]).index(search.get_best()["equation"])
    answer(front, "its defaults", f"PySR {version('pysr')}", chosen)


if __name__ == "__main__":
    main()
