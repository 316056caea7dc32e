#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares a run of a bench with its reference, or records one.

    build/release/bench/expression_bench --benchmark_repetitions=5 \\
        --benchmark_out=run.json --benchmark_out_format=json
    bench/compare.py run.json bench/reference/expression_bench.json
    bench/compare.py --record run.json bench/reference/expression_bench.json --machine "what it ran on"

The figure of a case is the best of its repetitions: its counter node_rows/s where it has one (more
is better), else its CPU time (less is better). Exit status: 0 no case is slower than the reference
by more than the tolerance, 1 at least one is, 2 bad input. Figures of different machines are
printed with a warning and never make the status 1.
"""
import argparse
import json
import sys

RATE = "node_rows/s"


def best_figures(run):
    """Case -> {"rate": best} or {"cpu_us": best}; only cases that ran."""
    micro = {"ns": 1e-3, "us": 1.0, "ms": 1e3, "s": 1e6}
    figures = {}
    for case in run["benchmarks"]:
        if case.get("run_type") == "aggregate" or case.get("error_occurred"):
            continue
        kept = figures.setdefault(case["run_name"], {})
        if RATE in case:
            kept["rate"] = max(kept.get("rate", 0.0), case[RATE])
        else:
            cpu = case["cpu_time"] * micro[case["time_unit"]]
            kept["cpu_us"] = min(kept.get("cpu_us", cpu), cpu)
    return figures


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        print(f"{path}: {error}", file=sys.stderr)
        sys.exit(2)


def record(run, path, machine):
    figures = {
        name: {key: float(f"{value:.4g}") for key, value in kept.items()}
        for name, kept in best_figures(run).items()
    }
    with open(path, "w", encoding="utf-8") as file:
        lines = [f"  {json.dumps(name)}: {json.dumps(kept)}" for name, kept in figures.items()]
        file.write(f'{{\n "machine": {json.dumps(machine)},\n "figures": {{\n')
        file.write(",\n".join(lines) + "\n }\n}\n")


def compare(run, reference, tolerance, machine):
    same_machine = machine is None or machine == reference["machine"]
    if not same_machine:
        print(f"reference taken on: {reference['machine']}; ratios tell little here")
    slower = 0
    now = best_figures(run)
    for name, before in reference["figures"].items():
        if name not in now:
            print(f"{'not run':>10}  {name}")
            continue
        if "rate" in before:
            ratio = now[name]["rate"] / before["rate"]
            shown = f"{now[name]['rate'] / 1e9:8.2f} G/s"
        else:
            ratio = before["cpu_us"] / now[name]["cpu_us"]
            shown = f"{now[name]['cpu_us']:8.2f} us "
        mark = "slower" if ratio < 1 - tolerance else ""
        slower += mark == "slower"
        print(f"{ratio:9.2f}x {shown}  {name} {mark}")
    return 1 if slower and same_machine else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("reference")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--machine")
    parser.add_argument("--tolerance", type=float, default=0.15)
    arguments = parser.parse_args()
    run = read(arguments.run)
    if arguments.record:
        if not arguments.machine:
            parser.error("--record wants --machine: a reference without its machine says nothing")
        record(run, arguments.reference, arguments.machine)
        return 0
    return compare(run, read(arguments.reference), arguments.tolerance, arguments.machine)


if __name__ == "__main__":
    sys.exit(main())
