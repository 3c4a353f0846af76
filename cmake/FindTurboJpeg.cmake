# libjpeg-turbo by its own interface. Target TurboJpeg::TurboJpeg. (The CMake package that Debian's libturbojpeg0-dev has
# stops with an error where other packages' files are missing.)
find_path(TurboJpeg_INCLUDE_DIR turbojpeg.h)
find_library(TurboJpeg_LIBRARY turbojpeg)
mark_as_advanced(TurboJpeg_INCLUDE_DIR TurboJpeg_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TurboJpeg REQUIRED_VARS TurboJpeg_LIBRARY TurboJpeg_INCLUDE_DIR)

if(TurboJpeg_FOUND AND NOT TARGET TurboJpeg::TurboJpeg)
  add_library(TurboJpeg::TurboJpeg INTERFACE IMPORTED)
  target_include_directories(TurboJpeg::TurboJpeg SYSTEM INTERFACE ${TurboJpeg_INCLUDE_DIR})
  target_link_libraries(TurboJpeg::TurboJpeg INTERFACE ${TurboJpeg_LIBRARY})
endif()
