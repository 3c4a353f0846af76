# softcell_embed(<target> <namespace> <name> <folder> <file>...)
# The files of `folder` go into the program as they are; softcell::<namespace>::embedded_<name>(), which the target declares itself,
# gives them out as base::EmbeddedFile, in the order given here.

function(softcell_embed target namespace name folder)
  set(stub_text ".section .rodata\n")
  set(declarations "")
  set(entries "")
  foreach(file IN LISTS ARGN)
    string(MAKE_C_IDENTIFIER "softcell_${name}_${file}" symbol)
    string(APPEND stub_text ".global ${symbol}, ${symbol}_end\n${symbol}:\n.incbin \"${folder}/${file}\"\n${symbol}_end:\n")
    string(APPEND declarations "extern const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND entries "      {\"${file}\", {${symbol}, ${symbol}_end}},\n")
    list(APPEND paths ${folder}/${file})
  endforeach()
  string(APPEND stub_text ".section .note.GNU-stack,\"\",%progbits\n")
  set(stub ${CMAKE_CURRENT_BINARY_DIR}/embedded_${name}.S)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_${name}.cpp)
  file(CONFIGURE OUTPUT ${stub} CONTENT "${stub_text}" @ONLY)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
#include <span>

#include "softcell/base/embedded_file.h"

extern "C" {
@declarations@}

namespace softcell::@namespace@ {

std::span<const base::EmbeddedFile> embedded_@name@();

std::span<const base::EmbeddedFile> embedded_@name@() {
  static const base::EmbeddedFile files[] = {
@entries@  };
  return files;
}

}  // namespace softcell::@namespace@
]])
  target_sources(${target} PRIVATE ${stub} ${source})
  set_source_files_properties(${stub} TARGET_DIRECTORY ${target} PROPERTIES OBJECT_DEPENDS "${paths}")
endfunction()
