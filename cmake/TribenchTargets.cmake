# What every target shares: language level, warnings, floating-point contract, linker, sanitizers.

include(CheckLinkerFlag)

add_library(tribench_options INTERFACE)
add_library(tribench::options ALIAS tribench_options)
set_target_properties(tribench_options PROPERTIES EXPORT_NAME options)
target_compile_features(tribench_options INTERFACE cxx_std_20)
# -ffp-contract=off: a fused multiply-add where the compiler likes it would make results depend on
# the instruction set; where we want one we write it.
target_compile_options(tribench_options INTERFACE -ffp-contract=off)
# Eigen would start threads of its own inside a cell that has been given one.
target_compile_definitions(tribench_options INTERFACE EIGEN_DONT_PARALLELIZE)

# Files compiled together shadow one another's names, and GCC 12 guesses wrongly about what it inlines
# of the standard library there; where each is compiled by itself (`dev`) it is asked about both.
add_library(tribench_warnings INTERFACE)
target_compile_options(tribench_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
  $<IF:$<BOOL:${CMAKE_UNITY_BUILD}>,$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-restrict>,-Wshadow>
  $<$<BOOL:${TRIBENCH_WARNINGS_AS_ERRORS}>:-Werror>)

# GNU gold links the program and each of a hundred tests two and a half times as fast as the default
# of binutils, with which Debian ships it; where it is missing, the default links. Debugging and
# sanitizers keep the compiler's own choice.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  check_linker_flag(CXX -fuse-ld=gold TRIBENCH_HAVE_GOLD)
  if(TRIBENCH_HAVE_GOLD)
    add_link_options(-fuse-ld=gold)
  endif()
endif()

if(TRIBENCH_SANITIZE)
  add_compile_options(-fsanitize=${TRIBENCH_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${TRIBENCH_SANITIZE})
  # What lies inside an allocation (a vector's spare room) or has no address yet (an empty one).
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  # For what a sanitizer's own memory or time would spoil; only GCC says by itself which is in use.
  add_compile_definitions(TRIBENCH_SANITIZED)
  if(TRIBENCH_SANITIZE MATCHES "undefined")
    # A finding ends the program: one that is only printed lets its test pass.
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()
if(TRIBENCH_FUZZ)  # and the coverage that says which lines a target reached
  add_compile_options(-fsanitize=fuzzer-no-link -fprofile-instr-generate -fcoverage-mapping)
  add_link_options(-fprofile-instr-generate)
endif()
if(TRIBENCH_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

# tribench_room(NAME [COLD] [BATCH n] SOURCES ... LINKS ... PRIVATE_LINKS ...): a static library for one
# room, exported as tribench::NAME. COLD rooms read, write and wait: they are compiled with -O1, which
# takes a third off the build of a fresh clone and changes no result (no flag here reorders sums).
# The preset `release` compiles a room's files together (CMAKE_UNITY_BUILD), eight at a time or BATCH:
# what all of them include is read once, for half of the time. More gain where a file is little beside
# what it includes, and lose where one long unit is waited for at the end. `dev` compiles each file by
# itself: a forgotten include fails.
function(tribench_room name)
  cmake_parse_arguments(ROOM "COLD" "BATCH" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  if(NOT ROOM_BATCH)
    set(ROOM_BATCH 8)
  endif()
  add_library(tribench_${name} STATIC ${ROOM_SOURCES})
  add_library(tribench::${name} ALIAS tribench_${name})
  set_target_properties(tribench_${name} PROPERTIES
    EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF
    UNITY_BUILD_BATCH_SIZE ${ROOM_BATCH})
  target_include_directories(tribench_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tribench>)
  target_link_libraries(tribench_${name} PUBLIC tribench::options ${ROOM_LINKS}
                        PRIVATE $<BUILD_INTERFACE:tribench_warnings> ${ROOM_PRIVATE_LINKS})
  if(ROOM_COLD)
    target_compile_options(tribench_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  set_property(GLOBAL APPEND PROPERTY TRIBENCH_ROOMS tribench_${name})
endfunction()

# tribench_test(NAME SOURCES ... LINKS ... LABELS ... TIMEOUT s): one GoogleTest program, one ctest. Tests
# that run the program link tribench_test_runs. Twelve of its files are compiled at a time.
function(tribench_test name)
  cmake_parse_arguments(TEST "" "TIMEOUT" "SOURCES;LINKS;LABELS" ${ARGN})
  add_executable(${name} ${TEST_SOURCES})
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF UNITY_BUILD_BATCH_SIZE 12)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE
    ${TEST_LINKS} tribench_test_support GTest::gmock GTest::gtest_main)
  if("tribench_test_runs" IN_LIST TEST_LINKS)  # the others are built without the program
    add_dependencies(${name} tribench_program)
  endif()
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 300) # a busy machine is several times as slow
  endif()
  # Nothing optimised, or every access checked: up to ten times as slow.
  if(CMAKE_BUILD_TYPE STREQUAL "Debug" OR TRIBENCH_SANITIZE)
    math(EXPR TEST_TIMEOUT "10 * ${TEST_TIMEOUT}")
  endif()
  add_test(NAME ${name} COMMAND ${name})
  # Freed memory stays, as with the program (foundation/freed_memory). Tests share the processors:
  # a thread that waits for others leaves its own to them.
  set_tests_properties(${name} PROPERTIES TIMEOUT ${TEST_TIMEOUT} LABELS "${TEST_LABELS}"
    ENVIRONMENT "MALLOC_MMAP_THRESHOLD_=1073741824;MALLOC_TRIM_THRESHOLD_=2147483647"
    ENVIRONMENT_MODIFICATION "OMP_WAIT_POLICY=set:passive")
  if("tribench_test_runs" IN_LIST TEST_LINKS)  # take longest: begun first, none is waited for at the end
    set_tests_properties(${name} PROPERTIES COST 1)
  endif()
endfunction()

# tribench_bench(NAME SOURCES ... LINKS ...): one Google Benchmark program. The functions that register
# a case and that begin and end its loop are wrapped by bench/measured_loop.cpp, so that no bench needs
# to mark what is counted.
function(tribench_bench name)
  cmake_parse_arguments(BENCH "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${BENCH_SOURCES} ${PROJECT_SOURCE_DIR}/bench/measured_loop.cpp)
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE
    ${BENCH_LINKS} tribench::foundation benchmark::benchmark benchmark::benchmark_main)
  target_link_options(${name} PRIVATE
    -Wl,--wrap=_ZN9benchmark8internal25RegisterBenchmarkInternalEPNS0_9BenchmarkE
    -Wl,--wrap=_ZN9benchmark5State16StartKeepRunningEv
    -Wl,--wrap=_ZN9benchmark5State17FinishKeepRunningEv)
endfunction()
