#include "spu_verbs.h"

#include <CLI/CLI.hpp>
#include <utility>
#include <vector>

#include "command_line/shared_options.h"
#include "kernel_task_options.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

constexpr std::uint64_t kMaxSeeds = 1'000'000'000;

ls_sim::Clock parse_clock(const std::string& text) {
  if (text == "host") return ls_sim::Clock::kHost;
  if (text == "simulated") return ls_sim::Clock::kSimulated;
  throw UsageError("--clock " + text + ": give host or simulated");
}

class SpuVerbs final : public Verb {
 public:
  explicit SpuVerbs(std::vector<KernelSample> samples) : samples_(std::move(samples)) {}

  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* spu = command.add_subcommand("spu", "SPU kernels: run, explore, budget");
    spu->require_subcommand(0, 1);
    add_run(*spu, chosen);
    add_explore(*spu, chosen);
    CLI::App* b = spu->add_subcommand(
        "budget", "Local store of kernels: sections, stack used, share of 256 KB, budget");
    b->add_option("KERNELS", budget_.kernels,
                  "Your kernels' .spu.elf files, or names of softcell's own (default: all of these)")
        ->type_name("KERNEL");
    b->add_flag(
        "--checked", budget_.checked,
        "Take the instrumented flavours, whose stack has room for the checks beside the kernel's own");
    add_json_option(*b, budget_.json, "the table");
    b->callback([&] { chosen = [this] { return run_budget(budget_, samples_); }; });
  }

 private:
  void add_run(CLI::App& spu, Call& chosen) {
    CLI::App* r = spu.add_subcommand(
        "run", "Run a kernel on your own data: softcell spu run saxpy.spu.elf --in x=x.bin --arg @x 1024");
    run_task_.add_to(*r);
    add_dma_option(*r, schedule_);
    r->add_option(
         "--clock", clock_,
         "What time is to the kernel: host (default), or simulated, where it advances with each channel "
         "operation and SPEs take turns, so that a run is the same every time")
        ->type_name("host|simulated");
    add_trace_option(*r, run_.trace);
    add_json_option(*r, run_.json, "statistics, findings and faults");
    r->callback([&] {
      chosen = [this] {
        run_.task = run_task_.task();
        run_.schedule = parse_dma(schedule_);
        run_.clock = parse_clock(clock_);
        return run_spu_run(run_);
      };
    });
  }

  void add_explore(CLI::App& spu, Call& chosen) {
    CLI::App* e = spu.add_subcommand(
        "explore",
        "Run a kernel under many orders of its transfers and SPEs; all must have the same outcome");
    explore_task_.add_to(*e);
    take_whole_number(e->add_option("--seeds", explore_.seeds,
                                    "Orders to try: --dma random:1 to random:SEEDS (default: 100)"),
                      1, kMaxSeeds)
        ->type_name("SEEDS");
    e->add_flag("--quiet", explore_.quiet, "No progress bar");
    add_json_option(*e, explore_.json, "the result");
    e->callback([&] {
      chosen = [this] {
        explore_.task = explore_task_.task();
        explore_.task_text = explore_task_.text();
        return run_spu_explore(explore_);
      };
    });
  }

  std::vector<KernelSample> samples_;
  KernelTaskOptions run_task_, explore_task_;
  SpuRunOptions run_;
  SpuExploreOptions explore_;
  BudgetOptions budget_;
  std::string schedule_ = "eager";
  std::string clock_ = "host";
};

}  // namespace

std::unique_ptr<Verb> spu_verbs(std::vector<KernelSample> samples) {
  return std::make_unique<SpuVerbs>(std::move(samples));
}

}  // namespace softcell::tool
