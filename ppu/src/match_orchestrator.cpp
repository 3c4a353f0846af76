#include "softcell/ppu/match_orchestrator.h"

#include <numeric>
#include <stdexcept>
#include <string>

namespace softcell::ppu {

MatchOrchestrator::MatchOrchestrator(dma::AddressSpace& memory, JobSystem& jobs,
                                     const ls_sim::KernelImage& match, const MatchPlan& plan,
                                     std::size_t bodies, std::size_t bodies_per_job)
    : match_(jobs.place(match)),
      bodies_(memory, plan, bodies),
      all_(bodies),
      bodies_per_job_(bodies_per_job),
      chain_(jobs, "match", (bodies + bodies_per_job - 1) / bodies_per_job) {
  std::iota(all_.begin(), all_.end(), std::size_t{0});
}

void MatchOrchestrator::step(const MatchSettings& settings) {
  kick(settings);
  wait();
}

void MatchOrchestrator::kick(const MatchSettings& settings) {
  chain_.clear();
  bodies_.add_jobs(chain_, match_, settings, all_, bodies_per_job_);
  chain_.kick();
  in_flight_ = true;
}

void MatchOrchestrator::wait() {
  chain_.wait();
  if (!in_flight_) return;
  in_flight_ = false;
  std::string failures;
  for (const JobFailure& failure : chain_.failures()) failures += "; " + failure.message;
  if (!failures.empty()) throw std::runtime_error("stepping soft bodies failed" + failures);
  std::string bad;
  for (const std::size_t body : bodies_.take_results())
    bad += (bad.empty() ? "" : ", ") + std::to_string(body);
  if (!bad.empty())
    throw std::runtime_error("soft bodies with positions or velocities that are not finite numbers: " + bad);
}

}  // namespace softcell::ppu
