#include "spu_verbs.h"

#include <CLI/CLI.hpp>
#include <utility>
#include <vector>

#include "command_line/shared_options.h"
#include "kernel_task_options.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

constexpr std::uint64_t kMaxPort = 65'535;

ls_sim::Clock parse_clock(const std::string& text, bool is_timed) {
  if (text == "host" && is_timed)
    throw UsageError("--clock host: --timing has a clock of its own, the simulated one");
  if (text == "host" || text.empty()) return ls_sim::Clock::kHost;
  if (text == "simulated") return ls_sim::Clock::kSimulated;
  throw UsageError("--clock " + text + ": give host or simulated");
}

class SpuVerbs final : public Verb {
 public:
  explicit SpuVerbs(std::vector<KernelSample> samples) : samples_(std::move(samples)) {}

  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* spu = command.add_subcommand("spu", "SPU kernels: run, explore, timing, disasm, debug, budget");
    spu->require_subcommand(0, 1);
    add_run(*spu, chosen);
    add_explore(*spu, chosen);
    add_timing(*spu, chosen);
    add_disasm(*spu, chosen);
    add_debug(*spu, chosen);
    CLI::App* b = spu->add_subcommand(
        "budget", "Local store of kernels: sections, stack used, share of 256 KB, budget");
    b->add_option("KERNELS", budget_.kernels,
                  "Your kernels' .spu.elf files, or names of softcell's own (default: all of these)")
        ->type_name("KERNEL");
    b->add_flag("--checked", budget_.checked,
                "Show the checked images, whose stack has room for the checks beside the kernel's own");
    b->add_flag("--functions", budget_.functions,
                "Show also in which functions the cycles went on a PS3, of softcell's own kernels");
    add_json_option(*b, budget_.json, "the table");
    b->callback([&] { chosen = [this] { return run_budget(budget_, samples_); }; });
  }

 private:
  void add_run(CLI::App& spu, Call& chosen) {
    CLI::App* r = spu.add_subcommand(
        "run", "Run a kernel on your own data: softcell spu run saxpy.spu.elf --in x=x.bin --arg @x 1024");
    run_task_.add_to(*r);
    add_dma_option(*r, schedule_);
    r->add_option("--clock", clock_,
                  "The kernel's clock: host (default), or simulated, which advances with each channel "
                  "operation and SPEs take turns, so that a run is the same every time")
        ->type_name("host|simulated");
    r->add_flag("--host-calls", run_.host_calls,
                "Serve the calls of programs built for the SPU that print, read and open files (stop 0x2100 "
                "and 0x2101)");
    r->add_option("--folder", run_.folder,
                  "With --host-calls: a folder in which the program may open, create and remove files")
        ->type_name("DIR")
        ->needs("--host-calls");
    r->add_flag(
        "--timing", run_.timing,
        "Report how long the run takes on a PS3, by a model of SPUs and transfers: cycles, stalls by cause "
        "and function, waits for transfers; of a kernel built for the host only the waits");
    r->add_option("--coverage", run_.coverage,
                  "Write which lines and branches were executed, in the format of lcov")
        ->type_name("FILE")
        ->excludes("--timing");
    add_trace_option(*r, run_.trace);
    add_json_option(*r, run_.json, "statistics, findings and faults");
    r->callback([&] {
      chosen = [this] {
        run_.task = run_task_.task();
        run_.schedule = parse_dma(schedule_);
        run_.clock = parse_clock(clock_, run_.timing);
        return run_spu_run(run_);
      };
    });
  }

  void add_explore(CLI::App& spu, Call& chosen) {
    CLI::App* e = spu.add_subcommand(
        "explore",
        "Run a kernel under many orders of its transfers and SPEs; all must have the same outcome");
    explore_task_.add_to(*e);
    accept_whole_number(e->add_option("--seeds", explore_.seeds,
                                      "Orders to try: --dma random:1 to random:SEEDS (default: 100)"),
                        1, kMaxSeeds)
        ->type_name("SEEDS");
    e->add_flag("--quiet", explore_.quiet, "Print errors only");
    add_json_option(*e, explore_.json, "the result");
    e->callback([&] {
      chosen = [this] {
        explore_.task = explore_task_.task();
        explore_.task_text = explore_task_.text();
        return run_spu_explore(explore_);
      };
    });
  }

  void add_timing(CLI::App& spu, Call& chosen) {
    CLI::App* t =
        spu.add_subcommand("timing",
                           "Run a program built for the SPU, and print its schedule in the layout of "
                           "spu_timing with the cycles that each instruction took");
    timing_task_.add_to(*t);
    add_function_option(*t, timing_.function);
    t->add_flag("--static", timing_.is_static, "Run nothing, and print the schedule alone");
    add_dma_option(*t, timing_schedule_);
    t->add_flag("--host-calls", timing_.host_calls,
                "Serve the calls of the program that print (stop 0x2100 and 0x2101)");
    add_json_option(*t, timing_.json, "the schedule and the cycles");
    t->callback([&] {
      chosen = [this] {
        timing_.task = timing_task_.task();
        timing_.schedule = parse_dma(timing_schedule_);
        return run_spu_timing(timing_);
      };
    });
  }

  void add_disasm(CLI::App& spu, Call& chosen) {
    CLI::App* d = spu.add_subcommand("disasm",
                                     "Print the instructions of a program built for the SPU, with symbols, "
                                     "targets and hints");
    d->add_option("PROGRAM", disasm_.task.image, "An executable that a compiler for the SPU has made")
        ->required()
        ->type_name("FILE");
    add_function_option(*d, disasm_.function);
    d->add_flag("--schedule", disasm_.with_schedule,
                "Print in which cycle and which pipe each instruction issues");
    add_json_option(*d, disasm_.json, "the instructions");
    d->callback([&] { chosen = [this] { return run_spu_disasm(disasm_); }; });
  }

  void add_debug(CLI::App& spu, Call& chosen) {
    CLI::App* d =
        spu.add_subcommand("debug",
                           "Wait for a debugger that speaks GDB's remote protocol, and run a program built "
                           "for the SPU in it, forwards and backwards");
    debug_task_.add_to(*d);
    add_dma_option(*d, debug_schedule_);
    accept_whole_number(
        d->add_option("--port", debug_.port, "Port of this host to wait at (default: any that is free)"), 1,
        kMaxPort)
        ->type_name("PORT");
    d->callback([&] {
      chosen = [this] {
        debug_.task = debug_task_.task();
        debug_.schedule = parse_dma(debug_schedule_);
        return run_spu_debug(debug_);
      };
    });
  }

  static void add_function_option(CLI::App& verb, std::string& function) {
    verb.add_option("--function", function, "Only this function (default: all)")->type_name("NAME");
  }

  std::vector<KernelSample> samples_;
  KernelTaskOptions run_task_, explore_task_, timing_task_, debug_task_;
  SpuDebugOptions debug_;
  std::string debug_schedule_ = "eager";
  SpuListingOptions timing_, disasm_;
  std::string timing_schedule_ = "eager";
  SpuRunOptions run_;
  SpuExploreOptions explore_;
  BudgetOptions budget_;
  std::string schedule_ = "eager";
  std::string clock_;
};

}  // namespace

std::unique_ptr<Verb> spu_verbs(std::vector<KernelSample> samples) {
  return std::make_unique<SpuVerbs>(std::move(samples));
}

}  // namespace softcell::tool
