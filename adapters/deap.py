#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""DEAP under tribench: its own example of symbolic regression (tournaments of 3, crossover 0.5, mutation
0.1, height 17 at most) without division, each formula scaled linearly. Debian: python3-deap.
Parameters: population (300), generations (40)."""
import random

import numpy as np

from protocol import answer, library, read_request

OPERATORS = {"+": np.add, "-": np.subtract, "*": np.multiply, "sin": np.sin, "cos": np.cos}
INFIX = dict(add="({} + {})", subtract="({} - {})", multiply="({}*{})", sin="sin({})", cos="cos({})")


def infix(tree):
    stack = []
    for node in reversed(tree):
        parts = [stack.pop() for _ in range(node.arity)]
        leaf = node.value if not node.arity else None
        stack.append(INFIX[node.name].format(*parts) if node.arity
                     else leaf if isinstance(leaf, str) else f"({float(leaf)!r})")
    return stack.pop()


def main():
    request, names, X, y = read_request()
    deap = library("deap", "apt install python3-deap")
    from deap import algorithms, base, creator, gp, tools
    random.seed(request["seed"])
    X, y = np.array(X).T, np.array(y)
    language = gp.PrimitiveSet("MAIN", len(names))
    language.renameArguments(**{f"ARG{i}": name for i, name in enumerate(names)})
    for function in (OPERATORS[o] for o in OPERATORS if o in request["operators"]):
        language.addPrimitive(function, function.nin, name=function.__name__)
    language.addEphemeralConstant("rand", lambda: random.uniform(-1, 1))

    def scaled(tree):
        with np.errstate(all="ignore"):
            values = np.broadcast_to(gp.compile(tree, language)(*X), y.shape).astype(float)
            slope = float(np.mean((values - values.mean()) * (y - y.mean())) / np.var(values))
            if not np.isfinite(slope):  # a constant, or no number
                return 0.0, float(y.mean()), float(np.var(y))
            offset = float(y.mean() - slope * values.mean())
            return slope, offset, float(np.mean((y - offset - slope * values) ** 2))

    creator.create("Worth", base.Fitness, weights=(-1.0,))
    creator.create("Tree", gp.PrimitiveTree, fitness=creator.Worth)
    box = base.Toolbox()
    box.register("draw", gp.genHalfAndHalf, pset=language, min_=1, max_=2)
    box.register("individual", tools.initIterate, creator.Tree, box.draw)
    box.register("evaluate", lambda tree: (scaled(tree)[2],))
    box.register("select", tools.selTournament, tournsize=3)
    box.register("mate", gp.cxOnePoint)
    box.register("grow", gp.genFull, min_=0, max_=2)
    box.register("mutate", gp.mutUniform, expr=box.grow, pset=language)
    box.decorate("mate", gp.staticLimit(key=lambda tree: tree.height, max_value=17))
    box.decorate("mutate", gp.staticLimit(key=lambda tree: tree.height, max_value=17))
    size = int(request["parameters"].get("population", 300))
    rounds = int(request["parameters"].get("generations", 40))
    best = tools.HallOfFame(1)
    algorithms.eaSimple(tools.initRepeat(list, box.individual, size), box, 0.5, 0.1, rounds,
                        halloffame=best, verbose=False)
    slope, offset, _ = scaled(best[0])
    answer([repr(float(y.mean())), f"{offset!r} + {slope!r}*{infix(best[0])}"],
           "its authors for this task (DEAP's example), linear scaling ours",
           f"deap {deap.__version__}, population {size}, generations {rounds}")


if __name__ == "__main__":
    main()
