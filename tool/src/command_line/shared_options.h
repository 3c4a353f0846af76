#pragma once
// Options that several verbs have, and what is allowed behind them.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "softcell/dma/schedule.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace softcell::tool {

/// The most orders of DMA, random:1 to random:SEEDS, that a verb tries.
inline constexpr std::uint64_t kMaxSeeds = 1'000'000'000;

/// Makes the option accept only a whole number in decimal digits from `least`, which is above 0, to `most`.
/// @return the option
CLI::Option* accept_whole_number(CLI::Option* option, std::uint64_t least, std::uint64_t most);

/// --dma; parse_dma() reads what it was given.
void add_dma_option(CLI::App& verb, std::string& text);
/// @throws UsageError
dma::Schedule parse_dma(const std::string& text);

/// --json, "-" for standard output. @param what  is written: "the table".
void add_json_option(CLI::App& verb, std::optional<std::filesystem::path>& file, const std::string& what);

/// --trace, likewise
void add_trace_option(CLI::App& verb, std::optional<std::filesystem::path>& file);

}  // namespace softcell::tool
