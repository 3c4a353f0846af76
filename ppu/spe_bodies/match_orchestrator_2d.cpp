#include "ppu/spe_bodies/match_orchestrator_2d.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "ppu/spe_bodies/match_orchestration.h"

namespace softcell::ppu {

namespace {

std::size_t jobs_for(std::size_t bodies, std::size_t bodies_per_job) {
  return (bodies + bodies_per_job - 1) / bodies_per_job;
}

/// Waits for the chain. @param in_flight  whether a step was kicked that nobody has waited for; false then
/// @return  its value before: there is something to take back. @throws as check_jobs()
bool take_back(JobChain& chain, bool& in_flight) {
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

std::size_t jobs_for_all(std::span<const MatchOrchestrator2d::Model> models, std::size_t bodies_per_job) {
  std::size_t jobs = 0;
  for (const MatchOrchestrator2d::Model& model : models) jobs += jobs_for(model.bodies, bodies_per_job);
  return jobs;
}

}  // namespace

MatchOrchestrator2d::Bodies::Bodies(dma::AddressSpace& memory, const Model& model, std::size_t bodies_per_job)
    : bodies(model.bodies),
      header(model.plan->header()),
      plan(memory, "match_2d plan", header.bytes, kSpesOnlyRead),
      positions(memory, "match_2d positions", bodies * spu::match_2d_positions_stride(header),
                of_floats(kSpesOnlyRead)),
      states(memory, "match_2d states", bodies * spu::match_2d_state_stride(header), of_floats()),
      jobs(memory, "match_2d jobs", jobs_for(bodies, bodies_per_job), kSpesOnlyRead) {
  std::memcpy(plan.data(), model.plan->bytes().data(), header.bytes);
  for (std::size_t job = 0; job < jobs.size(); ++job) {
    const std::size_t first = job * bodies_per_job;
    jobs[job] = {};
    jobs[job].plan_ea = plan.ea().value;
    jobs[job].positions_ea = positions.ea(first * spu::match_2d_positions_stride(header)).value;
    jobs[job].states_ea = states.ea(first * spu::match_2d_state_stride(header)).value;
    jobs[job].body_count = static_cast<std::uint32_t>(std::min(bodies_per_job, bodies - first));
  }
}

MatchOrchestrator2d::MatchOrchestrator2d(dma::AddressSpace& memory, JobSystem& jobs,
                                         const ls_sim::KernelImage& match_2d, std::span<const Model> models,
                                         std::size_t bodies_per_job)
    : chain_(jobs, "match_2d", jobs_for_all(models, bodies_per_job)) {
  const JobImage image = jobs.place(match_2d);
  models_.reserve(models.size());
  for (const Model& model : models) {
    const Bodies& added = models_.emplace_back(memory, model, bodies_per_job);
    for (std::size_t job = 0; job < added.jobs.size(); ++job)
      chain_.add({.image = image, .argp = added.jobs.ea(job)});
    for (std::size_t body = 0; body < added.bodies; ++body) reset(models_.size() - 1, body);
  }
}

std::span<MatchOrchestrator2d::Vector> MatchOrchestrator2d::positions(std::size_t model, std::size_t body) {
  Bodies& m = models_[model];
  std::byte* const at = m.positions.data() + body * spu::match_2d_positions_stride(m.header);
  return {reinterpret_cast<Vector*>(at), m.header.particles};
}

std::span<MatchOrchestrator2d::Vector> MatchOrchestrator2d::velocities(std::size_t model, std::size_t body) {
  Bodies& m = models_[model];
  return {reinterpret_cast<Vector*>(m.state(body) + sizeof(spu::MatchResult2d)), m.header.particles};
}

std::span<const spu::MatchDirections> MatchOrchestrator2d::directions(std::size_t model,
                                                                      std::size_t body) const {
  const Bodies& m = models_[model];
  const std::byte* const at = m.state(body) + spu::match_2d_directions_at(m.header);
  return {reinterpret_cast<const spu::MatchDirections*>(at), spu::groups_of(m.header.regions)};
}

void MatchOrchestrator2d::reset(std::size_t model, std::size_t body) {
  Bodies& m = models_[model];
  std::byte* const at = m.state(body) + spu::match_2d_directions_at(m.header);
  std::fill_n(reinterpret_cast<spu::MatchDirections*>(at), spu::groups_of(m.header.regions),
              spu::MatchDirections{{1, 1, 1, 1}, {0, 0, 0, 0}});
}

void MatchOrchestrator2d::step(std::span<const Settings> settings) {
  kick(settings);
  wait();
}

void MatchOrchestrator2d::kick(std::span<const Settings> settings) {
  if (settings.size() != models_.size())
    throw std::invalid_argument("matching on SPEs: settings for " + std::to_string(settings.size()) +
                                " models; expected " + std::to_string(models_.size()));
  for (const Settings& s : settings) {
    check_setting("pull", s.pull, std::numeric_limits<float>::max());
    check_setting("damping", s.damping, 1);
  }
  for (std::size_t m = 0; m < models_.size(); ++m) {
    for (spu::MatchJob2d& job : models_[m].jobs.span()) {
      job.pull = settings[m].pull;
      job.damping = settings[m].damping;
    }
  }
  chain_.kick();
  in_flight_ = true;
}

void MatchOrchestrator2d::wait() {
  if (!take_back(chain_, in_flight_)) return;
  BadBodies bad;
  std::size_t number = 0;
  for (const Bodies& model : models_) {
    for (std::size_t body = 0; body < model.bodies; ++body, ++number)
      if (reinterpret_cast<const spu::MatchResult2d*>(model.state(body))->finite == 0) bad.add(number);
  }
  bad.check();
}

}  // namespace softcell::ppu
