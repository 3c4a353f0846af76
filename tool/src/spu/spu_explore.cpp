// softcell spu explore: runs one kernel under many orders of its transfers. A correct kernel always has the same outcome.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernel_report.h"
#include "kernel_runs/kernel_file.h"
#include "kernel_runs/kernel_outcome.h"
#include "softcell/base/assert.h"
#include "spu_verbs.h"
#include "verb/exit_status.h"
#include "verb/interrupt.h"
#include "verb/output_files.h"
#include "verb/progress_bar.h"

namespace softcell::tool {
namespace {

constexpr std::uint64_t kFirstSeed = 1;

dma::Schedule schedule_of(std::uint64_t seed) { return {dma::Schedule::kRandom, seed}; }

class Explorer {
 public:
  explicit Explorer(const SpuExploreOptions& options)
      : options_(options),
        image_(load_kernel_file(options.task.image, options.task.checked, options.task.machine)),
        buffers_(memory_, options.task),
        files_({{"--json", options.json}}),
        json_(files_.open(options.json)) {}

  int explore() {
    {
      ProgressBar bar("spu explore", options_.seeds, options_.quiet);
      while (tried_ < options_.seeds && differences_.empty() && !endless() && !guard_.interrupted()) {
        try_next_seed();
        if (!options_.quiet) bar.show(tried_);
      }
    }
    if (guard_.interrupted() && differences_.empty()) {
      fmt::print(stderr, "softcell: interrupted; {} of {} seeds gave the same outcome\n", tried_,
                 options_.seeds);
      return kExitInterrupted;
    }
    report();  // before the file, which may fail to be written
    if (json_ != nullptr) write_json(*json_, document());
    files_.commit();
    return exit_status();
  }

 private:
  /// Whether the deadline has ended the run: the host's clock ends it at another place each time, so there is nothing to compare.
  bool endless() const {
    return std::ranges::any_of(first_run_.spes, [](const SpeRun& spe) {
      return spe.result.fault && spe.result.fault->rule == dma::Rule::kDeadlineExceeded;
    });
  }

  std::uint64_t last_seed() const {
    SC_ASSERT(tried_ > 0, "the last of {} seeds", tried_);
    return kFirstSeed + tried_ - 1;
  }

  void try_next_seed() {
    ++tried_;
    buffers_.reset();
    KernelRun run = run_kernel(memory_, image_, buffers_, options_.task,
                               {.schedule = schedule_of(last_seed()),
                                .clock = ls_sim::Clock::kSimulated,
                                .interrupted = [this] { return guard_.interrupted(); }});
    if (guard_.interrupted()) {  // perhaps during the run
      --tried_;
    } else if (tried_ == 1) {
      first_run_ = std::move(run);
      first_ = outcome(first_run_, buffers_);
    } else {
      differences_ = differences(first_, outcome(run, buffers_));
    }
  }

  int exit_status() const {
    return differences_.empty() ? tool::exit_status(image_, first_run_) : kExitFailed;
  }

  bool replaces_inputs() const {
    return std::ranges::any_of(buffers_.slots(), [](const KernelBuffers::Slot& slot) {
      return slot.spec->direction == BufferSpec::kInOut;
    });
  }

  std::string reproduction(std::uint64_t seed) const {
    return fmt::format("softcell spu run {} --dma random:{} --clock simulated", options_.task_text, seed);
  }

  void report() const {
    print_problems(image_, first_run_);
    if (endless()) {
      fmt::print("kernel {}: the run did not end, so that there is nothing to compare\n", image_.name);
      return;
    }
    if (differences_.empty()) {
      if (options_.quiet && exit_status() == 0) return;
      fmt::print("kernel {}: the same outcome under {} seed{}{}\n", image_.name, tried_,
                 tried_ == 1 ? "" : "s", exit_status() == 0 ? "" : ", and every run failed or had findings");
      return;
    }
    fmt::print(
        stderr,
        "softcell: kernel {}: the outcome depends on when transfers happen: seed {} differs from seed {}\n",
        image_.name, last_seed(), kFirstSeed);
    for (const Difference& difference : differences_) {
      fmt::print("{}\n", difference.sentence(fmt::format("seed {}", kFirstSeed),
                                             fmt::format("seed {}", last_seed())));
    }
    fmt::print("to reproduce either run{}:\n  {}\n  {}\n",
               replaces_inputs() ? " (each replaces the files of --inout: keep copies)" : "",
               reproduction(kFirstSeed), reproduction(last_seed()));
  }

  nlohmann::ordered_json document() const {
    nlohmann::ordered_json found = nlohmann::ordered_json::array();
    for (const Difference& difference : differences_) found.push_back(to_json(difference));
    nlohmann::ordered_json document{{"kernel", image_.name},
                                    {"checked", image_.checked},
                                    {"exit_status", exit_status()},
                                    {"seeds", options_.seeds},
                                    {"seeds_tried", tried_},
                                    {"first_seed", kFirstSeed},
                                    {"differs", !differences_.empty()},
                                    {"first_run", to_json(image_, first_run_)},
                                    {"differences", std::move(found)}};
    if (!differences_.empty()) {
      document["differing_seed"] = last_seed();
      document["reproduce"] = {reproduction(kFirstSeed), reproduction(last_seed())};
    }
    return document;
  }

  const SpuExploreOptions& options_;
  const ls_sim::KernelImage image_;
  dma::AddressSpace memory_;
  KernelBuffers buffers_;
  const InterruptGuard guard_;
  OutputFiles files_;
  base::WholeFile* const json_;  // opened before a long search, as it may not be writable
  std::uint64_t tried_ = 0;
  KernelRun first_run_;
  KernelOutcome first_;
  std::vector<Difference> differences_;
};

}  // namespace

int run_spu_explore(const SpuExploreOptions& options) {
  std::vector<NamedFile> files = written_files(options.task);  // of the printed run that reproduces it
  files.push_back({"--json", options.json});
  check_distinct(files);
  check_kept(read_files(options.task), files);
  return Explorer(options).explore();
}

}  // namespace softcell::tool
