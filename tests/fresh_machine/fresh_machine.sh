#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A machine that has nothing: both commands of the README, as they stand, in a bare Debian root.
#   tests/fresh_machine/fresh_machine.sh [--keep] [--cache CCACHE_FOLDER]
# The root is made of the distribution's packages (minbase: not even git), gets a clone of the
# commit that is checked out here, in a folder with a space in its path, and nothing else of this
# machine. Then, as the root's user: `./tribench run` leaves a leaderboard, `./tribench test` passes.
# After that, what needs a built checkout: no network, another user, a read-only disk.
# Needs root, a network (packages this machine has in apt's archive are taken from there) and 8 GB
# below $TMPDIR (/var/tmp). Without them it fails; it is never skipped. Mounts live in namespaces of
# their own and end with them, also after Ctrl-C. Logs: build/fresh_machine/.
#
# --cache lets the root's compiler ask a ccache that this machine's build filled (CI has no time for
# two builds). It cannot hide a missing package: an object is taken only where every header that it
# was made of lies in the root with the same content, else it is compiled there; configuring and
# linking are never cached. ccache comes with libraries of its own, in a folder nothing else looks at.
set -euo pipefail
export GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0='*'
checkout=$(dirname "$(readlink -f "$0")")/../..
checkout=$(git -C "$checkout" rev-parse --show-toplevel)
logs=$checkout/build/fresh_machine
keep=no
cache=
while [ $# -gt 0 ]; do
    case $1 in
    --keep) keep=yes ;;
    --cache)
        cache=$(realpath "$2")
        shift
        ;;
    *)
        sed -n '3,/^set/s/^# \{0,1\}//p' "$0"
        exit 2
        ;;
    esac
    shift
done
home='/srv/my projects' # of the clone, in the root

say() { printf 'fresh_machine: %s\n' "$*"; }
fail() {
    say "FAILED: $*"
    exit 1
}

[ "$(id -u)" -eq 0 ] || fail "making a root needs root"
command -v mmdebstrap >/dev/null || {
    apt-get -qq update
    DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends mmdebstrap >/dev/null
}
mkdir -p "$logs"
work=$(mktemp -d "${TMPDIR:-/var/tmp}/tribench-fresh.XXXXXX")
root=$work/root
clean_up() {
    if [ "$keep" = yes ]; then say "kept: $root"; else rm -rf --one-file-system "$work"; fi
}
trap clean_up EXIT
trap 'exit 130' INT TERM

