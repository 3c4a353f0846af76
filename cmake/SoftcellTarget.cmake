# What every target of the house shares: warnings are errors, and arithmetic that is the same everywhere.

add_library(softcell_options INTERFACE)
target_compile_options(softcell_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wpedantic -Werror
  # A contracted multiply-add rounds once where the source rounds twice: results would depend on the compiler.
  -ffp-contract=off)
if(SOFTCELL_SANITIZE)
  target_compile_options(softcell_options INTERFACE -fsanitize=${SOFTCELL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Instrumented code confuses GCC's flow analysis: it warns of std::regex's own members.
  target_compile_options(softcell_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(softcell_options INTERFACE -fsanitize=${SOFTCELL_SANITIZE})
endif()

# Assertions (softcell/base/assert.h) are alive where speed matters less than mistakes.
set(assertions OFF)
if(SOFTCELL_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(assertions ON)
endif()
option(SOFTCELL_ASSERTIONS "Check SC_ASSERT at run time" ${assertions})
if(SOFTCELL_ASSERTIONS)
  target_compile_definitions(softcell_options INTERFACE SOFTCELL_ASSERTIONS)
endif()

# softcell_add_library(<folder> [SOURCES ...])
# The one library of a folder, to which rooms add their sources, or one of several that share the folder's public headers: target
# softcell_<folder>, alias softcell::<folder>, public headers in include/ of the calling folder.
function(softcell_add_library folder)
  cmake_parse_arguments(arg "" "" "SOURCES" ${ARGN})
  add_library(softcell_${folder} STATIC ${arg_SOURCES})
  add_library(softcell::${folder} ALIAS softcell_${folder})
  set_target_properties(softcell_${folder} PROPERTIES EXPORT_NAME ${folder})
  target_compile_features(softcell_${folder} PUBLIC cxx_std_20)
  target_include_directories(softcell_${folder}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/src)
    target_include_directories(softcell_${folder} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  endif()
  # How we compile is not how users of the installed libraries have to.
  target_link_libraries(softcell_${folder} PRIVATE $<BUILD_INTERFACE:softcell_options>)
endfunction()
