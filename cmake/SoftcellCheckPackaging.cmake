# cpack reads this first. Without these two programs CPack makes no package, or one that depends on none of its libraries.
foreach(pair dpkg-shlibdeps:dpkg-dev file:file)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 program)
  list(GET pair 1 package)
  unset(found CACHE)
  find_program(found ${program})
  if(CPACK_GENERATOR STREQUAL DEB AND NOT found)
    message(FATAL_ERROR "softcell: ${program}, with which cpack finds out what a package depends on, was not found; "
      "on Debian it is in the package ${package}.")
  endif()
endforeach()
