// Lists: where elements go, what stalls and how it goes on, and what is found only while a list executes.
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

/// Every byte of the buffer tells where it is from.
class ListBench : public MfcBench {
 public:
  explicit ListBench(Schedule schedule) : MfcBench(schedule) {
    for (std::size_t i = 0; i < kBufferBytes; ++i) buffer[i] = static_cast<std::byte>(i * 37 % 251 + 1);
  }
  bool store_holds(std::uint32_t lsa, std::uint32_t offset, std::uint32_t bytes) const {
    return std::equal(buffer.data() + offset, buffer.data() + offset + bytes, store.begin() + lsa);
  }
  std::uint32_t stall_status() {
    const auto status = mfc.read_list_stall_status();
    EXPECT_TRUE(std::holds_alternative<std::uint32_t>(status));
    return std::holds_alternative<std::uint32_t>(status) ? std::get<std::uint32_t>(status) : 0;
  }
};

class MfcList : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcList, testing::ValuesIn(all_schedules()), schedule_test_name);

TEST_P(MfcList, GathersElementsOneBehindTheOther) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000,
                   {bench.element(256, 512), bench.element(16, 0), bench.element(16384, 1024)}, 3);
  bench.wait_all(1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1000, 512, 256));
  EXPECT_TRUE(bench.store_holds(0x1100, 0, 16));
  EXPECT_TRUE(bench.store_holds(0x1110, 1024, 16384));
  EXPECT_EQ(bench.store_at(0x1110 + 16384), 0);
}

TEST_P(MfcList, ScattersElements) {
  for (const MfcOpcode opcode : {MfcOpcode::putl, MfcOpcode::putrl}) {
    ListBench bench(GetParam());
    bench.fill_store(0x1000, 128, 0xA0);
    bench.fill_store(0x1080, 32, 0xB0);
    bench.issue_list(opcode, 0x1000, {bench.element(128, 4096), bench.element(32, 0)}, 3);
    bench.wait_all(1u << 3);
    EXPECT_EQ(bench.buffer_at(4096), 0xA0);
    EXPECT_EQ(bench.buffer_at(4096 + 127), 0xA0);
    EXPECT_EQ(bench.buffer_at(0), 0xB0);
    EXPECT_EQ(bench.buffer_at(31), 0xB0);
    EXPECT_NE(bench.buffer_at(32), 0xB0);
  }
}

// An element below 16 bytes keeps its place in the quadword, and the next one begins at a quadword.
TEST_P(MfcList, RoundsTheAddressAfterEachElementUpToAQuadword) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000,
                   {bench.element(4, 8), bench.element(1, 47), bench.element(8, 128), bench.element(32, 64),
                    bench.element(2, 14)},
                   3);
  bench.wait_all(1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1008, 8, 4));
  EXPECT_TRUE(bench.store_holds(0x101F, 47, 1));
  EXPECT_TRUE(bench.store_holds(0x1020, 128, 8));
  EXPECT_TRUE(bench.store_holds(0x1030, 64, 32));
  EXPECT_TRUE(bench.store_holds(0x105E, 14, 2));
  EXPECT_EQ(bench.count_in_store(0x1000, 0x60, 0), 0x60 - (4 + 1 + 8 + 32 + 2));
}

TEST_P(MfcList, TakesElementsOfSizeZeroAsNoTransfer) {
  ListBench bench(GetParam());
  bench.issue_list(
      MfcOpcode::getl, 0x1000,
      {ListElement{0, 0xFFFFFFFF}, bench.element(16, 0), bench.element(0, 0), bench.element(16, 64)}, 3);
  bench.wait_all(1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1000, 0, 16));
  EXPECT_TRUE(bench.store_holds(0x1010, 64, 16));
}

TEST_P(MfcList, TakesTheLongestList) {
  ListBench bench(GetParam());
  std::vector<ListElement> elements;
  for (std::uint32_t i = 0; i < 2048; ++i) elements.push_back(bench.element(16, (2047 - i) * 16));
  bench.issue_list(MfcOpcode::getl, 0, elements, 3);
  bench.wait_all(1u << 3);
  for (std::uint32_t i = 0; i < 2048; ++i) ASSERT_TRUE(bench.store_holds(i * 16, (2047 - i) * 16, 16)) << i;
}

