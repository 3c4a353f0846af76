# What `cmake --install` puts where, and how find_package(softcell) and pkg-config find it. The parts in brackets are those of the
# Debian packages, SoftcellPackages.cmake.
#
#   bin/softcell                           the command                                             [command]
#   share/man/man1/, share/bash-completion/, share/zsh/, share/fish/   its manual page, completion [command]
#   include/softcell/<library>/            public headers                                          [development]
#   include/libspe2.h, lib/libspe2.so      target softcell::libspe2                                [development]
#   include/softcell/libspe2/              headers of libsync's functions one by one               [development]
#   include/softcell/psl1ght/, share/softcell/psl1ght/  target softcell::psl1ght; what its Makefiles include [development]
#   share/softcell/cell/buildutils/        what Makefiles of SDK projects include [development]
#   bin/softcell-spu-*, softcell-embedspu, softcell-bin2s, lib/softcell/  the commands of a toolchain   [development]
#   lib/libsoftcell_<library>.a            targets softcell::<library>                             [development]
#   lib/cmake/softcell/                    the package                                             [development]
#   lib/pkgconfig/                         softcell-<component>.pc                                 [development]
#   share/softcell/cmake/                  softcell_add_spu_kernel                                 [development]
#   share/softcell/spu_kernels/            sdk/, common/ and the contracts *_job.h, beside cmake/ as in the source tree [development]
#   share/doc/softcell/                    licence, changes, pages, examples, scenes               [documentation]
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(SOFTCELL_INSTALL_MODULES ${CMAKE_INSTALL_DATADIR}/softcell/cmake)
set(SOFTCELL_INSTALL_KERNELS ${CMAKE_INSTALL_DATADIR}/softcell/spu_kernels)
set(SOFTCELL_INSTALL_PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/softcell)

# softcell_install_libraries(<file> <library>...)
# These libraries, as one file of targets, and their public headers.
function(softcell_install_libraries file)
  foreach(library IN LISTS ARGN)
    set_property(GLOBAL APPEND PROPERTY SOFTCELL_INSTALLED softcell_${library})
    install(TARGETS softcell_${library} EXPORT softcell_${file} ARCHIVE COMPONENT development)
    get_target_property(folder softcell_${library} SOURCE_DIR)
    if(IS_DIRECTORY ${folder}/include/softcell)
      list(APPEND SOFTCELL_PUBLIC_HEADERS ${folder}/include/softcell)
    endif()
  endforeach()
  install(EXPORT softcell_${file} NAMESPACE softcell:: DESTINATION ${SOFTCELL_INSTALL_PACKAGE}
    FILE softcell_${file}.cmake COMPONENT development)
  set(SOFTCELL_PUBLIC_HEADERS ${SOFTCELL_PUBLIC_HEADERS} PARENT_SCOPE)
endfunction()

# softcell_install_pkg_config(<component> <description> [REQUIRES <module>...] [CFLAGS <option>...] LIBS <option>...)
# softcell-<component>.pc, with hyphens for underscores.
function(softcell_install_pkg_config component description)
  cmake_parse_arguments(arg "" "" "REQUIRES;CFLAGS;LIBS" ${ARGN})
  list(JOIN arg_REQUIRES ", " requires)
  if(SOFTCELL_ASSERTIONS)  # what headers check inline, as softcell_base has it for CMake
    list(PREPEND arg_CFLAGS -DSOFTCELL_ASSERTIONS)
  endif()
  list(JOIN arg_CFLAGS " " cflags)
  list(JOIN arg_LIBS " " libs)
  set(folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${folder} OUTPUT_VARIABLE prefix_from_pc)
  string(REPLACE "_" "-" name ${component})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/softcell.pc.in ${PROJECT_BINARY_DIR}/softcell-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/softcell-${name}.pc DESTINATION ${folder} COMPONENT development)
endfunction()

