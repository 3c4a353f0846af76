#pragma once
// Compiles sources to objects. An object contains both builds of its code; the checked one, which calls softcell before each load and
// store, is in its section .softcell.checked.

#include <filesystem>
#include <map>
#include <string>

#include "options.h"
#include "places.h"
#include "process.h"

namespace softcell::toolchain {

inline constexpr const char kCheckedSection[] = ".softcell.checked";

/// Standard input is read once; both builds are compiled from what was read. Call it before compile().
void save_standard_input(const Options& options, ScratchFolder& scratch);

/// Compiles one source. @param dependent  what the dependencies of -MD are of: the object, or the program of which it becomes a part.
/// @throws Failed  the compiler has printed why.
void compile(const Input& source, const std::filesystem::path& object, const std::filesystem::path& dependent,
             const Options& options, const Places& places, ScratchFolder& scratch);

/// The files that -MD writes: the compiler writes one for each source, also where the sources of a call have the same.
class Dependencies {
 public:
  /// Puts what the earlier sources depend on back before what compile() has written last.
  void join(const Options& options, const std::filesystem::path& dependent);

 private:
  std::map<std::filesystem::path, std::string> rules_;
};

/// -E and -M: runs the preprocessor on the sources.
void preprocess(const Options& options, const Places& places);

/// Adds a file to an object as a section of its own.
void add_section(const std::filesystem::path& object, const std::string& section,
                 const std::filesystem::path& file);

}  // namespace softcell::toolchain
