#pragma once
// softcell run: runs a program that uses libspe2.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/verb.h"

namespace softcell::tool {

struct RunOptions {
  std::vector<std::string> words;  ///< the program and its arguments
  std::string dma = "eager";
  bool dma_is_given = false;  ///< on the command line
  bool turns = false, checked = false, allocations = false, low_memory = false, quiet = false;
  std::string deadline;     ///< seconds; empty: the default for `turns` and `seeds`
  std::uint64_t seeds = 0;  ///< 0: one run
  std::optional<std::filesystem::path> trace, json;
};

int run_program(const RunOptions& options);

std::unique_ptr<Verb> run_verb();

}  // namespace softcell::tool
