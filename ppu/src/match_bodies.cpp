#include "softcell/ppu/match_bodies.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "match_orchestration.h"

namespace softcell::ppu {

namespace {

constexpr std::size_t kLine = 128;

/// Elements in whole lines: every body's data begin on one.
template <typename T>
std::size_t stride_of(std::size_t count) {
  static_assert(kLine % sizeof(T) == 0);
  constexpr std::size_t kPerLine = kLine / sizeof(T);
  return (count + kPerLine - 1) / kPerLine * kPerLine;
}

}  // namespace

void validate(const MatchSettings& settings) {
  check_setting("pull", settings.pull, std::numeric_limits<float>::max());
  check_setting("damping", settings.damping, 1);
  if (settings.least_iterations > settings.most_iterations)
    throw std::invalid_argument("matching on SPEs: at least " + std::to_string(settings.least_iterations) +
                                " iterations, but at most " + std::to_string(settings.most_iterations));
}

MatchBodies::MatchBodies(dma::AddressSpace& memory, const MatchPlan& plan, std::size_t bodies)
    : particles_(plan.header().particles),
      region_groups_(spu::groups_of(plan.header().regions)),
      vector_stride_(stride_of<Vector>(particles_)),
      rotation_stride_(stride_of<spu::MatchRotations>(region_groups_)),
      plan_(memory, "match plan", plan.bytes().size(), kSpesOnlyRead),
      positions_(memory, "match positions", bodies * vector_stride_, kSpesOnlyRead),
      velocities_(memory, "match velocities", bodies * vector_stride_),
      rotations_(memory, "match rotations", bodies * rotation_stride_),
      results_(memory, "match results", bodies),
      lines_(memory, "match bodies", bodies, kSpesOnlyRead),
      descriptors_(memory, "match jobs", bodies, kSpesOnlyRead),
      cold_(bodies) {
  std::memcpy(plan_.data(), plan.bytes().data(), plan.bytes().size());
  for (std::size_t b = 0; b < bodies; ++b) reset(b);
}

std::span<MatchBodies::Vector> MatchBodies::positions(std::size_t body) {
  return positions_.span().subspan(body * vector_stride_, particles_);
}

std::span<MatchBodies::Vector> MatchBodies::velocities(std::size_t body) {
  return velocities_.span().subspan(body * vector_stride_, particles_);
}

std::span<const spu::MatchRotations> MatchBodies::rotations(std::size_t body) const {
  return {rotations_.data() + body * rotation_stride_, region_groups_};
}

void MatchBodies::reset(std::size_t body) {
  for (spu::MatchRotations& group : rotations_.span().subspan(body * rotation_stride_, rotation_stride_))
    group = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 1, 1, 1}};
  cold_[body] = true;
}

void MatchBodies::take_rotations(std::size_t body, const MatchBodies& other, std::size_t other_body) {
  const std::span<const spu::MatchRotations> from = other.rotations(other_body);
  std::copy(from.begin(), from.end(), rotations_.data() + body * rotation_stride_);
  cold_[body] = other.cold_[other_body];
}

void MatchBodies::add_jobs(JobChain& chain, const JobImage& match, const MatchSettings& settings,
                           std::span<const std::size_t> bodies, std::size_t bodies_per_job) {
  validate(settings);
  stepped_.assign(bodies.begin(), bodies.end());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::size_t body = bodies[i];
    lines_[i] = {};
    lines_[i].positions_ea = positions_.ea(body * vector_stride_).value;
    lines_[i].velocities_ea = velocities_.ea(body * vector_stride_).value;
    lines_[i].rotations_ea = rotations_.ea(body * rotation_stride_).value;
    lines_[i].result_ea = results_.ea(body).value;
    lines_[i].pull = settings.pull;
    lines_[i].damping = settings.damping;
    lines_[i].cold = cold_[body] ? 1 : 0;
  }
  for (std::size_t first = 0, job = 0; first < bodies.size(); first += bodies_per_job, ++job) {
    descriptors_[job] = {};
    descriptors_[job].plan_ea = plan_.ea().value;
    descriptors_[job].bodies_ea = lines_.ea(first).value;
    descriptors_[job].body_count =
        static_cast<std::uint32_t>(std::min(bodies_per_job, bodies.size() - first));
    descriptors_[job].least_iterations = settings.least_iterations;
    descriptors_[job].most_iterations = settings.most_iterations;
    chain.add({.image = match, .argp = descriptors_.ea(job)});
  }
}

std::vector<std::size_t> MatchBodies::take_results() {
  std::vector<std::size_t> bad;
  for (const std::size_t body : stepped_) {
    if (results_.data()[body].finite == 0)
      bad.push_back(body);
    else
      cold_[body] = false;
  }
  return bad;
}

}  // namespace softcell::ppu
