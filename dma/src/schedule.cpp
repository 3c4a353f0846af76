#include "softcell/dma/schedule.h"

#include <charconv>
#include <stdexcept>

namespace softcell::dma {

Schedule parse_schedule(std::string_view text) {
  if (text == "eager") return {.kind = Schedule::kEager};
  if (text == "lazy") return {.kind = Schedule::kLazy};

  constexpr std::string_view kPrefix = "random:";
  if (text.starts_with(kPrefix)) {
    const std::string_view digits = text.substr(kPrefix.size());
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seed);
    if (error == std::errc{} && end == digits.data() + digits.size()) return {Schedule::kRandom, seed};
  }
  throw std::invalid_argument("DMA schedule '" + std::string(text) +
                              "' is not known; allowed are eager, lazy and random:SEED with SEED from 0 to "
                              "18446744073709551615");
}

std::string to_string(const Schedule& schedule) {
  switch (schedule.kind) {
    case Schedule::kEager:
      return "eager";
    case Schedule::kLazy:
      return "lazy";
    case Schedule::kRandom:
      return "random:" + std::to_string(schedule.seed);
  }
  return {};
}

}  // namespace softcell::dma
