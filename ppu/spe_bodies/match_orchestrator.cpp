#include "ppu/spe_bodies/match_orchestrator.h"

#include <numeric>

#include "ppu/spe_bodies/match_orchestration.h"

namespace softcell::ppu {

MatchOrchestrator::MatchOrchestrator(dma::AddressSpace& memory, JobSystem& jobs,
                                     const ls_sim::KernelImage& match, const MatchPlan& plan,
                                     std::size_t bodies, std::size_t bodies_per_job)
    : match_(jobs.place(match)),
      bodies_(memory, plan, bodies),
      all_(bodies),
      bodies_per_job_(bodies_per_job),
      chain_(jobs, "match", jobs_for(bodies, bodies_per_job)) {
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
  if (!take_back(chain_, in_flight_)) return;
  BadBodies bad;
  for (const std::size_t body : bodies_.take_results()) bad.add(body);
  bad.check();
}

}  // namespace softcell::ppu
