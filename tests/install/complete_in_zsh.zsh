#!/usr/bin/env zsh
# SPDX-License-Identifier: MIT
# Whether an interactive zsh in a pseudo-terminal completes a line as expected: types, presses tab,
# looks at the screen for ten seconds at most.
#   complete_in_zsh.zsh FOLDER_OF_COMPLETIONS LINE EXPECTED_WORD
export TERM=dumb
zmodload zsh/zpty
zpty -b shell zsh -f -i
zpty -w shell "PS1=; fpath=(${(q)1} \$fpath); autoload -Uz compinit; compinit -u -D; print re''ady"

# wait_for TEXT: reads the screen until TEXT is on it.
wait_for() {
    local chunk
    repeat 100; do
        while zpty -rt shell chunk; do screen+=$chunk; done
        [[ $screen == *$1* ]] && return 0
        sleep 0.1
    done
    print -r -- "no '$1' on the screen: ${(V)screen}"
    return 1
}

screen=
wait_for ready || exit 1
screen=
zpty -w -n shell "$2"$'\t'
wait_for "$3"
