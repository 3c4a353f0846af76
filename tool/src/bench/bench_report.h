#pragma once
// The results of benchmarks: a table for the reader, JSON for programs, and a comparison with an earlier run.

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace softcell::tool {

/// The measurements of one benchmark.
struct BenchResult {
  std::string name;
  double ns_min = 0, ns_median = 0;  ///< nanoseconds per item
  std::size_t items = 0;             ///< in one measurement
};

/// The least times of an earlier run, in nanoseconds per item, by name.
using OldFigures = std::map<std::string, double, std::less<>>;

/// @throws std::runtime_error  `softcell bench --json` did not write this file.
OldFigures read_old_figures(const std::filesystem::path& file);

/// A row is marked if it took this many times as long as in the earlier run. Runs of the same program differ by less on an idle machine.
inline constexpr double kSlower = 1.05;

/// The table that is printed.
/// @param results  in the order of is_reported_before()
/// @param old      figures to compare with; null: there are none
std::string bench_table(const std::vector<BenchResult>& results, int rounds, const OldFigures* old);

/// The document that --json writes: an object for each benchmark.
nlohmann::ordered_json bench_document(const std::vector<BenchResult>& results, const OldFigures* old);

}  // namespace softcell::tool
