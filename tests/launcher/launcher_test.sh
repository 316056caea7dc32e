#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The launcher against a project that builds in a second: which packages it asks for, what it
# configures and builds, and what it does in checkouts that others own, that moved, that are
# read-only. Packages and their tools are made up; CMake, ninja and ctest are real.
#   launcher_test.sh LAUNCHER SCRATCH_FOLDER
set -euo pipefail
launcher=$1
scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch/tools"
failures=0

check() { # check WHAT COMMAND...
    local what=$1
    shift
    if "$@"; then echo "ok    $what"; else
        echo "WRONG $what"
        sed 's/^/      | /' "$scratch/output"
        failures=$((failures + 1))
    fi
}
not() { ! "$@"; }
says() { grep -q -- "$1" "$scratch/output"; }
asked_for() { grep -q -- " $1\( \|$\)" "$scratch/apt.log"; }

# A folder of tools, so that neither this machine's packages nor its sudo matter.
for tool in bash env cmake ctest ninja git sed tail cat find id flock rm mkdir nproc readlink \
    dirname uname sleep; do
    ln -s "$(command -v $tool)" "$scratch/tools/$tool"
done
cat >"$scratch/tools/dpkg-query" <<END
#!/usr/bin/env bash
cat "$scratch/installed"
END
cat >"$scratch/tools/apt-get" <<END
#!/usr/bin/env bash
echo "\$*" >>"$scratch/apt.log"
case "\$*" in
*update*) [ ! -e "$scratch/offline" ] ;;
*install*) for word in "\$@"; do echo "installed \$word" >>"$scratch/installed"; done ;;
esac
END
chmod +x "$scratch/tools/"{dpkg-query,apt-get}

make_checkout() { # a project with the two targets that the launcher knows
    mkdir -p "$1"
    cp "$launcher" "$1/tribench"
    cat >"$1/CMakePresets.json" <<'END'
{"version": 6,
 "configurePresets": [{"name": "release", "generator": "Ninja",
                       "binaryDir": "${sourceDir}/build/release"}],
 "testPresets": [{"name": "release", "configurePreset": "release",
                  "execution": {"noTestsAction": "error"}}]}
END
    cat >"$1/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(small LANGUAGES NONE)
option(TRIBENCH_BUILD_TESTS "" ON)
option(TRIBENCH_BUILD_BENCH "" ON)
file(APPEND ${CMAKE_SOURCE_DIR}/configured "tests ${TRIBENCH_BUILD_TESTS}\n")
add_custom_command(OUTPUT bin/tribench DEPENDS problems/program.sh
  COMMAND ${CMAKE_COMMAND} -E echo compiled >> ${CMAKE_SOURCE_DIR}/compiled
  COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_SOURCE_DIR}/problems/program.sh bin/tribench VERBATIM)
add_custom_target(tribench_program ALL DEPENDS bin/tribench)
if(TRIBENCH_BUILD_TESTS)
  enable_testing()
  add_test(NAME small COMMAND ${CMAKE_COMMAND} -E echo small)
endif()
END
    mkdir "$1/problems"
    printf '#!/usr/bin/env bash\necho "program in $PWD: $*"\n' >"$1/problems/program.sh"
    chmod +x "$1/problems/program.sh"
}
run() { PATH=$scratch/tools "$@" >"$scratch/output" 2>&1; }
lines() { [ "$(wc -l <"$1")" -eq "$2" ]; }
fresh_machine() {
    : >"$scratch/installed"
    : >"$scratch/apt.log"
    rm -f "$scratch/offline"
}

first="$scratch/a folder/tribench"
make_checkout "$first"

echo "# a machine that has nothing: run, then test"
fresh_machine
cd "$scratch"
check "runs" run "$first/tribench" run --out x
check "hands arguments over, in the caller's folder" says "program in $scratch: run --out x"
check "asks for what the program needs" asked_for libnlopt-dev
check "does not ask for what tests need" not asked_for libmpfr-dev
check "nor for the benchmarks' library" not asked_for libbenchmark-dev
check "without recommendations" grep -q -- --no-install-recommends "$scratch/apt.log"
check "configures without tests" grep -qx "tests OFF" "$first/configured"
check "test passes" run "$first/tribench" test
check "test asks for what it adds" asked_for libmpfr-dev
check "test configures with tests" grep -qx "tests ON" "$first/configured"
check "runs the tests" says "100% tests passed"
check "compiles once" lines "$first/compiled" 1
check "run after test" run "$first/tribench" run
check "does not configure again" lines "$first/configured" 2
check "hands arguments on to ctest" run "$first/tribench" test -N
check "which lists" says "Total Tests: 1"