TEST_P(MfcList, ReachesTheLastByteOfTheLocalStore) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x3FFE0,
                   {bench.element(16, 0), bench.element(1, 15), bench.element(0, 0)}, 3);
  bench.wait_all(1u << 3);
  EXPECT_TRUE(bench.store_holds(0x3FFFF, 15, 1));
}

TEST_P(MfcList, FencesAndBarriersTakeAListAsAWhole) {
  ListBench bench(GetParam());
  bench.fill_store(0x1000, 512, 0xA0);
  bench.issue_list(MfcOpcode::putl, 0x1000, {bench.element(256, 0), bench.element(256, 256)}, 3);
  bench.issue_list(MfcOpcode::getlf, 0x2000, {bench.element(256, 256), bench.element(256, 0)}, 3, 0x31000);
  bench.issue(MfcOpcode::getb, 0x1000, 4096, 512, 3);
  bench.issue_list(MfcOpcode::putrl, 0x1000, {bench.element(512, 8192)}, 3, 0x32000);
  bench.wait_all(1u << 3);
  EXPECT_EQ(bench.count_in_store(0x2000, 512, 0xA0), 512);
  EXPECT_TRUE(bench.store_holds(0x1000, 4096, 512));
  EXPECT_TRUE(bench.store_holds(0x1000, 8192, 512));
}

TEST_P(MfcList, StallsAfterTheElementWithTheBitAndGoesOnWhenAcknowledged) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000,
                   {bench.element(128, 0), bench.stalling(128, 128), bench.element(128, 256)}, 3);
  EXPECT_EQ(bench.stall_status(), 1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1000, 0, 256));
  EXPECT_EQ(bench.wait_immediate(1u << 3), 0u);
  EXPECT_FALSE(bench.store_holds(0x1100, 256, 128));
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
  EXPECT_EQ(bench.wait_all(1u << 3), 1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1100, 256, 128));
}

// The supported way to change a list while it is live.
TEST_P(MfcList, ElementsBehindAStalledOneMayBeRewritten) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(0, 0), ListElement{0x7FFF8000, 1}}, 3);
  EXPECT_EQ(bench.stall_status(), 1u << 3);
  bench.write_list({bench.element(64, 1024)}, MfcBench::kListLsa + kListElementBytes);
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
  bench.wait_all(1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1000, 1024, 64));
}

TEST_P(MfcList, TheLastElementDoesNotStall) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.element(64, 0), bench.stalling(64, 64)}, 3);
  bench.issue_list(MfcOpcode::getl, 0x2000, {bench.stalling(64, 0)}, 3, 0x31000);
  EXPECT_EQ(bench.wait_all(1u << 3), 1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1000, 0, 128));
  EXPECT_EQ(bench.mfc.list_stall_count(), 0);
  EXPECT_EQ(bench.mfc.statistics().get_list.stalls, 0u);
}

TEST_P(MfcList, OnlyCommandsOrderedBehindAStalledListWaitForIt) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(64, 0), bench.element(64, 64)}, 3);
  bench.issue(MfcOpcode::getf, 0x1040, 1024, 64, 3);  // over the list's second element
  bench.issue(MfcOpcode::get, 0x2000, 2048, 64, 4);
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(0x2000, 2048, 64));
  EXPECT_EQ(bench.stall_status(), 1u << 3);
  EXPECT_EQ(bench.count_in_store(0x1040, 64, 0), 64);
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
  bench.wait_all(1u << 3);
  EXPECT_TRUE(bench.store_holds(0x1040, 1024, 64));
}

