#include "ppu/spe_bodies/match_bodies.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "ppu/spe_bodies/match_orchestration.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// The name of a buffer of this kernel.
template <int kDimension>
std::string name_of(const char* what) {
  return std::string(MatchKernel<kDimension>::kName) + " " + what;
}

}  // namespace

void validate(const MatchSettings& settings) {
  check_setting("pull", settings.pull, std::numeric_limits<float>::max());
  check_setting("damping", settings.damping, 1);
  if (settings.least_iterations > settings.most_iterations)
    throw std::invalid_argument("matching on SPEs: at least " + std::to_string(settings.least_iterations) +
                                " iterations, but at most " + std::to_string(settings.most_iterations));
}

template <int kDimension>
MatchBodies<kDimension>::MatchBodies(dma::AddressSpace& memory, const typename Kernel::Plan& plan,
                                     std::size_t bodies)
    : header_(plan.header()),
      region_of_(plan.region_of().begin(), plan.region_of().end()),
      plan_(memory, name_of<kDimension>("plan"), header_.bytes, of_record(plan.record(), kSpesOnlyRead)),
      positions_(memory, name_of<kDimension>("positions"), bodies * Kernel::positions_stride(header_),
                 of_floats(kSpesOnlyRead)),
      states_(memory, name_of<kDimension>("states"), bodies * Kernel::state_stride(header_), of_floats()),
      places_(memory, name_of<kDimension>("bodies"), kDimension == 3 ? bodies : 1,
              of_record(kMatchBodyRecord, kSpesOnlyRead)),
      descriptors_(memory, name_of<kDimension>("jobs"), bodies,
                   of_record(Kernel::kJobRecord, kSpesOnlyRead)) {
  std::memcpy(plan_.data(), plan.bytes().data(), header_.bytes);
  for (std::size_t b = 0; b < bodies; ++b) reset(b);
}

template <int kDimension>
void MatchBodies<kDimension>::set_rest(const MatchingPlan<float, kDimension>& matching) {
  SC_ASSERT(matching.particles() == header_.particles && matching.regions() == header_.regions,
            "a rest shape of {} particles and {} regions in a plan of {} and {}", matching.particles(),
            matching.regions(), header_.particles, header_.regions);
  auto* const particles =
      reinterpret_cast<typename Kernel::Particles*>(plan_.data() + header_.particle_constants);
  auto* const regions = reinterpret_cast<typename Kernel::Regions*>(plan_.data() + header_.region_constants);
  for (std::uint32_t i = 0; i < header_.particles; ++i) {
    Kernel::set_rest(particles[i / 4], i % 4, matching.particle_constants()[i]);
    const std::uint32_t place = region_of_[i];
    Kernel::set_rest(regions[place / 4], place % 4,
                     matching.region_constants()[matching.sums().region_of()[i]]);
  }
}

template <int kDimension>
auto MatchBodies<kDimension>::positions(std::size_t body) -> std::span<Vector> {
  SC_ASSERT(body < size(), "positions of body {} of {}", body, size());
  std::byte* const at = positions_.data() + body * Kernel::positions_stride(header_);
  return {reinterpret_cast<Vector*>(at), header_.particles};
}

template <int kDimension>
auto MatchBodies<kDimension>::velocities(std::size_t body) -> std::span<Vector> {
  SC_ASSERT(body < size(), "velocities of body {} of {}", body, size());
  return {reinterpret_cast<Vector*>(state(body) + sizeof(Result)), header_.particles};
}

template <int kDimension>
auto MatchBodies<kDimension>::rotations(std::size_t body) -> std::span<Rotations> {
  SC_ASSERT(body < size(), "rotations of body {} of {}", body, size());
  std::byte* const at = state(body) + Kernel::rotations_at(header_);
  return {reinterpret_cast<Rotations*>(at), spu::groups_of(header_.regions)};
}

template <int kDimension>
auto MatchBodies<kDimension>::rotations(std::size_t body) const -> std::span<const Rotations> {
  return const_cast<MatchBodies*>(this)->rotations(body);
}

template <int kDimension>
void MatchBodies<kDimension>::reset(std::size_t body) {
  std::ranges::fill(rotations(body), Kernel::kUnturned);
  if constexpr (kDimension == 3) result(body).cold = 1;
}

