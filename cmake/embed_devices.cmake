# The devices that `fieldproof new` writes travel inside the program: each file of the folder, and the header of plug-ins, as
# a text with its name, in the generated header "cli/embedded_devices.hpp".
function(fieldproof_embed_devices target folder)
  file(GLOB devices CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/${folder}/*.in")
  set(constants "")
  foreach(file IN LISTS devices ITEMS "${CMAKE_SOURCE_DIR}/harness/iut/fieldproof_plugin.h")
    get_filename_component(name "${file}" NAME)
    string(REGEX REPLACE "\\.in$" "" name "${name}")
    string(MAKE_C_IDENTIFIER "${name}" name)
    file(READ "${file}" text)
    fieldproof_raw_strings("${text}" "" text)
    string(APPEND constants "inline constexpr std::string_view ${name}_text =${text};\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  endforeach()
  fieldproof_write("${CMAKE_BINARY_DIR}/generated/cli/embedded_devices.hpp"
    "#pragma once\n\n#include <string_view>\n\nnamespace fieldproof::cli {\n${constants}}  // namespace fieldproof::cli\n")
endfunction()