TEST_P(MfcList, AWaitForAnyPassesByATagThatHasStalled) {
  ListBench bench(GetParam());
  bench.issue(MfcOpcode::get, 0x2000, 2048, 64, 4);
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(64, 0), bench.element(64, 64)}, 3);
  EXPECT_EQ(bench.wait_any(1u << 3 | 1u << 4), 1u << 4);
  EXPECT_TRUE(bench.store_holds(0x2000, 2048, 64));
}

TEST_P(MfcList, ALoopThatPollsForAStallComesToAnEnd) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000,
                   {bench.element(4096, 0), bench.stalling(4096, 4096), bench.element(16, 0)}, 3);
  int polls = 0;
  while (bench.mfc.list_stall_count() == 0) ASSERT_LT(++polls, 100000);
  EXPECT_EQ(bench.stall_status(), 1u << 3);
  EXPECT_EQ(bench.mfc.list_stall_count(), 0) << "reading clears it";
}

TEST_P(MfcList, OneAcknowledgementIsForAllListsOfATagThatHaveStalled) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(64, 0), bench.element(64, 64)}, 3, 0x30000);
  bench.issue_list(MfcOpcode::getl, 0x2000, {bench.stalling(64, 0), bench.element(64, 64)}, 3, 0x31000);
  bench.issue_list(MfcOpcode::getl, 0x3000, {bench.stalling(64, 0), bench.element(64, 64)}, 5, 0x32000);
  std::uint32_t stalled = 0;
  while (bench.mfc.advance()) {
  }
  while (bench.mfc.list_stall_count() != 0) stalled |= bench.stall_status();
  EXPECT_EQ(stalled, 1u << 3 | 1u << 5);
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
  EXPECT_EQ(bench.wait_all(1u << 3), 1u << 3);
  EXPECT_EQ(bench.wait_immediate(1u << 5), 0u);
}

TEST_P(MfcList, CountsElementsBytesAndStalls) {
  ListBench bench(GetParam());
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.element(64, 0), bench.stalling(0, 0), bench.element(8, 0)},
                   3);
  EXPECT_EQ(bench.stall_status(), 1u << 3);
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
  bench.issue_list(MfcOpcode::putlb, 0x1000, {bench.element(16, 0)}, 3, 0x31000);
  bench.wait_all(1u << 3);
  const MfcStatistics& statistics = bench.mfc.statistics();
  EXPECT_EQ(statistics.get_list.commands, 1u);
  EXPECT_EQ(statistics.get_list.elements, 3u);
  EXPECT_EQ(statistics.get_list.bytes, 72u);
  EXPECT_EQ(statistics.get_list.stalls, 1u);
  EXPECT_EQ(statistics.put_list.commands, 1u);
  EXPECT_EQ(statistics.put_list.elements, 1u);
  EXPECT_EQ(statistics.put_list.bytes, 16u);
  EXPECT_EQ(statistics.put_list.stalls, 0u);
  EXPECT_EQ(statistics.commands(), 2u);
  EXPECT_EQ(statistics.bytes(), 88u);
}

// Neighbouring elements are under way together, so a list that puts twice to one place has no defined result.
TEST(MfcListOrder, RandomLetsNeighboursOvertakeEachOther) {
  std::set<int> winners;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    ListBench bench({Schedule::kRandom, seed});
    bench.fill_store(0x1000, 16, 1);
    bench.fill_store(0x1010, 16, 2);
    bench.issue_list(MfcOpcode::putl, 0x1000, {bench.element(16, 0), bench.element(16, 0)}, 3);
    bench.wait_all(1u << 3);
    winners.insert(bench.buffer_at(0));
  }
  EXPECT_EQ(winners, (std::set<int>{1, 2}));
}

// What a list's elements may break: each beside its nearest legal twin, as second element of two.
struct ElementCase {
  const char* name;
  ListElement legal, broken;
  Rule rule;
  const char* detail;
};

void PrintTo(const ElementCase& c, std::ostream* out) { *out << c.name; }

constexpr std::uint32_t kEal = static_cast<std::uint32_t>(kMainMemoryBase.value);

