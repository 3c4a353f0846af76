# softcell_embed_scenes(<target>)
# The scenes beside this file go into the program as they are; builtin_files.cpp gives them to the scene library.

set(SOFTCELL_SCENES_DIR ${CMAKE_CURRENT_LIST_DIR})

function(softcell_embed_scenes target)
  file(GLOB files RELATIVE ${SOFTCELL_SCENES_DIR} CONFIGURE_DEPENDS ${SOFTCELL_SCENES_DIR}/*.toml ${SOFTCELL_SCENES_DIR}/*.lua)
  list(SORT files)
  set(stub_text ".section .rodata\n")
  set(declarations "")
  set(entries "")
  foreach(file IN LISTS files)
    string(MAKE_C_IDENTIFIER "softcell_scene_${file}" symbol)
    string(APPEND stub_text ".global ${symbol}, ${symbol}_end\n${symbol}:\n.incbin \"${SOFTCELL_SCENES_DIR}/${file}\"\n${symbol}_end:\n")
    string(APPEND declarations "extern const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND entries "      {\"${file}\", {${symbol}, ${symbol}_end}},\n")
    list(APPEND paths ${SOFTCELL_SCENES_DIR}/${file})
  endforeach()
  string(APPEND stub_text ".section .note.GNU-stack,\"\",%progbits\n")
  set(stub ${CMAKE_CURRENT_BINARY_DIR}/scene_files.S)
  file(CONFIGURE OUTPUT ${stub} CONTENT "${stub_text}" @ONLY)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/builtin_files.cpp @ONLY CONTENT [[
#include "scene_file/builtin_files.h"

extern "C" {
@declarations@}

namespace softcell::demos {

std::span<const BuiltinFile> builtin_files() {
  static const BuiltinFile files[] = {
@entries@  };
  return files;
}

}  // namespace softcell::demos
]])
  target_sources(${target} PRIVATE ${stub} ${CMAKE_CURRENT_BINARY_DIR}/builtin_files.cpp)
  set_source_files_properties(${stub} PROPERTIES OBJECT_DEPENDS "${paths}")
endfunction()
