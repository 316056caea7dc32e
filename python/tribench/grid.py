# SPDX-License-Identifier: MIT
"""Running a grid and reading what it left."""
import csv
import dataclasses
import pathlib

from .program import run_program


@dataclasses.dataclass(frozen=True)
class GridRun:
    """A run's folder. records: one dict a cell, failed ones too; numbers as float, None where a
    figure does not exist."""
    folder: pathlib.Path
    records: list

    @classmethod
    def read(cls, folder):
        folder = pathlib.Path(folder)
        with open(folder / "results.csv", newline="", encoding="utf-8") as file:
            return cls(folder, [{k: _value(v) for k, v in row.items()}
                                for row in csv.DictReader(file)])

    @property
    def leaderboard(self):
        return (self.folder / "leaderboard.md").read_text(encoding="utf-8")


def _value(text):
    if text == "":
        return None
    try:
        return float(text)
    except ValueError:
        return text


def run_grid(grid="quick", out="run", *, jobs=None, data=None, resume=False):
    """Runs a grid (a file, or a name of `tribench list grids`) and returns its GridRun."""
    arguments = ["run", grid, "--out", out, "--quiet"]
    if jobs is not None:
        arguments += ["--jobs", jobs]
    if data is not None:
        arguments += ["--data", data]
    if resume:
        arguments.append("--resume")
    run_program(arguments)
    return GridRun.read(out)
