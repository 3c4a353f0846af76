# What `cmake --install` puts where, and how find_package(softcell) finds it:
#
#   bin/softcell
#   include/softcell/<folder>/         public headers
#   lib/libsoftcell_<folder>.a         targets softcell::<folder>
#   lib/cmake/softcell/                the package
#   share/softcell/cmake/              softcell_add_spu_kernel
#   share/man/man1/, share/bash-completion/, share/zsh/   the manual page and completions, for who builds it all
#   share/softcell/spu_kernels/        sdk/, common/ and the *_job.h contracts, beside cmake/ as in the source tree
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(SOFTCELL_INSTALL_MODULES ${CMAKE_INSTALL_DATADIR}/softcell/cmake)
set(SOFTCELL_INSTALL_KERNELS ${CMAKE_INSTALL_DATADIR}/softcell/spu_kernels)
set(SOFTCELL_INSTALL_PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/softcell)

# The libraries of these folders with their headers, as one file of targets.
function(softcell_install_libraries export)
  foreach(folder IN LISTS ARGN)
    if(NOT TARGET softcell_${folder})
      continue()
    endif()
    install(TARGETS softcell_${folder} EXPORT ${export} ARCHIVE)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/include/softcell TYPE INCLUDE)
    set(installed TRUE)
  endforeach()
  if(installed)
    install(EXPORT ${export} NAMESPACE softcell:: DESTINATION ${SOFTCELL_INSTALL_PACKAGE})
  endif()
endfunction()

# Called once all folders are known.
function(softcell_install_package)
  # Soft bodies bring Eigen, Bullet, Box2D and assimp; who only runs kernels does not need them.
  softcell_install_libraries(softcellKernelTargets base dma ls_sim spu_kernels)
  softcell_install_libraries(softcellBodyTargets ppu)
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
