# tribench_embed(TARGET NAME FILE): puts FILE into TARGET byte for byte, so that the program needs
# no folder beside it. The contents are had in C++ from
#   namespace tribench::embedded { std::string_view NAME(); }
function(tribench_embed target name file)
  cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
  set(EMBEDDED_NAME ${name})
  set(EMBEDDED_PATH ${path})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/${name}.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/embedded.cpp.in ${source} @ONLY)
  # By itself: of a source that is compiled with others CMake forgets what its object hangs on, and a
  # compiler cache keeps nothing that holds a file.
  set_source_files_properties(${source} PROPERTIES
    OBJECT_DEPENDS ${path} SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${source})
endfunction()
