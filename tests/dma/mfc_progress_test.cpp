// Time: how long a command may stay queued, what moves while the SPU sleeps, and who is told of it.
#include <algorithm>
#include <map>
#include <variant>
#include <vector>

#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

class MfcProgress : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcProgress, testing::ValuesIn(all_schedules()), schedule_test_name);

// A kernel that polls memory and never waits for its put's tag.
TEST_P(MfcProgress, NoCommandStaysQueuedForMoreThan256Visits) {
  MfcBench bench(GetParam());
  bench.fill_store(0, 1024, 1);
  bench.issue(MfcOpcode::put, 0, 0, 1024, 1);
  bench.issue(MfcOpcode::putf, 0, 1024, 1024, 1);
  bench.issue(MfcOpcode::barrier, 0, 0, 0, 2);
  bench.issue(MfcOpcode::put, 0, 2048, 1024, 3);
  for (std::uint64_t visit = 0; visit < Mfc::kMostVisits; ++visit) bench.mfc.visit();
  EXPECT_EQ(std::count(bench.buffer.data(), bench.buffer.data() + 4096, std::byte{1}), 3072);
  EXPECT_EQ(bench.mfc.free_slots(), 16);
}

TEST(MfcProgressWhenLazy, ACommandLeavesAtItsLastVisitAndNoSooner) {
  MfcBench bench(kLazy);
  bench.fill_store(0, 16, 1);
  bench.issue(MfcOpcode::put, 0, 0, 16, 1);
  for (std::uint64_t visit = 1; visit < Mfc::kMostVisits - 1; ++visit) bench.mfc.visit();
  EXPECT_EQ(bench.buffer_at(0), 0);
  bench.mfc.visit();
  EXPECT_EQ(bench.buffer_at(0), 1);
}

TEST(MfcProgressWhenLazy, EachCommandHasItsOwnTime) {
  MfcBench bench(kLazy);
  bench.fill_store(0, 16, 1);
  bench.issue(MfcOpcode::put, 0, 0, 16, 1);
  for (int visit = 0; visit < 100; ++visit) bench.mfc.visit();
  bench.issue(MfcOpcode::put, 0, 16, 16, 1);
  for (int visit = 0; visit < 160; ++visit) bench.mfc.visit();
  EXPECT_EQ(bench.buffer_at(0), 1);
  EXPECT_EQ(bench.buffer_at(16), 0);
  for (int visit = 0; visit < 100; ++visit) bench.mfc.visit();
  EXPECT_EQ(bench.buffer_at(16), 1);
}

// Polling by line commands and small gets is visiting, too.
TEST_P(MfcProgress, KernelsThatPollWithCommandsSeeTheirOwnPut) {
  MfcBench bench(GetParam());
  bench.fill_store(0, 16, 1);
  bench.issue(MfcOpcode::put, 0, 0, 16, 1);
  std::uint64_t polls = 0;
  do {
    bench.issue(MfcOpcode::getllar, 0x1000, 0, 0, 0);
    ASSERT_LE(++polls, Mfc::kMostVisits + 1);
  } while (bench.store_at(0x1000) != 1);
}

TEST_P(MfcProgress, AStalledListGoesOnWithin256VisitsOfItsAcknowledgement) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 64, 1);
  bench.issue_list(MfcOpcode::getl, 0, {bench.stalling(16, 0), bench.element(16, 0)}, 3);
  bench.issue(MfcOpcode::getf, 32, 0, 16, 3);
  for (int visit = 0; visit < 1000; ++visit) bench.mfc.visit();
  EXPECT_EQ(bench.count_in_store(0, 64, 1), 16);
  ASSERT_TRUE(std::holds_alternative<std::uint32_t>(bench.mfc.read_list_stall_status()));
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
  for (std::uint64_t visit = 0; visit < Mfc::kMostVisits; ++visit) bench.mfc.visit();
  EXPECT_EQ(bench.count_in_store(0, 64, 1), 48);
}

