# `cmake --install` puts the program, the schemas and the headers where a package would.
include(GNUInstallDirs)
if(TARGET fieldproof)
  install(TARGETS fieldproof RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()
foreach(folder IN ITEMS harness protocols conformance emc reports)
  if(IS_DIRECTORY "${CMAKE_SOURCE_DIR}/${folder}")
    install(DIRECTORY ${folder} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/fieldproof" FILES_MATCHING PATTERN "*.hpp"
      PATTERN "*.h"
      PATTERN node_modules EXCLUDE)
  endif()
endforeach()
foreach(folder IN ITEMS harness protocols conformance reports cli)
  if(IS_DIRECTORY "${CMAKE_SOURCE_DIR}/${folder}")
    install(DIRECTORY ${folder} DESTINATION "${CMAKE_INSTALL_DATADIR}/fieldproof" FILES_MATCHING PATTERN "*.schema.json"
      PATTERN node_modules EXCLUDE)
  endif()
endforeach()
install(FILES reports/wireshark/fieldproof.lua DESTINATION "${CMAKE_INSTALL_DATADIR}/fieldproof/wireshark")
