#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits one data set by three methods and prints each method's front (docs/python.md)."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
from tribench import TribenchRegressor  # noqa: E402


def main():
    random = np.random.default_rng(1)
    v = random.uniform(-2, 2, 200)
    X = np.column_stack([v, np.sign(v)])
    y = 8 * np.sign(v) + 12 * v + 0.1 * random.normal(size=200)
    for method in ("linear", "udsr", "pysr"):
        model = TribenchRegressor(method, operators="paper", evaluations=20_000_000).fit(X, y)
        print(f"{method}: R2 = {model.score(X, y):.6f}")
        for equation in model.equations_:
            print(f"  {equation['complexity']:3d}  {equation['formula']}")


if __name__ == "__main__":
    main()
