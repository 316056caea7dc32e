# The package as its users meet it: installed, found, linked, run.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${SCRATCH_DIR}")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${SCRATCH_DIR}/prefix")
run(${CMAKE_COMMAND} -S "${CONSUMER_DIR}" -B "${SCRATCH_DIR}/build" -G Ninja
  "-DCMAKE_PREFIX_PATH=${SCRATCH_DIR}/prefix" "-DCMAKE_CXX_COMPILER=${CXX}"
  "-DCMAKE_BUILD_TYPE=${CONFIG}")
run(${CMAKE_COMMAND} --build "${SCRATCH_DIR}/build")

# A program of one's own has the whole command line, and its own method in it.
run("${SCRATCH_DIR}/build/median" list methods)
if(NOT output MATCHES "median")
  message(FATAL_ERROR "the example's method is not listed:\n${output}")
endif()
file(WRITE "${SCRATCH_DIR}/grid.toml"
  "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"median\"]\n")
run("${SCRATCH_DIR}/build/median" run "${SCRATCH_DIR}/grid.toml" --out "${SCRATCH_DIR}/run"
  --jobs 1 --quiet)
file(READ "${SCRATCH_DIR}/run/results.csv" results)
if(NOT results MATCHES "median,-,1,ok")
  message(FATAL_ERROR "the example's method did not run:\n${results}")
endif()

# The installed program stands by itself.
run("${SCRATCH_DIR}/prefix/bin/tribench" --version)
run("${SCRATCH_DIR}/prefix/bin/tribench" run --dry-run)
