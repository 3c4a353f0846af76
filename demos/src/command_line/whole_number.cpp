#include "whole_number.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "../usage_error.h"

namespace softcell::demos {

CLI::Option* take_whole_number(CLI::Option* option, std::uint64_t least, std::uint64_t most) {
  return option->check([=](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    // The parser reads digits behind a 0 as octal ones.
    const bool whole = error == std::errc() && end == text.data() + text.size() && !text.starts_with('0');
    if (whole && value >= least && value <= most) return {};
    throw UsageError(
        fmt::format("{} {}: give a whole number from {} to {}", option->get_name(), text, least, most));
  });
}

}  // namespace softcell::demos
