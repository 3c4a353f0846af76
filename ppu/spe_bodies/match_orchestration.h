#pragma once
// What the code that runs the kernels match, match_tiles and match_2d shares.

#include <stdexcept>
#include <string>

#include "softcell/base/text.h"
#include "softcell/dma/address_space.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

inline constexpr dma::BufferOptions kSpesOnlyRead{.spe_access = dma::SpeAccess::kRead};

/// The options of a buffer of bytes that holds 32-bit words.
inline dma::BufferOptions of_floats(dma::BufferOptions options = {}) {
  options.element_bytes = sizeof(float);
  return options;
}

/// @throws std::invalid_argument  `value` is not within 0..most.
inline void check_setting(const char* name, float value, float most) {
  if (!(value >= 0 && value <= most))
    throw std::invalid_argument(std::string("matching on SPEs: ") + name + " " + base::shortest(value) +
                                ": expected a finite number of 0 or more" +
                                (most == 1 ? std::string(", at most 1") : std::string()));
}

/// @throws std::runtime_error  a job of the chain's last kick failed.
inline void check_jobs(const JobChain& chain) {
  std::string failures;
  for (const JobFailure& failure : chain.failures()) failures += "; " + failure.message;
  if (!failures.empty()) throw std::runtime_error("stepping soft bodies failed" + failures);
}

}  // namespace softcell::ppu