const ElementCase kElementCases[] = {
    {"ReservedBits",
     {16, kEal},
     {0x00008010, kEal},
     Rule::kListElementReservedBits,
     "element 1 of 2 (from 0): its first word is 0x00008010; bits 1 to 16 must be zero"},
    {"ReservedBitNextToTheStallBit",
     {16, kEal},
     {0x40000010, kEal},
     Rule::kListElementReservedBits,
     "0x40000010"},
    {"BitFieldsFromTheLowestBit",
     {16, kEal},
     {0x00100000, kEal},
     Rule::kListElementReservedBits,
     "its first word is 0x00100000; bits 1 to 16 must be zero; were bit fields written?"},
    {"SizeTwelve",
     {8, kEal},
     {12, kEal},
     Rule::kListElementSize,
     "element 1 of 2 (from 0): 12 bytes is neither 1, 2, 4, 8 nor a multiple of 16"},
    {"SizeAbove16384",
     {16384, kEal},
     {16400, kEal},
     Rule::kListElementSize,
     "element 1 of 2 (from 0): 16400 bytes are more than the 16384"},
    {"EaOfSixteenBytes",
     {16, kEal + 16},
     {16, kEal + 8},
     Rule::kListElementAlignment,
     "element 1 of 2 (from 0): EA 0x10000008 is 8 bytes past a multiple of 16"},
    {"EaOfFourBytes",
     {4, kEal + 4},
     {4, kEal + 6},
     Rule::kListElementAlignment,
     "element 1 of 2 (from 0): EA 0x10000006 is 2 bytes past a multiple of 4"},
    {"FourGigabytes",
     {16, kEal},
     {32, 0xFFFFFFF0},
     Rule::kListCrosses4Gb,
     "element 1 of 2 (from 0): 32 bytes from 0x5EA0FFFFFFF0 on reach past a boundary of 4 GB"},
    {"NotMapped",
     {16, kEal},
     {16, kEal + 0x100000},
     Rule::kEaNotMapped,
     "element 1 of 2 (from 0): no buffer lies there"},
    {"CrossesTheBuffer",
     {16, kEal + MfcBench::kBufferBytes - 16},
     {32, kEal + MfcBench::kBufferBytes - 16},
     Rule::kEaCrossesBuffer,
     "element 1 of 2 (from 0): 16 of 32 bytes lie in buffer 'buffer'"},
};

class MfcListElement : public testing::TestWithParam<ElementCase> {};
INSTANTIATE_TEST_SUITE_P(Cases, MfcListElement, testing::ValuesIn(kElementCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(MfcListElement, IsFoundWhileTheListExecutes) {
  const ElementCase& c = GetParam();
  for (const Schedule& schedule : all_schedules()) {
    ListBench legal(schedule);
    legal.issue_list(MfcOpcode::getl, 0x1000, {legal.element(16, 0), c.legal}, 3);
    EXPECT_EQ(legal.wait_all(1u << 3), 1u << 3);

    ListBench broken(schedule);
    broken.write_list({broken.element(16, 0), c.broken});
    const MfcCommand list = broken.list_command(MfcOpcode::getl, 0x1000, 2, 3);
    std::optional<Fault> fault = broken.mfc.issue(list);
    if (!fault) {
      broken.mfc.write_tag_mask(1u << 3);
      fault = broken.mfc.write_tag_update(2);
      ASSERT_FALSE(fault);
      const auto status = broken.mfc.read_tag_status();
      ASSERT_TRUE(std::holds_alternative<Fault>(status)) << to_string(schedule);
      fault = std::get<Fault>(status);
    }
    EXPECT_EQ(name(fault->rule), name(c.rule));
    EXPECT_EQ(fault->command, list);
    EXPECT_NE(fault->detail.find(c.detail), std::string::npos) << fault->detail;
  }
}

TEST(MfcListElements, AskForAnAlignedLocalStoreAddressFrom16BytesOn) {
  ListBench bench(kEager);
  bench.issue_list(MfcOpcode::getl, 0x1004, {bench.element(4, 8), bench.element(16, 16)}, 3);
  EXPECT_TRUE(bench.store_holds(0x1008, 8, 4));
  EXPECT_TRUE(bench.store_holds(0x1010, 16, 16));

  bench.write_list({bench.element(16, 16)});
  const std::optional<Fault> fault = bench.mfc.issue(bench.list_command(MfcOpcode::getl, 0x1004, 1, 3));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kLsaAlignment);
  EXPECT_EQ(
      fault->message(),
      "SPE unknown, kernel unknown: lsa-alignment: getl tag 3, LSA 0x01004, MFC_EAH 0x00005EA0, list "
      "0x30000, 8 bytes of list: element 0 of 1 (from 0): LSA 0x01004 is 4 bytes past a multiple of 16, "
      "which a transfer of 16 bytes needs");
}

TEST(MfcListElements, MustNotRunOffTheEndOfTheLocalStore) {
  ListBench bench(kEager);
  bench.write_list({bench.element(16, 0), bench.element(16, 0)});
  EXPECT_FALSE(bench.mfc.issue(bench.list_command(MfcOpcode::getl, 0x3FFE0, 2, 3)));
  const std::optional<Fault> fault = bench.mfc.issue(bench.list_command(MfcOpcode::getl, 0x3FFF0, 2, 3));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kLsaOutOfRange);
  EXPECT_NE(fault->detail.find("element 1 of 2 (from 0): bytes 0x40000..0x4000F"), std::string::npos)
      << fault->detail;
}

