#include "softcell/ppu/match_orchestrator.h"

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

MatchOrchestrator::MatchOrchestrator(dma::AddressSpace& memory, JobSystem& jobs,
                                     const ls_sim::KernelImage& match, const MatchPlan& plan,
                                     std::size_t bodies, std::size_t bodies_per_job)
    : particles_(plan.header().particles),
      region_groups_(spu::groups_of(plan.header().regions)),
      vector_stride_(stride_of<Vector>(particles_)),
      rotation_stride_(stride_of<spu::MatchRotations>(region_groups_)),
      plan_(memory, "match plan", plan.bytes().size(), kSpesOnlyRead),
      positions_(memory, "match positions", bodies * vector_stride_, kSpesOnlyRead),
      velocities_(memory, "match velocities", bodies * vector_stride_),
      rotations_(memory, "match rotations", bodies * rotation_stride_),
      results_(memory, "match results", bodies),
      bodies_(memory, "match bodies", bodies, kSpesOnlyRead),
      descriptors_(memory, "match jobs", jobs_for(bodies, bodies_per_job), kSpesOnlyRead),
      chain_(jobs, "match", jobs_for(bodies, bodies_per_job)) {
  std::memcpy(plan_.data(), plan.bytes().data(), plan.bytes().size());
  for (std::size_t b = 0; b < bodies; ++b) {
    spu::MatchBody& body = bodies_.span()[b];
    body = {};
    body.positions_ea = positions_.ea(b * vector_stride_).value;
    body.velocities_ea = velocities_.ea(b * vector_stride_).value;
    body.rotations_ea = rotations_.ea(b * rotation_stride_).value;
    body.result_ea = results_.ea(b).value;
    reset(b);
  }
  const JobImage image = jobs.place(match);
  for (std::size_t first = 0; first < bodies; first += bodies_per_job) {
    const std::size_t job = chain_.size();
    descriptors_[job] = {};
    descriptors_[job].plan_ea = plan_.ea().value;
    descriptors_[job].bodies_ea = bodies_.ea(first).value;
    descriptors_[job].body_count = static_cast<std::uint32_t>(std::min(bodies_per_job, bodies - first));
    chain_.add({.image = image, .argp = descriptors_.ea(job)});
  }
}

std::span<MatchOrchestrator::Vector> MatchOrchestrator::positions(std::size_t body) {
  return positions_.span().subspan(body * vector_stride_, particles_);
}

std::span<MatchOrchestrator::Vector> MatchOrchestrator::velocities(std::size_t body) {
  return velocities_.span().subspan(body * vector_stride_, particles_);
}

std::span<const spu::MatchRotations> MatchOrchestrator::rotations(std::size_t body) const {
  return {rotations_.data() + body * rotation_stride_, region_groups_};
}

float MatchOrchestrator::residual(std::size_t body) const { return results_.data()[body].residual; }

void MatchOrchestrator::reset(std::size_t body) {
  for (spu::MatchRotations& group : rotations_.span().subspan(body * rotation_stride_, rotation_stride_))
    group = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 1, 1, 1}};
  bodies_.span()[body].cold = 1;
}

void MatchOrchestrator::step(const MatchSettings& settings) {
  kick(settings);
  wait();
}

void MatchOrchestrator::kick(const MatchSettings& settings) {
  check_setting("pull", settings.pull, std::numeric_limits<float>::max());
  check_setting("damping", settings.damping, 1);
  if (settings.least_iterations > settings.most_iterations)
    throw std::invalid_argument("MatchOrchestrator: at least " + std::to_string(settings.least_iterations) +
                                " iterations, but at most " + std::to_string(settings.most_iterations));
  for (spu::MatchBody& body : bodies_.span()) {
    body.pull = settings.pull;
    body.damping = settings.damping;
  }
  for (spu::MatchJob& job : descriptors_.span()) {
    job.least_iterations = settings.least_iterations;
    job.most_iterations = settings.most_iterations;
  }
  chain_.kick();
  in_flight_ = true;
}

void MatchOrchestrator::wait() {
  chain_.wait();
  if (!in_flight_) return;
  in_flight_ = false;
  check_jobs(chain_);
  BadBodies bad;
  for (std::size_t b = 0; b < bodies(); ++b) {
    if (results_.data()[b].finite == 0)
      bad.add(b);
    else
      bodies_.span()[b].cold = 0;
  }
  bad.check();
}

}  // namespace softcell::ppu
