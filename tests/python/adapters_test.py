# SPDX-License-Identifier: MIT
"""The adapters: live where the library is installed; else the conversation, the library's side played by
what was recorded from the real one (conversations/), of PySR and Operon by what their documentation shows."""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    raise unittest.SkipTest("no numpy (Debian: python3-numpy)")

ADAPTERS = pathlib.Path(__file__).resolve().parents[2] / "adapters"

CONVERSATIONS = pathlib.Path(__file__).resolve().parent / "conversations"

# Recorded from the real library (record_conversation.py), with these parameters.
RECORDED = {"gplearn": {"population_size": 400, "generations": 6, "init_depth": "(2, 4)"}, "ffx": {},
            "earth": {"degree": 2}}

# The library's side, from a recording: it insists on being asked what it was asked then.
REPLAY = """
import json, pathlib
heard = json.loads(pathlib.Path(__file__).with_name("heard.json").read_text())["library"]
def plain(asked): return json.loads(json.dumps(asked))
"""
PLAYERS = {
    "gplearn": {"gplearn/__init__.py": "", "gplearn/genetic.py": REPLAY + """
class Function:
    def __init__(self, name, arity): self.name, self.arity = name, arity
class SymbolicRegressor:
    def __init__(self, **settings):
        assert plain(settings) == heard["asked"], settings
        self.__dict__.update(heard["answered"])
        self._generations = self.generations
        self._program = Function("program", 0)
        self._program.program = [Function(*node) if isinstance(node, list) else node for node in self.program]
    def set_params(self, generations, warm_start):
        assert warm_start and generations <= self._generations
        self.generations = generations
        return self
    def fit(self, X, y):
        self.run_details_ = {name: values[:self.generations]
                             for name, values in heard["answered"]["run_details_"].items()}
"""},
    "ffx": {"ffx/__init__.py": REPLAY + """
class Model:
    def __init__(self, text, size): self.text, self.size = text, size
    def complexity(self): return self.size
    def __str__(self): return self.text
def run(X, y, test_X, test_y, names):
    assert {"shape": list(X.shape), "names": names} == heard["asked"]
    return [Model(*model) for model in heard["answered"]]
"""},
    "earth": {"earth/Rscript": "#!/usr/bin/python3\nimport sys\n" + REPLAY + """
assert [pathlib.Path(word).name for word in sys.argv] == heard["asked"], sys.argv
print(heard["answered"], end="")
"""},
}

# What the documentation of the others shows of each library's side, as a module of its name.
PLAYED = {
    "pysr": {
        "pysr/__init__.py": """
class PySRRegressor:
    def __init__(self, **settings):
        assert settings['binary_operators'] == ['+', '-', '*', '/', '^'], settings
        assert settings['deterministic'] and settings['random_state'] == 5
    def fit(self, X, y, variable_names):
        assert variable_names == ['qd', 'g']
        self.equations_ = {'equation': ['1.5', 'qd', '(qd ** 2.0) - g']}
    def get_best(self): return {'equation': '(qd ** 2.0) - g'}
"""},
    "pyoperon": {
        "pyoperon/__init__.py": "",
        "pyoperon/sklearn.py": """
class SymbolicRegressor:
    def __init__(self, allowed_symbols, random_state, n_threads, objectives):
        assert allowed_symbols.startswith('add,sub,mul') and allowed_symbols.endswith('variable')
    def fit(self, X, y):
        self.model_ = 'b'
        self.pareto_front_ = [{'tree': 'b', 'complexity': 9}, {'tree': 'a', 'complexity': 1}]
    def get_model_string(self, tree, precision, names):
        return {'a': '1.5', 'b': '((3.0 * (qd ^ 2)) - g)'}[tree]
"""},
}
HEARD = {
    "pysr": ["1.5", "qd", "(qd ^ 2.0) - g"],
    "pyoperon": ["1.5", "((3.0 * (qd ^ 2)) - g)"],
}


def parabola(qd, g):
    return 3 * qd * qd - g + 0.5


def hinge(qd, g):  # what FFX has functions for
    return (2 * max(0.0, qd - 1.1) + 0.5 * math.log10(g)) / (1 + 0.3 * g)


LAWS = {"ffx": hinge}


def write_request(folder, adapter, parameters=None, seconds=20.0):
    """A request about the adapter's law, in a folder of its own."""
    random = np.random.default_rng(2)
    X = random.uniform(0.1, 2, (120, 2))
    rows = "\n".join(f"{a!r},{b!r},{LAWS.get(adapter, parabola)(a, b)!r},{i // 10}"
                     for i, (a, b) in enumerate(X.tolist()))
    (folder / "train.csv").write_text("qd,g,target,movement\n" + rows + "\n")
    request = {"protocol": 1, "train": "train.csv", "target": "target",
               "inputs": [{"name": "qd"}, {"name": "g"}], "operator_set": "full",
               "operators": ["+", "-", "*", "/", "exp", "log", "sqrt", "abs", "sin", "cos", "tanh", "^"],
               "proved_free_only": False, "evaluations": 100000000, "seconds": seconds, "seed": 5,
               "threads": 1, "parameters": parameters or {}}
    (folder / "request.json").write_text(json.dumps(request))
    return request


def install(modules, folder):
    for name, text in modules.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)


