#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What `cmake --install` leaves besides the program and its libraries: licence, documents, man page,
# completion in three shells, the nightly units with the paths they have there.
#   installed_files.sh BUILD_FOLDER SCRATCH_FOLDER
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
scratch=$2
prefix="$scratch/a prefix"
rm -rf "$scratch"
mkdir -p "$scratch"
cmake --install "$1" --prefix "$prefix" >"$scratch/install.log"
export PATH="$prefix/bin:$PATH"
export HOME=$scratch LC_ALL=C.UTF-8
failures=0

wrong() {
    echo "WRONG $*"
    failures=$((failures + 1))
}
check() { # check WHAT COMMAND...
    local what=$1
    shift
    if "$@"; then echo "ok    $what"; else wrong "$what"; fi
}
expect() { # expect WHAT WORD COMMAND...: the command prints that word on a line of its own
    local what=$1 word=$2 found
    shift 2
    found=$("$@" 2>&1) || true
    if grep -qx -- "$word" <<<"$found"; then echo "ok    $what"; else
        wrong "$what: no '$word' in: $(tr '\n' ' ' <<<"$found")"
    fi
}

echo "# documents"
for file in LICENSE README.md CHANGELOG.md CONTRIBUTING.md docs/closed_loop.md docs/install.md docs/peers.md; do
    check "$file" test -s "$prefix/share/doc/tribench/$file"
done
cd "$prefix/share/doc/tribench"
# shellcheck disable=SC2013
for link in $(grep -oh '](docs/[^)#]*' README.md | sed 's/](//' | sort -u); do
    check "README's $link" test -e "$link"
done
cd /

echo "# man page"
page=$prefix/share/man/man1/tribench.1
check "is there" test -s "$page"
warnings=$(groff -man -ww -z "$page" 2>&1) || true
[ -z "$warnings" ] || wrong "groff: $warnings"
text=$(groff -man -Tutf8 -P-cbou "$page")
for command in run fit loop check "study loop" "data list"; do
    check "describes tribench $command" grep -q "^ *tribench $command" <<<"$text"
done
# Every option that --help prints stands in the page, and nothing of what is hidden.
declare -A told=()
while read -r option; do told[$option]=1; done < <(grep -oE -- '--[a-z-]+' <<<"$text" | sort -u)
for command in $(tribench --help | sed -n '/^Subcommands/,/^$/s/^  \([a-z-]*\) .*/\1/p'); do
    for option in $(tribench "$command" --help | grep -o -- '^  *--[a-z-]*' | tr -d ' '); do
        [ -n "${told[$option]-}" ] || wrong "the page has no $option of $command"
    done
done
if grep -q "tribench describe" <<<"$text"; then wrong "the page shows what is hidden"; fi

echo "# completion in bash"
script=$prefix/share/bash-completion/completions/tribench
check "parses" bash -n "$script"
complete_in_bash() { # the words so far, the last one to be completed
    bash -c 'source "$1"; shift
        COMP_WORDS=(tribench "$@"); COMP_CWORD=$#
        _tribench_complete tribench; printf "%s\n" "${COMPREPLY[@]}"' _ "$script" "$@"
}
expect "a subcommand" loop complete_in_bash lo
expect "a nested subcommand" recovery complete_in_bash study re
expect "an option" --evaluations complete_in_bash fit x.csv --ev
expect "a method's name" pysr complete_in_bash fit x.csv --method py
expect "a grid's name" paper complete_in_bash run pa
expect "a problem's name" A/j2/load complete_in_bash generate A/j2/l
expect "files where no name is due" "" complete_in_bash fit --test ""

echo "# completion in zsh"
script=$prefix/share/zsh/site-functions/_tribench
check "parses" zsh -n "$script"
in_zsh=$here/complete_in_zsh.zsh
folder=$(dirname "$script")
check "a subcommand" "$in_zsh" "$folder" "tribench lo" "tribench loop"
check "an option" "$in_zsh" "$folder" "tribench fit x.csv --ev" "x.csv --evaluations"
check "a method's name" "$in_zsh" "$folder" "tribench fit x.csv --method pys" "--method pysr"

echo "# completion in fish"
script=$prefix/share/fish/vendor_completions.d/tribench.fish
check "parses" fish --no-execute "$script"
complete_in_fish() {
    # shellcheck disable=SC2016
    fish --no-config -c 'source $argv[1]; complete -C $argv[2]' "$script" "$*" | cut -f 1
}
expect "a subcommand" loop complete_in_fish "tribench lo"
expect "a nested subcommand" recovery complete_in_fish "tribench study re"
expect "an option" --evaluations complete_in_fish "tribench fit x.csv --ev"
expect "a method's name" pysr complete_in_fish "tribench fit x.csv --method py"
expect "a grid's name" paper complete_in_fish "tribench run pa"

echo "# the nightly units"
unit=$prefix/lib/systemd/system/tribench-nightly.service
check "the program they call" grep -qF "ExecStart=\"$prefix/bin/tribench\" nightly" "$unit"
check "systemd takes them" systemd-analyze verify --man=no "$unit" "${unit%.service}.timer"
cat >"$scratch/night.toml" <<'END'
[grid]
problems = ["A/j2/no_load"]
methods = ["linear"]
END
night() {
    "$prefix/bin/tribench" nightly --store "$scratch/nights" --grid "$scratch/night.toml" \
        --least-free 0 >"$scratch/night.log" 2>&1 || {
        cat "$scratch/night.log"
        return 1
    }
}
check "the first night" night
check "the second is compared with it" night
check "says what it found" grep -q "identical" "$scratch/night.log"

echo "$failures wrong"
[ "$failures" -eq 0 ]
