# SPDX-License-Identifier: MIT
"""tribench from Python: drives the installed program through files and JSON.

    from tribench import TribenchRegressor, run_grid, loop

    model = TribenchRegressor(method="udsr").fit(X, y)
    model.formula_, model.latex(), model.predict(X)
    run_grid("grids/quick.toml", out="run").records
    loop("recording.csv", "--gear-ratio", "160").verdict

Needs numpy; scikit-learn is used where it is there (its estimator checks pass). The program is
$TRIBENCH_PROGRAM, else `tribench` in PATH.
"""
from .closed_loop import Effect, LoopResult, loop
from .estimator import TribenchRegressor
from .grid import GridRun, run_grid
from .program import TribenchError, find_program

__all__ = ["Effect", "GridRun", "LoopResult", "TribenchError", "TribenchRegressor", "find_program",
           "loop", "run_grid"]
