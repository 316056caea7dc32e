#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""FFX (fast function extraction) under tribench. No parameters: it has none worth the name. Settings:
its defaults. Hinges max(0, a) are written (a + abs(a))/2, log10(a) as log(a)/log(10).
pip install ffx.
"""
import re

from protocol import answer, library, read_request, unsupported


def translated(text):
    """FFX's text in tribench's syntax; its functions hold no brackets but their own."""
    text = text.replace("**", "^")
    text = re.sub(r"log10\(([^()]*)\)", r"(log(\1)/2.302585092994046)", text)
    hinge = re.compile(r"max\(0, *([^()]*)\)")
    return hinge.sub(r"((\1 + abs(\1))/2)", text)


def main():
    request, names, X, y = read_request()
    if not {"+", "*", "/"} <= set(request["operators"]):
        unsupported("FFX writes + * and /")
    ffx = library("ffx", "pip install ffx")
    import numpy as np
    X, y = np.array(X), np.array(y)
    models = sorted(ffx.run(X, y, X, y, names), key=lambda model: model.complexity())
    answer([translated(str(model)) for model in models], "its defaults",
           f"ffx {getattr(ffx, '__version__', 'of unknown version')}")


if __name__ == "__main__":
    main()