TEST(MfcListElements, APutNeedsPermissionForEachElement) {
  ListBench bench(kEager);
  const Buffer<char> input(bench.space, "input", 128, {.spe_access = SpeAccess::kRead});
  bench.write_list({bench.element(16, 0), {16, static_cast<std::uint32_t>(input.ea().value)}});
  EXPECT_FALSE(bench.mfc.issue(bench.list_command(MfcOpcode::getl, 0x1000, 2, 3)));
  const std::optional<Fault> fault = bench.mfc.issue(bench.list_command(MfcOpcode::putl, 0x1000, 2, 3));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kEaNotWritable);
}

// A fault suspends the queue, as the hardware's does, until the next job.
TEST(MfcListFault, SuspendsTheQueueAndIsGivenOnceToWhoeverAsksFirst) {
  ListBench bench(kLazy);
  bench.issue(MfcOpcode::get, 0x2000, 0, 16, 4);
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.element(3, 0)}, 3);
  EXPECT_FALSE(bench.mfc.poll_fault());
  EXPECT_TRUE(bench.mfc.advance()) << "the list is the newest, and tried first";
  EXPECT_FALSE(bench.mfc.advance());
  const std::optional<Fault> fault = bench.mfc.poll_fault();
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kListElementSize);
  EXPECT_FALSE(bench.mfc.poll_fault());

  EXPECT_EQ(bench.count_in_store(0x2000, 16, 0), 16) << "nothing moves any more";
  const auto refused = bench.mfc.issue(command(MfcOpcode::get, 0x2000, bench.buffer.ea(), 16, 4));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->rule, Rule::kListElementSize);
  EXPECT_TRUE(bench.mfc.drain());

  bench.mfc.begin_job(1);
  EXPECT_FALSE(bench.mfc.poll_fault());
  bench.issue(MfcOpcode::get, 0x2000, 0, 16, 4);
  EXPECT_EQ(bench.wait_all(1u << 4), 1u << 4);
  EXPECT_FALSE(bench.mfc.drain());
}

TEST(MfcListStall, WaitingForATagThatHasStalledNeverEnds) {
  for (const Schedule& schedule : all_schedules()) {
    ListBench bench(schedule);
    bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(16, 0), bench.element(16, 0)}, 3);
    bench.mfc.write_tag_mask(1u << 3);
    ASSERT_FALSE(bench.mfc.write_tag_update(2));
    const auto status = bench.mfc.read_tag_status();
    ASSERT_TRUE(std::holds_alternative<Fault>(status));
    const Fault& fault = std::get<Fault>(status);
    EXPECT_EQ(fault.rule, Rule::kListStalledForEver);
    EXPECT_EQ(
        fault.detail,
        "the list has stalled after element 0 of 2 (from 0); write its tag 3 to MFC_WrListStallAck before "
        "waiting for what it holds up");
    const std::optional<Fault> at_end = bench.mfc.drain();
    ASSERT_TRUE(at_end);
    EXPECT_EQ(at_end->rule, Rule::kListStalledForEver);
  }
}

