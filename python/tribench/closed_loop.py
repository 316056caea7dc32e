# SPDX-License-Identifier: MIT
"""Closing the loop on a recording."""
import dataclasses
import json

from .program import run_program

CANNOT_TELL = 4  # the exit status of data that cannot tell; still an answer


@dataclasses.dataclass(frozen=True)
class Effect:
    family: str
    formula: str  # its columns as the library writes them
    p: float  # adjusted for all that was tried
    size: float  # root mean square, in the target's unit
    parameters: dict  # name: (value, low, high), 95 %
    aliases: list  # what else it could be
    provisional: bool


@dataclasses.dataclass(frozen=True)
class LoopResult:
    verdict: str  # NONE, EFFECTS, UNKNOWN or CANNOT_TELL
    effects: list  # of Effect, in the order found
    leftover: list  # inputs in which something is left
    mae_before: float  # held out, in the target's unit
    mae_after: float
    confirmed: bool
    formula: str
    json: dict  # all of loop.json


def loop(data, *options, seed=1, out=None):
    """data: a CSV file, or several in order; options: words as on the command line, such as
    "--roles", "tau=motor_torque", "--unordered"."""
    files = [data] if isinstance(data, (str, bytes)) or hasattr(data, "__fspath__") else list(data)
    arguments = ["loop", *files, *options, "--seed", seed, "--json"]
    if out is not None:
        arguments += ["--out", out]
    found = json.loads(run_program(arguments, accepted=(0, CANNOT_TELL)))
    effects = [Effect(e["family"], e["atom"], e["p_adj"], e["rms_contribution"],
                      {p["name"]: (p["value"], p["lo"], p["hi"]) for p in e["params"]},
                      [a["family"] for a in e["alias"]], e["provisional"])
               for e in found["effects"]]
    return LoopResult(found["verdict"], effects, found["leftover"].get("inputs", []),
                      found["error"]["mae_before"], found["error"]["mae_after"],
                      found["confirmed"], found["formula"], found)
