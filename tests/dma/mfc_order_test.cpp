// Fences and barriers: what they order under every schedule, and what they do not.
#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

constexpr std::uint32_t kBytes = 1024;

/// A bench whose buffer holds value v in block v of 1 KB.
class OrderBench : public MfcBench {
 public:
  explicit OrderBench(Schedule schedule) : MfcBench(schedule) {
    for (std::uint32_t block = 0; block < 16; ++block) {
      fill_buffer(kBytes * block, kBytes, static_cast<int>(block));
    }
  }
  void get_block(MfcOpcode opcode, int block, std::uint32_t lsa, std::uint32_t tag) {
    issue(opcode, lsa, kBytes * static_cast<std::uint32_t>(block), kBytes, tag);
  }
  bool store_holds(std::uint32_t lsa, int block) const {
    return count_in_store(lsa, kBytes, block) == kBytes;
  }
};

class MfcOrder : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcOrder, testing::ValuesIn(all_schedules()), schedule_test_name);

TEST_P(MfcOrder, AFencedGetComesAfterEarlierOnesOfItsTag) {
  OrderBench bench(GetParam());
  for (int block = 1; block <= 6; ++block) bench.get_block(MfcOpcode::getf, block, 0, 4);
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(0, 6));
}

TEST_P(MfcOrder, AFencedGetReadsWhatAnEarlierPutWrote) {
  OrderBench bench(GetParam());
  bench.fill_store(0, kBytes, 99);
  bench.issue(MfcOpcode::put, 0, 0, kBytes, 4);
  bench.issue(MfcOpcode::getf, 8192, 0, kBytes, 4);
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(8192, 99));
}

// The double-buffer pattern: the buffer is fetched into again once its put is fenced, with no wait in
// between.
TEST_P(MfcOrder, AFencedGetMayReuseTheSourceOfAPut) {
  OrderBench bench(GetParam());
  bench.fill_store(0, kBytes, 99);
  bench.issue(MfcOpcode::put, 0, 15 * kBytes, kBytes, 4);
  bench.get_block(MfcOpcode::getf, 1, 0, 4);
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(0, 1));
  EXPECT_EQ(bench.buffer_at(15 * kBytes), 99);
  EXPECT_EQ(bench.buffer_at(16 * kBytes - 1), 99);
}

TEST_P(MfcOrder, ABarrierSeparatesWhatIsBeforeItFromWhatIsAfter) {
  OrderBench bench(GetParam());
  bench.get_block(MfcOpcode::get, 1, 0, 4);
  bench.get_block(MfcOpcode::getb, 2, 8192, 4);
  bench.get_block(MfcOpcode::get, 3, 0, 4);     // after block 1
  bench.get_block(MfcOpcode::get, 4, 8192, 4);  // after block 2
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(0, 3));
  EXPECT_TRUE(bench.store_holds(8192, 4));
}

TEST_P(MfcOrder, OrderHoldsWhileTheQueueIsFull) {
  OrderBench bench(GetParam());
  for (int round = 0; round < 8; ++round) {
    for (int block = 1; block <= 6; ++block) {
      bench.get_block(block == 3 ? MfcOpcode::getb : MfcOpcode::getf, block, 0, 4);
      bench.get_block(MfcOpcode::get, 7, static_cast<std::uint32_t>(8192 + kBytes * block), 5);
    }
  }
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(0, 6));
}

TEST_P(MfcOrder, DrainKeepsOrder) {
  OrderBench bench(GetParam());
  for (int block = 1; block <= 6; ++block) bench.get_block(MfcOpcode::getb, block, 0, 4);
  bench.mfc.drain();
  EXPECT_TRUE(bench.store_holds(0, 6));
}

// The `barrier` command is of no tag's business: everything before it comes before everything after it.
TEST_P(MfcOrder, TheBarrierCommandOrdersTheWholeQueue) {
  OrderBench bench(GetParam());
  bench.get_block(MfcOpcode::get, 1, 0, 4);
  bench.get_block(MfcOpcode::get, 2, 8192, 5);
  bench.issue(MfcOpcode::barrier, 0, 0, 0, 6);
  bench.get_block(MfcOpcode::get, 3, 0, 7);
  bench.get_block(MfcOpcode::get, 4, 8192, 4);
  bench.wait_all(1u << 4 | 1u << 7);
  EXPECT_TRUE(bench.store_holds(0, 3));
  EXPECT_TRUE(bench.store_holds(8192, 4));
}

