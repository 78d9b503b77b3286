# Installs a build, moves the prefix, and builds and tests a project outside of the tree against it:
#   cmake -D BUILD=... -D PROJECT=... -D PLACE=... -D GENERATOR=... -D CXX=... -D C=... -P installation_test.cmake
# PLACE is emptied first.

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE "${PLACE}")
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PLACE}/installed" --component development)
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PLACE}/installed" --component runtime)
file(RENAME "${PLACE}/installed" "${PLACE}/prefix")

file(GLOB_RECURSE package "${PLACE}/prefix/*.cmake")
foreach(file IN LISTS package)
  file(STRINGS "${file}" lines REGEX "${BUILD}")
  if(lines)
    message(FATAL_ERROR "${file} knows where it was built: ${lines}")
  endif()
endforeach()
run("${PLACE}/prefix/bin/fieldproof" list protocols)

file(COPY "${PROJECT}/" DESTINATION "${PLACE}/project")
run("${CMAKE_COMMAND}" -S "${PLACE}/project" -B "${PLACE}/project/build" -G "${GENERATOR}"
  -D "CMAKE_PREFIX_PATH=${PLACE}/prefix" -D "CMAKE_CXX_COMPILER=${CXX}" -D "CMAKE_C_COMPILER=${C}"
  -D CMAKE_BUILD_TYPE=Release)
run("${CMAKE_COMMAND}" --build "${PLACE}/project/build" -j 2)
run("${CMAKE_CTEST_COMMAND}" --test-dir "${PLACE}/project/build" --output-on-failure)
