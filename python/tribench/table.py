# SPDX-License-Identifier: MIT
"""Arrays as the CSV files that the program reads; every double keeps its bits."""
import re

import numpy as np

# Names of functions in formulas; a column may not be called so.
_TAKEN = {"exp", "log", "sqrt", "abs", "sgn", "sin", "cos", "tanh", "atan"}


def formula_names(labels):
    """A name for each column that can stand in a formula: letters, digits and _, all different."""
    names = []
    for i, label in enumerate(labels):
        name = re.sub(r"[^A-Za-z0-9_]", "_", str(label))
        if not re.match(r"[A-Za-z_]", name) or name in _TAKEN or name.startswith("sgn_"):
            name = f"x{i}_{name}"
        while name in names:
            name += "_"
        names.append(name)
    return names


def write_table(path, names, columns):
    """columns: arrays of one length, in the order of names."""
    rows = zip(*(np.asarray(column, dtype=float).tolist() for column in columns))
    with open(path, "w", encoding="ascii") as file:
        file.write(",".join(names) + "\n")
        for row in rows:
            file.write(",".join(map(repr, row)) + "\n")
