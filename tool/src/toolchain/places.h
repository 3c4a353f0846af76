#pragma once
// Where the commands find what they use of softcell and of the host.

#include <filesystem>
#include <string>
#include <string_view>

#include "process.h"

namespace softcell::toolchain {

struct Places {
  std::filesystem::path sdk;
  std::filesystem::path library, checked_library, access_reports;  ///< archives
  std::filesystem::path vector_casts;                              ///< a program
  std::string compiler;          ///< for C and C++; the variable SOFTCELL_CXX overrides it
  std::string compiler_headers;  ///< folder of the compiler's own headers, such as stddef.h
};

/// @throws std::runtime_error  softcell is not complete, or there is no compiler; one sentence.
Places find_places();

/// The flags of a list with one flag per line, with the places filled in.
Words flags_of(std::string_view lines, const Places& places);

}  // namespace softcell::toolchain
