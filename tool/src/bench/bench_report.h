#pragma once
// What benchmarks found: a table for the reader, JSON for programs, and figures of an earlier run beside them.

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace softcell::tool {

/// What was measured of one benchmark.
struct BenchResult {
  std::string name;
  double ns_min = 0, ns_median = 0;  ///< nanoseconds of an item
  std::size_t items = 0;             ///< in one measurement
};

/// The least times of an earlier run, nanoseconds of an item by name.
using OldFigures = std::map<std::string, double, std::less<>>;

/// @throws std::runtime_error  the file is none that `softcell bench --json` wrote.
OldFigures read_old_figures(const std::filesystem::path& file);

/// A row that took this many times as long as in the earlier run is marked. Runs of the same program differ by
/// less on an idle machine.
inline constexpr double kSlower = 1.05;

/// What is printed of benchmarks.
/// @param results  in the order of is_reported_before()
/// @param old      figures to compare with; null: there are none
std::string bench_table(const std::vector<BenchResult>& results, int rounds, const OldFigures* old);

/// What --json writes: an object for each benchmark.
nlohmann::ordered_json bench_document(const std::vector<BenchResult>& results, const OldFigures* old);

}  // namespace softcell::tool