def ask(adapter, folder, parameters=None, libraries=None, seconds=20.0):
    """The adapter's answer to the request."""
    write_request(folder, adapter, parameters, seconds)
    ended = subprocess.run([sys.executable, str(ADAPTERS / f"{adapter}.py"), str(folder / "request.json")],
                           capture_output=True, text=True, check=False,
                           env={"PYTHONPATH": libraries or str(folder),
                                "PATH": f"{folder / adapter}:/usr/bin:/bin",
                                "PYTHONDONTWRITEBYTECODE": "1", "OMP_NUM_THREADS": "1"})
    assert ended.returncode == 0, ended.stderr
    return json.loads(ended.stdout.strip().split("\n")[-1])


def values(formula, qd, g):
    names = {name: getattr(np, name) for name in ("exp", "log", "sqrt", "abs", "sin", "cos", "tanh")}
    return eval(formula.replace("^", "**"), {"__builtins__": {}}, {**names, "qd": qd, "g": g})


class Adapters(unittest.TestCase):
    def setUp(self):
        self._scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self._scratch.cleanup)
        self.folder = pathlib.Path(self._scratch.name)

    def test_are_short_and_say_whose_settings_they_use(self):
        for adapter in ("pysr", "gplearn", "pyoperon", "deap", "sklearn", "ffx", "earth"):
            lines = (ADAPTERS / f"{adapter}.py").read_text().splitlines()
            self.assertLessEqual(sum(1 for line in lines if line.strip()), 60, adapter)

    def recorded(self, adapter):
        return json.loads((CONVERSATIONS / f"{adapter}.json").read_text())

    def expect_the_librarys_values(self, conversation, front):
        """Each formula says what its model predicts: FFX prints three digits of its thresholds."""
        rows = np.array(conversation["judged_rows"]).T
        for formula, predicted in zip(front, conversation["library"].get("predicted", [])):
            np.testing.assert_allclose(values(formula, *rows), predicted, rtol=1e-10,
                                       atol=0.02 if conversation["peer"] == "ffx" else 1e-10)

    def test_recorded_conversations(self):
        for adapter, parameters in RECORDED.items():
            with self.subTest(adapter):
                conversation = self.recorded(adapter)
                install(PLAYERS[adapter], self.folder)
                (self.folder / adapter / "heard.json").write_text(json.dumps(conversation))
                reply = ask(adapter, self.folder, parameters)
                told = json.loads(conversation["reply"])
                self.assertEqual(json.loads((self.folder / "request.json").read_text()),
                                 conversation["request"])
                self.assertEqual([reply["front"], reply.get("chosen")],
                                 [told["front"], told.get("chosen")])
                self.assertIn("config_provenance: its defaults", reply["note"])
                self.expect_the_librarys_values(conversation, reply["front"])

    def test_recorded_libraries_say_the_same_today(self):
        """Where the real library of the recorded version is there (PYTHONPATH, or installed)."""
        met = 0
        for adapter, parameters in RECORDED.items():
            reply = ask(adapter, self.folder, parameters, os.environ.get("PYTHONPATH", "/nowhere"))
            told = json.loads(self.recorded(adapter)["reply"])
            if "install it" in reply.get("unsupported", "") or reply["note"] != told["note"]:
                continue  # not there, or another version
            met += 1
            self.assertEqual(reply, told)
        if met == 0:
            self.skipTest("no recorded library is installed (Debian: r-cran-earth; 13: python3-gplearn)")

    def test_documented_conversations(self):
        for adapter, modules in PLAYED.items():
            install(modules, self.folder)
            with self.subTest(adapter):
                reply = ask(adapter, self.folder)
                self.assertEqual(reply["front"], HEARD[adapter])
                self.assertIn("config_provenance: its defaults", reply["note"])
                for formula in reply["front"]:
                    self.assertTrue(np.isfinite(values(formula, 0.7, 1.2)))

    def test_a_search_ends_with_the_last_generation_that_the_seconds_allow(self):
        conversation = self.recorded("gplearn")
        slow = {**PLAYERS["gplearn"]}
        slow["gplearn/genetic.py"] += """
        import time
        until = time.process_time() + 0.3
        while time.process_time() < until: pass
"""
        install(slow, self.folder)
        (self.folder / "gplearn" / "heard.json").write_text(json.dumps(conversation))
        reply = ask("gplearn", self.folder, RECORDED["gplearn"], seconds=1.2)
        self.assertRegex(reply["note"], "[1-4] of 6 generations")  # of 0.3 seconds each

    def test_a_library_that_is_not_there_is_asked_for(self):
        reply = ask("gplearn", self.folder)
        if "unsupported" not in reply:
            self.skipTest("gplearn is installed")
        self.assertIn("pip install gplearn", reply["unsupported"])

    def live(self, adapter, package, parameters=None):
        reply = ask(adapter, self.folder, parameters)
        if "install it" in reply.get("unsupported", ""):
            self.skipTest(f"no {adapter} (Debian: {package})")
        again = ask(adapter, self.folder, parameters)
        self.assertEqual(reply, again)  # the seed decides
        self.assertIn("config_provenance", reply["note"])
        qd, g = np.random.default_rng(3).uniform(0.1, 2, (2, 50))
        truth = 3 * qd**2 - g + 0.5
        errors = [np.mean((values(f, qd, g) - truth) ** 2) for f in reply["front"]]
        return errors[-1] / np.var(truth)

    def test_scikit_learn_finds_a_polynomial(self):
        self.assertLess(self.live("sklearn", "python3-sklearn"), 1e-3)

    def test_deap_explains_most(self):
        self.assertLess(self.live("deap", "python3-deap", {"population": 200, "generations": 15}), 0.1)


if __name__ == "__main__":
    unittest.main()
