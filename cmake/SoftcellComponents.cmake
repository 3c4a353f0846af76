# The components of softcell: for its own build, and for find_package(softcell). Each is a target softcell::<component>.
#
#   spu           the emulator, the kernels and job chains; softcell_add_spu_kernel, softcell_embed_spu_images
#   libspe2       the SPE Runtime Management Library for programs that were written for the Cell's Linux
#   soft_bodies   meshes given as arrays, lattices, models, bodies
#   mesh_import   meshes from files
#   bullet        soft bodies in a Bullet world
#   box2d         soft bodies in a Box2D world
#   spe_bodies    shape matching and skinning of soft bodies on SPEs
#   render        pictures of meshes, without a window

# In an order in which each comes behind those that it links.
set(SOFTCELL_ALL_COMPONENTS spu libspe2 soft_bodies mesh_import bullet box2d spe_bodies render)

# softcell_resolve_components(<variable> <wrong> <component>...)
# Sets the variable to these components and those that they link, in the order above; or <wrong> to a sentence about the first that there
# is not.
function(softcell_resolve_components variable wrong)
  set(wanted ${ARGN})
  set(${wrong} "" PARENT_SCOPE)
  foreach(component IN LISTS wanted)
    if(NOT component IN_LIST SOFTCELL_ALL_COMPONENTS)
      list(JOIN SOFTCELL_ALL_COMPONENTS ", " all)
      set(${wrong} "softcell has no component '${component}'; its components are ${all}." PARENT_SCOPE)
      return()
    endif()
  endforeach()
  if(wanted MATCHES "spe_bodies|libspe2")
    list(APPEND wanted spu)
  endif()
  if(wanted MATCHES "mesh_import|bullet|box2d|spe_bodies")
    list(APPEND wanted soft_bodies)
  endif()
  set(resolved)
  foreach(component IN LISTS SOFTCELL_ALL_COMPONENTS)
    if(component IN_LIST wanted)
      list(APPEND resolved ${component})
    endif()
  endforeach()
  set(${variable} ${resolved} PARENT_SCOPE)
endfunction()

# softcell_find_dependency(<missing> <component> <what> <Debian package> <arguments of find_package>...)
# Appends a sentence to the variable <missing> if the package is not found. A macro: packages set variables.
macro(softcell_find_dependency missing component what debian)
  find_package(${ARGN} QUIET)
  if(NOT ${ARGV4}_FOUND)
    string(APPEND ${missing}
      "softcell's component ${component} needs ${what}, which was not found; on Debian it is in the package ${debian}. ")
  endif()
endmacro()

# softcell_find_dependencies(<missing> <component>...)
# Finds what components link. Sets the variable <missing> to one sentence for each package that was not found.
macro(softcell_find_dependencies missing)
  set(${missing} "")
  foreach(softcell_component ${ARGN})
    if(softcell_component STREQUAL "spu")
      softcell_find_dependency(${missing} spu "the threads of the system" libc6-dev Threads)
      softcell_find_dependency(${missing} spu Boost.Context libboost-context-dev Boost COMPONENTS context)
    elseif(softcell_component STREQUAL "soft_bodies")
      softcell_find_dependency(${missing} soft_bodies "Eigen 3.4" libeigen3-dev Eigen3 3.4 NO_MODULE)
    elseif(softcell_component STREQUAL "mesh_import")
      softcell_find_dependency(${missing} mesh_import assimp libassimp-dev assimp)
      softcell_find_dependency(${missing} mesh_import libpng libpng-dev PNG)
      softcell_find_dependency(${missing} mesh_import libjpeg-turbo "libturbojpeg0-dev" TurboJpeg)
    elseif(softcell_component STREQUAL "bullet")
      softcell_find_dependency(${missing} bullet "Bullet in single precision" libbullet-dev BulletFloat)
    elseif(softcell_component STREQUAL "box2d")
      softcell_find_dependency(${missing} box2d "Box2D 2.4" libbox2d-dev box2d)
    elseif(softcell_component STREQUAL "render")
      softcell_find_dependency(${missing} render "Eigen 3.4" libeigen3-dev Eigen3 3.4 NO_MODULE)
      softcell_find_dependency(${missing} render libpng libpng-dev PNG)
    endif()
  endforeach()
endmacro()
