# Folders become targets: libraries, test programs, fuzz targets, benchmarks.
include(embed_schemas)
include(embed_page)
include(embed_devices)
include(hot_sources)

# Names of the direct subfolders of a folder that hold sources.
function(fieldproof_subfolders folder result)
  file(GLOB children CONFIGURE_DEPENDS RELATIVE "${CMAKE_SOURCE_DIR}/${folder}" "${CMAKE_SOURCE_DIR}/${folder}/*")
  set(names)
  foreach(child IN LISTS children)
    file(GLOB sources "${CMAKE_SOURCE_DIR}/${folder}/${child}/*.[ch]pp")
    if(sources)
      list(APPEND names ${child})
    endif()
  endforeach()
  set(${result} ${names} PARENT_SCOPE)
endfunction()

# fieldproof_library(name folder [ONLY regex] [EXCEPT regex] [UNINSTRUMENTED] [FAST] [LINK targets...] [PRIVATE targets...])
# FAST: those of its sources that hot_sources names are compiled each alone at -O3 in what users run, and the others at
# -O1, as all of a library that is not: its time passes in what it calls.
# A folder without sources gives an interface library, so that the link lines hold at every stage.
function(fieldproof_library name folder)
  cmake_parse_arguments(arg "UNINSTRUMENTED;FAST" "ONLY;EXCEPT" "LINK;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/${folder}/*.cpp")
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/${folder}/*.hpp" "${CMAKE_SOURCE_DIR}/${folder}/*.h")
  list(FILTER sources EXCLUDE REGEX "(_test|_fuzz|/main|/test_main)\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "/node_modules/")
  list(FILTER headers EXCLUDE REGEX "/node_modules/")
  list(FILTER headers EXCLUDE REGEX "/(approved_text|published_schema|(probe|program)_fixture|source_folder)\\.hpp$")  # of tests only: they need what CMake tells those
  if(arg_ONLY)
    list(FILTER sources INCLUDE REGEX "${arg_ONLY}")
    list(FILTER headers INCLUDE REGEX "${arg_ONLY}")
  endif()
  if(arg_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "${arg_EXCEPT}")
    list(FILTER headers EXCLUDE REGEX "${arg_EXCEPT}")
  endif()

  set(kind PUBLIC)
  if(sources)
    add_library(${name} STATIC ${sources})
    set_target_properties(${name} PROPERTIES UNITY_BUILD ${FIELDPROOF_UNITY} UNITY_BUILD_BATCH_SIZE 16)
    # Tables of rows name their parts alike: each is compiled alone. They take a second each.
    foreach(source IN LISTS sources)
      if(source MATCHES "/protocols/.*(_settings|_table|rule_members)\\.cpp$")
        set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endforeach()
    target_link_libraries(${name} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:fieldproof_warnings>)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    # Under sanitizers a compilation takes less than half of the time so, and its time passes elsewhere, too.
    if(FIELDPROOF_SANITIZE AND NOT arg_FAST)
      target_compile_options(${name} PRIVATE -O0)
    endif()
    if(arg_FAST AND CMAKE_BUILD_TYPE STREQUAL "Release")
      fieldproof_compile_hot_sources(${sources})
    endif()
    if(NOT arg_UNINSTRUMENTED)
      target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:fieldproof_instrumented>)
    endif()
  else()
    set(kind INTERFACE)
    add_library(${name} INTERFACE)
  endif()
  target_compile_features(${name} ${kind} cxx_std_20)
  target_link_libraries(${name} ${kind} ${arg_LINK})
  target_include_directories(${name} ${kind}
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/generated>)
  if(headers)
    target_sources(${name} ${kind} FILE_SET HEADERS BASE_DIRS "${CMAKE_SOURCE_DIR}" FILES ${headers})
  endif()
  if(sources AND NOT arg_ONLY)
    fieldproof_embed_schemas(${name} ${folder})
  endif()
endfunction()

# fieldproof_harness_library(name ...): a folder of the harness, with the arguments of fieldproof_library.
function(fieldproof_harness_library name)
  fieldproof_library(fieldproof_${name} harness/${name} FAST ${ARGN} PRIVATE ${third_party_libraries})
endfunction()

# What every test program shares, and the precompiled headers that they take over from it.
function(fieldproof_test_ground)
  if(TARGET fieldproof_test_ground)
    return()
  endif()
  add_library(fieldproof_test_ground INTERFACE)
  target_link_libraries(fieldproof_test_ground INTERFACE
    GTest::gtest_main GTest::gmock rapidcheck rapidcheck_gtest fmt::fmt nlohmann_json::nlohmann_json Boost::headers
    Threads::Threads fieldproof_warnings)
  target_include_directories(fieldproof_test_ground INTERFACE "${CMAKE_SOURCE_DIR}")
  # What is fast is what they test; optimizing them as well would take a quarter of the time of their compilation, and
  # under a sanitizer two thirds. Tests that COMPUTE would take six times as long without it.
  target_compile_options(fieldproof_test_ground INTERFACE
    $<IF:$<BOOL:$<TARGET_PROPERTY:FIELDPROOF_COMPUTES>>,-O1,-O0>)
  target_compile_definitions(fieldproof_test_ground INTERFACE FIELDPROOF_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  if(FIELDPROOF_PRECOMPILE)
    file(WRITE "${CMAKE_BINARY_DIR}/generated/precompiled.cpp" "")
    add_library(fieldproof_test_headers OBJECT "${CMAKE_BINARY_DIR}/generated/precompiled.cpp")
    target_link_libraries(fieldproof_test_headers PRIVATE fieldproof_test_ground fieldproof_instrumented)
    target_precompile_headers(fieldproof_test_headers PRIVATE <gtest/gtest.h> <rapidcheck/gtest.h>)
    fieldproof_cacheable_precompiled_headers(fieldproof_test_headers)
  endif()
endfunction()

function(fieldproof_cacheable_precompiled_headers name)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(${name} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
  else()
    target_compile_options(${name} PRIVATE -fpch-preprocess)
  endif()
endfunction()

# Under a sanitizer a program takes longer to begin than most of its tests take: they are run in eight parts, not one by
# one. The page is looked at in a browser, in which nothing of ours is instrumented.
# What a function leaves behind on its stack is looked at where its code is tested alone: in whole suites and programs,
# which come through the same code, that and long traces of each allocation would take half as much time again.
function(fieldproof_tests_in_parts name folder environment)
  set(parts 8)
  if(folder MATCHES "^(conformance|cli)$")
    string(APPEND environment
      ";ASAN_OPTIONS=strict_string_checks=1:detect_stack_use_after_return=0:malloc_context_size=1")
  endif()
  math(EXPR last "${parts} - 1")
  foreach(part RANGE ${last})
    add_test(NAME ${folder}/part_${part} COMMAND ${name} "--gtest_filter=-*SerialRuns*")
    set_tests_properties(${folder}/part_${part} PROPERTIES TIMEOUT 1200
      ENVIRONMENT "${environment};GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part}")
  endforeach()
  add_test(NAME ${folder}/wall_clock COMMAND ${name} "--gtest_filter=*SerialRuns*-Browser*")
  set_tests_properties(${folder}/wall_clock PROPERTIES TIMEOUT 600 RUN_SERIAL ON ENVIRONMENT "${environment}")
endfunction()

# fieldproof_tests(name folder [COMPUTE] LINK targets... [THREADS targets...]). Tests whose suite name contains "Threads"
# carry the label "threads", and link THREADS where they are built alone. COMPUTE: most of their time passes in templates
# that are compiled with the tests.
function(fieldproof_tests name folder)
  cmake_parse_arguments(arg "COMPUTE" "" "LINK;THREADS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS
    "${CMAKE_SOURCE_DIR}/${folder}/*_test.cpp" "${CMAKE_SOURCE_DIR}/${folder}/test_main.cpp")
  list(FILTER sources EXCLUDE REGEX "/node_modules/")
  # ThreadSanitizer sees threads only: a build for it has these sources alone.
  set(sources_with_threads)
  foreach(source IN LISTS sources)
    file(STRINGS "${source}" suites_with_threads REGEX "^(TEST|TEST_F|TEST_P|RC_GTEST_PROP)\\([A-Za-z]*Threads")
    if(suites_with_threads)
      list(APPEND sources_with_threads "${source}")
    endif()
  endforeach()
  if(FIELDPROOF_SANITIZE STREQUAL "thread")
    set(sources ${sources_with_threads})
    if(arg_THREADS)
      set(arg_LINK ${arg_THREADS})
    endif()
  endif()
  if(NOT sources)
    return()
  endif()
  fieldproof_test_ground()
  add_executable(${name} ${sources})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${FIELDPROOF_UNITY} FIELDPROOF_COMPUTES ${arg_COMPUTE})
  if(NOT arg_COMPUTE)
    set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 16)
  endif()
  target_link_libraries(${name} PRIVATE ${arg_LINK} fieldproof_test_ground fieldproof_instrumented)
  # Precompiled headers are of one optimization.
  if(FIELDPROOF_PRECOMPILE AND NOT arg_COMPUTE)
    target_precompile_headers(${name} REUSE_FROM fieldproof_test_headers)
    fieldproof_cacheable_precompiled_headers(${name})
  endif()
  if(sources_with_threads)
    add_dependencies(tests_with_threads ${name})
  endif()
  # One seed for all property tests: a failure in CI is a failure at the desk.
  # What is judged in wall-clock time has the machine for itself.
  set(seeds "RC_PARAMS=seed=20240611")
  if(FIELDPROOF_SANITIZE AND NOT FIELDPROOF_SANITIZE STREQUAL "thread")
    # A sanitizer looks at what the code does, not at how often it holds: fewer of the values, as large ones.
    fieldproof_tests_in_parts(${name} ${folder} "${seeds} max_success=25")
    return()
  endif()
  foreach(part IN ITEMS "*Threads*" "*SerialRuns*" "-*Threads*:*SerialRuns*")
    set(label plain)
    set(serial OFF)
    if(part STREQUAL "*Threads*")
      set(label threads)
    elseif(part STREQUAL "*SerialRuns*")
      set(label wall_clock)
      set(serial ON)
    endif()
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${folder}/" TEST_FILTER "${part}"
      TEST_LIST ${name}_${label}
      PROPERTIES LABELS ${label} ENVIRONMENT "${seeds}" TIMEOUT 600 RUN_SERIAL ${serial})
  endforeach()
endfunction()

# One fuzz target: x_replay (any compiler; a test over fuzz/corpus/x) and, with FIELDPROOF_FUZZ, x_fuzz.
function(fieldproof_fuzz_target name source)
  cmake_parse_arguments(arg "" "" "LINK;DEFINE" ${ARGN})
  set(programs ${name}_replay)
  add_executable(${name}_replay "${source}")
  target_link_libraries(${name}_replay PRIVATE fieldproof_fuzz_replay)
  add_test(NAME fuzz/${name}_replay COMMAND ${name}_replay "${CMAKE_SOURCE_DIR}/fuzz/corpus/${name}")
  set_tests_properties(fuzz/${name}_replay PROPERTIES LABELS corpus TIMEOUT 300)
  if(FIELDPROOF_FUZZ)
    list(APPEND programs ${name}_fuzz)
    add_executable(${name}_fuzz "${source}")
    if(FIELDPROOF_FUZZ_ENGINE)
      separate_arguments(engine UNIX_COMMAND "${FIELDPROOF_FUZZ_ENGINE}")
      target_link_libraries(${name}_fuzz PRIVATE ${engine})
    else()
      target_link_options(${name}_fuzz PRIVATE -fsanitize=fuzzer)
    endif()
    add_dependencies(fuzz_programs ${name}_fuzz)
  endif()
  foreach(program IN LISTS programs)
    target_link_libraries(${program} PRIVATE
      fieldproof_fuzz_shared ${arg_LINK} fieldproof_instrumented fieldproof_warnings)
    target_compile_definitions(${program} PRIVATE ${arg_DEFINE})
    set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/fuzz")
  endforeach()
endfunction()

# fuzz/x_fuzz.cpp is a target each; the sequence driver is one for each role of ROLES, "name=protocol/role".
function(fieldproof_fuzz_targets)
  cmake_parse_arguments(arg "" "" "LINK;ROLES" ${ARGN})
  file(GLOB targets CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/fuzz/*_fuzz.cpp" "${CMAKE_SOURCE_DIR}/fuzz/*/*_fuzz.cpp")
  file(GLOB shared CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/fuzz/*.cpp")
  list(FILTER shared EXCLUDE REGEX "(_fuzz|_test|/replay_main)\\.cpp$")
  # Objects, not an archive: nothing refers to the options of the sanitizers by name.
  foreach(part IN ITEMS shared replay)
    add_library(fieldproof_fuzz_${part} OBJECT)
    target_link_libraries(fieldproof_fuzz_${part} PUBLIC ${arg_LINK} PRIVATE fieldproof_instrumented fieldproof_warnings)
  endforeach()
  target_sources(fieldproof_fuzz_shared PRIVATE ${shared})
  target_sources(fieldproof_fuzz_replay PRIVATE fuzz/replay_main.cpp)
  if(FIELDPROOF_FUZZ)
    add_custom_target(fuzz_programs)
  endif()
  foreach(source IN LISTS targets)
    get_filename_component(name "${source}" NAME_WE)
    string(REGEX REPLACE "_fuzz$" "" name "${name}")
    fieldproof_fuzz_target(${name} "${source}")
  endforeach()
  foreach(role IN LISTS arg_ROLES)
    string(REPLACE "=" ";" parts "${role}")
    list(GET parts 0 name)
    list(GET parts 1 path)
    string(REGEX REPLACE "/.*" "" protocol "${path}")
    fieldproof_fuzz_target(${name} "${CMAKE_SOURCE_DIR}/fuzz/roles/sequence_driver.cpp"
      LINK fieldproof_${protocol}_suite DEFINE "FIELDPROOF_ROLE=\"${path}\"" "FIELDPROOF_SUITE=${protocol}_suite"
        "FIELDPROOF_SUITE_HEADER=\"conformance/${protocol}/suite.hpp\"")
  endforeach()
endfunction()

# bench/*_bench.cpp become one program; peers are compiled in when their packages are installed.
function(fieldproof_benchmarks)
  cmake_parse_arguments(arg "" "" "LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/bench/*.cpp")
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  if(NOT FIELDPROOF_BENCHMARKS OR NOT benchmark_FOUND OR NOT sources)
    return()
  endif()
  add_executable(fieldproof_bench ${sources})
  target_link_libraries(fieldproof_bench PRIVATE ${arg_LINK}
    benchmark::benchmark benchmark::benchmark_main fmt::fmt nlohmann_json::nlohmann_json Boost::headers Threads::Threads
    fieldproof_instrumented fieldproof_warnings)
  target_compile_definitions(fieldproof_bench PRIVATE
    FIELDPROOF_HAVE_BOOST_CRC FIELDPROOF_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
    FIELDPROOF_EXE="$<TARGET_FILE:fieldproof>")
  add_dependencies(fieldproof_bench fieldproof)
  if(ns3_include_folder AND ns3_core_library)
    target_compile_definitions(fieldproof_bench PRIVATE FIELDPROOF_HAVE_NS3)
    target_link_libraries(fieldproof_bench PRIVATE "${ns3_core_library}")
  endif()
endfunction()
