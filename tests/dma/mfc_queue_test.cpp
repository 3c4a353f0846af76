#include "softcell/dma/mfc_queue.h"

#include <gtest/gtest.h>

namespace softcell::dma {
namespace {

MfcCommand plain(std::uint32_t tag) { return {.word = 0x40, .tag = tag}; }
MfcCommand fence(std::uint32_t tag) { return {.word = 0x42, .tag = tag}; }
MfcCommand barrier(std::uint32_t tag) { return {.word = 0x41, .tag = tag}; }

/// The `barrier` command.
MfcCommand all(std::uint32_t tag) { return {.word = 0xC0, .tag = tag}; }

SlotSet bits(std::initializer_list<int> slots) {
  SlotSet set = 0;
  for (const int slot : slots) set |= static_cast<SlotSet>(1u << slot);
  return set;
}

TEST(MfcQueue, HoldsSixteen) {
  MfcQueue queue;
  EXPECT_TRUE(queue.empty());
  for (int i = 0; i < 16; ++i) {
    EXPECT_FALSE(queue.full());
    EXPECT_EQ(queue.free_slots(), 16 - i);
    queue.push(plain(static_cast<std::uint32_t>(i)));
  }
  EXPECT_TRUE(queue.full());
  EXPECT_EQ(queue.busy_tags(), 0xFFFFu);
  queue.complete(5);
  EXPECT_EQ(queue.free_slots(), 1);
  EXPECT_EQ(queue.busy_tags(), 0xFFDFu);
  EXPECT_EQ(queue.push(plain(31)), 5);
  EXPECT_EQ(queue.newest(queue.slots()), 5);
}

TEST(MfcQueue, PlainCommandsWaitForNothing) {
  MfcQueue queue;
  for (int i = 0; i < 3; ++i) queue.push(plain(1));
  EXPECT_EQ(queue.ready(), bits({0, 1, 2}));
}

TEST(MfcQueue, FenceWaitsForEarlierCommandsOfItsTagAndHoldsUpNone) {
  MfcQueue queue;
  queue.push(plain(1));
  queue.push(plain(2));
  queue.push(fence(1));
  queue.push(plain(1));
  EXPECT_EQ(queue.ready(), bits({0, 1, 3}));
  queue.complete(3);
  EXPECT_EQ(queue.ready(), bits({0, 1}));
  queue.complete(0);
  EXPECT_EQ(queue.ready(), bits({1, 2}));
}

TEST(MfcQueue, BarrierAlsoHoldsUpLaterCommandsOfItsTag) {
  MfcQueue queue;
  queue.push(plain(1));
  queue.push(barrier(1));
  queue.push(plain(1));
  queue.push(plain(2));
  EXPECT_EQ(queue.ready(), bits({0, 3}));
  queue.complete(0);
  EXPECT_EQ(queue.ready(), bits({1, 3}));
  queue.complete(1);
  EXPECT_EQ(queue.ready(), bits({2, 3}));
}

TEST(MfcQueue, FencesAndBarriersChain) {
  MfcQueue queue;
  queue.push(barrier(1));
  queue.push(fence(1));
  queue.push(barrier(1));
  queue.push(fence(1));
  for (int slot = 0; slot < 4; ++slot) {
    EXPECT_EQ(queue.ready(), bits({slot}));
    queue.complete(slot);
  }
  EXPECT_TRUE(queue.empty());
}

TEST(MfcQueue, TheBarrierCommandWaitsForAllAndAllWaitForIt) {
  MfcQueue queue;
  queue.push(plain(1));
  queue.push(plain(2));
  queue.push(all(3));
  queue.push(plain(2));
  queue.push(all(3));
  queue.push(fence(4));
  EXPECT_EQ(queue.ready(), bits({0, 1}));
  queue.complete(1);
  queue.complete(0);
  EXPECT_EQ(queue.ready(), bits({2}));
  queue.complete(2);
  EXPECT_EQ(queue.ready(), bits({3}));
  queue.complete(3);
  EXPECT_EQ(queue.ready(), bits({4}));
  queue.complete(4);
  EXPECT_EQ(queue.ready(), bits({5}));
}

TEST(MfcQueue, KnowsAllThatMustBeDoneBefore) {
  MfcQueue queue;
  queue.push(plain(1));
  queue.push(barrier(1));
  queue.push(plain(2));
  queue.push(plain(1));  // after slot 1, hence after slot 0
  queue.push(all(3));
  EXPECT_EQ(queue.with_predecessors(0), 0);
  EXPECT_EQ(queue.with_predecessors(bits({2})), bits({2}));
  EXPECT_EQ(queue.with_predecessors(bits({3})), bits({0, 1, 3}));
  EXPECT_EQ(queue.with_predecessors(bits({4})), bits({0, 1, 2, 3, 4}));
  queue.complete(0);
  EXPECT_EQ(queue.with_predecessors(bits({3})), bits({1, 3}));
}

// A slot filled anew is another command: those that waited for the old one do not wait for it.
TEST(MfcQueue, AReusedSlotHasNoPast) {
  MfcQueue queue;
  queue.push(barrier(1));
  queue.push(plain(1));
  queue.complete(0);
  EXPECT_EQ(queue.push(plain(2)), 0);
  EXPECT_EQ(queue.ready(), bits({0, 1}));
  EXPECT_EQ(queue.push(plain(1)), 2);
  EXPECT_EQ(queue.ready(), bits({0, 1, 2}));
}

TEST(MfcQueue, FindsSlotsByTagAndAge) {
  MfcQueue queue;
  queue.push(plain(1));
  queue.push(plain(31));
  queue.push(plain(1));
  EXPECT_EQ(queue.slots_of(1u << 1), bits({0, 2}));
  EXPECT_EQ(queue.slots_of(1u << 1 | 1u << 31), bits({0, 1, 2}));
  EXPECT_EQ(queue.slots_of(1u << 5), 0);
  EXPECT_EQ(queue.newest(bits({0, 1})), 1);
  EXPECT_EQ(queue.oldest(bits({1, 2})), 1);
  queue.clear();
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.busy_tags(), 0u);
}

}  // namespace
}  // namespace softcell::dma
