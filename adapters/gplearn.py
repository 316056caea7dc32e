#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""gplearn under tribench. Parameters: any of SymbolicRegressor's. Settings: its defaults, with the
functions of the operator set; its protected division, logarithm and root mean other things than the
formula says and are left out. pip install gplearn.
"""
from protocol import answer, library, read_request, unsupported

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


def main():
    request, names, X, y = read_request()
    gplearn = library("gplearn", "pip install gplearn")
    from gplearn.genetic import SymbolicRegressor
    functions = [NAMES[o] for o in request["operators"] if o in NAMES]
    if not functions:
        unsupported("none of gplearn's unprotected functions is in this operator set")
    search = SymbolicRegressor(function_set=functions, random_state=request["seed"],
                               n_jobs=request["threads"], **request["parameters"])
    search.fit(X, y)
    answer([infix(search._program.program, names)], "its defaults", f"gplearn {gplearn.__version__}")


if __name__ == "__main__":
    main()
