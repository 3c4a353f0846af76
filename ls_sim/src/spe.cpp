#include "spe.h"

#include <algorithm>

namespace softcell::ls_sim {

void Spe::make_resident(const KernelImage& image) {
  if (resident_ == &image && !options_.reload_always) return;
  engine_->load(image);
  resident_ = &image;
  ++statistics_.image_loads;
}

std::string Spe::run(const Job& job, std::uint64_t job_number) {
  const auto begin = std::chrono::steady_clock::now();
  make_resident(*job.image);
  mfc_.begin_job(job_number);
  MfcChannels channels(mfc_);
  RunResult result =
      engine_->run({static_cast<std::uint64_t>(number_), job.argp.value, job.envp.value}, channels);

  std::string failure;
  if (result.fault) {
    result.fault->spe = number_;
    result.fault->kernel = job.image->name;
    failure = result.fault->message();
    resident_ = nullptr;  // whatever it did to its local store goes with it
  } else {
    mfc_.drain();
    if (!result.ended_normally() || result.status() != 0) {
      failure = "SPE " + std::to_string(number_) + ", kernel " + job.image->name +
                (result.ended_normally() ? ": refused its job with status " + std::to_string(result.status())
                                         : ": stopped with code " + std::to_string(result.stop_code));
    }
  }

  ++statistics_.jobs;
  statistics_.busy += std::chrono::steady_clock::now() - begin;
  statistics_.dma = mfc_.statistics();
  if (options_.measure_stack) {
    statistics_.stack_high_water = std::max(statistics_.stack_high_water, engine_->stack_high_water());
  }
  return failure;
}

}  // namespace softcell::ls_sim
