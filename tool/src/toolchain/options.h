#pragma once
// Parses the command line of an SPU compiler.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "process.h"

namespace softcell::toolchain {

enum class Language : std::uint8_t { kC, kCxx };

struct Input {
  std::string file;
  std::optional<Language> language;  ///< none: input for the linker
};

/// The last step that the compiler takes; kCheck compiles and writes nothing.
enum class Step : std::uint8_t { kDependencies, kPreprocess, kCheck, kCompile, kLink };

struct Options {
  Step step = Step::kLink;
  std::optional<std::string> output;
  std::vector<Input> inputs;  ///< in order; among them libraries of -l, as the files that were found for them
  Words preprocessor;         ///< -I, -D, -M..., for the preprocessor
  Words macros;               ///< -dM and the like, for -E only
  Words compiler;             ///< warnings and options of the language
  /// Of C++ sources, unless `compiler` has another one. Like an SPU's compiler, it knows GNU's words.
  std::string cxx_standard = "-std=gnu++17";
  bool older_cxx = false;                    ///< -std= names an older C++ than there is
  Words linker;                              ///< -Map and the like, in the form that ld takes
  Words symbols;                             ///< --defsym and --wrap, which each build needs
  std::optional<std::uint32_t> stack_bytes;  ///< -Wl,-z,stack-size=BYTES
  bool relocatable = false;                  ///< -r
  bool verbose = false;
  Words meaningless;  ///< options that have no meaning here
  Words notes;        ///< sentences on options that cannot be followed
};

/// Parses the options of the compiler. @param language  of standard input and of `.c` files: for softcell-spu-g++ it is C++.
/// @throws std::invalid_argument  one sentence: a file cannot be used, or an option cannot be followed.
Options parse_compiler_options(const Words& words, Language language);

/// Parses the options of ld.
Options parse_linker_options(const Words& words);

/// Prints once which options have no meaning or cannot be followed, unless SOFTCELL_QUIET is set.
void report_meaningless(const std::string& command, const Options& options);

}  // namespace softcell::toolchain
