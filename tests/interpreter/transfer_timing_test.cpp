// What transfers take in simulated time.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/timing.h"
#include "spu_words.h"
#include "timing/slot_calendar.h"

namespace softcell::ls_sim::interpreter {
namespace {

using enum Mnemonic;

constexpr std::uint32_t kGet = 0x40, kPut = 0x20, kPutWithFence = 0x22, kAll = 2;

TEST(SlotCalendar, GivesWhatIsFree) {
  SlotCalendar calendar;
  EXPECT_EQ(calendar.first_free(5), 5u);
  for (std::uint64_t slot = 5; slot < 200; ++slot) calendar.take(slot);
  EXPECT_EQ(calendar.first_free(4), 4u);
  EXPECT_EQ(calendar.first_free(5), 200u);
  EXPECT_EQ(calendar.first_free(70), 200u);
  EXPECT_EQ(calendar.first_free(1000), 1000u);
  calendar.take(1000);
  EXPECT_EQ(calendar.first_free(200), 200u);
  calendar.forget_before(900);
  EXPECT_EQ(calendar.first_free(1000), 1001u);
  EXPECT_GE(calendar.first_free(0), 832u);
}

/// Writes programs that issue commands. $3 to $5 are the program's arguments.
class Program {
 public:
  Program& number(std::uint32_t reg, std::uint32_t value) {
    add(ri16(ilhu, reg, static_cast<std::int32_t>(value >> 16)));
    return add(ri16(iohl, reg, static_cast<std::int32_t>(value & 0xFFFF)));
  }
  Program& add(std::uint32_t word) {
    words.push_back(word);
    return *this;
  }
  /// The second word of `argp`, which is in $4, plus an offset.
  Program& command(std::uint32_t opcode, std::uint32_t lsa, std::uint32_t offset, std::uint32_t size,
                   std::uint32_t tag) {
    add(ri7(shlqbyi, 20, 4, 4)).number(21, offset).add(rr(a, 20, 20, 21));
    number(22, lsa).number(23, size).number(24, tag).number(25, opcode);
    write(16, 22).write(17, 4).write(18, 20).write(19, 23).write(20, 24);
    return write(21, 25);
  }
  Program& wait(std::uint32_t tags) {
    number(26, tags).number(27, kAll);
    write(22, 26).write(23, 27);
    return add(rr(rdch, 28, 24));
  }
  Program& work(int instructions) {
    for (int i = 0; i < instructions; ++i) add(ri10(ai, 30, 30, 1));
    return *this;
  }
  KernelImage image() {
    words.push_back(stop_with(0x2000));
    return program_of(words);
  }

 private:
  Program& write(std::uint32_t channel, std::uint32_t reg) { return add(rr(wrch, reg, channel)); }
  std::vector<std::uint32_t> words;
};

class TransferTiming : public testing::Test {
 protected:
  /// Runs the programs, SPE by SPE, on a buffer of a megabyte.
  void run(const std::vector<KernelImage>& images) {
    const int spes = static_cast<int>(images.size());
    timing_ = std::make_unique<Timing>(spes, parameters_);
    dma::AddressSpace memory;
    const dma::Buffer<std::byte> buffer(memory, "buffer", 1 << 20);
    SpeGroup group(memory, {.spes = spes,
                            .schedule = schedule_,
                            .clock = Clock::kSimulated,
                            .interleaving = Interleaving::kByTime,
                            .timing = timing_.get()});
    for (int spe = 0; spe < spes; ++spe) group.prepare(spe, images[spe], {.argp = buffer.ea().value});
    for (int spe = 0; spe < spes; ++spe) group.start(spe);
    for (int spe = 0; spe < spes; ++spe) {
      const RunResult result = group.wait(spe);
      EXPECT_TRUE(result.ended_normally()) << (result.fault ? result.fault->message() : "");
    }
  }
  std::uint64_t tag_wait(int spe = 0) const { return timing_->total(spe).stalled(Stall::kTagWait); }
  std::uint64_t latency() const { return timing_->transfers(0).latency; }

