#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One night: run the grid, compare with the last good run, keep the reports.
#   nightly.sh ARCHIVE [GRID]
# ARCHIVE holds one folder a night and `good`, a link to the last run without a regression.
# Exit status: 0 as good or better, 1 a regression, else what failed.
set -euo pipefail
archive=$(realpath -m "$1")
grid=${2:-nightly}
tribench=${TRIBENCH:-tribench}
night=$archive/$(date -u +%Y-%m-%d)
mkdir -p "$archive"

# A night that was cut short goes on where it ended.
"$tribench" run "$grid" --out "$night" --resume --quiet

if [ ! -e "$archive/good" ]; then
    ln -sfn "$(basename "$night")" "$archive/good"
    echo "first run kept as the base: $night"
    exit 0
fi

# What changed stands on the first screen of the leaderboard and of the page.
"$tribench" report "$night" --base "$archive/good/" >"$night/report.txt"

status=0
"$tribench" compare "$archive/good/" "$night" >"$night/comparison.md" || status=$?
cat "$night/comparison.md"
if [ "$status" -eq 0 ]; then
    ln -sfn "$(basename "$night")" "$archive/good"
fi
exit "$status"
