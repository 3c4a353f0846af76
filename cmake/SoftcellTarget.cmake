# What every target of the house shares: warnings, and arithmetic that is the same everywhere.

add_library(softcell_options INTERFACE)
target_compile_options(softcell_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wpedantic
  $<$<BOOL:${SOFTCELL_WARNINGS_AS_ERRORS}>:-Werror>
  # A contracted multiply-add rounds once where the source rounds twice: results would depend on the compiler.
  -ffp-contract=off)
if(SOFTCELL_SANITIZE)
  target_compile_options(softcell_options INTERFACE -fsanitize=${SOFTCELL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/sanitizer_ignorelist.txt>
    # Checks at each load and store of a pointer are half of what these sanitizers add, and the address sanitizer and the processor find
    # most of the same mistakes. The libraries that take addresses apart (softcell_add_library()) keep them.
    $<$<AND:$<CXX_COMPILER_ID:Clang>,$<NOT:$<BOOL:$<TARGET_PROPERTY:SOFTCELL_EVERY_CHECK>>>>:-fno-sanitize=null,vptr,object-size,pointer-overflow,alignment>)
  # Instrumented code confuses GCC's flow analysis: it warns of std::regex's own members.
  target_compile_options(softcell_options INTERFACE "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-array-bounds;-Wno-stringop-overflow>")
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

# Headers of other projects that many of our sources include, compiled once for all libraries and once for all tests. A build without
# them shows where a source forgets an #include.
option(SOFTCELL_PRECOMPILED_HEADERS "Compile the headers of the standard library, Eigen and GoogleTest once" ${PROJECT_IS_TOP_LEVEL})
if(SOFTCELL_PRECOMPILED_HEADERS)
  target_compile_options(softcell_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()

# Several sources of a target compiled as one: what they share is read and compiled once, which halves the time of a whole build. A source
# that changes takes its neighbours with it, and what one source includes the next one sees: a build without shows what was forgotten.
option(SOFTCELL_UNITY_BUILD "Compile the sources of a target in groups of twelve" OFF)
if(SOFTCELL_UNITY_BUILD)
  # GCC collects garbage from 128 MB on, which takes a tenth of its time here, and still needs 1.2 GB for the largest group: 1.5 GB without.
  target_compile_options(softcell_options INTERFACE "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=1048576>")
  # Types of unnamed namespaces in private structures, which GCC takes for a header's because a file includes their source.
  target_compile_options(softcell_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
function(softcell_group_sources target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SOFTCELL_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 12)
endfunction()

# softcell_add_precompiled_headers(<target> <header>...): for `target_precompile_headers(... REUSE_FROM <target>)`.
function(softcell_add_precompiled_headers target)
  set(empty ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  add_library(${target} OBJECT ${empty})
  target_link_libraries(${target} PRIVATE softcell_options)
  target_precompile_headers(${target} PRIVATE
    <algorithm> <array> <atomic> <condition_variable> <cstdint> <filesystem> <functional> <map> <memory> <mutex> <optional> <set> <span>
    <stdexcept> <string> <string_view> <thread> <unordered_map> <variant> <vector> ${ARGN})
endfunction()
set(SOFTCELL_EIGEN_HEADERS)
if("soft_bodies" IN_LIST SOFTCELL_COMPONENTS)
  find_package(Eigen3 3.4 QUIET NO_MODULE)
  set(SOFTCELL_EIGEN_HEADERS <Eigen/Core>)
endif()
if(SOFTCELL_PRECOMPILED_HEADERS)
  softcell_add_precompiled_headers(softcell_library_headers ${SOFTCELL_EIGEN_HEADERS})
  if(TARGET Eigen3::Eigen)
    target_link_libraries(softcell_library_headers PRIVATE Eigen3::Eigen)
  endif()
endif()

# softcell_add_library(<folder> [SOURCES ...])
# The one library of a folder, to which rooms add their sources, or one of several that share the folder's public headers: target
# softcell_<folder>, alias softcell::<folder>, public headers in include/ of the calling folder.
function(softcell_add_library folder)
  cmake_parse_arguments(arg "" "" "SOURCES" ${ARGN})
  add_library(softcell_${folder} STATIC ${arg_SOURCES})
  add_library(softcell::${folder} ALIAS softcell_${folder})
  softcell_group_sources(softcell_${folder})
  set_target_properties(softcell_${folder} PROPERTIES EXPORT_NAME ${folder})
  target_compile_features(softcell_${folder} PUBLIC cxx_std_20)
  target_include_directories(softcell_${folder}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/src)
    target_include_directories(softcell_${folder} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  endif()
  # How we compile is not how users of the installed libraries have to.
  target_link_libraries(softcell_${folder} PRIVATE $<BUILD_INTERFACE:softcell_options>)
  set(own_headers)
  if(folder MATCHES "^(base|dma)$")  # these two include less than it takes to read the others
    set(own_headers ON)
  endif()
  if(SOFTCELL_SANITIZE AND folder MATCHES "^(base|dma|ls_sim)$")
    set_target_properties(softcell_${folder} PROPERTIES SOFTCELL_EVERY_CHECK ON)
    set(own_headers ON)  # precompiled ones have other options
  endif()
  # What reads files, transfers and programs is fuzzed. Here libFuzzer sees which ways an input has taken; everywhere, it would cost a tenth of
  # the time of compiling and of the tests.
  if(SOFTCELL_BUILD_FUZZERS AND folder MATCHES "^(base|dma|ls_sim|mesh_import|render|demos|tool)$")
    target_compile_options(softcell_${folder} PRIVATE -fsanitize=fuzzer-no-link)
    set(own_headers ON)
  endif()
  # What scenes and the command do themselves takes little time beside the libraries, and half as long to compile. With the address sanitizer
  # optimising the checks takes as long again as compiling them. Benchmarks are optimised as what they measure. Precompiled headers have the
  # libraries' options, which GCC would take for these sources, too. Compilers need less memory for them: larger groups are no larger a load.
  if(folder MATCHES "^(demos|tool|tool_demo)$")
    set_target_properties(softcell_${folder} PROPERTIES UNITY_BUILD_BATCH_SIZE 24)
    if(NOT SOFTCELL_SANITIZE)
      target_compile_options(softcell_${folder} PRIVATE $<$<CONFIG:Release>:-O1>)
      set(own_headers ON)
    endif()
  endif()
  if(SOFTCELL_SANITIZE MATCHES address AND folder MATCHES "^(demos|tool.*)$")
    target_compile_options(softcell_${folder} PRIVATE -O0)
    set(own_headers ON)
  endif()
  if(SOFTCELL_PRECOMPILED_HEADERS AND NOT own_headers)
    target_precompile_headers(softcell_${folder} REUSE_FROM softcell_library_headers)
  endif()
endfunction()

# softcell_link_libraries_first(<program> <library>...): of an inline function, linkers take the first copy for all callers. With the address
# sanitizer, tests and the command's own libraries are not optimised, and a copy of theirs would be every library's, which then takes up to a hundred
# times as long. So libraries come before the program's objects, as a whole and with those that they need; the command's come last.
function(softcell_link_libraries_first program)
  set(files)
  set(seen)
  set(left ${ARGN})
  while(left)
    list(POP_FRONT left library)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" library "${library}")
    if(NOT TARGET ${library})
      continue()
    endif()
    get_target_property(aliased ${library} ALIASED_TARGET)
    if(aliased)
      set(library ${aliased})
    endif()
    if(library IN_LIST seen OR NOT library MATCHES "^softcell_")
      continue()
    endif()
    list(APPEND seen ${library})
    get_target_property(type ${library} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      list(APPEND files $<TARGET_FILE:${library}>)
    endif()
    get_target_property(needed ${library} INTERFACE_LINK_LIBRARIES)
    if(needed)
      list(APPEND left ${needed})
    endif()
  endwhile()
  set(commands ${files})
  list(FILTER commands INCLUDE REGEX "softcell_(demos|tool)")
  list(FILTER files EXCLUDE REGEX "softcell_(demos|tool)")
  list(APPEND files ${commands})
  list(JOIN files "," files)
  target_link_options(${program} PRIVATE "LINKER:--whole-archive,${files},--no-whole-archive")
endfunction()
