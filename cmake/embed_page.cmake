# The page of reports/page travels inside the program as one text with a gap where the data go: the generated header
# "reports/embedded_page.hpp" declares page_before_data() and page_after_data(), texts in pieces.
#
# The page's modules are joined to one script, because a page that is opened from disk loads none: their import lines go,
# and so does the word export. The page's Content-Security-Policy names script and styles by their hashes.

set(page_modules
  dom format data later table charts time_line_model time_line case_detail case_table summary course burst_course burst_shares timing heat_map thresholds pulse immunity fit fuzz campaign history comparison residual publication
  matrix detection coverage measured_bursts cover appendix page)

# The octets of a hexadecimal number as base64.
function(fieldproof_base64 hexadecimal result)
  set(alphabet "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
  string(LENGTH "${hexadecimal}" digits)
  set(text "")
  set(at 0)
  while(at LESS digits)
    string(SUBSTRING "${hexadecimal}00000" ${at} 6 group)
    math(EXPR value "0x${group}")
    foreach(shift IN ITEMS 18 12 6 0)
      math(EXPR index "(${value} >> ${shift}) & 63")
      string(SUBSTRING "${alphabet}" ${index} 1 letter)
      string(APPEND text "${letter}")
    endforeach()
    math(EXPR at "${at} + 6")
  endwhile()
  math(EXPR missing "(6 - ${digits} % 6) % 6 / 2")
  string(LENGTH "${text}" length)
  math(EXPR kept "${length} - ${missing}")
  string(SUBSTRING "${text}" 0 ${kept} text)
  string(REPEAT "=" ${missing} padding)
  set(${result} "${text}${padding}" PARENT_SCOPE)
endfunction()

function(fieldproof_source_of_hash text result)
  string(SHA256 hash "${text}")
  fieldproof_base64("${hash}" coded)
  set(${result} "'sha256-${coded}'" PARENT_SCOPE)
endfunction()

function(fieldproof_joined_modules folder result)
  set(script "")
  foreach(name IN LISTS page_modules)
    file(READ "${folder}/${name}.js" module)
    string(REGEX REPLACE "(^|\n)import [^;]*;" "\\1" module "${module}")
    string(REGEX REPLACE "(^|\n)export " "\\1" module "${module}")
    string(APPEND script "${module}")
  endforeach()
  string(REGEX MATCHALL "(^|\n)(async )?(function|class|const|let) [A-Za-z0-9]+" names "${script}")
  list(TRANSFORM names REPLACE "^.* " "")
  foreach(name IN LISTS names)
    if(name IN_LIST known)
      message(FATAL_ERROR "Two modules of ${folder} declare \"${name}\", and the page has one script; rename one.")
    endif()
    list(APPEND known "${name}")
  endforeach()
  set(${result} "${script}" PARENT_SCOPE)
endfunction()

function(fieldproof_page_function name text result)
  fieldproof_raw_strings("${text}" "," pieces)
  set(${result} "std::span<const std::string_view> ${name}() {
  static constexpr std::string_view kPieces[] = {${pieces}};
  return kPieces;
}
" PARENT_SCOPE)
endfunction()

# Fills the gaps @NAME@ of page.html and cuts it where the data go.
function(fieldproof_embed_page target folder)
  set(sources "${CMAKE_SOURCE_DIR}/${folder}")
  set(charts "${sources}/node_modules/uplot")
  if(NOT EXISTS "${charts}/dist/uPlot.iife.min.js")
    message(FATAL_ERROR "uPlot, which draws the charts of the report, is not in ${folder}/node_modules. "
      "Run script/setup, which fetches it, and configure again.")
  endif()
  file(GLOB page_files CONFIGURE_DEPENDS "${sources}/*.js" "${sources}/page.html" "${sources}/page.css")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${page_files} "${charts}/dist/uPlot.iife.min.js" "${charts}/dist/uPlot.min.css")
  file(READ "${charts}/LICENSE" chart_licence)
  file(READ "${charts}/dist/uPlot.iife.min.js" chart_script)
  file(READ "${charts}/dist/uPlot.min.css" chart_style)
  file(READ "${sources}/page.css" style)
  file(READ "${sources}/page.html" page)
  fieldproof_joined_modules("${sources}" script)
  # An element's hash is that of all between its tags.
  fieldproof_source_of_hash("${chart_script}" chart_hash)
  fieldproof_source_of_hash("${script}" script_hash)
  string(APPEND style "\n${chart_style}")
  fieldproof_source_of_hash("${style}" style_hash)
  string(REPLACE "@SCRIPT_HASHES@" "${chart_hash} ${script_hash}" page "${page}")
  string(REPLACE "@STYLE_HASH@" "${style_hash}" page "${page}")
  string(REPLACE "@CHART_LICENCE@" "${chart_licence}" page "${page}")
  string(REPLACE "@CHART_SCRIPT@" "${chart_script}" page "${page}")
  string(REPLACE "@STYLE@" "${style}" page "${page}")
  string(REPLACE "@SCRIPT@" "${script}" page "${page}")

  string(FIND "${page}" "@DATA@" gap)
  string(SUBSTRING "${page}" 0 ${gap} before)
  math(EXPR behind "${gap} + 6")
  string(SUBSTRING "${page}" ${behind} -1 after)
  fieldproof_page_function(page_before_data "${before}" before)
  fieldproof_page_function(page_after_data "${after}" after)
  set(stem "${CMAKE_BINARY_DIR}/generated/reports/embedded_page")
  fieldproof_write("${stem}.hpp" "#pragma once

#include <span>
#include <string_view>

namespace fieldproof::reports {
std::span<const std::string_view> page_before_data();
std::span<const std::string_view> page_after_data();
}  // namespace fieldproof::reports
")
  fieldproof_write("${stem}.cpp"
    "#include \"reports/embedded_page.hpp\"\n\nnamespace fieldproof::reports {\n${before}${after}}  // namespace fieldproof::reports\n")
  target_sources(${target} PRIVATE "${stem}.cpp")
endfunction()
