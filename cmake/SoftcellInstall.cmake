# What `cmake --install` puts where, and how find_package(softcell) finds it:
#
#   bin/softcell
#   include/softcell/<library>/        public headers
#   lib/libsoftcell_<library>.a        targets softcell::<library>
#   lib/cmake/softcell/                the package
#   share/softcell/cmake/              softcell_add_spu_kernel
#   share/man/man1/, share/bash-completion/, share/zsh/   the manual page and completions, for who builds it all
#   share/softcell/spu_kernels/        sdk/, common/ and the *_job.h contracts, beside cmake/ as in the source tree
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(SOFTCELL_INSTALL_MODULES ${CMAKE_INSTALL_DATADIR}/softcell/cmake)
set(SOFTCELL_INSTALL_KERNELS ${CMAKE_INSTALL_DATADIR}/softcell/spu_kernels)
set(SOFTCELL_INSTALL_PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/softcell)

# softcell_install_component(<component> <library>...)
# One component of the package: its libraries, those of them that are built, as one file of targets, and their public headers.
function(softcell_install_component component)
  foreach(library IN LISTS ARGN)
    if(TARGET softcell_${library})
      install(TARGETS softcell_${library} EXPORT softcell_${component} ARCHIVE)
      set(installed TRUE)
      get_target_property(folder softcell_${library} SOURCE_DIR)
      if(IS_DIRECTORY ${folder}/include/softcell)
        list(APPEND SOFTCELL_PUBLIC_HEADERS ${folder}/include/softcell)
      endif()
    endif()
  endforeach()
  if(installed)
    install(EXPORT softcell_${component} NAMESPACE softcell:: DESTINATION ${SOFTCELL_INSTALL_PACKAGE}
      FILE softcell_${component}.cmake)
    list(APPEND SOFTCELL_COMPONENTS ${component})
    set(SOFTCELL_COMPONENTS ${SOFTCELL_COMPONENTS} PARENT_SCOPE)
    set(SOFTCELL_PUBLIC_HEADERS ${SOFTCELL_PUBLIC_HEADERS} PARENT_SCOPE)
  endif()
endfunction()

# Called once all folders are known.
function(softcell_install_package)
  # What a component links besides is in softcellConfig.cmake.in.
  set(SOFTCELL_COMPONENTS)
  set(SOFTCELL_PUBLIC_HEADERS)
  softcell_install_component(base base)
  list(REMOVE_ITEM SOFTCELL_COMPONENTS base)  # all others have it
  softcell_install_component(spu dma ls_sim spu_kernels jobs spu)
  softcell_install_component(soft_bodies soft_bodies)
  softcell_install_component(mesh_import mesh_import)
  softcell_install_component(bullet bullet)
  softcell_install_component(box2d box2d)
  softcell_install_component(spe_bodies spe_bodies)
  softcell_install_component(render glad render)
  list(REMOVE_DUPLICATES SOFTCELL_PUBLIC_HEADERS)
  foreach(headers IN LISTS SOFTCELL_PUBLIC_HEADERS)
    install(DIRECTORY ${headers} TYPE INCLUDE PATTERN render/window.h EXCLUDE PATTERN render/overlay.h EXCLUDE)
  endforeach()
  if(TARGET softcell)
    install(TARGETS softcell RUNTIME)
    get_target_property(tool softcell BINARY_DIR)
    install(FILES ${tool}/manuals/softcell.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
    install(FILES ${tool}/manuals/softcell DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions OPTIONAL)
    install(FILES ${tool}/manuals/_softcell DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions OPTIONAL)
  endif()

  install(DIRECTORY ${PROJECT_SOURCE_DIR}/spu_kernels/sdk ${PROJECT_SOURCE_DIR}/spu_kernels/common
    DESTINATION ${SOFTCELL_INSTALL_KERNELS})
  file(GLOB contracts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/spu_kernels/*_job.h)
  install(FILES ${contracts} DESTINATION ${SOFTCELL_INSTALL_KERNELS})
  install(FILES
    ${PROJECT_SOURCE_DIR}/cmake/SoftcellSpuKernel.cmake
    ${PROJECT_SOURCE_DIR}/cmake/CheckSpuBudget.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindBulletFloat.cmake
    DESTINATION ${SOFTCELL_INSTALL_MODULES})

  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/softcellConfig.cmake.in ${PROJECT_BINARY_DIR}/softcellConfig.cmake
    INSTALL_DESTINATION ${SOFTCELL_INSTALL_PACKAGE} PATH_VARS SOFTCELL_INSTALL_MODULES)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/softcellConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/softcellConfig.cmake ${PROJECT_BINARY_DIR}/softcellConfigVersion.cmake
    DESTINATION ${SOFTCELL_INSTALL_PACKAGE})
endfunction()
