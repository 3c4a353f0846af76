#pragma once
// What the orchestrators of the kernels match, match_tiles and match_2d share.

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "softcell/dma/address_space.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

inline constexpr dma::BufferOptions kSpesOnlyRead{.spe_access = dma::SpeAccess::kRead};

/// Of a buffer of bytes that holds words.
inline dma::BufferOptions of_floats(dma::BufferOptions options = {}) {
  options.element_bytes = sizeof(float);
  return options;
}

inline std::size_t jobs_for(std::size_t bodies, std::size_t bodies_per_job) {
  return (bodies + bodies_per_job - 1) / bodies_per_job;
}

/// @throws std::invalid_argument  `value` is not within 0..most.
inline void check_setting(const char* name, float value, float most) {
  if (!(value >= 0 && value <= most))
    throw std::invalid_argument(std::string("matching on SPEs: ") + name + " " + std::to_string(value) +
                                ": expected a finite number of 0 or more" +
                                (most == 1 ? std::string(", at most 1") : std::string()));
}

/// @throws std::runtime_error  a job of the chain's last kick failed.
inline void check_jobs(const JobChain& chain) {
  std::string failures;
  for (const JobFailure& failure : chain.failures()) failures += "; " + failure.message;
  if (!failures.empty()) throw std::runtime_error("stepping soft bodies failed" + failures);
}

/// Waits for the chain. @param in_flight  whether a step was kicked that nobody has waited for; false then
/// @return  its value before: there is something to take back. @throws as check_jobs()
inline bool take_back(JobChain& chain, bool& in_flight) {
  chain.wait();
  if (!std::exchange(in_flight, false)) return false;
  check_jobs(chain);
  return true;
}

/// Bodies whose data are no numbers.
class BadBodies {
 public:
  void add(std::size_t body) { names_ += (names_.empty() ? "" : ", ") + std::to_string(body); }

  /// @throws std::runtime_error  there are any.
  void check() const {
    if (!names_.empty())
      throw std::runtime_error("soft bodies with positions or velocities that are not finite numbers: " +
                               names_);
  }

 private:
  std::string names_;
};

}  // namespace softcell::ppu
