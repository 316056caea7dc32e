# SPDX-License-Identifier: MIT
# A method of diagnosis for the test of the study's protocol: knows one effect, load-dependent
# Coulomb friction, and claims it where least squares with it fits the training rows much better.
import csv
import json
import os
import sys


def solve(a, b):
    n = len(b)
    m = [row[:] + [b[i]] for i, row in enumerate(a)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(m[r][i]))
        m[i], m[pivot] = m[pivot], m[i]
        for r in range(n):
            if r != i:
                f = m[r][i] / m[i][i]
                m[r] = [x - f * y for x, y in zip(m[r], m[i])]
    return [m[i][n] / m[i][i] for i in range(n)]


def columns(row, with_load):
    v, g = float(row["velocity_rad_s"]), float(row["gravity_torque_Nm"])
    s = (v > 0) - (v < 0)
    return [s, 1.0, v, abs(v)] + ([s * abs(g)] if with_load else [])


def fit(rows, target, with_load):
    xs = [columns(r, with_load) for r in rows]
    ys = [float(r[target]) for r in rows]
    p = len(xs[0])
    a = [[sum(x[i] * x[j] for x in xs) for j in range(p)] for i in range(p)]
    beta = solve(a, [sum(x[i] * y for x, y in zip(xs, ys)) for i in range(p)])
    loss = sum((y - sum(b * c for b, c in zip(beta, x))) ** 2 for x, y in zip(xs, ys))
    return beta, loss


request_file = sys.argv[1]
folder = os.path.dirname(request_file)
with open(request_file) as f:
    request = json.load(f)
assert "load_coulomb" in request["families"]
with open(os.path.join(folder, request["train"])) as f:
    train = list(csv.DictReader(f))
with open(os.path.join(folder, request["held_out"])) as f:
    held_out = list(csv.DictReader(f))
assert request["target"] not in held_out[0]
plain, loss_plain = fit(train, request["target"], False)
loaded, loss_loaded = fit(train, request["target"], True)
found = loss_loaded < 0.8 * loss_plain
beta = loaded if found else plain
print("chatter is no answer")
print(json.dumps({
    "verdict": "EFFECTS" if found else "NONE",
    "effects": [{"family": "load_coulomb", "alias": [{"family": "load_viscous"}]}] if found else [],
    "events": [],
    "held_out": [sum(b * c for b, c in zip(beta, columns(r, found))) for r in held_out],
}))
