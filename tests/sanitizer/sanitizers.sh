#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every test under the sanitizers, one line each; for the night (an hour and more on two cores).
#   tests/sanitizer/sanitizers.sh [address|thread]...      both where none is named
# address: address and undefined-behaviour sanitizers over the whole suite, end-to-end and `slow`
# included. thread: what runs in threads, with the two tests that say whether its answers mean
# something. Exit status 1 where a test fails; logs: build/{asan,tsan}/{build,test}.log.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
[ $# -gt 0 ] || set -- address thread

# check NAME PRESET CTEST_ARGUMENT...
check() {
    local name=$1 build=build/$2 start=$SECONDS summary
    mkdir -p "$build"
    if ! { cmake --preset "$2" && cmake --build "$build"; } >"$build/build.log" 2>&1; then
        tail -n 40 "$build/build.log"
        echo "$name: does not build; see $build/build.log"
        return 1
    fi
    shift 2
    local status=0
    ctest --test-dir "$build" --output-on-failure -j "$(nproc)" "$@" >"$build/test.log" 2>&1 || status=1
    summary=$(grep -o '[0-9]* tests failed out of [0-9]*' "$build/test.log" || echo "no tests ran")
    echo "$name: $summary, $((SECONDS - start)) s"
    sed -n '/The following tests FAILED/,/^$/p' "$build/test.log"
    return $status
}

status=0
for sanitizer in "$@"; do
    case $sanitizer in
    address)
        export LSAN_OPTIONS=suppressions=$PWD/tests/sanitizer/foreign_leaks.txt
        check "address, undefined" asan || status=1
        ;;
    thread)
        export TSAN_OPTIONS=ignore_noninstrumented_modules=1
        check thread tsan -R 'sanitizer|pysr' || status=1
        ;;
    *)
        echo "no sanitizer '$sanitizer': address or thread"
        exit 2
        ;;
    esac
done
exit $status
