// The MFC's channels: commands, tag status, queue-full stalls, statistics, jobs.
#include "softcell/dma/mfc.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

void expect_rule(const std::variant<std::uint32_t, Fault>& status, Rule rule) {
  ASSERT_TRUE(std::holds_alternative<Fault>(status));
  EXPECT_EQ(name(std::get<Fault>(status).rule), name(rule));
}

class MfcUnderEverySchedule : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcUnderEverySchedule, testing::ValuesIn(all_schedules()),
                         schedule_test_name);

TEST_P(MfcUnderEverySchedule, MovesBytesBothWays) {
  MfcBench bench(GetParam());
  for (std::size_t i = 0; i < 16384; ++i) bench.buffer[i] = static_cast<std::byte>(i * 31 >> 3);
  bench.issue(MfcOpcode::get, 0x3C000, 0, 16384, 31);
  EXPECT_EQ(bench.wait_all(1u << 31), 1u << 31);
  EXPECT_TRUE(std::equal(bench.store.begin() + 0x3C000, bench.store.end(), bench.buffer.data()));
  bench.issue(MfcOpcode::put, 0x3C000, 16384, 16384, 0);
  EXPECT_EQ(bench.wait_all(1), 1u);
  EXPECT_TRUE(std::equal(bench.buffer.data(), bench.buffer.data() + 16384, bench.buffer.data() + 16384));
}

TEST_P(MfcUnderEverySchedule, MovesSmallTransfersWithinTheirQuadword) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 64, 7);
  bench.issue(MfcOpcode::get, 8, 24, 4, 0);
  bench.issue(MfcOpcode::get, 31, 15, 1, 0);
  bench.wait_all(1);
  EXPECT_EQ(bench.count_in_store(0, 64, 7), 5);
  EXPECT_EQ(bench.count_in_store(8, 4, 7), 4);
  EXPECT_EQ(bench.store_at(31), 7);
}

TEST_P(MfcUnderEverySchedule, WaitForAllMeansAllOfTheMask) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 8192, 1);
  for (std::uint32_t tag = 0; tag < 8; ++tag) bench.issue(MfcOpcode::get, tag * 1024, tag * 1024, 1024, tag);
  EXPECT_EQ(bench.wait_all(0x0F), 0x0Fu);
  EXPECT_EQ(bench.count_in_store(0, 4096, 1), 4096);
}

TEST_P(MfcUnderEverySchedule, WaitForAnyGivesAtLeastOneAndTheBytesOfEachGiven) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 8192, 1);
  for (std::uint32_t tag = 0; tag < 8; ++tag) bench.issue(MfcOpcode::get, tag * 1024, tag * 1024, 1024, tag);
  std::uint32_t left = 0xFF;
  while (left != 0) {
    const std::uint32_t done = bench.wait_any(left);
    ASSERT_NE(done, 0u);
    ASSERT_EQ(done & ~left, 0u);
    for (std::uint32_t tag = 0; tag < 8; ++tag) {
      if ((done >> tag & 1) == 0) continue;
      EXPECT_EQ(bench.count_in_store(tag * 1024, 1024, 1), 1024) << "tag " << tag;
    }
    left &= ~done;
  }
}

TEST_P(MfcUnderEverySchedule, LoopsThatPollComeToAnEnd) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 4096, 1);
  const auto issue_four = [&] {
    for (std::uint32_t i = 0; i < 4; ++i) bench.issue(MfcOpcode::get, i * 1024, i * 1024, 1024, 3);
  };
  constexpr int kPatience = 100000;

  issue_four();
  int polls = 0;
  while (bench.wait_immediate(1u << 3) == 0) ASSERT_LT(++polls, kPatience);
  EXPECT_EQ(bench.count_in_store(0, 4096, 1), 4096);

  bench.fill_store(0, 4096, 0);
  issue_four();
  bench.mfc.write_tag_mask(1u << 3);
  ASSERT_FALSE(bench.mfc.write_tag_update(2));
  polls = 0;
  while (bench.mfc.tag_status_count() == 0) ASSERT_LT(++polls, kPatience);
  EXPECT_EQ(bench.count_in_store(0, 4096, 1), 4096);
  EXPECT_TRUE(std::holds_alternative<std::uint32_t>(bench.mfc.read_tag_status()));

  for (std::uint32_t i = 0; i < 16; ++i) bench.issue(MfcOpcode::get, i * 16, i * 16, 16, 3);
  polls = 0;
  while (bench.mfc.free_slots() < 1) ASSERT_LT(++polls, kPatience);
}