# The libraries and the pkg-config file of one component. What a component links besides is in SoftcellComponents.cmake.
macro(softcell_install_component component)
  if("${component}" STREQUAL "spu")
    softcell_install_libraries(spu dma ls_sim spu_kernels jobs spu)
    softcell_install_pkg_config(spu "emulator of SPEs, kernels and job chains"
      CFLAGS -I\${prefix}/${SOFTCELL_INSTALL_KERNELS}
      LIBS -lsoftcell_jobs -lsoftcell_spu_kernels -lsoftcell_ls_sim -lsoftcell_dma -lsoftcell_base -lboost_context -ldw -lelf -pthread)
  elseif("${component}" STREQUAL "libspe2")
    # One library, as on the Cell; softcell's own are inside it.
    set_property(GLOBAL APPEND PROPERTY SOFTCELL_INSTALLED softcell_libspe2 softcell_allocations softcell_low_memory)
    install(TARGETS softcell_libspe2 softcell_psl1ght EXPORT softcell_libspe2 LIBRARY COMPONENT development)
    install(EXPORT softcell_libspe2 NAMESPACE softcell:: DESTINATION ${SOFTCELL_INSTALL_PACKAGE}
      FILE softcell_libspe2.cmake COMPONENT development)
    install(TARGETS softcell_allocations LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/softcell COMPONENT development)
    install(TARGETS softcell_low_memory EXPORT softcell_libspe2 LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/softcell COMPONENT development)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/ppu/psl1ght/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/softcell/psl1ght COMPONENT development)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/ppu/psl1ght/installed/ DESTINATION ${CMAKE_INSTALL_DATADIR}/softcell/psl1ght COMPONENT development)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/ppu/libspe2/installed/ DESTINATION ${CMAKE_INSTALL_DATADIR}/softcell/cell COMPONENT development)
    softcell_install_pkg_config(psl1ght "thread groups and raw SPUs as PSL1GHT has them"
      CFLAGS -fno-pie -I\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}/softcell/psl1ght
      LIBS -no-pie -Wl,--no-as-needed -L\${prefix}/${CMAKE_INSTALL_LIBDIR}/softcell -lsoftcell_low_memory -lspe2
        -Wl,-rpath,\${prefix}/${CMAKE_INSTALL_LIBDIR}/softcell -Wl,-rpath,\${libdir})
    install(FILES ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/libspe2.h ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/libspe2-types.h
      ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/cbea_map.h ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/cbe_mfc.h
      ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/ppu_intrinsics.h
      ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/libmisc.h ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/malloc_align.h
      ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/free_align.h ${PROJECT_SOURCE_DIR}/ppu/libspe2/include/libsync.h
      ${PROJECT_SOURCE_DIR}/spu_kernels/sdk/shared/softcell_sync.h TYPE INCLUDE COMPONENT development)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/ppu/libspe2/inlined/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/softcell/libspe2 COMPONENT development)
    softcell_install_pkg_config(libspe2 "the SPE Runtime Management Library"
      CFLAGS -I\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}/softcell/libspe2 LIBS -Wl,-rpath,\${libdir} -lspe2)
  elseif("${component}" STREQUAL "render")
    softcell_install_libraries(render glad render)
    softcell_install_pkg_config(render "pictures of meshes, without a window"
      REQUIRES eigen3 libpng LIBS -lsoftcell_render -lsoftcell_glad -lsoftcell_base -ldl)
  else()
    softcell_install_libraries(${component} ${component})
    if("${component}" STREQUAL "soft_bodies")
      softcell_install_pkg_config(soft_bodies "meshes given as arrays, lattices, models and bodies"
        REQUIRES eigen3 LIBS -lsoftcell_soft_bodies -lsoftcell_base -lxxhash)
    elseif("${component}" STREQUAL "mesh_import")
      softcell_install_pkg_config(mesh_import "meshes from files"
        REQUIRES softcell-soft-bodies assimp libpng libturbojpeg LIBS -lsoftcell_mesh_import)
    elseif("${component}" STREQUAL "bullet")
      softcell_install_pkg_config(bullet "soft bodies in a Bullet world" REQUIRES softcell-soft-bodies bullet LIBS -lsoftcell_bullet)
    elseif("${component}" STREQUAL "box2d")
      softcell_install_pkg_config(box2d "soft bodies in a Box2D world" REQUIRES softcell-soft-bodies box2d LIBS -lsoftcell_box2d)
    elseif("${component}" STREQUAL "spe_bodies")
      softcell_install_pkg_config(spe_bodies "shape matching of soft bodies on SPEs"
        REQUIRES softcell-soft-bodies softcell-spu LIBS -lsoftcell_spe_bodies)
    endif()
  endif()
