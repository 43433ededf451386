# How every target of orcart is built: language level, warnings, and one function per kind of target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(orcart_flags INTERFACE)
target_include_directories(orcart_flags INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(orcart_flags INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wno-missing-field-initializers
  $<$<BOOL:${ORCART_WERROR}>:-Werror>)
# At -O3 GCC 12 guesses wrong in these two (GCC bugs 105329 and 105593).
target_compile_options(orcart_flags INTERFACE
  "$<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Wno-restrict;-Wno-maybe-uninitialized>")

# orcart_library(realtime/base SOURCES a.cpp ... LINK orcart::x ... SYSTEM dep ...)
# makes the library orcart::realtime_base out of the calling folder; header-only where no SOURCES are given.
function(orcart_library folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  string(REPLACE "/" "_" name ${folder})
  string(REPLACE "-" "_" name ${name})
  if(ARG_SOURCES)
    add_library(orcart_${name} STATIC ${ARG_SOURCES})
    target_link_libraries(orcart_${name} PUBLIC orcart_flags ${ARG_LINK} PRIVATE ${ARG_PRIVATE_LINK})
  else()
    add_library(orcart_${name} INTERFACE)
    target_link_libraries(orcart_${name} INTERFACE orcart_flags ${ARG_LINK})
  endif()
  add_library(orcart::${name} ALIAS orcart_${name})
endfunction()

# orcart_test(name LABEL unit [THREADS] [SERIAL] [TIMEOUT s] SOURCES ... LINK ... ENVIRONMENT A=1 ...)
# One GoogleTest program, each of its tests known to ctest under the label. THREADS also gives the label `threads`:
# these are the tests that tools/check repeats under ThreadSanitizer. SERIAL: nothing else runs beside them.
# The target tests_LABEL builds every program of a label.
function(orcart_test name)
  cmake_parse_arguments(ARG "THREADS;SERIAL" "LABEL;TIMEOUT" "SOURCES;LINK;ENVIRONMENT" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 60)
  endif()
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=") # several times slower, on machines that are busy too
    math(EXPR ARG_TIMEOUT "5 * ${ARG_TIMEOUT}")
  endif()
  set(labels ${ARG_LABEL})
  if(ARG_THREADS)
    list(APPEND labels threads)
  endif()
  set(environment ORCART_SOURCE_DIR=${CMAKE_SOURCE_DIR} ORCART_BINARY_DIR=${CMAKE_BINARY_DIR} ${ARG_ENVIRONMENT})

  add_executable(test_${name} ${ARG_SOURCES})
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=address")
    target_sources(test_${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests/support/keep_libraries.cpp)
  endif()
  target_link_libraries(test_${name} PRIVATE orcart_flags ${ARG_LINK} GTest::gtest GTest::gtest_main)
  foreach(label ${labels})
    if(NOT TARGET tests_${label})
      add_custom_target(tests_${label})
    endif()
    add_dependencies(tests_${label} test_${name})
  endforeach()

  # Properties that are lists do not survive gtest_discover_tests' own PROPERTIES, so they are set beside it.
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST)
  set(properties ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_properties.cmake)
  file(CONFIGURE OUTPUT ${properties} @ONLY CONTENT [[
if(test_@name@_TESTS)
  set_tests_properties(${test_@name@_TESTS} PROPERTIES
    LABELS "@labels@" TIMEOUT @ARG_TIMEOUT@ RUN_SERIAL @ARG_SERIAL@ ENVIRONMENT "@environment@")
endif()
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${properties})
endfunction()
if(ORCART_TESTS)
  include(GoogleTest)
endif()
