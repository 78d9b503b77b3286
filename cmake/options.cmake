# Language, warnings, instrumentation and tools: all that holds for every target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_VERIFY_INTERFACE_HEADER_SETS ON)

option(FIELDPROOF_TESTS "Build the tests and the replay of the fuzz corpora" ON)
option(FIELDPROOF_BENCHMARKS "Build the benchmarks where Google Benchmark is installed" ON)
option(FIELDPROOF_MPI "Build the module for mpirun where MPI is installed" ON)
option(FIELDPROOF_FUZZ "Build the libFuzzer programs (clang only)" OFF)
set(FIELDPROOF_FUZZ_ENGINE "" CACHE STRING
  "With FIELDPROOF_FUZZ: what links another fuzzing engine, as LIB_FUZZING_ENGINE of OSS-Fuzz; CXXFLAGS then instrument")
option(FIELDPROOF_COVERAGE "Count executed lines and branches (g++ only)" OFF)
option(FIELDPROOF_PRECOMPILE "Precompile GoogleTest and RapidCheck once for all test programs" ON)
option(FIELDPROOF_UNITY "Compile several sources at once: less time for all, more for one file" OFF)
set(FIELDPROOF_SANITIZE "" CACHE STRING "Sanitizers for everything, e.g. address,undefined or thread")

add_library(fieldproof_warnings INTERFACE)
target_compile_options(fieldproof_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wnon-virtual-dtor -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 reports overlaps and overruns inside std::string that are not there (GCC bugs 105651 and 105329).
  # AddressSanitizer runs over the whole suite and sees the real ones.
  target_compile_options(fieldproof_warnings INTERFACE
    -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Its collector of garbage runs at every 30 % more memory: that is a tenth of the time of a compilation.
  add_compile_options(--param=ggc-min-expand=300 --param=ggc-min-heapsize=1000000)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # std::stable_sort of libstdc++ 12 calls a function that libstdc++ itself marks as deprecated.
  target_compile_options(fieldproof_warnings INTERFACE -Wno-deprecated-declarations)
endif()

# A fused multiply-add rounds once where the product and the sum round twice: results would differ between machines
# with and without it.
add_compile_options(-ffp-contract=off)

# Code that is under test in a fuzz build. The frame check stays outside: its inner loop would be counted, not tested.
# Comparisons are not traced: that is a third of a run, and what it would find, words, stands in the dictionaries.
add_library(fieldproof_instrumented INTERFACE)
if(FIELDPROOF_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "FIELDPROOF_FUZZ needs clang (libFuzzer is part of it): use the preset 'fuzz'.")
  endif()
endif()
# Who brings an engine brings the instrumentation that it needs, too.
if(FIELDPROOF_FUZZ AND NOT FIELDPROOF_FUZZ_ENGINE)
  set(fuzz_sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all)
  target_compile_options(fieldproof_instrumented INTERFACE -fsanitize=fuzzer-no-link
    -fno-sanitize-coverage=trace-cmp ${fuzz_sanitizers} -fno-omit-frame-pointer)
  add_link_options(${fuzz_sanitizers})
endif()

if(FIELDPROOF_SANITIZE)
  add_compile_options(-fsanitize=${FIELDPROOF_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FIELDPROOF_SANITIZE})
endif()

if(FIELDPROOF_COVERAGE)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    message(FATAL_ERROR "FIELDPROOF_COVERAGE needs g++ (gcovr reads its counters): use the preset 'coverage'.")
  endif()
  add_compile_options(--coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()

# Paths in messages begin at the root of the project: builds in different places tell the same.
add_compile_options("-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=")

find_program(ccache_program ccache)
if(ccache_program AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # A precompiled header can only be cached when ccache does not mistrust its time stamps and __TIME__.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime "${ccache_program}")
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  string(REGEX MATCH "^[0-9]+" clang_major "${CMAKE_CXX_COMPILER_VERSION}")
  find_program(lld_program NAMES ld.lld-${clang_major} ld.lld)
else()
  find_program(lld_program NAMES ld.lld)
endif()
if(lld_program)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    add_link_options(--ld-path=${lld_program})
  else()
    add_link_options(-fuse-ld=lld)
  endif()
endif()
