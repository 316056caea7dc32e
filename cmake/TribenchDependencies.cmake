# Every library comes from the distribution; nothing is downloaded by the build.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(NLopt 2.7 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(tomlplusplus 3 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(spdlog 1.10 REQUIRED)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  find_package(xbyak 6 REQUIRED CONFIG)  # machine code for compiled formulas
endif()
find_package(OpenSSL 3 REQUIRED COMPONENTS Crypto)
find_package(ZLIB 1.2 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(IPOPT REQUIRED IMPORTED_TARGET ipopt)
pkg_check_modules(URDFDOM QUIET IMPORTED_TARGET urdfdom)        # optional: --urdf
pkg_check_modules(OROCOS_KDL QUIET IMPORTED_TARGET orocos-kdl)  # with it
if(TRIBENCH_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
endif()
if(TRIBENCH_BUILD_BENCH)
  find_package(benchmark 1.7 REQUIRED)
endif()
