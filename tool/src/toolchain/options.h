#pragma once
// The command line of an SPU compiler.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "process.h"

namespace softcell::toolchain {

enum class Language : std::uint8_t { kC, kCxx };

struct Input {
  std::string file;
  std::optional<Language> language;  ///< none: for the linker
};

/// How far the compiler is to go.
enum class Step : std::uint8_t { kDependencies, kPreprocess, kCompile, kLink };

struct Options {
  Step step = Step::kLink;
  std::optional<std::string> output;
  std::vector<Input> inputs;  ///< in order; libraries of -l among them, as the files that they are
  Words preprocessor;         ///< -I, -D, -M..., for the first step
  Words compiler;             ///< warnings and the language
  Words linker;               ///< -Map and the like, as ld takes them
  std::optional<std::uint32_t> stack_bytes;  ///< -Wl,-z,stack-size=BYTES
  bool relocatable = false;                  ///< -r
  bool verbose = false;
  Words meaningless;  ///< options that have no meaning here
};

/// The options of the compiler. @param language  of standard input and `.c`: softcell-spu-g++ takes C++.
/// @throws std::invalid_argument  one sentence: a file that cannot be used, an option that cannot be followed.
Options parse_compiler_options(const Words& words, Language language);

/// The options of ld.
Options parse_linker_options(const Words& words);

/// Says once that options have no meaning, unless SOFTCELL_QUIET is set.
void note_meaningless(const std::string& command, const Options& options);

}  // namespace softcell::toolchain
