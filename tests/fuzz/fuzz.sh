#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs each fuzz target for a time and prints one line each: executions, how much of the code it aims
# at was reached, findings. Exit status 1 where there is a finding.
#   tests/fuzz/fuzz.sh SECONDS [TARGET...]        (60 for a look, 3600 for a night)
# Builds the preset `fuzz` (clang). What was found to be new is kept in build/fuzz/corpus and gone on
# from; a finding is made small and left in build/fuzz/findings: mend it, and put it into
# tests/fuzz/corpus/TARGET, where the tests of every day run it.
set -euo pipefail
root=$(dirname "$(readlink -f "$0")")/../..
root=$(cd "$root" && pwd)
build=$root/build/fuzz
seconds=${1:?usage: fuzz.sh SECONDS [TARGET...]}
shift
[ -f "$build/build.ninja" ] || (cd "$root" && cmake --preset fuzz >/dev/null)
targets=("$@")
[ $# -gt 0 ] || mapfile -t targets < <(cd "$root/tests/fuzz/targets" && basename -s .cpp -- *.cpp)
cmake --build "$build" --target "${targets[@]/#/fuzz_}" >"$build/build.log" ||
    { tail -n 40 "$build/build.log" && exit 3; }

# Inputs that the project has anyway, as further seeds.
seeds_of() {
    case $1 in
    grid) echo "$root/grids" ;;
    manifest) echo "$root/problems/measured" ;;
    effect) echo "$root/examples/effects" ;;
    suite) echo "$root/suites" ;;
    esac
}

# llvm_tool NAME: the one that belongs to the compiler in use.
llvm_tool() {
    local version
    version=$(sed -n 's/^set(CMAKE_CXX_COMPILER_VERSION "\([0-9]*\)\..*/\1/p' \
        "$build"/CMakeFiles/*/CMakeCXXCompiler.cmake | head -n 1)
    command -v "$1-$version" || command -v "$1"
}

# The share of lines reached by the corpus, in the files that the target aims at.
coverage_of() {
    local target=$1 program=$build/tests/fuzz/fuzz_$1
    shift
    LLVM_PROFILE_FILE=$build/corpus/$target.profraw "$program" -runs=0 "$@" >/dev/null 2>&1 || true
    "$(llvm_tool llvm-profdata)" merge -o "$build/corpus/$target.profdata" "$build/corpus/$target.profraw"
    "$(llvm_tool llvm-cov)" export "$program" -instr-profile="$build/corpus/$target.profdata" \
        -format=lcov -summary-only | awk -F: '
            NR == FNR { aim[++n] = $0; next }
            /^SF/ { hit = 0; for (i in aim) if (index($2, aim[i])) hit = 1 }
            /^LF/ && hit { all += $2 }
            /^LH/ && hit { reached += $2 }
            END { if (all > 0) printf "%.1f %%", 100 * reached / all }' "$build/tests/fuzz/$target.reads" -
}

status=0
for target in "${targets[@]}"; do
    mkdir -p "$build/corpus/$target" "$build/findings/$target"
    log=$build/corpus/$target.log
    folders=("$build/corpus/$target" "$root/tests/fuzz/corpus/$target")
    [ -z "$(seeds_of "$target")" ] || folders+=("$(seeds_of "$target")")
    dictionary=$root/tests/fuzz/dictionaries/$target.dict
    options=(-max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=4096
        -print_final_stats=1 -artifact_prefix="$build/findings/$target/")
    [ ! -f "$dictionary" ] || options+=(-dict="$dictionary")
    found=0
    LLVM_PROFILE_FILE=/dev/null "$build/tests/fuzz/fuzz_$target" "${options[@]}" "${folders[@]}" \
        >"$log" 2>&1 || found=1
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    [ -n "$executions" ] || executions=$(grep -o '^#[0-9]*' "$log" | tail -n 1 | tr -d '#')
    printf '%-12s %12s executions, %6s of the lines aimed at, %d finding(s)\n' "$target" \
        "${executions:-0}" "$(coverage_of "$target" "${folders[@]}")" "$found"
    if [ $found -eq 1 ]; then
        status=1
        grep -m 3 -E "ERROR:|what\(\)|runtime error|SUMMARY" "$log" | cut -c1-300 | sed 's/^/    /'
        finding=$(sed -n 's/.*Test unit written to //p' "$log" | tail -n 1)
        [ -z "$finding" ] || {
            "$build/tests/fuzz/fuzz_$target" -minimize_crash=1 -runs=20000 -timeout=20 \
                -exact_artifact_path="$finding.small" "$finding" >/dev/null 2>&1 || true
            echo "    $finding"
        }
    fi
done
exit $status
