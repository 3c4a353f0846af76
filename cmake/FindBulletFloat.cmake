# Bullet as its default package builds it, in single precision. Target BulletFloat::Bullet, and with Bullet's own soft
# bodies BulletFloat::SoftBody.
#
# Debian also ships bullet-float64, with the same headers and other library names; a program that mixes the two
# compiles, links and corrupts memory. So the package is asked for by name, and one that turns out to be in double
# precision is refused.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PC_BULLET QUIET bullet)
endif()
if("-DBT_USE_DOUBLE_PRECISION" IN_LIST PC_BULLET_CFLAGS_OTHER)
  message(FATAL_ERROR "pkg-config's package 'bullet' is built in double precision; softcell needs single precision")
endif()

find_path(BulletFloat_INCLUDE_DIR btBulletDynamicsCommon.h HINTS ${PC_BULLET_INCLUDE_DIRS} PATH_SUFFIXES bullet)
set(bullet_libraries)
foreach(library BulletSoftBody BulletDynamics BulletCollision LinearMath)  # in link order
  find_library(BulletFloat_${library}_LIBRARY ${library} HINTS ${PC_BULLET_LIBRARY_DIRS})
  mark_as_advanced(BulletFloat_${library}_LIBRARY)
  list(APPEND bullet_libraries BulletFloat_${library}_LIBRARY)
endforeach()
mark_as_advanced(BulletFloat_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletFloat
  REQUIRED_VARS ${bullet_libraries} BulletFloat_INCLUDE_DIR VERSION_VAR PC_BULLET_VERSION)

if(BulletFloat_FOUND AND NOT TARGET BulletFloat::Bullet)
  add_library(BulletFloat::Bullet INTERFACE IMPORTED)
  # SYSTEM: its headers would not pass our warnings.
  target_include_directories(BulletFloat::Bullet SYSTEM INTERFACE ${BulletFloat_INCLUDE_DIR})
  target_link_libraries(BulletFloat::Bullet INTERFACE
    ${BulletFloat_BulletDynamics_LIBRARY} ${BulletFloat_BulletCollision_LIBRARY} ${BulletFloat_LinearMath_LIBRARY})
  add_library(BulletFloat::SoftBody INTERFACE IMPORTED)
  target_link_libraries(BulletFloat::SoftBody INTERFACE ${BulletFloat_BulletSoftBody_LIBRARY} BulletFloat::Bullet)
endif()
