#include "kernel_run.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

ls_sim::SpeOptions spe_options(const KernelTask& task, const RunSettings& settings) {
  const bool is_simulated = settings.clock == ls_sim::Clock::kSimulated;
  ls_sim::SpeOptions options{
      .spes = task.spes,
      .schedule = settings.schedule,
      .deadline = task.deadline,
      .clock = settings.clock,
      .interleaving = is_simulated ? ls_sim::Interleaving::kTurns : ls_sim::Interleaving::kFree,
      .measure_stack = true,
      .host_calls = settings.host_calls,
      .debugger = settings.debugger,
      .trace = settings.trace};
  ls_sim::time_by(settings.timing, options);
  return options;
}

/// While the object lives, it ends the group's runs as soon as `wanted` returns true.
class Interrupter {
 public:
  Interrupter(ls_sim::SpeGroup& group, const std::function<bool()>& wanted) {
    if (!wanted) return;
    thread_ = std::jthread([this, &group, &wanted](const std::stop_token& end) {
      while (!end.stop_requested()) {
        if (wanted()) {
          has_ended_runs_ = true;
          return group.stop_runs();
        }
        std::this_thread::sleep_for(kPeriod);
      }
    });
  }

  bool has_ended_runs() const { return has_ended_runs_; }

 private:
  static constexpr std::chrono::milliseconds kPeriod{5};
  std::atomic<bool> has_ended_runs_ = false;
  std::jthread thread_;
};

}  // namespace

std::string describe_end(const SpeRun& spe) {
  const ls_sim::RunResult& result = spe.result;
  if (spe.interrupted) return "interrupted";
  if (result.fault) return std::string(dma::name(result.fault->rule));
  if (result.ended_normally()) return fmt::format("status {}", result.status());
  return fmt::format("stop code 0x{:04X}", result.stop_code);
}

std::vector<std::string> KernelRun::failures(const ls_sim::KernelImage& image) const {
  std::vector<std::string> sentences;
  for (std::size_t spe = 0; spe < spes.size(); ++spe) {
    const ls_sim::RunResult& result = spes[spe].result;
    if (result.fault) {
      sentences.push_back(result.fault->message());
    } else if (!result.ended_normally() || result.status() != 0) {
      sentences.push_back(
          fmt::format("SPE {}, kernel {}: ended with {}", spe, image.name, describe_end(spes[spe])));
    }
  }
  return sentences;
}

KernelRun run_kernel(dma::AddressSpace& memory, const ls_sim::KernelImage& image,
                     const KernelBuffers& buffers, const KernelTask& task, const RunSettings& settings) {
  SC_ASSERT(task.spes > 0 && task.spes <= dma::kSpeCount, "a task for {} SPEs", task.spes);
  ls_sim::Findings findings;
  ls_sim::SpeOptions options = spe_options(task, settings);
  if (image.checked) options.findings = &findings;
  ls_sim::SpeGroup group(memory, options);
  for (int spe = 0; spe < task.spes; ++spe) {
    for (const std::uint32_t value : task.in_mbox) group.problem_state(spe).write_in_mbox(value);
    group.prepare(spe, image, buffers.arguments(spe));
  }
  for (int spe = 0; spe < task.spes; ++spe) group.start(spe);  // it may write to others' local stores
  const Interrupter interrupter(group, settings.interrupted);
  KernelRun run;
  for (int spe = 0; spe < task.spes; ++spe) {
    SpeRun& one = run.spes.emplace_back();
    one.result = group.wait(spe);
    one.interrupted = interrupter.has_ended_runs() && one.result.fault &&
                      one.result.fault->rule == dma::Rule::kDeadlineExceeded;
    one.out_mbox = group.problem_state(spe).read_out_mbox();
    one.out_intr_mbox = group.problem_state(spe).read_out_intr_mbox();
    one.statistics = group.statistics(spe);
  }
  run.findings = findings.list();
  return run;
}

}  // namespace softcell::tool
