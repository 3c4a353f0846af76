#pragma once
// softcell bench: measures kernels and what they are compared with, in turn and in one run.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "command_line/verb.h"

namespace softcell::tool {

struct BenchOptions {
  std::string filter;                            ///< regular expression; empty: all
  int rounds = 31;                               ///< each benchmark runs once per round
  bool list = false;                             ///< print names, measure nothing
  std::optional<std::filesystem::path> compare;  ///< figures of an earlier run
  std::optional<std::filesystem::path> json;
};

/// @return the exit status: 0, or 130 when interrupted.
int run_bench(const BenchOptions& options);

std::unique_ptr<Verb> bench_verb();

}  // namespace softcell::tool
