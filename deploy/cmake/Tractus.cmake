# The build's vocabulary: one call per folder. Sources are globbed, so a new file is only a new file.
#
#   tractus_library(core DEPS fmt::fmt)          every *.cpp here but *_test.cpp -> tractus::core, tests -> core_test
#   tractus_program(tractus DEPS ...)            every *.cpp here -> build/<preset>/bin/tractus
#   tractus_catalogue(metrics ...)               see below

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(TRACTUS_ARCH x86-64-v3 CACHE STRING "Processor the programs are built for (-march)")
option(TRACTUS_SYMBOLS "Record functions and lines, which the packages keep apart from the programs" OFF)
set(TRACTUS_SANITIZE "" CACHE STRING "Sanitizers, comma separated")

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(zstd REQUIRED)
find_package(CLI11 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(sodium REQUIRED IMPORTED_TARGET libsodium)
pkg_check_modules(modbus REQUIRED IMPORTED_TARGET libmodbus)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser)

# Folders where -O3 was measured to pay (tests/bench) are compiled with it, all others with what the preset says.
set(TRACTUS_HOT_FOLDERS shared/math shared/volume shared/laws shared/effects shared/models shared/drilling shared/lab
  station/safety station/loop tests/bench)

# Folders that no everyday change touches are compiled in larger pieces (TRACTUS_UNITY).
set(TRACTUS_LARGE_PIECES shared/app shared/assessment db/store)

add_library(tractus_options INTERFACE)
target_compile_options(tractus_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror
  $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow$<SEMICOLON>-Wno-restrict>  # gcc 12 at -O3 is wrong about buffers of fmt and std::string
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>  # KiB: the compiler tidies its memory less often, a tenth less time
  -march=${TRACTUS_ARCH} -fno-math-errno
  $<$<CXX_COMPILER_ID:GNU>:-fexpensive-optimizations>)  # without it gcc at -O1 leaves out vzeroupper, and exp() is 20 times slower after Eigen
target_link_libraries(tractus_options INTERFACE Threads::Threads fmt::fmt)
if(TRACTUS_SYMBOLS)
  target_compile_options(tractus_options INTERFACE -g1)
endif()
find_program(TRACTUS_MOLD mold)
if(TRACTUS_MOLD)  # links the test programs several times faster than GNU ld
  target_link_options(tractus_options INTERFACE -fuse-ld=mold)
endif()
if(TRACTUS_SANITIZE)
  target_compile_options(tractus_options INTERFACE -fsanitize=${TRACTUS_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(tractus_options INTERFACE -fsanitize=${TRACTUS_SANITIZE})
endif()

if(TRACTUS_TESTS)
  enable_testing()
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(TRACTUS_TESTS OR TRACTUS_FUZZ OR TRACTUS_BENCH)
  # The paths of this checkout, in one object: all others are the same in every checkout, and a compiler cache serves them.
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/checkout.cpp @ONLY CONTENT
"#include <checkout.hpp>
namespace tractus::checkout {
const char* const kSource = \"${CMAKE_SOURCE_DIR}\";
const char* const kBin = \"${CMAKE_BINARY_DIR}/bin\";
const char* const kStandIn = \"${CMAKE_BINARY_DIR}/standin\";
}
")
  add_library(tractus_checkout STATIC ${CMAKE_BINARY_DIR}/checkout.cpp)
  target_include_directories(tractus_checkout PUBLIC ${CMAKE_SOURCE_DIR}/tests/support/checkout)
endif()

# One precompiled header of the standard library, fmt, JSON and Eigen serves every target: two thirds of the time of a
# file is otherwise spent in reading them. Each file still includes what it names (TRACTUS_PCH=OFF builds without).
# GCC 12 optimises a file as its precompiled header was, whatever -O it is given itself: hot folders have one of their own.
option(TRACTUS_PCH "Use the precompiled header" ON)
if(TRACTUS_PCH)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp CONTENT "" @ONLY)
  foreach(kind library hot test)
    add_library(tractus_precompiled_${kind} OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    target_link_libraries(tractus_precompiled_${kind} PRIVATE tractus_options Eigen3::Eigen nlohmann_json::nlohmann_json)
    string(REPLACE hot library header ${kind})
    target_precompile_headers(tractus_precompiled_${kind} PRIVATE ${CMAKE_SOURCE_DIR}/deploy/cmake/precompiled_${header}.hpp)
  endforeach()
  target_compile_options(tractus_precompiled_hot PRIVATE $<$<CONFIG:Release>:-O3>)
  if(TRACTUS_TESTS)
    target_link_libraries(tractus_precompiled_test PRIVATE GTest::gmock GTest::gtest)
  endif()
endif()

# __FILE__ is the same in every checkout, for the compiler cache. After the precompiled header, which would hold the option itself.
add_compile_options(-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=)
if(TRACTUS_SYMBOLS)
  add_compile_options(-fdebug-prefix-map=${CMAKE_SOURCE_DIR}=/usr/src/tractus)  # where a debugger looks for the sources
endif()

option(TRACTUS_UNITY "Compile the files of a folder several at a time" ON)
set(TRACTUS_UNITY_FILES 16 CACHE STRING "How many at a time: three times as many take half of the time, but more is compiled anew after a change")

# What every target of ours gets: optimisation by folder, the precompiled header, and several files
# compiled as one (TRACTUS_UNITY), for most of a file's time is the headers': names of a folder's anonymous namespaces are unique.
function(tractus_compile target kind)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE folder)
  if(folder IN_LIST TRACTUS_HOT_FOLDERS AND kind STREQUAL "library")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O3>
      $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds$<SEMICOLON>-Wno-stringop-overread>)  # of std::vector and std::string, wrongly by gcc 12
    set(kind hot)
  endif()
  if(kind STREQUAL "test")  # gcc 12 at -O1 is wrong about the bounds of a std::string that is put together
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
  endif()
  if(TRACTUS_PCH)
    target_link_libraries(${target} PRIVATE nlohmann_json::nlohmann_json)
    target_precompile_headers(${target} REUSE_FROM tractus_precompiled_${kind})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # for ccache
  endif()
  if(TRACTUS_UNITY)
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # warns of anonymous namespaces in included files
    set(files ${TRACTUS_UNITY_FILES})
    if(folder IN_LIST TRACTUS_LARGE_PIECES AND NOT kind STREQUAL "test")
      math(EXPR files "3 * ${files}")
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()

