# SPDX-License-Identifier: MIT
"""A scikit-learn regressor whose model is a formula that the program found and judged."""
import inspect
import json
import pathlib
import tempfile

import numpy as np

from .program import run_program
from .table import formula_names, write_table

try:
    from sklearn.base import BaseEstimator, RegressorMixin
    from sklearn.utils.validation import check_is_fitted
    HAVE_SKLEARN = True
except ImportError:  # the same surface without scikit-learn
    HAVE_SKLEARN = False

    class BaseEstimator:
        """get_params and set_params from the signature of __init__, as scikit-learn has them."""

        def get_params(self, deep=True):
            names = [n for n in inspect.signature(type(self).__init__).parameters if n != "self"]
            return {name: getattr(self, name) for name in names}

        def set_params(self, **parameters):
            for name, value in parameters.items():
                if name not in self.get_params():
                    raise ValueError(f"Invalid parameter {name!r} for {type(self).__name__}")
                setattr(self, name, value)
            return self

    class RegressorMixin:
        """R2, as scikit-learn has it."""

        def score(self, X, y):
            y = np.asarray(y, dtype=float)
            return 1 - np.sum((y - self.predict(X)) ** 2) / np.sum((y - y.mean()) ** 2)

    def check_is_fitted(estimator):
        if not hasattr(estimator, "formula_"):
            raise RuntimeError("this TribenchRegressor is not fitted: call fit first")


class TribenchRegressor(RegressorMixin, BaseEstimator):
    """Fits a formula with any method of `tribench list methods`.

    Parameters
    ----------
    method : name of the method.
    operators : name of the operator set (`tribench list operators`).
    evaluations : budget in node-rows, the reproducible one; None: the program's.
    seconds : budget in CPU seconds; None: the program's.
    parameters : {name: value} of the method.
    random_state : whole number, the seed; None is 1: the program never draws from a clock.

    Attributes after fit
    --------------------
    formula_ : the chosen formula, as it was judged.
    equations_ : list of {"formula", "complexity", "mae_train", "singularity", ...}, the front.
    names_ : what each column is called in formulas.
    result_ : all that `tribench fit --json` printed.
    """

    def __init__(self, method="udsr", operators="full", evaluations=None, seconds=None,
                 parameters=None, random_state=None):
        self.method = method
        self.operators = operators
        self.evaluations = evaluations
        self.seconds = seconds
        self.parameters = parameters
        self.random_state = random_state

    def fit(self, X, y):
        """X: n x d numbers (an array or a data frame), y: n numbers; no NaN. Returns itself."""
        labels = getattr(X, "columns", None)
        X, y = self._checked_pair(X, y)
        if len(y) < 2:
            raise ValueError("1 sample: a fit needs two or more rows")
        self.names_ = formula_names(labels if labels is not None
                                    else [f"x{i}" for i in range(X.shape[1])])
        target = "target"
        while target in self.names_:
            target += "_"
        arguments = ["--target", target, "--inputs", ",".join(self.names_), "--method",
                     self.method, "--operators", self.operators, "--seed", self._seed(), "--json"]
        for option, value in (("--evaluations", self.evaluations), ("--seconds", self.seconds)):
            if value is not None:
                arguments += [option, value]
        for name, value in (self.parameters or {}).items():
            arguments += ["--parameter", f"{name}={_text(value)}"]
        with tempfile.TemporaryDirectory() as folder:
            data = pathlib.Path(folder) / "train.csv"
            write_table(data, [*self.names_, target], [*X.T, y])
            self.result_ = json.loads(run_program(["fit", data, *arguments]))
        self.formula_ = self.result_["formula"]
        self.equations_ = self.result_["front"]
        self.n_features_in_ = X.shape[1]
        return self

    def predict(self, X):
        """The formula's values by the program's own evaluator, bit for bit."""
        check_is_fitted(self)
        X = self._checked_rows(X)
        with tempfile.TemporaryDirectory() as folder:
            data = pathlib.Path(folder) / "rows.csv"
            write_table(data, self.names_, X.T)
            model = pathlib.Path(folder) / "model.json"  # a command line has an end, formulas do not
            model.write_text(json.dumps({"formula": self.formula_}), encoding="utf-8")
            lines = run_program(["predict", model, data]).split("\n")[1:]
        return np.array([float(line) if line else np.nan for line in lines[:len(X)]])

    def latex(self):
        """The chosen formula as LaTeX."""
        check_is_fitted(self)
        return run_program(["export", "--as", "latex", "--", self.formula_]).strip()

    def _seed(self):
        if self.random_state is None:
            return 1
        if hasattr(self.random_state, "randint"):  # a numpy generator, as scikit-learn hands them
            return int(self.random_state.randint(2**31 - 1))
        return int(self.random_state)

    def _checked_pair(self, X, y):
        if HAVE_SKLEARN:
            return self._validate_data(X, y, dtype=float, y_numeric=True)
        X, y = np.asarray(X, dtype=float), np.asarray(y, dtype=float)
        if X.ndim != 2 or y.shape != (len(X),) or not (np.isfinite(X).all() and np.isfinite(y).all()):
            raise ValueError("give rows and columns and a number for each row, all of them finite")
        return X, y

    def _checked_rows(self, X):
        if HAVE_SKLEARN:
            return self._validate_data(X, dtype=float, reset=False)
        X = np.asarray(X, dtype=float)
        if X.ndim != 2 or X.shape[1] != self.n_features_in_:
            raise ValueError(f"give rows of {self.n_features_in_} columns, as the fit had")
        return X


def _text(value):
    return str(value).lower() if isinstance(value, bool) else str(value)
