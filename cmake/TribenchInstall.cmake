# Install and export, so that another project can find_package(tribench).
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY TRIBENCH_ROOMS)
install(TARGETS ${rooms} tribench_options EXPORT tribench
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS tribench_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(room foundation problems algorithms reports harness)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tribench
    FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(DIRECTORY grids suites adapters python examples DESTINATION ${CMAKE_INSTALL_DATADIR}/tribench
  USE_SOURCE_PERMISSIONS
  PATTERN "*.in" EXCLUDE PATTERN "__pycache__" EXCLUDE PATTERN "*.timer" EXCLUDE)
install(FILES examples/nightly/tribench-nightly.timer DESTINATION lib/systemd/system)
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Two steps, since the program's path is a generator expression and @-variables are none.
configure_file(cmake/InstallDescription.cmake.in
  ${PROJECT_BINARY_DIR}/install/description.cmake.in @ONLY)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/install/description.cmake
  INPUT ${PROJECT_BINARY_DIR}/install/description.cmake.in)
install(SCRIPT ${PROJECT_BINARY_DIR}/install/description.cmake)
install(EXPORT tribench NAMESPACE tribench:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/tribench
  FILE tribenchTargets.cmake)
configure_package_config_file(cmake/tribenchConfig.cmake.in
  ${PROJECT_BINARY_DIR}/tribenchConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/tribench)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tribenchConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tribenchConfig.cmake
  ${PROJECT_BINARY_DIR}/tribenchConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/tribench)
