# Run at every build: writes which commit is being built, touching the file only when it changes.
# Arguments: -DSOURCE_DIR= -DTEMPLATE= -DOUTPUT= and what the template names.
find_package(Git QUIET)
set(TRIBENCH_COMMIT "unknown")
set(TRIBENCH_DIRTY "false")
if(GIT_FOUND AND EXISTS "${SOURCE_DIR}/.git")
  # Somebody else's checkout is as good, and a question must not write into it.
  set(git ${GIT_EXECUTABLE} -c safe.directory=* --no-optional-locks)
  execute_process(COMMAND ${git} rev-parse --short=12 HEAD
    WORKING_DIRECTORY "${SOURCE_DIR}" OUTPUT_VARIABLE commit RESULT_VARIABLE failed
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(TRIBENCH_COMMIT "${commit}")
    execute_process(COMMAND ${git} status --porcelain --untracked-files=no
      WORKING_DIRECTORY "${SOURCE_DIR}" OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT "${changes}" STREQUAL "")
      set(TRIBENCH_DIRTY "true")
    endif()
  endif()
endif()
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