# The root that #include lines start from: shared/ sees only itself, the others the whole repository.
function(tractus_include_roots target)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "^${CMAKE_SOURCE_DIR}/shared(/|$)")
    target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR}/shared)
  else()
    target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR}/shared ${CMAKE_SOURCE_DIR})
  endif()
endfunction()

# A gtest program of its own, for tests that span folders: tractus_add_test(name SOURCES … DEPS … [LABELS slow] [TIMEOUT s])
# ALONE: nothing else runs beside it, since it keeps to a bus in real time.
# BOTH_DATABASES: those of its tests that run on PostgreSQL (PostgreSQL/*) are one test of ctest, so that they share one server.
# LONG FILTER…: cases that take more than 1.5 s are one test of ctest, NAME_long, which deploy/test --fast leaves out.
# Cases of unit tests (LABELS unit) are one test of ctest too.
function(tractus_add_test name)
  cmake_parse_arguments(ARG "BOTH_DATABASES;ALONE" "TIMEOUT" "SOURCES;DEPS;LABELS;LONG" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  tractus_include_roots(${name})
  target_link_libraries(${name} PRIVATE tractus_options tractus_checkout ${ARG_DEPS} GTest::gmock GTest::gtest_main)
  foreach(source IN LISTS ARG_SOURCES)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    file(STRINGS ${source} allocates REGEX "void\\* operator new" LIMIT_COUNT 1)  # for its whole program: compiled alone
    if(allocates)
      set_property(SOURCE ${source} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  tractus_compile(${name} test)
  set(apart ${ARG_LONG})
  if(ARG_LONG)
    list(JOIN ARG_LONG ":" long)
    tractus_ctest(${name}_long ${name} "${long}" 600 "${ARG_LABELS};long")
  endif()
  if(ARG_BOTH_DATABASES)
    list(APPEND apart "PostgreSQL/*")
    tractus_ctest(${name}_on_postgresql ${name} "PostgreSQL/*" 900 "${ARG_LABELS}")
  endif()
  list(JOIN apart ":" apart)
  set(filter "*-${apart}")
  if("unit" IN_LIST ARG_LABELS)
    tractus_ctest(${name} ${name} "${filter}" 600 "${ARG_LABELS}")
  else()
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60 TEST_FILTER "${filter}"
      PROPERTIES TIMEOUT ${ARG_TIMEOUT} COST ${ARG_TIMEOUT} LABELS "${ARG_LABELS}" RUN_SERIAL ${ARG_ALONE})
  endif()
endfunction()

# One test of ctest for all cases of a program, for starting a program costs more than most cases. Its report names each case
# (deploy/junit.py counts them).
function(tractus_ctest test program filter timeout_s labels)
  add_test(NAME ${test} COMMAND ${program} --gtest_filter=${filter} --gtest_output=xml:${CMAKE_BINARY_DIR}/reports/${test}.xml)
  set_tests_properties(${test} PROPERTIES TIMEOUT ${timeout_s} COST ${timeout_s} LABELS "${labels}" ${ARGN})  # the longest begin first
endfunction()

# The whole program once more, as one test, with its servers' records in PostgreSQL (tests/support/database).
function(tractus_again_on_postgresql name)
  if(TRACTUS_TESTS)
    tractus_ctest(${name}_on_postgresql ${name} "*" 1200 slow ENVIRONMENT TRACTUS_TEST_DATABASE=postgresql)
  endif()
endfunction()

# A library of the sources of this folder, and of FOLDERS below it, with the tests beside them (*_test.cpp; LONG as above).
function(tractus_library name)
  cmake_parse_arguments(ARG "BOTH_DATABASES" "" "FOLDERS;DEPS;PRIVATE_DEPS;TEST_DEPS;LONG" ${ARGN})
  set(patterns *.cpp)
  set(test_patterns *_test.cpp)
  foreach(folder IN LISTS ARG_FOLDERS)
    list(APPEND patterns ${folder}/*.cpp)
    list(APPEND test_patterns ${folder}/*_test.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  file(GLOB tests CONFIGURE_DEPENDS ${test_patterns})
  list(REMOVE_ITEM sources ${tests} "")
  if(sources)
    add_library(tractus_${name} STATIC ${sources})
    target_link_libraries(tractus_${name} PUBLIC ${ARG_DEPS} PRIVATE tractus_options ${ARG_PRIVATE_DEPS})
    tractus_include_roots(tractus_${name})
    add_library(tractus::${name} ALIAS tractus_${name})
    tractus_compile(tractus_${name} library)
  else()
    add_library(tractus_${name} INTERFACE)  # headers alone
    target_link_libraries(tractus_${name} INTERFACE ${ARG_DEPS})
    add_library(tractus::${name} ALIAS tractus_${name})
  endif()
  if(TRACTUS_TESTS AND tests)
    set(both "")
    if(ARG_BOTH_DATABASES)
      set(both BOTH_DATABASES)
    endif()
    tractus_add_test(${name}_test ${both} SOURCES ${tests} DEPS tractus::${name} ${ARG_TEST_DEPS} LABELS unit LONG ${ARG_LONG})
  endif()
endfunction()

function(tractus_program name)
  cmake_parse_arguments(ARG "" "" "DEPS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  file(GLOB tests CONFIGURE_DEPENDS *_test.cpp)
  list(REMOVE_ITEM sources ${tests} "")
  add_executable(${name} ${sources})
  tractus_include_roots(${name})
  target_link_libraries(${name} PRIVATE tractus_options ${ARG_DEPS})
  tractus_compile(${name} library)
  target_compile_definitions(${name} PRIVATE TRACTUS_VERSION="${PROJECT_VERSION}")
endfunction()

# tractus_catalogue(target NAMESPACE metrics TYPE MetricInfo HEADER metrics/metric.hpp FILES catalogue/*.cpp [SUFFIX _metric])
# Every NAME.cpp of FILES (but *_test.cpp) must define `TYPE NAMESPACE::NAME<SUFFIX>()`; generates `std::vector<TYPE>
# NAMESPACE::all()` in file-name order. The file's name is the id; a file without its function is a link error (ADR-0001).
function(tractus_catalogue target)
  cmake_parse_arguments(ARG "" "NAMESPACE;TYPE;HEADER;FILES;SUFFIX" "" ${ARGN})
  file(GLOB files CONFIGURE_DEPENDS ${ARG_FILES})
  list(SORT files COMPARE FILE_BASENAME)
  get_target_property(kind ${target} TYPE)
  if(kind STREQUAL "INTERFACE_LIBRARY")
    return()
  endif()
  set(declarations "")
  set(sources "")
  set(entries "")
  foreach(file IN LISTS files)
    cmake_path(GET file STEM id)
    if(NOT id MATCHES "_test$")
      list(APPEND sources ${file})
      string(APPEND declarations "${ARG_TYPE} ${id}${ARG_SUFFIX}();\n")
      string(APPEND entries "  entries.push_back(${id}${ARG_SUFFIX}());\n")
    endif()
  endforeach()
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/${ARG_NAMESPACE}_catalogue.cpp)
  string(REPLACE "::" "_" generated "${generated}")
  file(CONFIGURE OUTPUT ${generated} CONTENT
"#include \"${ARG_HEADER}\"\n#include <vector>\nnamespace tractus::${ARG_NAMESPACE} {\n${declarations}std::vector<${ARG_TYPE}> all() {\n  std::vector<${ARG_TYPE}> entries;\n${entries}  return entries;\n}\n}  // namespace tractus::${ARG_NAMESPACE}\n" @ONLY)
  target_sources(${target} PRIVATE ${generated} ${sources})
endfunction()
