# SPDX-License-Identifier: MIT
"""The Python package against the program named in $TRIBENCH_PROGRAM."""
import pathlib
import pickle
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    raise unittest.SkipTest("no numpy (Debian: python3-numpy)")

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import tribench  # noqa: E402
from tribench import estimator, table  # noqa: E402
from tribench.program import run_program  # noqa: E402


def law(rows=150, seed=0):
    random = np.random.default_rng(seed)
    X = random.uniform(-2, 2, (rows, 2))
    return X, 3 * X[:, 0] ** 2 - X[:, 1] + 0.5


class Regressor(unittest.TestCase):
    def test_finds_a_law_and_predicts_the_programs_bits(self):
        X, y = law()
        model = tribench.TribenchRegressor(method="udsr", evaluations=50_000_000).fit(X, y)
        self.assertGreater(model.score(X, y), 1 - 1e-12)
        self.assertIn(model.formula_, [e["formula"] for e in model.equations_])
        self.assertIn("x_{0}", model.latex().replace("x0", "x_{0}"))
        with tempfile.TemporaryDirectory() as folder:
            data = pathlib.Path(folder) / "rows.csv"
            table.write_table(data, ["x0", "x1"], X.T)
            printed = run_program(["predict", "--", model.formula_, data]).split()[1:]
        self.assertEqual([float(v).hex() for v in printed], [v.hex() for v in model.predict(X)])

    def test_parameters_reach_the_program_and_mistakes_come_back(self):
        X, y = law()
        with self.assertRaisesRegex(tribench.TribenchError, "did you mean"):
            tribench.TribenchRegressor(method="udsrr").fit(X, y)
        with self.assertRaisesRegex(tribench.TribenchError, "no_such"):
            tribench.TribenchRegressor(parameters={"no_such": 1}).fit(X, y)
        a = tribench.TribenchRegressor(method="linear", random_state=3)
        self.assertEqual(a.get_params()["random_state"], 3)
        self.assertEqual(a.set_params(method="constant").method, "constant")
        again = pickle.loads(pickle.dumps(a.fit(X, y)))
        np.testing.assert_array_equal(again.predict(X), a.predict(X))

    def test_columns_get_names_that_formulas_can_hold(self):
        self.assertEqual(table.formula_names(["v", "q [deg]", "sin", "1a", "v"]),
                         ["v", "q__deg_", "x2_sin", "x3_1a", "v_"])

    @unittest.skipUnless(estimator.HAVE_SKLEARN, "no scikit-learn (Debian: python3-sklearn)")
    def test_passes_scikit_learns_estimator_checks(self):
        from sklearn.utils.estimator_checks import check_estimator
        check_estimator(tribench.TribenchRegressor(method="linear"))


class Runs(unittest.TestCase):
    def test_a_grid_gives_records(self):
        with tempfile.TemporaryDirectory() as folder:
            grid = pathlib.Path(folder) / "g.toml"
            grid.write_text('[grid]\nproblems = ["A/j2/no_load"]\nmethods = ["constant", "linear"]\n')
            run = tribench.run_grid(grid, pathlib.Path(folder) / "run", jobs=1)
            self.assertEqual([r["method"] for r in run.records], ["constant", "linear"])
            self.assertGreater(run.records[0]["mae_test"], run.records[1]["mae_test"])
            self.assertIn("Who wins where", run.leaderboard)

    def test_the_loop_names_a_planted_effect(self):
        with tempfile.TemporaryDirectory() as folder:
            data = pathlib.Path(folder) / "recording.csv"
            run_program(["generate", "undeclared/stribeck/2", "--out", data])
            found = tribench.loop(data, "--gear-ratio", "160", "--any-sign")
        self.assertEqual(found.verdict, "EFFECTS")
        self.assertEqual(found.effects[0].family, "stribeck")
        self.assertLess(found.mae_after, found.mae_before)
        self.assertLess(found.effects[0].p, 0.003)


if __name__ == "__main__":
    unittest.main()
