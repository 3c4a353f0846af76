#include "bench_verb.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <vector>

#include "bench_groups.h"
#include "bench_report.h"
#include "benchmarks.h"
#include "command_line/shared_options.h"
#include "median.h"
#include "softcell/base/assert.h"
#include "verb/exit_status.h"
#include "verb/interrupt.h"
#include "verb/output_files.h"

namespace softcell::tool {
namespace {

std::vector<Benchmark> all_benchmarks() {
  std::vector<Benchmark> all;
  add_solver_benchmarks(all);
  add_bullet_benchmarks(all);
  add_solver_2d_benchmarks(all);
  add_rotation_benchmarks(all);
  add_tiles_benchmarks(all);
  add_skin_benchmarks(all);
  add_dma_benchmarks(all);
  add_dispatch_benchmarks(all);
  add_interpreter_benchmarks(all);
  add_frame_benchmarks(all);
  add_frame_2d_benchmarks(all);
  add_contact_benchmarks(all);
  return all;
}

/// The benchmarks with names that the user asks for, in the order of the report.
std::vector<Benchmark> chosen_benchmarks(const std::string& filter_text) {
  std::vector<Benchmark> all = all_benchmarks();
  SC_ASSERT(
      std::ranges::all_of(
          all, [&](const Benchmark& b) { return std::ranges::count(all, b.name, &Benchmark::name) == 1; }),
      "two of {} benchmarks have one name", all.size());
  try {
    const std::regex filter(filter_text);
    std::erase_if(all, [&](const Benchmark& b) { return !std::regex_search(b.name, filter); });
  } catch (const std::regex_error&) {
    throw UsageError("--filter " + filter_text + " is not a regular expression");
  }
  if (all.empty())
    throw UsageError("--filter " + filter_text + " leaves no benchmark; --list shows their names");
  std::ranges::sort(all, is_reported_before, &Benchmark::name);
  return all;
}

/// A benchmark's work and its measured times.
struct Measurement {
  Work work;
  std::vector<double> nanoseconds = {};  // per item, one for each round; sorted at the end

  double least() const {
    SC_ASSERT(!nanoseconds.empty(), "a measurement of {} items has no rounds", work.items);
    return nanoseconds.front();
  }
  double median() const { return median_of(nanoseconds); }
};

std::chrono::nanoseconds spent(const Work& work) {
  return work.spent ? work.spent() : std::chrono::steady_clock::now().time_since_epoch();
}

/// Measures all benchmarks. The result is incomplete if interrupted.
std::vector<Measurement> measure(const std::vector<Benchmark>& benchmarks, int rounds,
                                 const InterruptGuard& guard) {
  std::vector<Measurement> all;
  SC_ASSERT(rounds > 0, "{} benchmarks in {} rounds", benchmarks.size(), rounds);
  for (const Benchmark& benchmark : benchmarks) {
    if (guard.interrupted()) return all;
    all.push_back({benchmark.prepare()});
    SC_ASSERT(all.back().work.items > 0 && all.back().work.run, "{} has {} items of work", benchmark.name,
              all.back().work.items);
    all.back().work.run();  // fills caches and makes first allocations
  }
  // Round by round, so that a change of the machine's speed affects all benchmarks equally.
  for (int round = 0; round < rounds; ++round) {
    for (Measurement& m : all) {
      if (guard.interrupted()) return all;
      if (m.work.before) m.work.before();
      const std::chrono::nanoseconds begin = spent(m.work);
      m.work.run();
      const std::chrono::duration<double, std::nano> elapsed = spent(m.work) - begin;
      SC_ASSERT(elapsed.count() >= 0, "round {} took {} ns", round, elapsed.count());
      m.nanoseconds.push_back(elapsed.count() / static_cast<double>(m.work.items));
    }
  }
  for (Measurement& m : all) std::ranges::sort(m.nanoseconds);
  return all;
}

}  // namespace

int run_bench(const BenchOptions& options) {
  if (options.list && options.json)
    throw UsageError("--list measures nothing that --json could write: leave one of them out");
  if (options.list && options.compare)
    throw UsageError("--list measures nothing that --compare could compare: leave one of them out");
  const std::vector<Benchmark> benchmarks = chosen_benchmarks(options.filter);
  if (options.list) {
    for (const Benchmark& b : benchmarks) fmt::print("{}\n", b.name);
    return 0;
  }
  check_kept({{"--compare", options.compare}}, {{"--json", options.json}});
  OutputFiles files({{"--json", options.json}});
  std::optional<OldFigures> old;
  if (options.compare) old = read_old_figures(*options.compare);
  const InterruptGuard guard;
  base::WholeFile* const json = files.open(options.json);
  const std::vector<Measurement> all = measure(benchmarks, options.rounds, guard);
  if (guard.interrupted()) {
    fmt::print(stderr, "softcell: interrupted; nothing is reported of a part of the rounds\n");
    return kExitInterrupted;
  }

  SC_ASSERT(all.size() == benchmarks.size(), "{} of {} benchmarks were measured", all.size(),
            benchmarks.size());
  std::vector<BenchResult> results;
  for (std::size_t i = 0; i < all.size(); ++i)
    results.push_back({benchmarks[i].name, all[i].least(), all[i].median(), all[i].work.items});
  const OldFigures* const compared = old ? &*old : nullptr;
  fmt::print("{}", bench_table(results, options.rounds, compared));
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].work.note) fmt::print("\n{}: {}", benchmarks[i].name, all[i].work.note());
  if (json != nullptr) write_json(*json, bench_document(results, compared));
  files.commit();
  return 0;
}

namespace {

constexpr int kMaxRounds = 100'000;

class BenchVerb final : public Verb {
 public:
  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* b = command.add_subcommand("bench", "Measure kernels, side by side in one run");
    b->add_option("--filter", options_.filter,
                  "Prepare and measure only benchmarks in whose name this regular expression is found")
        ->type_name("REGEX");
    accept_whole_number(
        b->add_option("--rounds", options_.rounds,
                      "How often each is run, in turn; minimum and median are reported (default: 31)"),
        1, kMaxRounds)
        ->type_name("ROUNDS");
    b->add_flag("--list", options_.list, "Print the names of the benchmarks and measure nothing");
    b->add_option(
         "--compare", options_.compare,
         "A file that --json wrote in an earlier run: also print how many times as long each benchmark "
         "takes now")
        ->type_name("FILE");
    add_json_option(*b, options_.json, "the figures");
    b->callback([&] { chosen = [this] { return run_bench(options_); }; });
  }

 private:
  BenchOptions options_;
};

}  // namespace

std::unique_ptr<Verb> bench_verb() { return std::make_unique<BenchVerb>(); }

}  // namespace softcell::tool