TEST_P(MfcUnderEverySchedule, AFullQueueStallsButDoesNotFault) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 40 * 128, 1);
  for (std::uint32_t i = 0; i < 40; ++i) bench.issue(MfcOpcode::get, i * 128, i * 128, 128, i % 32);
  EXPECT_EQ(bench.wait_all(~0u), ~0u);
  EXPECT_EQ(bench.count_in_store(0, 40 * 128, 1), 40 * 128);
  EXPECT_LE(bench.mfc.statistics().highest_queue_occupancy, 16);
}

TEST_P(MfcUnderEverySchedule, DrainCompletesEverything) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 1024, 1);
  bench.issue(MfcOpcode::get, 0, 0, 1024, 1);
  bench.issue(MfcOpcode::putf, 0, 8192, 1024, 1);
  bench.mfc.drain();
  EXPECT_EQ(bench.buffer_at(8192 + 1023), 1);
  EXPECT_EQ(bench.mfc.free_slots(), 16);
}

TEST_P(MfcUnderEverySchedule, CountsCommandsAndBytes) {
  MfcBench bench(GetParam());
  bench.issue(MfcOpcode::get, 0, 0, 1024, 1);
  bench.issue(MfcOpcode::getb, 0, 0, 16, 1);
  bench.issue(MfcOpcode::putr, 0, 0, 8, 1);
  EXPECT_TRUE(bench.mfc.issue(command(MfcOpcode::get, 1, bench.buffer.ea(), 16, 1)));
  const MfcStatistics& statistics = bench.mfc.statistics();
  EXPECT_EQ(statistics.get.commands, 2u);
  EXPECT_EQ(statistics.get.bytes, 1040u);
  EXPECT_EQ(statistics.put.commands, 1u);
  EXPECT_EQ(statistics.put.bytes, 8u);
  EXPECT_EQ(statistics.commands(), 3u);
  EXPECT_EQ(statistics.bytes(), 1048u);
  EXPECT_GE(statistics.highest_queue_occupancy, 1);
}

TEST(Mfc, CountsStallsAndWaitsExactlyWhenLazy) {
  MfcBench bench(kLazy);
  for (std::uint32_t i = 0; i < 20; ++i) bench.issue(MfcOpcode::get, i * 16, i * 16, 16, 2);
  EXPECT_EQ(bench.mfc.statistics().queue_full_stalls, 4u);
  EXPECT_EQ(bench.mfc.statistics().highest_queue_occupancy, 16);
  bench.wait_all(1u << 2);
  bench.wait_all(1u << 2);
  EXPECT_EQ(bench.mfc.statistics().tag_waits, 1u);
}

TEST(Mfc, CountsHowFullItsQueueWas) {
  MfcBench lazy(kLazy);
  EXPECT_EQ(lazy.mfc.statistics().mean_queue_occupancy(), 0.0);
  for (std::uint32_t i = 0; i < 3; ++i) lazy.issue(MfcOpcode::get, i * 16, i * 16, 16, 2);
  lazy.issue(MfcOpcode::getllar, 0, 0, 0, 0);  // at once, in no slot
  EXPECT_EQ(lazy.mfc.statistics().queued_commands, 3u);
  EXPECT_EQ(lazy.mfc.statistics().mean_queue_occupancy(), 2.0);
  EXPECT_EQ(lazy.mfc.statistics().highest_queue_occupancy, 3);

  MfcBench eager(kEager);
  for (std::uint32_t i = 0; i < 3; ++i) eager.issue(MfcOpcode::get, i * 16, i * 16, 16, 2);
  EXPECT_EQ(eager.mfc.statistics().mean_queue_occupancy(), 1.0);
}

