# SPDX-License-Identifier: MIT
"""Finding and running the program."""
import os
import shutil
import subprocess


class TribenchError(RuntimeError):
    """The program refused or failed: its message, and its exit status in `status`."""

    def __init__(self, message, status):
        super().__init__(message)
        self.status = status


def find_program():
    """The path of the program; FileNotFoundError says where it was looked for."""
    named = os.environ.get("TRIBENCH_PROGRAM")
    if named:
        return named
    found = shutil.which("tribench")
    if found is None:
        raise FileNotFoundError("no program tribench: name it in $TRIBENCH_PROGRAM or put it in PATH")
    return found


def run_program(arguments, accepted=(0,)):
    """Standard output of `tribench ARGUMENTS`; TribenchError for another exit status."""
    ended = subprocess.run([find_program(), *map(str, arguments)], capture_output=True, text=True,
                           check=False)
    if ended.returncode not in accepted:
        raise TribenchError(ended.stderr.strip() or f"status {ended.returncode}", ended.returncode)
    return ended.stdout
