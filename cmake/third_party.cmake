# Libraries of others come from the system's packages; nothing of them lies in this repository.

macro(fieldproof_require package)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR
      "${package} (${ARGN}) was not found. Run script/setup, which installs every library that fieldproof needs, and configure again.")
  endif()
endmacro()

set(THREADS_PREFER_PTHREAD_FLAG ON)
fieldproof_require(Threads)
fieldproof_require(fmt 9 CONFIG)
fieldproof_require(nlohmann_json 3.11 CONFIG)
fieldproof_require(CLI11 2 CONFIG)
fieldproof_require(rapidcheck CONFIG)  # its package has no version file
# libboost1.81-dev and libboost1.74-dev replace each other silently: asking for the version tells.
fieldproof_require(Boost 1.81 CONFIG COMPONENTS headers)

if(FIELDPROOF_TESTS)
  fieldproof_require(GTest 1.12 CONFIG)
  include(GoogleTest)
else()
  find_package(GTest 1.12 CONFIG QUIET)  # for fieldproof_gtest
endif()
if(FIELDPROOF_BENCHMARKS)
  find_package(benchmark CONFIG QUIET)
  find_path(ns3_include_folder ns3/simulator.h)
  find_library(ns3_core_library NAMES ns3-core ns3.37-core)
endif()

# For campaigns over the ranks of mpirun; everything else goes without it.
if(FIELDPROOF_MPI AND NOT FIELDPROOF_SANITIZE)
  find_package(MPI COMPONENTS CXX QUIET)
  if(NOT MPI_CXX_FOUND)
    message(STATUS "MPI was not found: fieldproof is built without ranks of mpirun (libopenmpi-dev openmpi-bin)")
  endif()
endif()