TEST_P(MfcOrder, MfcsyncAndMfceieioAreBarriersOfTheirTag) {
  for (const MfcOpcode opcode : {MfcOpcode::mfcsync, MfcOpcode::mfceieio}) {
    OrderBench bench(GetParam());
    bench.get_block(MfcOpcode::get, 1, 0, 4);
    bench.issue(opcode, 0, 0, 0, 4);
    bench.get_block(MfcOpcode::get, 2, 0, 4);
    bench.wait_all(1u << 4);
    EXPECT_TRUE(bench.store_holds(0, 2)) << name(opcode);
  }
}

// Each is a queue command with a tag of its own that one can wait for.
TEST_P(MfcOrder, WaitingForAnOrderingCommandIsWaitingForWhatItOrders) {
  OrderBench bench(GetParam());
  bench.get_block(MfcOpcode::get, 1, 0, 4);
  bench.issue(MfcOpcode::barrier, 0, 0, 0, 6);
  bench.wait_all(1u << 6);
  EXPECT_TRUE(bench.store_holds(0, 1));
  EXPECT_EQ(bench.mfc.statistics().ordering, 1u);
  EXPECT_EQ(bench.mfc.statistics().bytes(), kBytes);
}

// What follows is legal behaviour that surprises; the lazy schedule always shows it.

TEST(MfcOrderWhenLazy, UnorderedCommandsGoInReverse) {
  OrderBench bench(kLazy);
  bench.get_block(MfcOpcode::get, 1, 0, 4);
  bench.get_block(MfcOpcode::get, 2, 0, 4);
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(0, 1));
}

TEST(MfcOrderWhenLazy, AFenceDoesNotHoldUpLaterCommands) {
  OrderBench bench(kLazy);
  bench.get_block(MfcOpcode::get, 1, 0, 4);
  bench.get_block(MfcOpcode::getf, 2, 8192, 4);
  bench.get_block(MfcOpcode::get, 3, 0, 4);
  bench.wait_all(1u << 4);
  EXPECT_TRUE(bench.store_holds(0, 1));
}

TEST(MfcOrderWhenLazy, FencesAndBarriersDoNotReachOtherTags) {
  for (const MfcOpcode opcode : {MfcOpcode::getf, MfcOpcode::getb}) {
    OrderBench bench(kLazy);
    bench.get_block(MfcOpcode::get, 1, 0, 4);
    bench.get_block(opcode, 2, 0, 5);
    bench.wait_all(1u << 4 | 1u << 5);
    EXPECT_TRUE(bench.store_holds(0, 1));
  }
}

TEST(MfcOrderWhenLazy, MfcsyncAndMfceieioDoNotReachOtherTags) {
  for (const MfcOpcode opcode : {MfcOpcode::mfcsync, MfcOpcode::mfceieio}) {
    OrderBench bench(kLazy);
    bench.get_block(MfcOpcode::get, 1, 0, 4);
    bench.issue(opcode, 0, 0, 0, 5);
    bench.get_block(MfcOpcode::get, 2, 0, 5);
    bench.wait_all(1u << 4 | 1u << 5);
    EXPECT_TRUE(bench.store_holds(0, 1)) << name(opcode);
  }
}

TEST(MfcOrderWhenLazy, AWaitCompletesNothingElse) {
  OrderBench bench(kLazy);
  for (int block = 1; block <= 4; ++block) {
    bench.get_block(MfcOpcode::get, block, static_cast<std::uint32_t>(8192 * block),
                    static_cast<std::uint32_t>(block));
  }
  EXPECT_EQ(bench.wait_all(1u << 2), 1u << 2);
  EXPECT_TRUE(bench.store_holds(8192 * 2, 2));
  EXPECT_EQ(bench.wait_any(1u << 1 | 1u << 3), 1u << 3);
  for (const int block : {1, 4})
    EXPECT_TRUE(bench.store_holds(static_cast<std::uint32_t>(8192 * block), 0)) << block;
}

}  // namespace
}  // namespace softcell::dma
