# SPDX-License-Identifier: MIT
"""The adapters: scikit-learn and DEAP live where they are installed; of the others the conversation,
with the library's side played by what its documentation shows."""
import json
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

# What each library's side says, as a module of its name.
PLAYED = {
    "gplearn": {
        "gplearn/__init__.py": "__version__ = '0.4.2'\n",
        "gplearn/genetic.py": """
class Function:
    def __init__(self, name, arity): self.name, self.arity = name, arity
class SymbolicRegressor:
    def __init__(self, function_set, random_state, n_jobs, **more):
        assert function_set == ['add', 'sub', 'mul', 'abs', 'sin', 'cos'], function_set
        assert random_state == 5 and more == {'generations': 7}, more
    def fit(self, X, y):
        class Program:
            program = [Function('add', 2), Function('mul', 2), 0, 0.123456789, Function('neg', 1), 1]
        self._program = Program()
"""},
    "pysr": {
        "pysr/__init__.py": """
__version__ = '1.5.9'
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
        "pyoperon/__init__.py": "__version__ = '0.5.0'\n",
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
    "ffx": {
        "ffx/__init__.py": """
__version__ = '2.0.2'
class Model:
    def __init__(self, text, size): self.text, self.size = text, size
    def complexity(self): return self.size
    def __str__(self): return self.text
def run(train_X, train_y, test_X, test_y, names):
    return [Model('0.5 + 2.1*max(0,0.3-qd) - 0.1*log10(g) + 1.2*qd**2', 5), Model('1.5', 0)]
"""},
}
HEARD = {
    "gplearn": ["((qd*(0.123456789)) + (-g))"],
    "pysr": ["1.5", "qd", "(qd ^ 2.0) - g"],
    "pyoperon": ["1.5", "((3.0 * (qd ^ 2)) - g)"],
    "ffx": ["1.5", "0.5 + 2.1*((0.3-qd + abs(0.3-qd))/2) - 0.1*(log(g)/2.302585092994046) + 1.2*qd^2"],
}


def ask(adapter, folder, parameters=None):
    """The adapter's answer to a request about 3 qd^2 - g + 0.5."""
    random = np.random.default_rng(2)
    X = random.uniform(0.1, 2, (120, 2))
    rows = "\n".join(f"{a!r},{b!r},{3 * a * a - b + 0.5!r},{i // 10}"
                     for i, (a, b) in enumerate(X.tolist()))
    (folder / "train.csv").write_text("qd,g,target,movement\n" + rows + "\n")
    request = {"protocol": 1, "train": "train.csv", "target": "target",
               "inputs": [{"name": "qd"}, {"name": "g"}], "operator_set": "full",
               "operators": ["+", "-", "*", "/", "exp", "log", "sqrt", "abs", "sin", "cos", "tanh", "^"],
               "proved_free_only": False, "evaluations": 100000000, "seconds": 20.0, "seed": 5,
               "threads": 1, "parameters": parameters or {}}
    (folder / "request.json").write_text(json.dumps(request))
    ended = subprocess.run([sys.executable, str(ADAPTERS / f"{adapter}.py"), str(folder / "request.json")],
                           capture_output=True, text=True, check=False,
                           env={"PYTHONPATH": str(folder), "PATH": "/usr/bin:/bin",
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
        for adapter in ("pysr", "gplearn", "pyoperon", "deap", "sklearn", "ffx"):
            lines = (ADAPTERS / f"{adapter}.py").read_text().splitlines()
            self.assertLessEqual(sum(1 for line in lines if line.strip()), 60, adapter)

    def test_recorded_conversations(self):
        for adapter, modules in PLAYED.items():
            for name, text in modules.items():
                (self.folder / name).parent.mkdir(exist_ok=True)
                (self.folder / name).write_text(text)
            with self.subTest(adapter):
                reply = ask(adapter, self.folder, {"generations": 7} if adapter == "gplearn" else {})
                self.assertEqual(reply["front"], HEARD[adapter])
                self.assertIn("config_provenance: its defaults", reply["note"])
                for formula in reply["front"]:
                    self.assertTrue(np.isfinite(values(formula, 0.7, 1.2)))

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