TEST_P(MfcProgress, AdvanceMovesAllThatCanMoveAndSaysWhenNothingCan) {
  MfcBench bench(GetParam());
  EXPECT_FALSE(bench.mfc.advance());
  bench.fill_buffer(0, 4096, 1);
  for (std::uint32_t i = 0; i < 4; ++i) bench.issue(MfcOpcode::getb, i * 1024, i * 1024, 1024, 1);
  bench.issue_list(MfcOpcode::getl, 0x2000, {bench.stalling(16, 0), bench.element(16, 0)}, 3);
  bench.issue(MfcOpcode::getf, 0x3000, 0, 16, 3);
  int steps = 0;
  while (bench.mfc.advance()) ASSERT_LT(++steps, 1000);
  EXPECT_EQ(bench.count_in_store(0, 4096, 1), 4096);
  EXPECT_EQ(bench.count_in_store(0x2000, 32, 1), 16);
  EXPECT_EQ(bench.count_in_store(0x3000, 16, 1), 0);
  EXPECT_EQ(bench.mfc.free_slots(), 14);
}

// Events.

TEST_P(MfcProgress, TheTagStatusEventComesWhenTheRequestBecomesTrue) {
  MfcBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0, {bench.stalling(16, 0), bench.element(16, 0)}, 3);
  while (bench.mfc.advance()) {
  }
  bench.mfc.poll_events();
  bench.mfc.write_tag_mask(1u << 3);
  ASSERT_FALSE(bench.mfc.write_tag_update(2));
  EXPECT_EQ(bench.mfc.poll_events(), 0u);
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
  while (bench.mfc.advance()) {
  }
  EXPECT_EQ(bench.mfc.poll_events(), Mfc::kTagStatusEvent);
  EXPECT_EQ(bench.mfc.poll_events(), 0u) << "taken";
  EXPECT_TRUE(std::holds_alternative<std::uint32_t>(bench.mfc.read_tag_status()));
  ASSERT_FALSE(bench.mfc.write_tag_update(2));
  EXPECT_EQ(bench.mfc.poll_events(), Mfc::kTagStatusEvent) << "true at once";
}

TEST_P(MfcProgress, TheListStallEventComesWhenAListStalls) {
  MfcBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0, {bench.stalling(16, 0), bench.element(16, 0)}, 3);
  while (bench.mfc.advance()) {
  }
  EXPECT_EQ(bench.mfc.poll_events(), Mfc::kListStallEvent);
}

TEST(MfcEvents, TheQueueSlotEventComesWhenAFullQueueHasRoomAgain) {
  MfcBench bench(kLazy);
  for (std::uint32_t i = 0; i < 15; ++i) bench.issue(MfcOpcode::get, i * 16, 0, 16, 3);
  ASSERT_TRUE(bench.mfc.advance());
  EXPECT_EQ(bench.mfc.poll_events(), 0u) << "it was not full";
  for (std::uint32_t i = 0; i < 2; ++i) bench.issue(MfcOpcode::get, i * 16, 0, 16, 3);
  EXPECT_EQ(bench.mfc.poll_events(), 0u);
  ASSERT_TRUE(bench.mfc.advance());
  EXPECT_EQ(bench.mfc.poll_events(), Mfc::kQueueSlotEvent);
  ASSERT_TRUE(bench.mfc.advance());
  EXPECT_EQ(bench.mfc.poll_events(), 0u);
}

// Observers.

class Recorder final : public MfcObserver {
 public:
  struct Issued {
    MfcOpcode opcode;
    std::uint64_t bytes;
    bool operator==(const Issued&) const = default;
  };
  void on_issue(std::uint64_t number, const MfcCommand& command, std::uint64_t bytes) override {
    EXPECT_TRUE(issued.emplace(number, Issued{command.opcode(), bytes}).second);
  }
  void on_complete(std::uint64_t number) override {
    EXPECT_TRUE(issued.contains(number)) << "issued before it is complete";
    completed.push_back(number);
  }
  void on_reservation_lost(std::uint64_t number) override {
    EXPECT_TRUE(issued.contains(number)) << "issued before it fails";
    failed.push_back(number);
  }
  std::map<std::uint64_t, Issued> issued;
  std::vector<std::uint64_t> completed;
  std::vector<std::uint64_t> failed;
};

