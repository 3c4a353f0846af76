#pragma once
// The numbers of the timing model, in one place.

#include <cstdint>
#include <span>
#include <string_view>

namespace softcell::ls_sim {

/// Cycles of an SPU's clock. [CBEA] documented
inline constexpr std::uint64_t kCyclesPerSecond = 3'200'000'000;

/// docs/reference/timing.md explains each parameter and how sure its value is.
struct TimingParameters {
#define SC_TIMING_PARAMETER(name, value, unit, confidence, source, meaning) std::uint32_t name = (value);
#include "softcell/ls_sim/timing_parameters.def"
#undef SC_TIMING_PARAMETER
};

/// A row of the table.
struct TimingParameterInfo {
  std::string_view name;
  std::uint32_t value;  ///< unless a program says otherwise
  std::string_view unit, confidence, source, meaning;
};

/// In the order of the table. Any thread.
std::span<const TimingParameterInfo> timing_parameters();

}  // namespace softcell::ls_sim
