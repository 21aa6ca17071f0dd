# Flags that every target of the project shares.
add_library(evo_flags INTERFACE)
# No fused multiply-add behind our back: the same program gives the same bytes on every x86-64.
target_compile_options(evo_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
                                           -Werror -ffp-contract=off -fno-math-errno)
# GCC 12 sees reads beyond std::string_view where there are none.
target_compile_options(evo_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>)
if(EVO_NATIVE)
  # Eigen then adds up more numbers at a time, in another order. With AVX, GCC 12 warns of its loads of small matrices,
  # which it takes for longer than they are.
  target_compile_options(evo_flags INTERFACE -march=native $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
endif()
if(EVO_SANITIZE)
  target_link_options(evo_flags INTERFACE -fsanitize=${EVO_SANITIZE})
endif()

# Instruments a target of a module, if its module is to be.
function(evo_sanitize target module)
  if(EVO_SANITIZE AND (NOT EVO_SANITIZE_MODULES OR module IN_LIST EVO_SANITIZE_MODULES))
    # Instrumented code makes GCC see uninitialised values where there are none, as its manual says.
    target_compile_options(${target} PRIVATE -fsanitize=${EVO_SANITIZE} -fno-omit-frame-pointer
                                             -Wno-maybe-uninitialized)
  endif()
endfunction()

# evo_module(<name> SOURCES <file>... DEPENDS <module or library>...)
# One static library a module; it depends only on modules listed above it in CMakeLists.txt (scripts/check.py checks
# that).
function(evo_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(evo_${name} STATIC ${ARG_SOURCES})
  add_library(evo::${name} ALIAS evo_${name})
  target_include_directories(evo_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(evo_${name} PUBLIC ${ARG_DEPENDS} PRIVATE evo_flags)
  # Headers of libraries that most files of the module include are parsed once.
  set(precompiled <algorithm> <filesystem> <functional> <string> <vector>)
  if(NOT name MATCHES "^(core|events)$")
    list(APPEND precompiled <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <Eigen/LU>)
  endif()
  if(name STREQUAL app)
    list(APPEND precompiled <CLI/CLI.hpp>)
  endif()
  target_precompile_headers(evo_${name} PRIVATE ${precompiled})
  evo_sanitize(evo_${name} ${name})
endfunction()

# evo_test(<module> SOURCES <file>... [DEPENDS <library>...])
function(evo_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_include_directories(${name}_test PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${name}_test PRIVATE evo::${name} ${ARG_DEPENDS} GTest::gtest_main evo_flags)
  target_precompile_headers(${name}_test PRIVATE <gtest/gtest.h> <filesystem> <fstream> <functional> <string> <vector>)
  # GCC 12 sees overlaps and overflows in chains of string + string where there are none (its bug 105329).
  target_compile_options(${name}_test PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow>)
  evo_sanitize(${name}_test ${name})
  target_compile_definitions(${name}_test PRIVATE EVO_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${name}_test TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()
