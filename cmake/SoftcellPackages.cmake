# Debian packages, made by `cpack` in the build folder (ci/test-packages makes them and tries them in a clean Debian):
#
#   softcell         the command
#   libsoftcell-dev  libraries (static, but for libspe2 and what is loaded with it), headers, CMake package, pkg-config files, commands of a
#                    toolchain
#   softcell-doc     licence, pages, examples
# Each with the licence, where Debian has it.
foreach(pair softcell:command libsoftcell-dev:development softcell-doc:documentation)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 package)
  list(GET pair 1 component)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} RENAME copyright COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME softcell)
set(CPACK_PACKAGE_VENDOR softcell)
set(CPACK_PACKAGE_CONTACT "the softcell maintainers <maintainers@softcell.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL development documentation)
if(TARGET softcell)
  list(APPEND CPACK_COMPONENTS_ALL command)
  set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/SoftcellCheckPackaging.cmake)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME softcell)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
# Loaded at run time, run, or read by scenes (glmark2-data): invisible to dpkg-shlibdeps.
set(CPACK_DEBIAN_COMMAND_PACKAGE_DEPENDS "libosmesa6")
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "fonts-dejavu-core, glmark2-data, libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "ffmpeg, libsoftcell-dev, softcell-doc")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsoftcell-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# A static library has no list of what it needs: these are the headers and libraries that a program links with it.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "binutils, libassimp-dev, libboost-context-dev, libbox2d-dev, libbullet-dev, libdw-dev, libeigen3-dev, libelf-dev, libpng-dev, libturbojpeg0-dev, libxxhash-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake (>= 3.25), g++ (>= 4:12), libosmesa6, softcell")

set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME softcell-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)

set(CPACK_COMPONENT_COMMAND_DESCRIPTION "The command softcell: demos, kernels on a simulated SPE, benchmarks and reports.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Libraries, headers, kernel SDK and toolchain commands of softcell, for programs of one's own.")
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION "Pages and examples of softcell.")
include(CPack)
