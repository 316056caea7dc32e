#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Everything that looks for what nobody thought of, in one night: every fuzz target, then every test
# under the sanitizers, a line each. Exit status 1 where one of them finds something.
#   tests/robustness.sh [SECONDS]        of each fuzz target (600: four hours)
set -uo pipefail
tests=$(dirname "$(readlink -f "$0")")
status=0
"$tests/fuzz/fuzz.sh" "${1:-600}" || status=1
"$tests/sanitizer/sanitizers.sh" || status=1
exit $status
