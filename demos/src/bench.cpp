// softcell bench: kernels and what they are compared with, measured in turn in one run.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <vector>

#include "benchmarks.h"
#include "json_file.h"
#include "usage_error.h"
#include "verbs.h"

namespace softcell::demos {
namespace {

constexpr int kRounds = 31;  // of which the minimum and the median are reported

void measure(std::vector<Benchmark>& all) {
  for (Benchmark& benchmark : all) benchmark.run();  // caches, first allocations
  // Round by round, so that a change of the machine's speed meets all alike.
  for (int round = 0; round < kRounds; ++round) {
    for (Benchmark& benchmark : all) {
      const auto begin = std::chrono::steady_clock::now();
      benchmark.run();
      const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - begin;
      benchmark.nanoseconds.push_back(elapsed.count() / static_cast<double>(benchmark.items));
    }
  }
  for (Benchmark& benchmark : all) std::sort(benchmark.nanoseconds.begin(), benchmark.nanoseconds.end());
}

}  // namespace

int run_bench(const BenchOptions& options) {
  std::vector<Benchmark> all;
  add_skin_benchmarks(all);
  add_solver_benchmarks(all);
  add_dma_benchmarks(all);
  add_dispatch_benchmarks(all);
  try {
    const std::regex filter(options.filter);
    std::erase_if(all, [&](const Benchmark& b) { return !std::regex_search(b.name, filter); });
  } catch (const std::regex_error&) {
    throw UsageError("--filter " + options.filter + " is not a regular expression");
  }
  if (all.empty()) throw UsageError("--filter " + options.filter + " leaves no benchmark");
  measure(all);

  auto document = nlohmann::ordered_json::array();
  fmt::print("{:<32} {:>10} {:>10} {:>9}   nanoseconds per item, {} rounds\n", "name", "minimum", "median",
             "items", kRounds);
  for (const Benchmark& b : all) {
    const double least = b.nanoseconds.front(), median = b.nanoseconds[b.nanoseconds.size() / 2];
    fmt::print("{:<32} {:>10.2f} {:>10.2f} {:>9}\n", b.name, least, median, b.items);
    document.push_back({{"name", b.name}, {"ns_min", least}, {"ns_median", median}, {"items", b.items}});
  }
  if (options.json) write_json(*options.json, document);
  return 0;
}

}  // namespace softcell::demos