TEST(Mfc, EagerNeverStallsOrWaits) {
  MfcBench bench(kEager);
  for (std::uint32_t i = 0; i < 20; ++i) bench.issue(MfcOpcode::get, i * 16, i * 16, 16, 2);
  EXPECT_EQ(bench.mfc.free_slots(), 16);
  EXPECT_EQ(bench.wait_all(1u << 2), 1u << 2);
  EXPECT_EQ(bench.mfc.statistics().queue_full_stalls, 0u);
  EXPECT_EQ(bench.mfc.statistics().tag_waits, 0u);
}

TEST(Mfc, FaultsWithTheCommandAndQueuesNothing) {
  MfcBench bench(kLazy);
  const MfcCommand misaligned = command(MfcOpcode::get, 8, bench.buffer.ea(), 16, 1);
  const std::optional<Fault> first = bench.mfc.issue(misaligned);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->rule, Rule::kLsaAlignment);
  EXPECT_EQ(first->command, misaligned);

  const MfcCommand crossing = command(MfcOpcode::put, 0, bench.buffer.ea(MfcBench::kBufferBytes - 16), 32, 1);
  const std::optional<Fault> second = bench.mfc.issue(crossing);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->rule, Rule::kEaCrossesBuffer);
  EXPECT_EQ(second->command, crossing);
  EXPECT_EQ(bench.mfc.free_slots(), 16);
}

TEST(Mfc, GetNeedsReadAndPutNeedsWritePermission) {
  MfcBench bench(kEager);
  const Buffer<char> input(bench.space, "input", 128, {.spe_access = SpeAccess::kRead});
  const Buffer<char> output(bench.space, "output", 128, {.spe_access = SpeAccess::kWrite});
  const Buffer<char> video(bench.space, "video", 128, {.memory = Memory::kVideo});
  const auto rule_of = [&](MfcOpcode opcode, EffectiveAddress ea) {
    const std::optional<Fault> fault = bench.mfc.issue(command(opcode, 0, ea, 128, 0));
    return fault ? std::string(name(fault->rule)) : std::string("none");
  };
  // Twice, because the second answer comes from the translation cache.
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(rule_of(MfcOpcode::get, input.ea()), "none");
    EXPECT_EQ(rule_of(MfcOpcode::put, input.ea()), "ea-not-writable");
    EXPECT_EQ(rule_of(MfcOpcode::get, output.ea()), "ea-not-readable");
    EXPECT_EQ(rule_of(MfcOpcode::put, output.ea()), "none");
    EXPECT_EQ(rule_of(MfcOpcode::get, video.ea()), "none");
    EXPECT_EQ(rule_of(MfcOpcode::putr, video.ea()), "video-memory-write");
  }
}

TEST(Mfc, SeesThatABufferWasFreedAndItsPlaceGivenAway) {
  MfcBench bench(kEager);
  Buffer<char> first(bench.space, "first", 4096);
  const EffectiveAddress ea = first.ea();
  ASSERT_FALSE(bench.mfc.issue(command(MfcOpcode::put, 0, ea, 4096, 0)));
  first = {};
  std::optional<Fault> fault = bench.mfc.issue(command(MfcOpcode::put, 0, ea, 16, 0));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kEaNotMapped);
  const Buffer<char> second(bench.space, "second", 128);
  ASSERT_EQ(second.ea(), ea);
  EXPECT_FALSE(bench.mfc.issue(command(MfcOpcode::put, 0, ea, 128, 0)));
  fault = bench.mfc.issue(command(MfcOpcode::put, 0, ea, 256, 0));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kEaCrossesBuffer);
}

