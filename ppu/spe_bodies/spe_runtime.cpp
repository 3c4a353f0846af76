#include "softcell/spe_bodies/spe_runtime.h"

#include <map>
#include <stdexcept>
#include <string>

#include "ppu/spe_bodies/spe_contacts.h"
#include "softcell/spe_bodies/spe_solver.h"
#include "softcell/spu_kernels/load_kernel.h"

namespace softcell::ppu {
namespace {

ls_sim::SpeOptions options_of(const SpeRuntimeOptions& options, ls_sim::Findings& findings) {
  if (options.spes < 1 || options.spes > dma::kSpeCount) {
    throw std::invalid_argument("a runtime of " + std::to_string(options.spes) + " SPEs; 1 to " +
                                std::to_string(dma::kSpeCount) + " are possible");
  }
  ls_sim::SpeOptions spe_options{.spes = options.spes,
                                 .schedule = options.schedule,
                                 .deadline = options.deadline,
                                 .findings = options.checked ? &findings : nullptr};
  ls_sim::time_by(options.timing, spe_options);
  return spe_options;
}

}  // namespace

struct SpeRuntime::State {
  explicit State(const SpeRuntimeOptions& options)
      : checked(options.checked),
        machine(options.machine),
        memory(options.main_memory_bytes),
        jobs(memory, options_of(options, findings), job_loop) {}

  bool checked;
  ls_sim::Machine machine;
  ls_sim::Findings findings;
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = spu_kernels::load_kernel("job_loop", false, machine);
  std::map<std::string, ls_sim::KernelImage, std::less<>> kernels;  // jobs keep their addresses
  JobSystem jobs;
};

SpeRuntime::SpeRuntime(const SpeRuntimeOptions& options) : state_(std::make_unique<State>(options)) {}
SpeRuntime::~SpeRuntime() = default;

std::unique_ptr<SoftBodySolver<3>> SpeRuntime::make_solver() {
  return std::make_unique<SpeSolver<3>>(
      memory(), jobs(), MatchKernels<3>{kernel("match"), kernel("match_tiles"), &kernel("strain")});
}

std::shared_ptr<ContactWorker> SpeRuntime::make_contact_worker() {
  return std::make_shared<SpeContacts>(
      memory(), jobs(), ContactKernels{kernel("contact_find"), kernel("contact_solve"), kernel("attach")});
}

std::unique_ptr<SoftBodySolver<2>> SpeRuntime::make_solver_2d() {
  return std::make_unique<SpeSolver<2>>(memory(), jobs(),
                                        MatchKernels<2>{kernel("match_2d"), &kernel("strain")});
}

dma::AddressSpace& SpeRuntime::memory() { return state_->memory; }
JobSystem& SpeRuntime::jobs() { return state_->jobs; }
int SpeRuntime::spes() const { return state_->jobs.spes(); }

const ls_sim::KernelImage& SpeRuntime::kernel(std::string_view name) {
  const auto known = state_->kernels.find(name);
  if (known != state_->kernels.end()) return known->second;
  return state_->kernels.emplace(name, spu_kernels::load_kernel(name, state_->checked, state_->machine))
      .first->second;
}

const ls_sim::Findings& SpeRuntime::findings() const { return state_->findings; }
std::vector<ls_sim::SpeStatistics> SpeRuntime::statistics() const { return state_->jobs.statistics(); }

}  // namespace softcell::ppu
