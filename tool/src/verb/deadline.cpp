#include "deadline.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "exit_status.h"

namespace softcell::tool {

std::chrono::milliseconds parse_deadline(const std::string& text) {
  constexpr double kLeastSeconds = 0.001, kMostSeconds = 86'400;
  double seconds = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, seconds);
  if (error != std::errc() || rest != end || !(seconds >= kLeastSeconds) || seconds > kMostSeconds)
    throw UsageError("--deadline " + text + ": give seconds from 0.001 to 86400");
  return std::chrono::milliseconds(std::lround(seconds * 1000));
}

}  // namespace softcell::tool
