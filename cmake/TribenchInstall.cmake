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
install(DIRECTORY grids adapters examples DESTINATION ${CMAKE_INSTALL_DATADIR}/tribench
  USE_SOURCE_PERMISSIONS)
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
