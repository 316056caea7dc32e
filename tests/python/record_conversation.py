#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Records what an adapter and the real library say to each other, for adapters_test.py to play again:

    python3 tests/python/record_conversation.py gplearn "Debian 13, python3-gplearn 0.4.2-4"

The library has to be there (PYTHONPATH); what is written is tests/python/conversations/PEER.json. Not for
PySR and Operon before somebody has them: what adapters_test.py plays of these is their documentation.
"""
import contextlib
import datetime
import functools
import importlib.util
import io
import json
import pathlib
import platform
import subprocess
import sys
import tempfile

import numpy as np

import adapters_test

FOLDER = pathlib.Path(__file__).resolve().parent / "conversations"
JUDGED_ROWS = [[0.25, 0.5], [0.7, 1.2], [1.5, 0.3], [1.9, 1.8]]


def listen_to_gplearn(heard):
    from gplearn.genetic import SymbolicRegressor
    whole = SymbolicRegressor.__init__

    @functools.wraps(whole)
    def spied(self, **settings):
        heard.update(asked=settings, search=self)
        whole(self, **settings)

    SymbolicRegressor.__init__ = spied

    def told():
        search = heard.pop("search")
        defaults = {name: search.get_params()[name]
                    for name in ("metric", "stopping_criteria", "population_size")}
        program = [[node.name, node.arity] if hasattr(node, "arity") else node
                   for node in search._program.program]
        details = {name: [float(each) for each in search.run_details_[name]]
                   for name in ("best_fitness", "average_length")}
        heard["answered"] = {**defaults, "generations": heard["asked"].get("generations", 20),
                             "program": program, "run_details_": details}
        heard["predicted"] = [search.predict(np.array(JUDGED_ROWS)).tolist()]

    return told


def listen_to_ffx(heard):
    import ffx.api
    whole = ffx.api.run

    def spied(X, y, test_X, test_y, names):
        heard["asked"] = {"shape": list(X.shape), "names": names}
        models = whole(X, y, test_X, test_y, names)
        heard["answered"] = [[str(model), model.complexity()] for model in models]
        ranked = sorted(models, key=lambda model: model.complexity())
        heard["predicted"] = [m.simulate(np.array(JUDGED_ROWS)).tolist() for m in ranked]
        return models

    ffx.api.run = spied
    return lambda: None


def listen_to_earth(heard):
    whole = subprocess.run

    def spied(command, **more):
        ended = whole(command, **more)
        heard["asked"] = [pathlib.Path(word).name for word in command]
        heard["answered"] = ended.stdout
        return ended

    subprocess.run = spied

    def told():
        subprocess.run = whole

    return told


LISTEN = {"gplearn": listen_to_gplearn, "ffx": listen_to_ffx, "earth": listen_to_earth}


def main():
    peer, source = sys.argv[1:3]
    parameters = adapters_test.RECORDED[peer]
    heard = {}
    told = LISTEN[peer](heard)
    spec = importlib.util.spec_from_file_location("adapter", adapters_test.ADAPTERS / f"{peer}.py")
    sys.path.insert(0, str(adapters_test.ADAPTERS))
    adapter = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(adapter)
    with tempfile.TemporaryDirectory() as folder:
        request = adapters_test.write_request(pathlib.Path(folder), peer, parameters)
        sys.argv[1:] = [str(pathlib.Path(folder) / "request.json")]
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            adapter.main()
    told()
    reply = said.getvalue().strip().split("\n")[-1]
    record = {"peer": peer, "source": source, "recorded": datetime.date.today().isoformat(),
              "with": f"Python {platform.python_version()}, numpy {np.__version__}",
              "command": f"python3 tests/python/record_conversation.py {peer} '{source}'",
              "request": request, "library": heard, "judged_rows": JUDGED_ROWS, "reply": reply}
    (FOLDER / f"{peer}.json").write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()
