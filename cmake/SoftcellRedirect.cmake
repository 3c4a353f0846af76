# A project that has softcell as a part of it by add_subdirectory(), or parts of that project that are also built alone, may ask for it by
# find_package(softcell): it is there already.
file(CONFIGURE OUTPUT ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/softcell-config.cmake @ONLY CONTENT [[
set(softcell_missing)
foreach(softcell_component IN LISTS softcell_FIND_COMPONENTS)
  if(TARGET softcell::${softcell_component})
    set(softcell_${softcell_component}_FOUND TRUE)
  elseif(softcell_FIND_REQUIRED_${softcell_component})
    list(APPEND softcell_missing ${softcell_component})
  endif()
endforeach()
if(softcell_missing)
  set(softcell_NOT_FOUND_MESSAGE
    "softcell is a part of this project, built with SOFTCELL_COMPONENTS \"@SOFTCELL_COMPONENTS@\": without ${softcell_missing}.")
  set(softcell_FOUND FALSE)
endif()
]])
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/softcell-config-version.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
