#include "settings.h"

#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace softcell::libspe2 {
namespace {

constexpr std::string_view kProcess = "%p";  // in the name of a file

std::string_view value_of(const char* variable) {
  const char* const value = std::getenv(variable);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

[[noreturn]] void refuse(std::string_view variable, std::string_view value, std::string_view expected) {
  throw std::runtime_error("the environment variable " + std::string(variable) + " is '" +
                           std::string(value) + "'; expected is " + std::string(expected));
}

bool switch_of(const char* variable) {
  const std::string_view value = value_of(variable);
  if (value == "1") return true;
  if (!value.empty() && value != "0") refuse(variable, value, "0 or 1");
  return false;
}

/// The name of a file, with the number of the process in place of %p.
std::string file_of(const char* variable) {
  std::string name(value_of(variable));
  if (const auto at = name.find(kProcess); at != std::string::npos)
    name.replace(at, kProcess.size(), std::to_string(getpid()));
  return name;
}

std::chrono::milliseconds milliseconds_of(const char* variable) {
  const std::string_view value = value_of(variable);
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (!value.empty() && (error != std::errc() || end != value.data() + value.size()))
    refuse(variable, value, "a number of milliseconds, 0 to 4294967295");
  return std::chrono::milliseconds(number);
}

}  // namespace

Settings settings_from_environment() {
  Settings settings;
  if (const std::string_view schedule = value_of("SOFTCELL_DMA"); !schedule.empty()) {
    try {
      settings.schedule = dma::parse_schedule(schedule);
    } catch (const std::invalid_argument&) {
      refuse("SOFTCELL_DMA", schedule, "eager, lazy or random:SEED");
    }
  }
  settings.turns = switch_of("SOFTCELL_TURNS");
  settings.checked = switch_of("SOFTCELL_CHECKED");
  settings.deadline = milliseconds_of("SOFTCELL_DEADLINE_MS");
  settings.trace_file = file_of("SOFTCELL_TRACE");
  settings.report_file = file_of("SOFTCELL_REPORT");
  return settings;
}

}  // namespace softcell::libspe2