endmacro()

# Called once all folders are known.
function(softcell_install_package)
  set(SOFTCELL_PUBLIC_HEADERS)
  softcell_install_libraries(base base)
  foreach(component IN LISTS SOFTCELL_COMPONENTS)
    softcell_install_component(${component})
  endforeach()
  list(REMOVE_DUPLICATES SOFTCELL_PUBLIC_HEADERS)
  # What only softcell's own layers include of each other; windows are the demos'.
  set(own)
  foreach(header base/embedded_file base/json_text base/nearest_name base/read_file base/sanitizers base/text dma/host_registers dma/local_store_port
      dma/mfc_rules dma/proxy_queue render/overlay render/window)
    list(APPEND own PATTERN ${header}.h EXCLUDE)
  endforeach()
  foreach(headers IN LISTS SOFTCELL_PUBLIC_HEADERS)
    install(DIRECTORY ${headers} TYPE INCLUDE COMPONENT development ${own})
  endforeach()

  if(TARGET softcell)
    set_property(GLOBAL APPEND PROPERTY SOFTCELL_INSTALLED softcell softcell_manuals)
    install(TARGETS softcell RUNTIME COMPONENT command)
    get_target_property(tool softcell BINARY_DIR)
    foreach(page man/man1/softcell.1 bash-completion/completions/softcell zsh/site-functions/_softcell
        fish/vendor_completions.d/softcell.fish)
      cmake_path(GET page PARENT_PATH folder)
      install(FILES ${tool}/manuals/${page} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder} COMPONENT command OPTIONAL)
    endforeach()
  endif()

  # All that an installation needs, and no tests.
  get_property(installed GLOBAL PROPERTY SOFTCELL_INSTALLED)
  add_custom_target(softcell_installation DEPENDS ${installed})

  if("spu" IN_LIST SOFTCELL_COMPONENTS)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/spu_kernels/sdk ${PROJECT_SOURCE_DIR}/spu_kernels/common
      DESTINATION ${SOFTCELL_INSTALL_KERNELS} COMPONENT development)
    file(GLOB contracts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/spu_kernels/*_job.h)
    install(FILES ${contracts} DESTINATION ${SOFTCELL_INSTALL_KERNELS} COMPONENT development)
  endif()
  install(FILES
    ${PROJECT_SOURCE_DIR}/cmake/SoftcellComponents.cmake
    ${PROJECT_SOURCE_DIR}/cmake/SoftcellKernelSettings.cmake
    ${PROJECT_SOURCE_DIR}/cmake/SoftcellSpuKernel.cmake
    ${PROJECT_SOURCE_DIR}/cmake/SoftcellSpuElf.cmake
    ${PROJECT_SOURCE_DIR}/cmake/CheckSpuBudget.cmake
    ${PROJECT_SOURCE_DIR}/cmake/link_spu_image.sh
    ${PROJECT_SOURCE_DIR}/cmake/FindBulletFloat.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindTurboJpeg.cmake
    DESTINATION ${SOFTCELL_INSTALL_MODULES} COMPONENT development)

  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/softcellConfig.cmake.in ${PROJECT_BINARY_DIR}/softcellConfig.cmake
    INSTALL_DESTINATION ${SOFTCELL_INSTALL_PACKAGE} PATH_VARS SOFTCELL_INSTALL_MODULES)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/softcellConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/softcellConfig.cmake ${PROJECT_BINARY_DIR}/softcellConfigVersion.cmake
    DESTINATION ${SOFTCELL_INSTALL_PACKAGE} COMPONENT development)

  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
    ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples
    DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/demos/scenes DESTINATION ${CMAKE_INSTALL_DOCDIR}/demos COMPONENT documentation)
  # Pictures and broken kernels that the pages show and link.
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/demos/golden DESTINATION ${CMAKE_INSTALL_DOCDIR}/tests/demos COMPONENT documentation)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/zoo/broken ${PROJECT_SOURCE_DIR}/tests/zoo/legal
    DESTINATION ${CMAKE_INSTALL_DOCDIR}/tests/zoo COMPONENT documentation)
endfunction()