  dma::Schedule schedule_{};
  TimingParameters parameters_;
  std::unique_ptr<Timing> timing_;
};

TEST_F(TransferTiming, OfOneLineIsStartAndLatency) {
  run({Program().command(kGet, 0x1000, 0, 128, 3).wait(1 << 3).image()});
  EXPECT_EQ(latency(), 20u + 500u);
  EXPECT_EQ(timing_->transfers(0).commands, 1u);
  EXPECT_EQ(timing_->transfers(0).lines, 1u);
  EXPECT_EQ(timing_->transfers(0).tag_waits, 1u);
  EXPECT_GT(tag_wait(), 450u);
  EXPECT_EQ(timing_->total(0).cycles, timing_->now(0));
}

TEST_F(TransferTiming, OfFewBytesIsThatOfALine) {
  run({Program().command(kGet, 0x1000, 0, 16, 3).wait(1 << 3).image()});
  EXPECT_EQ(latency(), 520u);
  run({Program().command(kGet, 0x1000, 112, 32, 3).wait(1 << 3).image()});  // the ends of two lines
  EXPECT_EQ(timing_->transfers(0).lines, 2u);
}

TEST_F(TransferTiming, IsHiddenByWork) {
  run({Program().command(kGet, 0x1000, 0, 128, 3).work(600).wait(1 << 3).image()});
  EXPECT_EQ(tag_wait(), 0u);
  EXPECT_EQ(timing_->transfers(0).tag_waits, 0u);
}

TEST_F(TransferTiming, OfManyLinesIsLimitedByWhatIsOnItsWay) {
  run({Program().command(kGet, 0x1000, 0, 16384, 3).wait(1 << 3).image()});
  // Sixteen lines in each latency of 500 cycles, of which the last comes 15 lines behind the first.
  EXPECT_EQ(latency(), 20u + 8 * 500 + 15 * 16);
  parameters_.outstanding_lines = 64;
  run({Program().command(kGet, 0x1000, 0, 16384, 3).wait(1 << 3).image()});
  // A line in 16 cycles.
  EXPECT_NEAR(static_cast<double>(latency()), 20 + 500 + 127 * 16, 40);
}

TEST_F(TransferTiming, WaitsForFencesAndTagsOnly) {
  const auto both = [](std::uint32_t second, std::uint32_t tag) {
    return Program()
        .command(kGet, 0x1000, 0, 128, 3)
        .command(second, 0x1000, 0x4000, 128, tag)
        .wait(0xFFFFFFFF)
        .image();
  };
  run({both(kPut, 3)});
  EXPECT_LT(latency(), 2 * 520u + 40u);  // side by side
  run({both(kPutWithFence, 4)});
  EXPECT_LT(latency(), 2 * 520u + 40u);  // another tag group
  run({both(kPutWithFence, 3)});
  EXPECT_GT(latency(), 3 * 500u);  // one after the other
}

TEST_F(TransferTiming, AFullQueueHoldsUpTheSpu) {
  Program program;
  for (std::uint32_t i = 0; i < 20; ++i) program.command(kGet, 0x1000, 0x4000 * i, 16384, i % 32);
  run({program.wait(0xFFFFFFFF).image()});
  EXPECT_GT(timing_->total(0).stalled(Stall::kDmaQueue), 1000u);
  EXPECT_EQ(timing_->transfers(0).queue_waits, 4u);
}

/// 32 KB in blocks of 2 KB, the next of which is fetched before or after the work on one.
KernelImage blocks(bool is_doubled) {
  Program program;
  const auto get = [&](std::uint32_t block) {
    program.command(kGet, 0x30000 + 0x800 * (block % 2), 0x800 * block, 0x800, block % 2);
  };
  constexpr std::uint32_t kBlocks = 16;
  if (is_doubled) get(0);
  for (std::uint32_t block = 0; block < kBlocks; ++block) {
    if (!is_doubled) get(block);
    if (is_doubled && block + 1 < kBlocks) get(block + 1);
    program.wait(1u << block % 2).work(1000);
  }
  return program.image();
}

TEST_F(TransferTiming, DoubleBuffersWaitLess) {
  run({blocks(false)});
  const std::uint64_t single = tag_wait();
  run({blocks(true)});
  EXPECT_LT(tag_wait(), single / 8);
}

TEST_F(TransferTiming, SixSpesShareMainMemory) {
  const auto cycles_of = [&](std::size_t spes) {
    Program program;
    for (std::uint32_t i = 0; i < 8; ++i) program.command(kGet, 0x1000, 0x4000 * i, 16384, i);
    run(std::vector<KernelImage>(spes, program.wait(0xFF).image()));
    std::uint64_t last = 0;
    for (int spe = 0; spe < static_cast<int>(spes); ++spe) last = std::max(last, timing_->now(spe));
    return static_cast<double>(last);
  };
  constexpr double kLines = 8 * 128;
  const double one = cycles_of(1);
  EXPECT_NEAR(one, kLines * 500 / 16, 1500);                           // one waits for latencies
  EXPECT_NEAR(cycles_of(6), 6 * kLines * 16, 0.03 * 6 * kLines * 16);  // six for main memory: 25.6 GB/s
}

TEST_F(TransferTiming, IsTheSameInEveryRunOfSixSpes) {
  std::vector<std::uint64_t> first;
  for (int round = 0; round < 5; ++round) {
    std::vector<KernelImage> images;
    for (int spe = 0; spe < 6; ++spe) images.push_back(blocks(spe % 2 == 0));
    run(images);
    std::vector<std::uint64_t> cycles;
    for (int spe = 0; spe < 6; ++spe) cycles.push_back(timing_->now(spe));
    if (round == 0) first = cycles;
    EXPECT_EQ(cycles, first) << round;
  }
}

/// It comes to its transfer first, by the host's time, and last by its own.
TEST_F(TransferTiming, OfAnSpeThatHasComputedForLongComesInItsTurn) {
  Program early;
  for (std::uint32_t i = 0; i < 4; ++i) early.command(kGet, 0x10000, 0, 128, 3).wait(1 << 3);
  run({early.image()});
  const std::uint64_t alone = tag_wait(0);
  run({Program().work(5000).command(kGet, 0x10000, 0, 128, 3).wait(1 << 3).image(), early.image()});
  EXPECT_EQ(tag_wait(1), alone);
  EXPECT_EQ(tag_wait(0), alone / 4);
}

TEST_F(TransferTiming, LinesTakeCyclesOfThePort) {
  Program program;
  program.command(kGet, 0x20000, 0, 16384, 3);
  for (int i = 0; i < 4000; ++i) program.add(ri10(lqd, 31, 1, 0));
  run({program.wait(8).image()});
  const std::uint64_t taken = timing_->total(0).stalled(Stall::kLocalStorePort);
  EXPECT_GT(taken, 100u);  // of 128 lines; the last come when the loads are over
  EXPECT_LE(taken, 128u);
}

TEST_F(TransferTiming, DoesNotDependOnTheSchedule) {
  run({blocks(true)});
  const std::uint64_t eager = timing_->now(0);
  schedule_ = {dma::Schedule::kLazy};
  run({blocks(true)});
  EXPECT_EQ(timing_->now(0), eager);
  schedule_ = {dma::Schedule::kRandom, 3};
  run({blocks(true)});
  EXPECT_EQ(timing_->now(0), eager);
}

/// The decrementer counts simulated time: 79.8 MHz.
TEST_F(TransferTiming, TheDecrementerFollowsTheClock) {
  Program program;
  program.number(10, 1'000'000).add(rr(wrch, 10, 7)).work(8000);
  program.add(rr(rdch, 11, 8)).add(rr(wrch, 11, 28));
  timing_ = std::make_unique<Timing>(1);
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1,
                          .clock = Clock::kSimulated,
                          .interleaving = Interleaving::kByTime,
                          .timing = timing_.get()});
  const KernelImage image = program.image();
  group.start(0, image, {});
  EXPECT_TRUE(group.wait(0).ended_normally());
  const std::uint32_t left = group.problem_state(0).read_out_mbox().value_or(0);
  EXPECT_NEAR(1'000'000 - static_cast<double>(left), 2 * 8000 / 40.1, 2);
}

TEST_F(TransferTiming, NeedsTheOptionsThatBelongToIt) {
  dma::AddressSpace memory;
  Timing timing(1);
  EXPECT_THROW(SpeGroup(memory, {.spes = 1, .timing = &timing}), std::invalid_argument);
  EXPECT_THROW(SpeGroup(memory, {.spes = 1, .interleaving = Interleaving::kByTime}), std::invalid_argument);
  EXPECT_THROW(
      SpeGroup(
          memory,
          {.spes = 2, .clock = Clock::kSimulated, .interleaving = Interleaving::kByTime, .timing = &timing}),
      std::invalid_argument);
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
