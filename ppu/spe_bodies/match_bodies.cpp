#include "ppu/spe_bodies/match_bodies.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "ppu/spe_bodies/match_orchestration.h"

namespace softcell::ppu {

void validate(const MatchSettings& settings) {
  check_setting("pull", settings.pull, std::numeric_limits<float>::max());
  check_setting("damping", settings.damping, 1);
  if (settings.least_iterations > settings.most_iterations)
    throw std::invalid_argument("matching on SPEs: at least " + std::to_string(settings.least_iterations) +
                                " iterations, but at most " + std::to_string(settings.most_iterations));
}

MatchBodies::MatchBodies(dma::AddressSpace& memory, const MatchPlan& plan, std::size_t bodies)
    : header_(plan.header()),
      plan_(memory, "match plan", header_.bytes, kSpesOnlyRead),
      positions_(memory, "match positions", bodies * spu::match_positions_stride(header_),
                 of_floats(kSpesOnlyRead)),
      states_(memory, "match states", bodies * spu::match_state_stride(header_), of_floats()),
      places_(memory, "match bodies", bodies, kSpesOnlyRead),
      descriptors_(memory, "match jobs", bodies, kSpesOnlyRead) {
  std::memcpy(plan_.data(), plan.bytes().data(), header_.bytes);
  for (std::size_t b = 0; b < bodies; ++b) reset(b);
}

std::span<MatchBodies::Vector> MatchBodies::positions(std::size_t body) {
  std::byte* const at = positions_.data() + body * spu::match_positions_stride(header_);
  return {reinterpret_cast<Vector*>(at), header_.particles};
}

std::span<MatchBodies::Vector> MatchBodies::velocities(std::size_t body) {
  return {reinterpret_cast<Vector*>(state(body) + sizeof(spu::MatchResult)), header_.particles};
}

std::span<spu::MatchRotations> MatchBodies::rotations(std::size_t body) {
  std::byte* const at = state(body) + spu::match_rotations_at(header_);
  return {reinterpret_cast<spu::MatchRotations*>(at), spu::groups_of(header_.regions)};
}

std::span<const spu::MatchRotations> MatchBodies::rotations(std::size_t body) const {
  return const_cast<MatchBodies*>(this)->rotations(body);
}

void MatchBodies::reset(std::size_t body) {
  std::ranges::fill(rotations(body),
                    spu::MatchRotations{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 1, 1, 1}});
  result(body).cold = 1;
}

void MatchBodies::take_rotations(std::size_t body, const MatchBodies& other, std::size_t other_body) {
  std::ranges::copy(other.rotations(other_body), rotations(body).begin());
  result(body).cold = other.result(other_body).cold;
}

void MatchBodies::add_jobs(JobChain& chain, const JobImage& match, const MatchSettings& settings,
                           std::span<const std::size_t> bodies, std::size_t bodies_per_job) {
  validate(settings);
  stepped_.assign(bodies.begin(), bodies.end());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    places_[i].positions_ea = positions_.ea(bodies[i] * spu::match_positions_stride(header_)).value;
    places_[i].state_ea = states_.ea(bodies[i] * spu::match_state_stride(header_)).value;
  }
  for (std::size_t first = 0, number = 0; first < bodies.size(); first += bodies_per_job, ++number) {
    spu::MatchJob& job = descriptors_[number];
    job = {};
    job.plan_ea = plan_.ea().value;
    job.bodies_ea = places_.ea(first).value;
    job.body_count = static_cast<std::uint32_t>(std::min(bodies_per_job, bodies.size() - first));
    job.pull = settings.pull;
    job.damping = settings.damping;
    job.least_iterations = settings.least_iterations;
    job.most_iterations = settings.most_iterations;
    chain.add({.image = match, .argp = descriptors_.ea(number)});
  }
}

std::vector<std::size_t> MatchBodies::take_results() {
  std::vector<std::size_t> bad;
  for (const std::size_t body : stepped_)
    if (result(body).finite == 0) bad.push_back(body);
  return bad;
}

}  // namespace softcell::ppu
