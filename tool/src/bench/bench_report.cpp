#include "bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "bench_groups.h"
#include "softcell/base/assert.h"
#include "softcell/base/read_file.h"
#include "softcell/base/text.h"
#include "verb/verb_files.h"

namespace softcell::tool {
namespace {

constexpr std::uint64_t kMostFileBytes = std::uint64_t{16} << 20;

/// A result and the results to which it is compared.
struct Row {
  const BenchResult& result;
  std::string peer;               ///< empty: it has none
  std::optional<double> factor;   ///< its time divided by that of its peer
  std::optional<double> against;  ///< its time divided by that in the earlier run

  bool is_slower() const { return against && *against > kSlower; }
};

std::vector<Row> rows_of(const std::vector<BenchResult>& results, const OldFigures* old) {
  std::vector<Row> rows;
  for (const BenchResult& result : results) {
    SC_ASSERT(result.ns_min <= result.ns_median, "{} took {} ns at least, {} ns as a median", result.name,
              result.ns_min, result.ns_median);
    Row row{result, bench_peer(result.name), {}, {}};
    const auto peer = std::ranges::find(results, row.peer, &BenchResult::name);
    if (peer != results.end() && peer->name != result.name) row.factor = result.ns_min / peer->ns_min;
    if (old != nullptr)
      if (const auto before = old->find(result.name); before != old->end())
        row.against = result.ns_min / before->second;
    rows.push_back(std::move(row));
  }
  return rows;
}

/// "12.3 x", with three digits.
std::string times(const std::optional<double>& factor) {
  if (!factor) return "";
  return fmt::format("{:.{}f} x", *factor, *factor < 9.995 ? 2 : *factor < 99.95 ? 1 : 0);
}

std::string heading(const BenchGroup& group, std::size_t name_width, bool compares) {
  return fmt::format("\n{}: {} for {}\n{:<{}} {:>10} {:>10} {:>9}{}\n", group.heading, group.unit, group.item,
                     "name", name_width, "least", "median", "to peer", compares ? "    to old" : "");
}

std::string line(const Row& row, const BenchGroup& group, std::size_t name_width, bool compares) {
  SC_ASSERT(group.unit_ns > 0 && row.result.name.size() <= name_width, "{} in units of {} ns",
            row.result.name, group.unit_ns);
  const bool is_peer = row.peer == row.result.name;
  std::string text = fmt::format("{:<{}} {:>10.2f} {:>10.2f} {:>9}", row.result.name, name_width,
                                 row.result.ns_min / group.unit_ns, row.result.ns_median / group.unit_ns,
                                 is_peer ? "peer" : times(row.factor));
  if (compares)
    text +=
        fmt::format(" {:>9}{}", row.against ? times(row.against) : "new", row.is_slower() ? "  slower" : "");
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

std::string comparison(const std::vector<Row>& rows) {
  const auto compared = std::ranges::count_if(rows, [](const Row& row) { return row.against.has_value(); });
  const auto slower = std::ranges::count_if(rows, [](const Row& row) { return row.is_slower(); });
  return fmt::format("\n{} of {} took more than {:.0f} % longer than in the old run\n", slower,
                     base::counted(static_cast<std::uint64_t>(compared), "benchmark"), 100 * (kSlower - 1));
}

}  // namespace

OldFigures read_old_figures(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = base::read_file(file, kMostFileBytes);
  const auto* const text = reinterpret_cast<const char*>(bytes.data());
  OldFigures figures;
  try {
    const auto document = nlohmann::json::parse(text, text + bytes.size());
    if (!document.is_array() || document.empty()) throw std::runtime_error("it is no list of benchmarks");
    for (const auto& entry : document) {
      const double least = entry.at("ns_min").get<double>();
      if (!(least > 0)) throw std::runtime_error("a time is not above 0");
      figures[entry.at("name").get<std::string>()] = least;
    }
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{} holds no figures of `softcell bench --json`: {}", file.string(),
                                         base::one_line(explanation_of(error))));
  }
  return figures;
}

std::string bench_table(const std::vector<BenchResult>& results, int rounds, const OldFigures* old) {
  SC_ASSERT(rounds > 0, "{} results of {} rounds", results.size(), rounds);
  const std::vector<Row> rows = rows_of(results, old);
  std::size_t width = 4;
  for (const BenchResult& result : results) width = std::max(width, result.name.size());
  std::string text = fmt::format(
      "least and median time of an item in {}; \"to peer\": times as long as the row marked \"peer\"\n",
      base::counted(static_cast<std::uint64_t>(rounds), "round"));
  const BenchGroup* last = nullptr;
  for (const Row& row : rows) {
    const BenchGroup& group = bench_group(row.result.name);
    if (&group != last) text += heading(group, width, old != nullptr);
    last = &group;
    text += line(row, group, width, old != nullptr);
  }
  if (old != nullptr) text += comparison(rows);
  return text;
}

nlohmann::ordered_json bench_document(const std::vector<BenchResult>& results, const OldFigures* old) {
  SC_ASSERT(std::ranges::all_of(results, [](const BenchResult& result) { return result.items > 0; }),
            "one of {} results has no items", results.size());
  auto document = nlohmann::ordered_json::array();
  for (const Row& row : rows_of(results, old)) {
    const BenchGroup& group = bench_group(row.result.name);
    nlohmann::ordered_json entry{
        {"name", row.result.name},   {"ns_min", row.result.ns_min}, {"ns_median", row.result.ns_median},
        {"items", row.result.items}, {"group", group.heading},      {"item", group.item}};
    if (row.factor) {
      entry["peer"] = row.peer;
      entry["times_peer"] = *row.factor;
    }
    if (row.against) entry["times_old"] = *row.against;
    document.push_back(std::move(entry));
  }
  return document;
}

}  // namespace softcell::tool
