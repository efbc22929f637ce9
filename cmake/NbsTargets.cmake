# Helpers that give every target of the project the same language level, warnings and include root.

find_program(NBS_CCACHE ccache)
if(NBS_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${NBS_CCACHE})
endif()

add_library(nbs_options INTERFACE)
target_compile_features(nbs_options INTERFACE cxx_std_20)
# -msse4.2 is the widest set that is safe with Debian's Eigen users; wider code is dispatched at run time inside one file.
# -ffp-contract=off: the same expression gives the same bits in every translation unit.
target_compile_options(nbs_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -msse4.2 -ffp-contract=off)
target_include_directories(nbs_options INTERFACE ${PROJECT_SOURCE_DIR})
if(NBS_SANITIZE)
  # LCM's C++ header calls through casts that the vptr check refuses.
  target_compile_options(nbs_options INTERFACE -fsanitize=address,undefined -fno-sanitize=vptr -fno-omit-frame-pointer)
  target_link_options(nbs_options INTERFACE -fsanitize=address,undefined)
  target_compile_definitions(nbs_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# nbs_library(NAME SOURCES a.cc b.cc LINK x y [LINK_PRIVATE z]): a static library with the project's options.
function(nbs_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LINK_PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC nbs_options Eigen3::Eigen ${ARG_LINK} PRIVATE ${ARG_LINK_PRIVATE})
endfunction()

# nbs_executable(NAME SOURCES main.cc LINK x y): an executable, all of which land in <build>/bin. The target nbs_programs is all whose name
# begins with nbs-: what the scripts run.
add_custom_target(nbs_programs)
function(nbs_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE nbs_options ${ARG_LINK})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  if(name MATCHES "^nbs-")
    add_dependencies(nbs_programs ${name})
  endif()
endfunction()

# nbs_test(NAME SOURCES a_test.cc LINK x y): one GoogleTest executable, registered as one test of the suite.
function(nbs_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE nbs_options GTest::gtest GTest::gmock GTest::gtest_main ${ARG_LINK})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  target_compile_definitions(${name} PRIVATE NBS_SOURCE_DIR="${PROJECT_SOURCE_DIR}" NBS_BINARY_DIR="${PROJECT_BINARY_DIR}")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT})
endfunction()
