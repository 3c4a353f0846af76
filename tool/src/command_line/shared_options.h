#pragma once
// The options that several verbs have, and the values that they allow.

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

/// The most orders of DMA that a verb tries, random:1 to random:SEEDS.
inline constexpr std::uint64_t kMaxSeeds = 1'000'000'000;

/// Makes the option accept only a whole number in decimal digits from `least`, which is above 0, to `most`.
/// @return the option
CLI::Option* accept_whole_number(CLI::Option* option, std::uint64_t least, std::uint64_t most);

/// Adds --dma; parse_dma() reads its value.
void add_dma_option(CLI::App& verb, std::string& text);
/// @throws UsageError
dma::Schedule parse_dma(const std::string& text);

/// Adds --json, whose value "-" is standard output. @param what  the option writes: "the table".
void add_json_option(CLI::App& verb, std::optional<std::filesystem::path>& file, const std::string& what);

/// Adds --trace, likewise.
void add_trace_option(CLI::App& verb, std::optional<std::filesystem::path>& file);

}  // namespace softcell::tool
