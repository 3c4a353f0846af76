#pragma once
// Bodies of one model in main memory, as the kernel `match` steps them.

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "match_job.h"
#include "ppu/plans/match_plan.h"
#include "skin_job.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

struct MatchSettings {
  float pull = 0;                      ///< alpha / h, 1/s, not negative
  float damping = 0;                   ///< k, 0..1
  std::uint32_t least_iterations = 0;  ///< of each rotation; 2 and 2 for a fixed effort,
  std::uint32_t most_iterations = 6;   ///< 0 and 6 to go by the residual
};

/// @throws std::invalid_argument  a setting is out of its range; the sentence names it.
void validate(const MatchSettings& settings);

/// Used by one thread at a time. While jobs are under way nothing may be read or changed.
class MatchBodies {
 public:
  using Vector = spu::SkinCorner;  ///< x y z 0: what the kernels read

  /// @throws std::runtime_error  main memory is full.
  MatchBodies(dma::AddressSpace& memory, const MatchPlan& plan, std::size_t bodies);

  std::size_t size() const { return places_.size(); }
  std::span<Vector> positions(std::size_t body);   ///< metres; a step does not change them
  std::span<Vector> velocities(std::size_t body);  ///< m/s
  /// Of the plan's regions, in groups of four: see MatchPlan::region_of().
  std::span<const spu::MatchRotations> rotations(std::size_t body) const;
  /// The largest |axial(R^T A)| of the last step over the sum of |A|'s elements, roughly radians.
  float residual(std::size_t body) const { return std::sqrt(result(body).residual_square); }

  /// Forgets a body's rotations: its next step starts cold. That is also how a body begins.
  void reset(std::size_t body);
  /// Takes the rotations of one of `other`'s bodies. @pre both have the same plan
  void take_rotations(std::size_t body, const MatchBodies& other, std::size_t other_body);

  /// Adds the jobs of one step to a chain.
  /// @param bodies          numbers of the bodies to be stepped, ascending
  /// @param bodies_per_job  a job fetches the plan once and steps so many bodies
  /// @throws std::length_error  the chain has no room for ceil(bodies / bodies_per_job) more.
  void add_jobs(JobChain& chain, const JobImage& match, const MatchSettings& settings,
                std::span<const std::size_t> bodies, std::size_t bodies_per_job);

  /// After these jobs have ended well. @return the bodies whose positions or velocities are no finite
  /// numbers; they are as they were before the step.
  std::vector<std::size_t> take_results();

 private:
  std::byte* state(std::size_t body) { return states_.data() + body * spu::match_state_stride(header_); }
  const std::byte* state(std::size_t body) const { return const_cast<MatchBodies*>(this)->state(body); }
  const spu::MatchResult& result(std::size_t body) const {
    return *reinterpret_cast<const spu::MatchResult*>(state(body));
  }
  /// Writable views of what the accessors above show.
  spu::MatchResult& result(std::size_t body) { return *reinterpret_cast<spu::MatchResult*>(state(body)); }
  std::span<spu::MatchRotations> rotations(std::size_t body);

  spu::MatchPlanHeader header_;
  dma::Buffer<std::byte> plan_, positions_, states_;
  dma::Buffer<spu::MatchBody> places_;      // of the bodies to be stepped
  dma::Buffer<spu::MatchJob> descriptors_;  // at most one for each body
  std::vector<std::size_t> stepped_;        // by the jobs added last
};

}  // namespace softcell::ppu
