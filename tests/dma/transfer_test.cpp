#include "softcell/dma/transfer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace softcell::dma {
namespace {

constexpr std::byte kUntouched{0xEE};

// Local store and storage with different, position-dependent contents.
struct Memories {
  std::vector<std::byte> store = std::vector<std::byte>(kLocalStoreBytes, kUntouched);
  std::vector<std::byte> storage;

  Memories() {
    for (int i = 0; i < 32768; ++i) storage.push_back(static_cast<std::byte>(i * 7 % 229));
  }
};

MfcCommand get_at(std::uint64_t ea_offset, std::uint32_t size) {
  return {static_cast<std::uint32_t>(MfcOpcode::get), {1024}, kMainMemoryBase + ea_offset, size, 0};
}

struct Shape {
  std::uint64_t ea_offset;
  std::uint32_t size;
  std::uint32_t pieces;
};

class TransferShape : public testing::TestWithParam<Shape> {};

TEST_P(TransferShape, IsCutAtLinesOfMainStorage) {
  const auto [offset, size, pieces] = GetParam();
  Memories memories;
  const Transfer transfer(get_at(offset, size), memories.store.data(), memories.storage.data() + offset);
  EXPECT_EQ(transfer.pieces_left(), pieces);
}

// Whatever the order of the pieces, each byte arrives once and none beside them.
TEST_P(TransferShape, MovesEveryByteInAnyOrderOfPieces) {
  const auto [offset, size, pieces] = GetParam();
  for (std::uint32_t order = 0; order < 4; ++order) {
    Memories memories;
    Transfer transfer(get_at(offset, size), memories.store.data(), memories.storage.data() + offset);
    while (transfer.pieces_left() > 0) {
      const std::uint32_t left = transfer.pieces_left();
      const std::uint32_t choices[] = {0, left - 1, left / 2, (left * 13 + 5) % left};
      transfer.move_piece(choices[order]);
      ASSERT_EQ(transfer.pieces_left(), left - 1);
    }
    EXPECT_EQ(std::memcmp(&memories.store[1024], &memories.storage[offset], size), 0) << "order " << order;
    EXPECT_EQ(memories.store[1023], kUntouched);
    EXPECT_EQ(memories.store[1024 + size], kUntouched);
  }
}

TEST_P(TransferShape, MovesTheRestAfterSomePieces) {
  const auto [offset, size, pieces] = GetParam();
  Memories memories;
  Transfer transfer(get_at(offset, size), memories.store.data(), memories.storage.data() + offset);
  for (std::uint32_t i = 0; i < pieces / 2; ++i) transfer.move_piece(transfer.pieces_left() / 2);
  transfer.move_rest();
  EXPECT_EQ(transfer.pieces_left(), 0u);
  EXPECT_EQ(std::memcmp(&memories.store[1024], &memories.storage[offset], size), 0);
  EXPECT_EQ(memories.store[1024 + size], kUntouched);
}

INSTANTIATE_TEST_SUITE_P(Shapes, TransferShape,
                         testing::Values(Shape{0, 1, 1}, Shape{8, 4, 1}, Shape{0, 128, 1}, Shape{16, 128, 2},
                                         Shape{112, 16, 1}, Shape{112, 32, 2}, Shape{0, 8192, 64},
                                         Shape{0, 8208, 65}, Shape{0, 16384, 128}, Shape{16, 16384, 129},
                                         Shape{112, 16384, 129}));

TEST(Transfer, MovesAWholePieceAndOnlyThat) {
  Memories memories;
  Transfer transfer(get_at(112, 272), memories.store.data(), memories.storage.data() + 112);
  ASSERT_EQ(transfer.pieces_left(), 3u);  // 16, 128 and 128 bytes
  transfer.move_piece(1);
  EXPECT_EQ(memories.store[1024 + 15], kUntouched);
  EXPECT_EQ(std::memcmp(&memories.store[1024 + 16], &memories.storage[128], 128), 0);
  EXPECT_EQ(memories.store[1024 + 144], kUntouched);
}

TEST(Transfer, PutGoesTheOtherWay) {
  Memories memories;
  Transfer transfer({static_cast<std::uint32_t>(MfcOpcode::putr), {1024}, kMainMemoryBase, 32, 0},
                    memories.store.data(), memories.storage.data());
  transfer.move_rest();
  EXPECT_EQ(memories.storage[31], kUntouched);
  EXPECT_NE(memories.storage[32], kUntouched);
}

}  // namespace
}  // namespace softcell::dma