TEST_P(MfcProgress, AnObserverSeesEachCommandComeAndGoOnce) {
  MfcBench bench(GetParam());
  Recorder recorder;
  bench.mfc.set_observer(&recorder);
  bench.issue(MfcOpcode::get, 0, 0, 1024, 1);
  EXPECT_TRUE(bench.mfc.issue(command(MfcOpcode::get, 1, bench.buffer.ea(), 16, 1))) << "not legal, not told";
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.element(64, 0), bench.element(0, 0), bench.element(8, 0)},
                   1);
  bench.issue(MfcOpcode::putqlluc, 0, 0, 0, 1);
  bench.issue(MfcOpcode::getllar, 0, 0, 0, 1);
  bench.issue(MfcOpcode::sdcrz, 0, 100, 100, 1);
  bench.issue(MfcOpcode::sdcrt, 0, 100, 100, 1);
  bench.issue(MfcOpcode::mfcsync, 0, 0, 0, 1);
  bench.wait_all(1u << 1);
  const std::map<std::uint64_t, Recorder::Issued> expected = {
      {1, {MfcOpcode::get, 1024}},    {2, {MfcOpcode::getl, 72}},   {3, {MfcOpcode::putqlluc, 128}},
      {4, {MfcOpcode::getllar, 128}}, {5, {MfcOpcode::sdcrz, 256}}, {6, {MfcOpcode::sdcrt, 0}},
      {7, {MfcOpcode::mfcsync, 0}},
  };
  EXPECT_EQ(recorder.issued, expected);
  std::vector<std::uint64_t> completed = recorder.completed;
  std::sort(completed.begin(), completed.end());
  EXPECT_EQ(completed, (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(recorder.completed.back(), 7u) << "it waits for all of its tag";

  bench.mfc.set_observer(nullptr);
  bench.issue(MfcOpcode::get, 0, 0, 1024, 1);
  EXPECT_EQ(recorder.issued.size(), 7u);
}

TEST(MfcObservers, SeeCommandsLeaveWhenTheyDo) {
  Recorder recorder;
  MfcBench bench(kLazy);
  bench.mfc.set_observer(&recorder);
  bench.issue(MfcOpcode::get, 0, 0, 16, 1);
  bench.issue(MfcOpcode::get, 0, 0, 16, 2);
  EXPECT_TRUE(recorder.completed.empty());
  bench.wait_all(1u << 2);
  EXPECT_EQ(recorder.completed, std::vector<std::uint64_t>{2});
  bench.wait_all(1u << 1);
  EXPECT_EQ(recorder.completed, (std::vector<std::uint64_t>{2, 1}));
}

TEST(MfcObservers, SeeALineCommandLeaveAtOnce) {
  Recorder recorder;
  MfcBench bench(kEager);
  bench.mfc.set_observer(&recorder);
  bench.issue(MfcOpcode::getllar, 0, 0, 0, 0);
  bench.issue(MfcOpcode::putllc, 0, 0, 0, 0);
  EXPECT_EQ(recorder.completed, (std::vector<std::uint64_t>{1, 2}));
}

TEST(MfcObservers, AreToldOfAPutllcThatMovedNothing) {
  Recorder recorder;
  MfcBench bench(kEager);
  bench.mfc.set_observer(&recorder);
  bench.issue(MfcOpcode::putllc, 0, 0, 0, 0);
  EXPECT_TRUE(recorder.completed.empty());
  EXPECT_EQ(recorder.failed, std::vector<std::uint64_t>{1});
}

}  // namespace
}  // namespace softcell::dma
