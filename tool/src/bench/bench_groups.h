#pragma once
// How benchmarks belong together: found from their names.

#include <span>
#include <string>
#include <string_view>

namespace softcell::tool {

/// Benchmarks of the same kind of work.
struct BenchGroup {
  std::string_view prefix;   ///< of their names
  std::string_view heading;  ///< for the reader
  std::string_view item;     ///< what an item is, in words: "a particle"
  std::string_view unit;     ///< in which the reader gets the time of an item
  double unit_ns;            ///< nanoseconds
};

/// In the order in which they are reported.
std::span<const BenchGroup> bench_groups();

/// The one that the benchmark belongs to. @pre `name` is a benchmark's.
const BenchGroup& bench_group(std::string_view name);

/// The benchmark of the same work that the others are compared to: the SPE's kernel where there is one, memcpy
/// for transfers, the whole frame for its parts. May be the benchmark itself; empty: it has no peers.
std::string bench_peer(std::string_view name);

/// Whether `a` is reported before `b`: by group, then by name, but what the others are compared to comes first.
bool is_reported_before(std::string_view a, std::string_view b);

}  // namespace softcell::tool
