#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The paper's baseline as the paper ran it: the static friction model fitted by SciPy's basin
hopping (Scholl et al. 2025), under tribench's protocol (docs/external_methods.md).

  tau(v) = sgn(v) (Fc + (Fs - Fc) exp(-|v / vs|^delta)) + Fv v

Parameters: model = "symmetric" | "asymmetric" (five parameters for each direction), hops (SciPy's
niter, 100 by default), start_high (the start is drawn from [0, start_high] in every parameter; the
paper does not print its start). Everything else is SciPy's default: BFGS, steps of 0.5, T = 1.
"""
import csv
import json
import pathlib
import sys

import numpy as np
from scipy.optimize import basinhopping

NAMES = ("Fs", "Fc", "vs", "delta", "Fv")


def branch(parameters, v):
    """The model for one direction; v in rad/s, the result in the target's unit."""
    fs, fc, vs, delta, fv = parameters
    with np.errstate(all="ignore"):
        return np.sign(v) * (fc + (fs - fc) * np.exp(-np.abs(v / vs) ** delta)) + fv * v


def model(parameters, v, symmetric):
    if symmetric:
        return branch(parameters, v)
    return np.where(v >= 0, branch(parameters[:5], v), branch(parameters[5:], v))


def branch_formula(parameters, v, sign):
    fs, fc, vs, delta, fv = (repr(float(p)) for p in parameters)
    return f"({sign}*({fc} + ({fs} - ({fc}))*exp(-abs({v}/({vs}))^({delta}))) + {fv}*{v})"


def formula(parameters, v, sign, symmetric):
    if symmetric:
        return branch_formula(parameters, v, sign)
    up = branch_formula(parameters[:5], v, sign)
    down = branch_formula(parameters[5:], v, sign)
    # (1 +- s) / 2 picks the branch by its sign.
    return f"0.5*(1 + {sign})*{up} + 0.5*(1 - {sign})*{down}"


def main():
    path = pathlib.Path(sys.argv[1])
    request = json.loads(path.read_text())
    with open(path.parent / request["train"], newline="") as file:
        rows = list(csv.DictReader(file))
    velocity = [i["name"] for i in request["inputs"] if i["role"] == "velocity"]
    if not velocity or not rows:
        print(json.dumps({"unsupported": "no input has the role velocity"}))
        return
    v_name = velocity[0]
    names = [i["name"] for i in request["inputs"]]
    sign = f"sgn_{v_name}" if f"sgn_{v_name}" in names else f"sgn({v_name})"
    v = np.array([float(row[v_name]) for row in rows])
    y = np.array([float(row[request["target"]]) for row in rows])
    options = request["parameters"]
    symmetric = options.get("model", "symmetric") == "symmetric"
    count = 5 if symmetric else 10
    random = np.random.RandomState(request["seed"])
    evaluations = 0

    def error(parameters):
        nonlocal evaluations
        evaluations += 15 * len(v)
        with np.errstate(all="ignore"):
            return float(np.mean((model(parameters, v, symmetric) - y) ** 2))

    best = [np.inf]

    def on_minimum(_, value, __):
        if value < best[0]:
            best[0] = value
            print(json.dumps({"improved": {"train_error": value, "evaluations": evaluations}}),
                  flush=True)
        return evaluations > request["evaluations"]

    start = random.uniform(0, options.get("start_high", 100.0), count)
    result = basinhopping(error, start, niter=options.get("hops", 100), seed=random,
                          callback=on_minimum)
    if not np.all(np.isfinite(result.x)):
        sys.exit("basin hopping ended at parameters that are not finite")
    print(json.dumps({
        "front": [formula(result.x, v_name, sign, symmetric)],
        "evaluations": evaluations,
        "note": ", ".join(f"{name} = {value:.6g}" for name, value in zip(NAMES * 2, result.x)),
    }), flush=True)


if __name__ == "__main__":
    main()
