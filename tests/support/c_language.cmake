# C in a folder. A C compiler of another make would take over the extension of precompiled headers.
set(extension_of_precompiled_headers "${CMAKE_PCH_EXTENSION}")
enable_language(C)
set(CMAKE_PCH_EXTENSION "${extension_of_precompiled_headers}")
if(SOFTCELL_CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()
find_package(Threads REQUIRED)