TEST(MfcTagStatus, ReadingWithoutARequestIsAFault) {
  MfcBench bench(kEager);
  EXPECT_EQ(bench.mfc.tag_status_count(), 0);
  expect_rule(bench.mfc.read_tag_status(), Rule::kTagStatusNotRequested);
  bench.wait_all(1);
  expect_rule(bench.mfc.read_tag_status(), Rule::kTagStatusNotRequested);
}

TEST(MfcTagStatus, OnlyThreeConditionsExist) {
  MfcBench bench(kEager);
  const std::optional<Fault> fault = bench.mfc.write_tag_update(3);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kTagUpdateCondition);
  EXPECT_EQ(bench.mfc.tag_status_count(), 0);
}

TEST(MfcTagStatus, ASecondRequestNeedsTheFirstReadOrCancelled) {
  MfcBench bench(kLazy);
  bench.issue(MfcOpcode::get, 0, 0, 16, 1);
  bench.mfc.write_tag_mask(2);
  ASSERT_FALSE(bench.mfc.write_tag_update(2));
  const std::optional<Fault> fault = bench.mfc.write_tag_update(1);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kTagUpdatePending);
  ASSERT_FALSE(bench.mfc.write_tag_update(0));
  EXPECT_EQ(std::get<std::uint32_t>(bench.mfc.read_tag_status()), 0u);
  EXPECT_EQ(bench.wait_all(2), 2u);
}

TEST(MfcTagStatus, AllOfAnEmptyMaskIsTrueAtOnceAndAnyOfItNever) {
  MfcBench bench(kEager);
  EXPECT_EQ(bench.wait_all(0), 0u);
  ASSERT_FALSE(bench.mfc.write_tag_update(1));
  EXPECT_EQ(bench.mfc.tag_status_count(), 0);
  expect_rule(bench.mfc.read_tag_status(), Rule::kTagMaskEmpty);
}

TEST(MfcTagStatus, TagsWithoutCommandsAreComplete) {
  MfcBench bench(kLazy);
  bench.issue(MfcOpcode::get, 0, 0, 16, 1);
  EXPECT_EQ(bench.wait_immediate(0b111), 0b101u);
  bench.mfc.write_tag_mask(0b1000);
  EXPECT_EQ(bench.mfc.tag_mask(), 0b1000u);
}

TEST(MfcTagStatus, ARequestIsForTheMaskOfItsTime) {
  MfcBench bench(kLazy);
  bench.issue(MfcOpcode::get, 0, 0, 16, 1);
  bench.mfc.write_tag_mask(2);
  ASSERT_FALSE(bench.mfc.write_tag_update(2));
  bench.mfc.write_tag_mask(0);
  EXPECT_EQ(std::get<std::uint32_t>(bench.mfc.read_tag_status()), 2u);
}

TEST(Mfc, BeginJobDropsWhatAFaultedJobLeft) {
  MfcBench bench(kLazy);
  bench.fill_buffer(0, 16, 1);
  bench.issue(MfcOpcode::get, 0, 0, 16, 1);
  bench.mfc.write_tag_mask(2);
  ASSERT_FALSE(bench.mfc.write_tag_update(2));
  bench.mfc.begin_job(1);
  EXPECT_EQ(bench.mfc.free_slots(), 16);
  EXPECT_EQ(bench.mfc.tag_mask(), 0u);
  expect_rule(bench.mfc.read_tag_status(), Rule::kTagStatusNotRequested);
  EXPECT_EQ(bench.store_at(0), 0);
}

TEST(Mfc, RefusesALocalStoreOfAnotherSize) {
  AddressSpace space;
  std::vector<std::byte> small(4096);
  EXPECT_THROW(Mfc(small, space, kEager), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::dma
