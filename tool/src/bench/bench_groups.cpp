#include "bench_groups.h"

#include <array>
#include <tuple>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr double kMicrosecond = 1e3, kMillisecond = 1e6;

/// If a name has several of the prefixes, the longest counts.
constexpr std::array<BenchGroup, 12> kGroups{
    {{"frame/", "Whole frames of 1/60 s, without pictures, and parts of them", "a frame", "ms", kMillisecond,
      BenchPeer::kFrame},
     {"contact/", "Frames in which bodies touch, skinning included: processor time of all threads",
      "a particle and frame", "ns", 1, BenchPeer::kOurs},
     {"solver3d/", "A step of shape matching and damping in three dimensions, one SPE", "a particle", "ns", 1,
      BenchPeer::kSpe},
     {"solver3d/one1000/", "The same of one body of 1000 particles by itself, from kick to result",
      "a particle", "ns", 1, BenchPeer::kNone},
     {"solver3d/big", "The same of one body in tiles", "a particle", "ns", 1, BenchPeer::kNone},
     {"solver2d/", "A step of shape matching and damping in two dimensions, one SPE", "a particle", "ns", 1,
      BenchPeer::kSpe},
     {"rotation/", "The rotation nearest to a matrix, one SPE", "a matrix", "ns", 1, BenchPeer::kSpe},
     {"skin/", "Skinning, one SPE", "a vertex", "ns", 1, BenchPeer::kSpe},
     {"dma/", "Transfers of 16 KB", "16 KB", "ns", 1, BenchPeer::kMemcpy},
     {"dma/command/", "Gets of 16 bytes, the waits for them included", "a command", "ns", 1,
      BenchPeer::kNone},
     {"dispatch/", "Dispatch of empty jobs", "a job", "us", kMicrosecond, BenchPeer::kNone},
     {"interpreter/", "Instructions of a program built for the SPU, one SPE", "an instruction", "ns", 1,
      BenchPeer::kNone}}};

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
  const BenchGroup& group = bench_group(name);
  switch (group.peer) {
    case BenchPeer::kNone:
      break;
    case BenchPeer::kSpe:
    case BenchPeer::kOurs:
      SC_ASSERT(name.rfind('/') >= group.prefix.size(),
                "the benchmark {} has no body between its group and its solver", name);
      return std::string(name.substr(0, name.rfind('/'))) +
             (group.peer == BenchPeer::kSpe ? "/spe" : "/ours");
    case BenchPeer::kMemcpy:
      return "dma/memcpy16k";
    case BenchPeer::kFrame:
      return std::string(name.substr(0, name.find('/', group.prefix.size())));
  }
  return {};
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