echo "# the tests' packages go"
sed -i '/libmpfr-dev/d' "$scratch/installed"
check "run goes on" run "$first/tribench" run
check "configured without tests" [ "$(tail -n 1 "$first/configured")" = "tests OFF" ]
check "and does not install them" not grep -q "libmpfr-dev$" <(tail -n 1 "$scratch/apt.log")
check "compiles once still" lines "$first/compiled" 1

echo "# the reverse: test first"
second=$scratch/second
make_checkout "$second"
fresh_machine
check "test" run "$second/tribench" test
check "run" run "$second/tribench" run
check "configured once" lines "$second/configured" 1
check "compiled once" lines "$second/compiled" 1

echo "# no network"
fresh_machine
touch "$scratch/offline"
check "goes on with cached packages" run "$second/tribench" run
check "and says so" says "could not be refreshed"

echo "# two at a time, and the sources change"
sleep 1.1 # a later time stamp than the program's
echo "# changed" >>"$second/problems/program.sh"
PATH=$scratch/tools "$second/tribench" a >"$scratch/a" 2>&1 &
other=$!
check "both run" run "$second/tribench" b
wait "$other" || check "the other too" false
check "compiled once more" lines "$second/compiled" 2

echo "# through a link, from elsewhere"
ln -s "$first/tribench" "$scratch/link"
cd /
check "runs" run "$scratch/link" list
check "in the caller's folder" says "program in /: list"

echo "# moved and copied"
cp -r "$second" "$scratch/third"
printf '#!/usr/bin/env bash\necho third\n' >"$scratch/third/problems/program.sh"
check "a copy builds its own sources" run "$scratch/third/tribench" run
check "says so" says "moved or copied"
check "runs its own program" says "^third$"

echo "# an interrupted or failed configure is made up for"
echo 'message(FATAL_ERROR "no such library")' >>"$scratch/third/CMakeLists.txt"
check "fails" not run "$scratch/third/tribench" test
sed -i '$d' "$scratch/third/CMakeLists.txt"
check "works again" run "$scratch/third/tribench" test

echo "# somebody else's checkout: another user, no sudo"
fresh_machine
if [ "$(id -u)" -eq 0 ]; then
    other_user=(setpriv --reuid 12345 --regid 12345 --clear-groups)
    chmod -R go+rX,go-w "$scratch"
else
    other_user=(env)
    chmod -R a-w "$second"
fi
as_other() { "${other_user[@]}" env PATH="$scratch/tools" "$@" >"$scratch/output" 2>&1; }
# The scratch folder may lie where other users cannot look: then a second view of it.
reach() { "${other_user[@]}" test -r "$second/tribench"; }
if reach; then
    cd /tmp
    check "runs as built" as_other "$second/tribench" list
    check "in the caller's folder" says "program in /tmp: list"
    check "without a word" lines "$scratch/output" 1
    touch "$second/problems/newer" 2>/dev/null || true
    [ ! -e "$second/problems/newer" ] || {
        check "stale: runs" as_other "$second/tribench" list
        check "and says so" says "problems/newer is newer"
    }
    status=0
    as_other "$second/tribench" test || status=$?
    check "tests are refused" [ "$status" -eq 3 ]
    check "with the mend" says "clone"
    fourth=$scratch/fourth
    make_checkout "$fourth"
    if [ "$(id -u)" -eq 0 ]; then chown -R 12345 "$fourth"; fi
    status=0
    as_other "$fourth/tribench" run || status=$?
    check "packages without sudo are refused" [ "$status" -eq 3 ]
    check "naming them" says "are missing: .*libnlopt-dev.* as root"
else
    echo "skipped: $scratch cannot be read by another user"
fi
chmod -R u+w "$scratch"

if [ "$(id -u)" -eq 0 ] && unshare --mount true 2>/dev/null; then
    echo "# a read-only disk"
    read_only() {
        unshare --mount bash -c 'mount --bind "$1" "$1" && mount -o remount,bind,ro "$1" &&
            PATH=$2 "$1/tribench" list' bash "$second" "$scratch/tools" >"$scratch/output" 2>&1
    }
    check "root runs it as built" read_only
fi

echo "$failures wrong"
[ "$failures" -eq 0 ]