environment=(HOME=/root USER=root TERM=dumb ${http_proxy:+"http_proxy=$http_proxy"}
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
[ -z "$cache" ] || environment+=(CMAKE_CXX_COMPILER_LAUNCHER=/opt/ccache/ccache
    CCACHE_DIR=/opt/ccache/cache "CCACHE_BASEDIR=$home/tribench" CCACHE_COMPILERCHECK=content
    CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=locale)

# in_root NETWORK COMMAND...: in the root, with namespaces of its own; NETWORK is `online` or
# `offline`. The environment is the root's, not ours.
in_root() {
    local namespaces=(--mount --pid --fork --kill-child)
    [ "$1" = online ] || namespaces+=(--net)
    shift
    # shellcheck disable=SC2016
    unshare "${namespaces[@]}" bash -c '
        set -e
        root=$1
        cache=$2
        settings=()
        shift 2
        while [ "$1" != -- ]; do
            settings+=("$1")
            shift
        done
        shift
        mount -t proc proc "$root/proc"
        mount --rbind /sys "$root/sys"
        mount --rbind /dev "$root/dev"
        if [ -n "$cache" ]; then mount --bind "$cache" "$root/opt/ccache/cache"; fi
        chroot "$root" env -i "${settings[@]}" "$@" || exit' \
        in_root "$root" "$cache" "${environment[@]}" -- "$@" </dev/null
}

# Seconds of processor that everything run so far has used.
cpu_seconds() { awk '{print int(($16 + $17) / 100)}' "/proc/$$/stat"; }

# stage NAME COMMAND...: runs it into a log of that name, says how long it took and how it ended.
stage() {
    local name=$1 start=$SECONDS cpu
    cpu=$(cpu_seconds)
    shift
    "$@" >"$logs/$name.log" 2>&1 || {
        # The assertions first: a test's own words stand far above the log's end.
        grep -A 9 ': Failure$' "$logs/$name.log" | head -n 60 || true
        tail -n 40 "$logs/$name.log"
        fail "$name, after $((SECONDS - start)) s; the whole log is $logs/$name.log"
    }
    say "$name: $((SECONDS - start)) s, $(($(cpu_seconds) - cpu)) s of processor"
    tail -n "${lines:-3}" "$logs/$name.log" | sed 's/^/    /'
}

# The distribution as this machine knows it: same mirror, nobody else's packages.
sources() {
    # shellcheck disable=SC2016
    apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' \
        'Identifier: Packages' 'Origin: Debian' | sort -u
}

make_root() {
    [ -n "$(sources)" ] || apt-get -qq update
    sources >"$work/sources.list"
    grep -q ' bookworm ' "$work/sources.list" || fail "apt knows no Debian 12 (bookworm) here"
    # Nobody needs the root after a power cut: dpkg does not wait for the disk.
    mmdebstrap --variant=minbase --aptopt='Acquire::Check-Valid-Until "false"' \
        --aptopt='Acquire::Retries "3"' --dpkgopt=force-unsafe-io \
        bookworm "$root" - <"$work/sources.list"
    # Packages that this machine has fetched before need no second download; apt checks their hashes.
    ln /var/cache/apt/archives/*.deb "$root/var/cache/apt/archives/" 2>/dev/null || true
    cp /etc/resolv.conf "$root/etc/resolv.conf"
}

# This machine's ccache with the libraries it needs, started by their own loader.
bring_ccache() {
    local folder=$root/opt/ccache library
    mkdir -p "$folder/libraries" "$folder/cache"
    cp "$(command -v ccache)" "$folder/program"
    ldd "$(command -v ccache)" | grep -o '/[^ ]*' | while read -r library; do
        cp -L "$library" "$folder/libraries/"
    done
    printf '%s\n' '#!/bin/sh' 'exec /opt/ccache/libraries/ld-linux-*.so.* --argv0 ccache \' \
        '    --library-path /opt/ccache/libraries /opt/ccache/program "$@"' >"$folder/ccache"
    chmod +x "$folder/ccache"
}

clone() {
    local commit
    commit=$(git -C "$checkout" rev-parse HEAD)
    [ -z "$(git -C "$checkout" status --porcelain)" ] || say "note: what is not committed is not tested"
    mkdir -p "$root$home"
    git clone --quiet --no-checkout "$checkout" "$root$home/tribench"
    git -C "$root$home/tribench" checkout --quiet --detach "$commit"
    git -C "$root$home/tribench" log -1 --oneline
}

stage base make_root
stage clone clone
[ -z "$cache" ] || stage ccache bring_ccache

# The README's first command. What only tests need must not have come with it.
lines=12 stage run in_root online bash -ec "cd '$home/tribench' && ./tribench run"
leaderboard=$(find "$root$home/tribench" -path '*/run-*/leaderboard.md' -size +1k)
[ -n "$leaderboard" ] || fail "./tribench run left no leaderboard"
for file in /usr/include/mpfr.h /usr/include/gtest /usr/bin/chromium; do
    [ ! -e "$root$file" ] || fail "./tribench run installed what only tests need: $file"
done
compiled=$(stat -c %Y "$root$home/tribench/build/release/bin/tribench")

# The README's second command.
lines=8 stage test in_root online bash -ec "cd '$home/tribench' && ./tribench test"
[ "$compiled" = "$(stat -c %Y "$root$home/tribench/build/release/bin/tribench")" ] ||
    fail "./tribench test built the program a second time"

# Once packages are in apt's archive, no network is needed.
in_root online apt-get -qq purge -y libfmt-dev >/dev/null
lines=1 stage offline in_root offline bash -ec "cd '$home/tribench' && ./tribench run --dry-run"

# Another user in another folder, who may not write to the checkout; then nobody may.
cat >"$root/tmp/small.toml" <<'END'
[grid]
problems = ["A/j2/no_load"]
methods = ["linear"]
END
lines=1 stage other_user in_root offline setpriv --reuid 12345 --regid 12345 --clear-groups \
    env HOME=/tmp bash -ec "cd /tmp && '$home/tribench/tribench' run small.toml --out 'other user' &&
        test -s 'other user/leaderboard.md'"
# shellcheck disable=SC2016
lines=1 stage read_only in_root offline bash -ec 'mount --bind "$1" "$1"
    mount -o remount,bind,ro "$1"
    cd / && "$1/tribench" run /tmp/small.toml --out "/tmp/read only"
    test -s "/tmp/read only/leaderboard.md"' read_only "$home/tribench"
say "passed, $SECONDS s"
