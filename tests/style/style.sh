#!/usr/bin/env bash
# usage: tests/style/style.sh [SECONDS [BASE]]
# Formatting and clang-tidy on the C++ files that changed since BASE (else in the day before the last
# commit), the latest first. Formatting looks at all of them, clang-tidy at the sources of the
# program; what it has not begun within SECONDS (120) is counted and left. Exit status 1 where the
# formatting is another, 123 where clang-tidy finds something. Needs clang-format-14, clang-tidy-14
# and, for its generated headers, a built build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=${1:-120}
if ! git rev-parse --quiet --verify HEAD >/dev/null 2>&1; then
    echo "style: no history here, so nothing that has changed"
    exit 0
fi
range=(${2:+"$2..HEAD"})
[ ${#range[@]} -gt 0 ] || range=("--since=@$(($(git log -1 --format=%ct) - 86400))")

mapfile -t files < <(git log "${range[@]}" --format= --name-only --diff-filter=AMR -- '*.cpp' '*.hpp' |
    awk '!seen[$0]++' | while read -r file; do [ ! -f "$file" ] || echo "$file"; done)
if [ ${#files[@]} -eq 0 ]; then
    echo "style: no C++ file has changed"
    exit 0
fi
clang-format-14 --dry-run -Werror "${files[@]}"

# The preset `dev` compiles every file by itself, which is what clang-tidy reads.
[ -f build/dev/compile_commands.json ] || cmake --preset dev >/dev/null
# A header is seen with the sources that include it; what the compiler is not called for has no flags.
left=$(mktemp)
trap 'rm -f "$left"' EXIT
mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep -vE '^(tests|bench|examples)/' |
    grep -Fxf <(sed -n "s|^ *\"file\": \"$PWD/\(.*\)\".*|\1|p" build/dev/compile_commands.json))
check() { # DEADLINE LEFT FILE
    if [ "$(date +%s)" -ge "$1" ]; then
        echo "$3" >>"$2"
    else
        clang-tidy-14 -p build/dev --quiet "$3" 2> >(grep -v 'warnings\? generated' >&2)
    fi
}
export -f check
[ ${#sources[@]} -eq 0 ] || printf '%s\0' "${sources[@]}" |
    xargs -0 -r -n 1 -P "$(nproc)" bash -c 'check "$@"' - "$(($(date +%s) + seconds))" "$left"
echo "style: ${#files[@]} files formatted, $((${#sources[@]} - $(wc -l <"$left"))) of" \
    "${#sources[@]} sources read by clang-tidy in $SECONDS s, no findings"
