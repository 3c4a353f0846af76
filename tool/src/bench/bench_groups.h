#pragma once
// The groups of benchmarks, found by the names of their benchmarks.

#include <span>
#include <string>
#include <string_view>

namespace softcell::tool {

/// What the benchmarks of a group are compared to.
enum class BenchPeer {
  kNone,
  kSpe,     ///< the SPE's kernel: the same name with `spe` as its last part
  kMemcpy,  ///< the host's memcpy
  kOurs,    ///< the same case by softcell: the same name with `ours` as its last part
  kFrame,   ///< the whole frame, of which the benchmarks are parts
};

/// Benchmarks of the same kind of work.
struct BenchGroup {
  std::string_view prefix;   ///< of their names
  std::string_view heading;  ///< printed above the group
  std::string_view item;     ///< what an item is: "a particle"
  std::string_view unit;     ///< in which the table shows the time of an item
  double unit_ns;            ///< nanoseconds
  BenchPeer peer;
};

/// All groups, in the order of the report.
std::span<const BenchGroup> bench_groups();

/// The group of a benchmark. @pre `name` is a benchmark's.
const BenchGroup& bench_group(std::string_view name);

/// The name of the benchmark to which this one is compared, as its group states. It may be the benchmark itself; empty: it is compared to
/// none. @pre `name` is a benchmark's.
std::string bench_peer(std::string_view name);

/// Whether `a` is reported before `b`: by group, then by name, with each peer before the benchmarks that are compared to it.
bool is_reported_before(std::string_view a, std::string_view b);

}  // namespace softcell::tool
