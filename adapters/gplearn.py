#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gplearn under tribench. Parameters: any of SymbolicRegressor's ("(2, 4)" is a tuple). Settings: its
defaults, with the functions of the operator set; its protected division, logarithm and root mean other
things than the formula says and are left out. Stops after the last generation that the seconds allow.
pip install gplearn; from Debian 13 on: python3-gplearn.
"""
import time

from protocol import answer, library, read_request, unsupported, version

NAMES = {"+": "add", "-": "sub", "*": "mul", "abs": "abs", "sin": "sin", "cos": "cos"}
INFIX = {"add": "({} + {})", "sub": "({} - {})", "mul": "({}*{})", "abs": "abs({})",
         "neg": "(-{})", "sin": "sin({})", "cos": "cos({})"}


def infix(program, names):
    """program: functions, places of inputs (int) and constants (float), in prefix order."""
    stack = []
    for node in reversed(program):
        if hasattr(node, "arity"):
            parts = [stack.pop() for _ in range(node.arity)]
            stack.append(INFIX[node.name].format(*parts))
        else:
            stack.append(names[node] if isinstance(node, int) else f"({float(node)!r})")
    return stack.pop()


def evolve(search, generations, X, y, seconds):
    """The same as one fit of all generations, but for the seconds. Returns how many there were."""
    for generation in range(1, generations + 1):
        search.set_params(generations=generation, warm_start=True).fit(X, y)
        best = search.run_details_["best_fitness"][-1]
        sign = 1 if search.metric in ("pearson", "spearman") else -1
        if sign * best >= sign * search.stopping_criteria:
            break
        if time.process_time() * (generation + 1) / generation > seconds:
            break
    return generation


def main():
    request, names, X, y = read_request()
    library("gplearn", "pip install gplearn (Debian 13: apt install python3-gplearn)")
    from gplearn.genetic import SymbolicRegressor
    functions = [NAMES[o] for o in request["operators"] if o in NAMES]
    settings = {"function_set": functions, "random_state": request["seed"],
                "n_jobs": request["threads"], **request["parameters"]}
    if not settings["function_set"] or not set(settings["function_set"]) <= set(INFIX):
        unsupported("gplearn's functions without protection are " + ", ".join(INFIX))
    search = SymbolicRegressor(**settings)
    asked = search.generations
    done = evolve(search, asked, X, y, request["seconds"])
    nodes = sum(search.run_details_["average_length"]) * search.population_size
    answer([infix(search._program.program, names)], "its defaults",
           f"gplearn {version('gplearn')}, {done} of {asked} generations",
           evaluations=round(nodes * len(y)))


if __name__ == "__main__":
    main()
