#include "bench_groups.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr double kMicrosecond = 1e3, kMillisecond = 1e6;

/// Of several prefixes that a name has, the longest counts.
constexpr std::array<BenchGroup, 10> kGroups{
    {{"frame/", "Whole frames of 1/60 s, without pictures, and parts of them", "a frame", "ms", kMillisecond},
     {"solver3d/", "A step of shape matching and damping in three dimensions, one SPE", "a particle", "ns",
      1},
     {"solver3d/one1000/", "The same of one body of 1000 particles by itself, handed over and waited for",
      "a particle", "ns", 1},
     {"solver3d/big", "The same of one body in tiles", "a particle", "ns", 1},
     {"solver2d/", "A step of shape matching and damping in two dimensions, one SPE", "a particle", "ns", 1},
     {"rotation/", "The rotation nearest to a matrix, one SPE", "a matrix", "ns", 1},
     {"skin/", "Skinning, one SPE", "a vertex", "ns", 1},
     {"dma/", "Transfers of 16 KB", "16 KB", "ns", 1},
     {"dma/command/", "Gets of 16 bytes, the waits for them included", "a command", "ns", 1},
     {"dispatch/", "Dispatch of empty jobs", "a job", "us", kMicrosecond}}};

std::size_t group_index(std::string_view name) {
  std::size_t longest = kGroups.size();
  for (std::size_t i = 0; i < kGroups.size(); ++i) {
    if (!name.starts_with(kGroups[i].prefix)) continue;
    if (longest == kGroups.size() || kGroups[i].prefix.size() > kGroups[longest].prefix.size()) longest = i;
  }
  SC_ASSERT(longest < kGroups.size(), "the benchmark {} has no group", name);
  return longest;
}

}  // namespace

std::span<const BenchGroup> bench_groups() { return kGroups; }

const BenchGroup& bench_group(std::string_view name) { return kGroups[group_index(name)]; }

std::string bench_peer(std::string_view name) {
  const std::string_view prefix = bench_group(name).prefix;
  if (prefix == "dma/") return "dma/memcpy16k";
  if (prefix == "frame/") return std::string(name.substr(0, name.find('/', prefix.size())));
  for (const std::string_view alone : {"solver3d/one1000/", "solver3d/big", "dma/command/", "dispatch/"})
    if (prefix == alone) return {};
  return std::string(name.substr(0, name.rfind('/'))) + "/spe";
}

bool is_reported_before(std::string_view a, std::string_view b) {
  const auto key = [](std::string_view name) {
    const std::string peer = bench_peer(name);
    const std::string family = peer.empty() ? std::string(name) : peer;
    return std::tuple(group_index(name), family, name != family, name);
  };
  return key(a) < key(b);
}

}  // namespace softcell::tool
