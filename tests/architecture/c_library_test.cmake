# Which mathematical functions of the C library the rooms call: their last bits differ between
# processors and versions, so that a result may depend on none (foundation/elementary.hpp has our
# own). Fails on any that is not allowed below. Arguments: -DARCHIVES= -DNM=
cmake_minimum_required(VERSION 3.25)
set(exact fma fmaf fmod remainder)  # correctly rounded or exact by definition
set(inexact exp exp2 expm1 exp10 log log2 log10 log1p pow sin cos tan sincos asin acos atan atan2
  sinh cosh tanh asinh acosh atanh cbrt hypot erf erfc lgamma lgamma_r tgamma j0 j1 y0 y1
  cabs carg cexp clog cpow csqrt csin ccos ctan)
# object -> what it may call: the checker of certificates trusts the C library on purpose, so that
# it shares nothing with the prover, and moves every value outward by 8 ulp.
set(allowed_certificate_check exp log sin cos tanh atan pow)

set(found "")
set(seen 0)
foreach(archive IN LISTS ARCHIVES)
  execute_process(COMMAND ${NM} -A --undefined-only ${archive} OUTPUT_VARIABLE listing
    ERROR_QUIET RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${NM} cannot read ${archive}")
  endif()
  string(REPLACE "\n" ";" lines "${listing}")
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "([A-Za-z0-9_]+)\\.[a-z]+\\.o(bj)?:.* U ([A-Za-z0-9_]+)$")
      continue()
    endif()
    set(object ${CMAKE_MATCH_1})
    set(symbol ${CMAKE_MATCH_3})
    string(REGEX REPLACE "^__(.*)_finite$" "\\1" name ${symbol})
    string(REGEX REPLACE "^_ZGV.*_" "" name ${name})
    set(double_name ${name})
    if(NOT name IN_LIST inexact)
      string(REGEX REPLACE "[fl]$" "" double_name ${name})
    endif()
    math(EXPR seen "${seen} + 1")
    if(double_name IN_LIST inexact AND NOT symbol IN_LIST exact
       AND NOT name IN_LIST allowed_${object})
      get_filename_component(room ${archive} NAME)
      list(APPEND found "${room}: ${object} calls ${symbol}")
    endif()
  endforeach()
endforeach()
if(seen LESS 1000)
  message(FATAL_ERROR "only ${seen} symbols were read: the test looks at nothing")
endif()
if(found)
  list(JOIN found "\n  " text)
  message(FATAL_ERROR "use foundation/elementary.hpp:\n  ${text}")
endif()
message(STATUS "${seen} symbols, no function whose bits are the C library's")
