#include "shared_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <stdexcept>

#include "softcell/base/assert.h"
#include "verb/exit_status.h"

namespace softcell::tool {

CLI::Option* accept_whole_number(CLI::Option* option, std::uint64_t least, std::uint64_t most) {
  SC_ASSERT(option != nullptr && least <= most, "an option takes numbers from {} to {}", least, most);
  return option->check([=](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    // The parser would read digits after a 0 as octal.
    const bool whole = error == std::errc() && end == text.data() + text.size() && !text.starts_with('0');
    if (whole && value >= least && value <= most) return {};
    throw UsageError(
        fmt::format("{} {}: give a whole number from {} to {}", option->get_name(), text, least, most));
  });
}

void add_dma_option(CLI::App& verb, std::string& text) {
  verb.add_option("--dma", text, "When transfers finish (default: eager)")
      ->type_name("eager|lazy|random:SEED");
}

dma::Schedule parse_dma(const std::string& text) {
  try {
    return dma::parse_schedule(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError("--dma " + text + ": " + error.what());
  }
}

void add_json_option(CLI::App& verb, std::optional<std::filesystem::path>& file, const std::string& what) {
  verb.add_option("--json", file, "Write " + what + " as JSON to this file; - is standard output")
      ->type_name("FILE");
}

void add_trace_option(CLI::App& verb, std::optional<std::filesystem::path>& file) {
  verb.add_option("--trace", file,
                  "Write a trace of what happened when, which `softcell report` shows; - is standard output")
      ->type_name("FILE");
}

}  // namespace softcell::tool
