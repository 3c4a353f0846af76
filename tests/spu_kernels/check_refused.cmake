# cmake -DSOURCE=<file> -P check_refused.cmake -- <compiler and its arguments>
# Succeeds when the compiler fails and its output matches the regular expression in the first line of SOURCE.

file(STRINGS ${SOURCE} first_line LIMIT_COUNT 1)
if(NOT first_line MATCHES "^// refused: (.+)$")
  message(FATAL_ERROR "${SOURCE}: the first line must be `// refused: <regular expression>`")
endif()
set(expected "${CMAKE_MATCH_1}")

include(${CMAKE_CURRENT_LIST_DIR}/command_behind_dashes.cmake)
command_behind_dashes(command)

set(ENV{LC_ALL} C)  # messages in English, quotes in ASCII
execute_process(COMMAND ${command} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles, but a real SPU compiler refuses it: ${expected}")
endif()
# The message only: the compiler also quotes the source and names its file.
string(REGEX MATCHALL "error: [^\n]*" errors "${output}")
if(NOT errors MATCHES "${expected}")
  message(FATAL_ERROR "${SOURCE} is refused, but not for the reason expected.\nExpected: ${expected}\n${output}")
endif()
