// Kernels that share memory by reservations: no change may be lost, whatever the schedule and the interleaving.

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "softcell/dma/atomics.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/spe_group.h"
#include "test_images.h"

namespace softcell::ls_sim {
namespace {

using Line = std::array<std::uint32_t, 32>;

struct Setting {
  const char* schedule;
  Interleaving interleaving = Interleaving::kFree;
};

void PrintTo(const Setting& setting, std::ostream* out) {
  *out << setting.schedule << (setting.interleaving == Interleaving::kTurns ? ", turns" : "");
}

class SharedMemory : public testing::TestWithParam<Setting> {
 protected:
  SpeOptions options(int spes) const {
    return {.spes = spes,
            .schedule = dma::parse_schedule(GetParam().schedule),
            .deadline = std::chrono::seconds(100),
            .clock = takes_turns() ? Clock::kSimulated : Clock::kHost,
            .interleaving = GetParam().interleaving};
  }
  bool takes_turns() const { return GetParam().interleaving == Interleaving::kTurns; }

  /// Runs the kernel on all six SPEs and expects that each ends with status 0.
  void run(const char* kernel, std::uint64_t envp) {
    const KernelImage image = test_image(kernel);
    SpeGroup group(memory_, options(kSpes));
    for (int spe = 0; spe < kSpes; ++spe) {
      group.start(spe, image,
                  {.spe_id = static_cast<std::uint64_t>(spe), .argp = lines_.ea().value, .envp = envp});
    }
    for (int spe = 0; spe < kSpes; ++spe) {
      const RunResult result = group.wait(spe);
      EXPECT_FALSE(result.fault) << result.fault->message();
      EXPECT_EQ(result.status(), 0u);
    }
  }

  static constexpr int kSpes = 6;
  static constexpr std::uint32_t kRounds = 200;

  dma::AddressSpace memory_;
  dma::Buffer<Line> lines_{memory_, "lines", 1 + kSpes};
};

TEST_P(SharedMemory, SixSpesAndThePpuCountTogether) {
  const KernelImage image = test_image("increments");
  SpeGroup group(memory_, options(kSpes));
  for (int spe = 0; spe < kSpes; ++spe) group.start(spe, image, {.argp = lines_.ea().value, .envp = kRounds});
  dma::Atomics ppu(memory_);
  for (std::uint32_t i = 0; i < kRounds; ++i) ppu.fetch_add<std::uint32_t>(lines_.ea(), 1);
  std::uint64_t failed = 0;
  for (int spe = 0; spe < kSpes; ++spe) {
    EXPECT_FALSE(group.wait(spe).fault);
    const dma::MfcStatistics statistics = group.statistics(spe).dma;
    EXPECT_EQ(statistics.putllc - statistics.putllc_failed, kRounds);
    EXPECT_EQ(statistics.getllar, statistics.putllc);
    failed += statistics.putllc_failed;
  }
  EXPECT_EQ(lines_.span()[0][0], (kSpes + 1) * kRounds);
  if (takes_turns()) {
    EXPECT_GT(failed, 0u) << "no two SPEs ever met: these turns explore nothing";
  }
}

TEST_P(SharedMemory, ALockLetsOneInAtATime) {
  run("locks", kRounds / 4);
  for (const std::uint32_t word : lines_.span()[1]) EXPECT_EQ(word, kSpes * (kRounds / 4));
  EXPECT_EQ(lines_.span()[0][0], 0u);
}

TEST_P(SharedMemory, AQueueGivesEachNumberOnce) {
  run("queues", kRounds);
  std::uint32_t sum = 0, mixture = 0;
  for (std::uint32_t i = 0; i < kSpes * kRounds; ++i) sum += i, mixture ^= i;
  EXPECT_EQ(lines_.span()[1][2], sum);
  EXPECT_EQ(lines_.span()[1][3], mixture);
  EXPECT_EQ(lines_.span()[0][0], kSpes * kRounds);
}

TEST_P(SharedMemory, ABarrierHoldsEverybodyAndSleepsOnItsLine) {
  lines_.span()[0][2] = kSpes;
  run("meets", kRounds / 8);
  EXPECT_EQ(lines_.span()[0][1], 2 * (kRounds / 8));
}

INSTANTIATE_TEST_SUITE_P(Schedules, SharedMemory,
                         testing::Values(Setting{"eager"}, Setting{"lazy"}, Setting{"random:1"},
                                         Setting{"random:2"}, Setting{"eager", Interleaving::kTurns},
                                         Setting{"lazy", Interleaving::kTurns},
                                         Setting{"random:3", Interleaving::kTurns},
                                         Setting{"random:4", Interleaving::kTurns}));

TEST(SharedCounter, SixSpesAndThePpuCountToAMillion) {
  constexpr std::uint32_t kCounters = 7, kEach = 1'000'000 / kCounters + 1;
  dma::AddressSpace memory;
  const dma::Buffer<Line> line(memory, "counter", 1);
  const KernelImage image = test_image("increments");
  SpeGroup group(memory, {.spes = 6, .deadline = std::chrono::minutes(5)});
  for (int spe = 0; spe < 6; ++spe) group.start(spe, image, {.argp = line.ea().value, .envp = kEach});
  dma::Atomics ppu(memory);
  for (std::uint32_t i = 0; i < kEach; ++i) ppu.fetch_add<std::uint32_t>(line.ea(), 1);
  for (int spe = 0; spe < 6; ++spe) {
    const RunResult result = group.wait(spe);
    EXPECT_FALSE(result.fault) << result.fault->message();
  }
  EXPECT_EQ(line.span()[0][0], kCounters * kEach);
}

// ---- turns

/// Runs six SPEs that increment one counter. @return  the number of failed putllc of each
std::vector<std::uint64_t> fight(const std::string& schedule) {
  dma::AddressSpace memory;
  const dma::Buffer<Line> line(memory, "line", 1);
  const KernelImage image = test_image("increments");
  SpeGroup group(memory, {.spes = 6,
                          .schedule = dma::parse_schedule(schedule),
                          .clock = Clock::kSimulated,
                          .interleaving = Interleaving::kTurns});
  for (int spe = 0; spe < 6; ++spe) group.start(spe, image, {.argp = line.ea().value, .envp = 50});
  std::vector<std::uint64_t> failures;
  for (int spe = 0; spe < 6; ++spe) {
    EXPECT_FALSE(group.wait(spe).fault);
    failures.push_back(group.statistics(spe).dma.putllc_failed);
  }
  return failures;
}

TEST(Turns, AreTheSameForTheSameSeedAndOthersForAnother) {
  const auto first = fight("random:7");
  for (int again = 0; again < 3; ++again) EXPECT_EQ(fight("random:7"), first);
  EXPECT_NE(fight("random:8"), first);
}

}  // namespace
}  // namespace softcell::ls_sim