TEST(MfcListStall, AQueueFullOfStalledListsTakesNoMore) {
  for (const Schedule& schedule : all_schedules()) {
    ListBench bench(schedule);
    for (std::uint32_t i = 0; i < 16; ++i) {
      bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(16, 0), bench.element(16, 0)}, 3,
                       0x30000 + i * 16);
    }
    const auto refused = bench.mfc.issue(command(MfcOpcode::get, 0, bench.buffer.ea(), 16, 4));
    ASSERT_TRUE(refused) << to_string(schedule);
    EXPECT_EQ(refused->rule, Rule::kListStalledForEver);
    EXPECT_FALSE(bench.mfc.advance());
    ASSERT_FALSE(bench.mfc.write_list_stall_ack(3));
    bench.issue(MfcOpcode::get, 0, 0, 16, 4);
    bench.wait_all(1u << 3 | 1u << 4);
  }
}

TEST(MfcListStall, ReadingItsStatusWithNothingThatStallsNeverEnds) {
  ListBench bench(kLazy);
  const auto expect_fault = [&](const char* detail) {
    const auto status = bench.mfc.read_list_stall_status();
    ASSERT_TRUE(std::holds_alternative<Fault>(status));
    EXPECT_EQ(std::get<Fault>(status).rule, Rule::kListStallNotExpected);
    EXPECT_EQ(std::get<Fault>(status).detail, detail);
  };
  expect_fault("MFC_RdListStallStat was read, and no list that stalls is queued");
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.element(16, 0)}, 3);
  expect_fault("MFC_RdListStallStat was read, and no list that stalls is queued");
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(16, 0), bench.element(16, 0)}, 3);
  EXPECT_EQ(bench.stall_status(), 1u << 3);
  expect_fault(
      "MFC_RdListStallStat was read again, and no further list stalls before tag 3 is written to "
      "MFC_WrListStallAck; the stall bit of a list's last element has no effect");
}

TEST(MfcListStall, ReadingItsStatusAgainNamesTheTagsThatWait) {
  ListBench bench(kEager);
  for (const std::uint32_t tag : {1u, 4u, 1u})
    bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(16, 0), bench.stalling(16, 0)}, tag);
  EXPECT_EQ(bench.stall_status(), 1u << 1 | 1u << 4);
  ASSERT_FALSE(bench.mfc.write_list_stall_ack(4));  // on to its last element, which does not stall
  const auto status = bench.mfc.read_list_stall_status();
  ASSERT_TRUE(std::holds_alternative<Fault>(status));
  EXPECT_EQ(std::get<Fault>(status).detail,
            "MFC_RdListStallStat was read again, and no further list stalls before tag 1 is written to "
            "MFC_WrListStallAck; the stall bit of a list's last element has no effect");
}

TEST(MfcListStall, AnAcknowledgementNeedsAStalledListOfItsTag) {
  ListBench bench(kEager);
  bench.issue_list(MfcOpcode::getl, 0x1000, {bench.stalling(16, 0), bench.element(16, 0)}, 3);
  for (const std::uint32_t tag : {4u, 32u, 35u}) {
    const std::optional<Fault> fault = bench.mfc.write_list_stall_ack(tag);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->rule, Rule::kListStallAckTag);
    EXPECT_EQ(fault->detail, "MFC_WrListStallAck was written with tag " + std::to_string(tag) +
                                 ", of which no list has stalled");
  }
  EXPECT_FALSE(bench.mfc.write_list_stall_ack(3));
  EXPECT_TRUE(bench.mfc.write_list_stall_ack(3)) << "once";
}

}  // namespace
}  // namespace softcell::dma
