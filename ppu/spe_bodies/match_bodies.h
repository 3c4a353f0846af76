#pragma once
// Bodies of one model in main memory, stepped by the kernel `match`, or `match_2d` in two dimensions.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/matching/matching_plan.h"
#include "ppu/spe_bodies/match_kernel.h"
#include "ppu/spe_bodies/region_rotations.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

struct MatchSettings {
  float pull = 0;     ///< alpha / h, 1/s, not negative
  float damping = 0;  ///< k, 0..1
  // Iterations of each rotation; 2 and 2 for a fixed effort, 0 and 6 to stop by the residual. In two dimensions a rotation has a closed
  // form.
  std::uint32_t least_iterations = 0;
  std::uint32_t most_iterations = 6;

  bool operator==(const MatchSettings&) const = default;
};

/// @throws std::invalid_argument  a setting is out of its range; the message names it.
void validate(const MatchSettings& settings);

/// Used by one thread at a time. While jobs are under way, call nothing that reads or changes a body.
/// @tparam kDimension  2 or 3
template <int kDimension>
class MatchBodies {
 public:
  using Kernel = MatchKernel<kDimension>;
  using Vector = typename Kernel::Vector;  ///< what the kernel reads
  using Rotations = typename Kernel::Rotations;

  /// @throws std::runtime_error  main memory is full.
  MatchBodies(dma::AddressSpace& memory, const typename Kernel::Plan& plan, std::size_t bodies);

  std::size_t size() const { return descriptors_.size(); }
  std::span<Vector> positions(std::size_t body);   ///< metres; a step does not change them
  std::span<Vector> velocities(std::size_t body);  ///< m/s
  dma::EffectiveAddress positions_ea(std::size_t body) const {
    return positions_.ea(body * Kernel::positions_stride(header_));
  }
  /// One for each of the plan's regions, in groups of four: see KernelPlan::region_of().
  std::span<const Rotations> rotations(std::size_t body) const;
  /// The largest |axial(R^T A)| of the last step over the sum of |A|'s elements, roughly radians; 0 in two
  /// dimensions, where a rotation has a closed form.
  float residual(std::size_t body) const {
    if constexpr (kDimension == 3) return std::sqrt(result(body).residual_square);
    return 0;
  }

  /// Takes the constants of another rest shape, for all of these bodies.
  /// @pre they are of a body with the same lattice and regions as the plan's; no jobs are under way
  void set_rest(const MatchingPlan<float, kDimension>& matching);

  /// Forgets a body's rotations: its next step starts cold, as a new body's first step does.
  void reset(std::size_t body);
  /// Copies the rotations of one of `other`'s bodies. @pre both have the same plan
  void take_rotations(std::size_t body, const MatchBodies& other, std::size_t other_body);
  /// The rotations of a body, valid as long as this object. It is a template because Clang 14 instantiates members that are none together
  /// with their class, even if their `requires` is false.
  template <int kOwn = kDimension>
  RegionRotations region_rotations(std::size_t body) requires(kOwn == 3) {
    return {rotations(body), region_of_, result(body).cold};
  }

  /// Adds the jobs of one step to a chain: at most one for each body.
  /// @param settings        of each body to be stepped; a job steps bodies with the same settings
  /// @param bodies          their numbers, ascending
  /// @param bodies_per_job  a job fetches the plan once and steps at most so many bodies
  /// @throws std::length_error      the chain has no room for them.
  /// @throws std::invalid_argument  as validate().
  void add_jobs(JobChain& chain, const JobImage& match, std::span<const MatchSettings> settings,
                std::span<const std::size_t> bodies, std::size_t bodies_per_job);

  /// The same for bodies with the same settings.
  void add_jobs(JobChain& chain, const JobImage& match, const MatchSettings& settings,
                std::span<const std::size_t> bodies, std::size_t bodies_per_job) {
    alike_.assign(bodies.size(), settings);
    add_jobs(chain, match, alike_, bodies, bodies_per_job);
  }

  /// Call it after these jobs have ended without failure. @return the bodies whose positions or velocities are not finite; they are as they
  /// were before the step.
  std::vector<std::size_t> take_results();

 private:
  using Header = typename Kernel::Header;
  using Result = typename Kernel::Result;

  /// How many of `bodies`, from the first one on, one job may step.
  std::size_t bodies_of_job(std::span<const std::size_t> bodies, std::size_t bodies_per_job) const;
  /// Writes which bodies a job steps. @param first  index of the first of `bodies` among those of the step
  void write_bodies(typename Kernel::Job& job, std::span<const std::size_t> bodies, std::size_t first);

  dma::EffectiveAddress state_ea(std::size_t body) const {
    return states_.ea(body * Kernel::state_stride(header_));
  }
  std::byte* state(std::size_t body) { return states_.data() + body * Kernel::state_stride(header_); }
  const std::byte* state(std::size_t body) const { return const_cast<MatchBodies*>(this)->state(body); }
  const Result& result(std::size_t body) const { return *reinterpret_cast<const Result*>(state(body)); }
  // Writable views of the same data as the accessors above.
  Result& result(std::size_t body) { return *reinterpret_cast<Result*>(state(body)); }
  std::span<Rotations> rotations(std::size_t body);

  Header header_;
  std::vector<std::uint32_t> region_of_;  // the plan's
  dma::Buffer<std::byte> plan_, positions_, states_;
  dma::Buffer<spu::MatchBody> places_;  // of the bodies to be stepped; unused in two dimensions
  dma::Buffer<typename Kernel::Job> descriptors_;
  std::vector<MatchSettings> alike_;
  std::vector<std::size_t> stepped_;  // bodies that the jobs added last step
};

}  // namespace softcell::ppu
