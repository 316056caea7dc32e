# SPDX-License-Identifier: MIT
"""What every adapter says and hears (docs/external_methods.md), so that each is its peer alone."""
import ast
import csv
import importlib
import importlib.metadata
import json
import pathlib
import sys

# An adapter is called like the library it drives: its folder must not hide the library.
sys.path[:] = [p for p in sys.path if pathlib.Path(p or ".").resolve() != pathlib.Path(__file__).parent]


def value(text):
    """Parameters of a grid are numbers and words; "(2, 6)", "[1]" and "None" are what Python takes them for."""
    if isinstance(text, str) and (text[:1] in ("(", "[", "{") or text == "None"):
        return ast.literal_eval(text)
    return text


def read_request():
    """The request, its inputs' names, X (a list of rows) and y."""
    path = pathlib.Path(sys.argv[1])
    request = json.loads(path.read_text())
    request["parameters"] = {name: value(each) for name, each in request["parameters"].items()}
    with open(path.parent / request["train"], newline="") as file:
        rows = list(csv.DictReader(file))
    names = [each["name"] for each in request["inputs"]]
    X = [[float(row[name]) for name in names] for row in rows]
    return request, names, X, [float(row[request["target"]]) for row in rows]


def library(name, install):
    """The peer's module, or an answer that says what to install."""
    sys.modules.pop(name, None)  # the adapter itself where it is run as this name
    try:
        return importlib.import_module(name)
    except ImportError as missing:
        print(json.dumps({"unsupported": f"{missing}; install it: {install}"}), flush=True)
        sys.exit(0)


def version(package):
    """Of an installed package; not every library says its own."""
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "of unknown version"


def unsupported(why):
    print(json.dumps({"unsupported": why}), flush=True)
    sys.exit(0)


def answer(front, provenance, peer, chosen=None, evaluations=None):
    """front: formulas from simple to complex. provenance: who chose the settings: "its defaults",
    "its authors for this task" or "ours". peer: its name and version. evaluations: node-rows spent,
    where they are known."""
    reply = {"front": front, "note": f"config_provenance: {provenance}; {peer}"}
    for name, known in {"chosen": chosen, "evaluations": evaluations}.items():
        if known is not None:
            reply[name] = known
    print(json.dumps(reply), flush=True)