template <int kDimension>
void MatchBodies<kDimension>::take_rotations(std::size_t body, const MatchBodies& other,
                                             std::size_t other_body) {
  SC_ASSERT(header_.particles == other.header_.particles && header_.regions == other.header_.regions,
            "bodies of {} particles and {} regions, and of {} and {}, have not the same plan",
            header_.particles, header_.regions, other.header_.particles, other.header_.regions);
  std::ranges::copy(other.rotations(other_body), rotations(body).begin());
  if constexpr (kDimension == 3) result(body).cold = other.result(other_body).cold;
}

/// The kernel match_2d steps bodies that lie one after the other in memory.
template <>
std::size_t MatchBodies<2>::bodies_of_job(std::span<const std::size_t> bodies,
                                          std::size_t bodies_per_job) const {
  std::size_t count = 1;
  while (count < bodies.size() && count < bodies_per_job && bodies[count] == bodies[0] + count) ++count;
  return count;
}

template <>
void MatchBodies<2>::write_bodies(spu::MatchJob2d& job, std::span<const std::size_t> bodies, std::size_t) {
  job.positions_ea = positions_ea(bodies[0]).value;
  job.states_ea = state_ea(bodies[0]).value;
}

/// The kernel match is told where each body lies.
template <>
std::size_t MatchBodies<3>::bodies_of_job(std::span<const std::size_t> bodies,
                                          std::size_t bodies_per_job) const {
  return std::min(bodies_per_job, bodies.size());
}

template <>
void MatchBodies<3>::write_bodies(spu::MatchJob& job, std::span<const std::size_t> bodies,
                                  std::size_t first) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    places_[first + i].positions_ea = positions_ea(bodies[i]).value;
    places_[first + i].state_ea = state_ea(bodies[i]).value;
  }
  job.bodies_ea = places_.ea(first).value;
}

template <int kDimension>
void MatchBodies<kDimension>::add_jobs(JobChain& chain, const JobImage& match,
                                       std::span<const MatchSettings> settings,
                                       std::span<const std::size_t> bodies, std::size_t bodies_per_job) {
  for (const MatchSettings& of_body : settings) validate(of_body);
  SC_ASSERT(settings.size() == bodies.size(), "settings of {} bodies of {}", settings.size(), bodies.size());
  SC_ASSERT(bodies_per_job > 0, "jobs of {} bodies", bodies_per_job);
  SC_ASSERT(std::ranges::adjacent_find(bodies, std::ranges::greater_equal()) == bodies.end(),
            "the numbers of {} bodies do not ascend", bodies.size());
  SC_ASSERT(bodies.empty() || bodies.back() < size(), "body {} of {}", bodies.back(), size());
  stepped_.assign(bodies.begin(), bodies.end());
  for (std::size_t first = 0, number = 0; first < bodies.size(); ++number) {
    const MatchSettings& of_job = settings[first];
    const auto other =
        std::ranges::find_if(settings.subspan(first), [&](const MatchSettings& s) { return s != of_job; });
    const auto alike = static_cast<std::size_t>(other - settings.subspan(first).begin());
    const std::size_t count = bodies_of_job(bodies.subspan(first, alike), bodies_per_job);
    typename Kernel::Job& job = descriptors_[number];
    job = {};
    job.plan_ea = plan_.ea().value;
    write_bodies(job, bodies.subspan(first, count), first);
    job.body_count = static_cast<std::uint32_t>(count);
    job.pull = of_job.pull;
    job.damping = of_job.damping;
    if constexpr (kDimension == 3) {
      job.least_iterations = of_job.least_iterations;
      job.most_iterations = of_job.most_iterations;
    }
    chain.add({.image = match, .argp = descriptors_.ea(number)});
    first += count;
  }
}

template <int kDimension>
std::vector<std::size_t> MatchBodies<kDimension>::take_results() {
  std::vector<std::size_t> bad;
  for (const std::size_t body : stepped_)
    if (result(body).finite == 0) bad.push_back(body);
  return bad;
}

template class MatchBodies<2>;
template class MatchBodies<3>;

}  // namespace softcell::ppu
