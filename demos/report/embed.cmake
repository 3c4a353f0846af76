# softcell_embed_report(<target>)
# The page of `softcell report`: its files go into the program as they are, and report_files.cpp gives them to report_page.cpp.

set(SOFTCELL_REPORT_DIR ${CMAKE_CURRENT_LIST_DIR})
# In the order in which they build on each other.
set(SOFTCELL_REPORT_SCRIPTS format row trace view timeline charts tables main)

function(softcell_embed_report target)
  set(stub_text ".section .rodata\n")
  set(declarations "")
  set(script_list "")
  set(files page.html style.css)
  foreach(script IN LISTS SOFTCELL_REPORT_SCRIPTS)
    list(APPEND files ${script}.js)
  endforeach()
  foreach(file IN LISTS files)
    string(MAKE_C_IDENTIFIER "softcell_report_${file}" symbol)
    string(APPEND stub_text ".global ${symbol}, ${symbol}_end\n${symbol}:\n.incbin \"${SOFTCELL_REPORT_DIR}/${file}\"\n${symbol}_end:\n")
    string(APPEND declarations "extern const char ${symbol}[], ${symbol}_end[];\n")
    if(file MATCHES "\\.js$")
      string(APPEND script_list "      {${symbol}, ${symbol}_end},\n")
    endif()
    list(APPEND paths ${SOFTCELL_REPORT_DIR}/${file})
  endforeach()
  string(APPEND stub_text ".section .note.GNU-stack,\"\",%progbits\n")
  set(stub ${CMAKE_CURRENT_BINARY_DIR}/report_files.S)
  file(CONFIGURE OUTPUT ${stub} CONTENT "${stub_text}" @ONLY)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/report_files.cpp @ONLY CONTENT [[
#include "report_files.h"

extern "C" {
@declarations@}

namespace softcell::demos {

std::string_view report_template() { return {softcell_report_page_html, softcell_report_page_html_end}; }
std::string_view report_style() { return {softcell_report_style_css, softcell_report_style_css_end}; }

std::span<const std::string_view> report_scripts() {
  static const std::string_view scripts[] = {
@script_list@  };
  return scripts;
}

}  // namespace softcell::demos
]])
  target_sources(${target} PRIVATE ${stub} ${CMAKE_CURRENT_BINARY_DIR}/report_files.cpp)
  set_source_files_properties(${stub} PROPERTIES OBJECT_DEPENDS "${paths}")
endfunction()
