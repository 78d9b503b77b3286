# `cmake --install BUILD --prefix PREFIX [--component runtime|development]`, and the prefix may be moved afterwards:
#   runtime      bin/fieldproof, the schemas of its files, the dissector for Wireshark
#   development  libraries, headers with their paths from the root below include/fieldproof, find_package(fieldproof)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/fieldproof")
set(header_folder "${CMAKE_INSTALL_INCLUDEDIR}/fieldproof")
set(data_folder "${CMAKE_INSTALL_DATADIR}/fieldproof")

if(TARGET fieldproof)
  install(TARGETS fieldproof RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT runtime)
endif()
if(TARGET fieldproof_mpi)
  install(TARGETS fieldproof_mpi LIBRARY DESTINATION lib/fieldproof COMPONENT runtime)
endif()
foreach(folder IN ITEMS harness protocols emc reports campaign cli)
  file(GLOB_RECURSE schemas CONFIGURE_DEPENDS RELATIVE "${CMAKE_SOURCE_DIR}" "${CMAKE_SOURCE_DIR}/${folder}/*.schema.json")
  list(FILTER schemas EXCLUDE REGEX "/node_modules/")
  foreach(schema IN LISTS schemas)
    get_filename_component(place "${schema}" DIRECTORY)
    install(FILES "${schema}" DESTINATION "${data_folder}/${place}" COMPONENT runtime)
  endforeach()
endforeach()
file(GLOB dissectors CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/reports/wireshark/*.lua")
install(FILES ${dissectors} DESTINATION "${data_folder}/wireshark" COMPONENT runtime)

# Plug-ins in C need this directory and no library.
add_library(fieldproof_plugin INTERFACE)
target_include_directories(fieldproof_plugin INTERFACE
  $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:${header_folder}>)

# Headers calculate in the code of whoever includes them: as in ours (see options).
target_compile_options(fieldproof_kernel INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>)

# fieldproof_install(export-set targets...): as fieldproof::NAME without its prefix.
function(fieldproof_install export)
  foreach(target IN LISTS ARGN)
    string(REPLACE "fieldproof_" "" name ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    set(header_set)
    get_target_property(header_sets ${target} INTERFACE_HEADER_SETS)
    if(header_sets)
      set(header_set FILE_SET HEADERS DESTINATION "${header_folder}" COMPONENT development)
    endif()
    install(TARGETS ${target} EXPORT ${export}
      ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development
      ${header_set})
  endforeach()
  install(EXPORT ${export} NAMESPACE fieldproof:: DESTINATION "${package_folder}" COMPONENT development)
endfunction()

set(harness_libraries kernel frame_check line config trace fault segment judge field measure traffic network iut harness)
list(TRANSFORM harness_libraries PREPEND fieldproof_)
fieldproof_install(fieldproofTargets ${harness_libraries} ${protocol_libraries}
  fieldproof_cases ${suite_libraries} fieldproof_conformance fieldproof_fuzz fieldproof_campaign fieldproof_emc fieldproof_reports fieldproof_papers fieldproof_cli fieldproof_plugin)
if(TARGET fieldproof_gtest)
  fieldproof_install(fieldproofGTestTargets fieldproof_gtest)
endif()

configure_package_config_file(cmake/fieldproofConfig.cmake.in "${CMAKE_BINARY_DIR}/fieldproofConfig.cmake"
  INSTALL_DESTINATION "${package_folder}")
write_basic_package_version_file("${CMAKE_BINARY_DIR}/fieldproofConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/fieldproofConfig.cmake" "${CMAKE_BINARY_DIR}/fieldproofConfigVersion.cmake"
  DESTINATION "${package_folder}" COMPONENT development)
