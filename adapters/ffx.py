#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""FFX (fast function extraction) under tribench. No parameters and no limit of time: it has none. Settings:
its defaults. Hinges max(0, a) are written (a + abs(a))/2, log10(a) as log(a)/log(10).
pip install ffx.
"""
import re

from protocol import answer, library, read_request, unsupported, version


def translated(text, names):
    """FFX's text over x0, x1 ... in tribench's syntax; its functions hold no brackets but their own.
    The names come last: FFX would replace what looks like x0 in them too."""
    text = text.replace("**", "^")
    text = re.sub(r"log10\(([^()]*)\)", r"(log(\1)/2.302585092994046)", text)
    text = re.sub(r"max\(0, *([^()]*)\)", r"((\1 + abs(\1))/2)", text)
    return re.sub(r"\bx(\d+)\b", lambda place: names[int(place[1])], text)


def main():
    request, names, X, y = read_request()
    if not {"+", "*", "/", "log", "abs"} <= set(request["operators"]):
        unsupported("FFX writes + * / log abs")
    ffx = library("ffx", "pip install ffx")
    import numpy as np
    X, y = np.array(X), np.array(y)
    places = [f"x{j}" for j in range(len(names))]
    models = sorted(ffx.run(X, y, X, y, places), key=lambda model: model.complexity())
    answer([translated(str(model), names) for model in models], "its defaults",
           f"ffx {version('ffx')}")


if __name__ == "__main__":
    main()
