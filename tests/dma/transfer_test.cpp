#include "softcell/dma/transfer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace softcell::dma {
namespace {

constexpr std::byte kUntouched{0xEE};

// Local store and storage with different, position-dependent contents, and a get from one to the other.
struct Memories {
  AddressSpace space;
  std::vector<std::byte> store = std::vector<std::byte>(kLocalStoreBytes, kUntouched);
  StoragePort port{store.data(), space, nullptr};
  std::vector<std::byte> storage;

  Memories() {
    for (int i = 0; i < 32768; ++i) storage.push_back(static_cast<std::byte>(i * 7 % 229));
  }

  StoragePlace place(std::uint64_t offset) { return {kMainMemoryBase + offset, storage.data() + offset}; }
  Transfer get(std::uint64_t offset, std::uint32_t size) {
    return Transfer::get(place(offset), &store[1024], size);
  }
};

struct Shape {
  std::uint64_t ea_offset;
  std::uint32_t size;
  std::uint32_t pieces;
};

void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.size << " bytes at " << shape.ea_offset; }

class TransferShape : public testing::TestWithParam<Shape> {};

TEST_P(TransferShape, IsCutAtLinesOfMainStorage) {
  const auto [offset, size, pieces] = GetParam();
  Memories memories;
  const Transfer transfer = memories.get(offset, size);
  EXPECT_EQ(transfer.pieces_left(), pieces);
}

// Whatever the order of the pieces, each byte arrives once and none beside them.
TEST_P(TransferShape, MovesEveryByteInAnyOrderOfPieces) {
  const auto [offset, size, pieces] = GetParam();
  for (std::uint32_t order = 0; order < 4; ++order) {
    Memories memories;
    Transfer transfer = memories.get(offset, size);
    while (transfer.pieces_left() > 0) {
      const std::uint32_t left = transfer.pieces_left();
      const std::uint32_t choices[] = {0, left - 1, left / 2, (left * 13 + 5) % left};
      transfer.move_piece(choices[order], memories.port);
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
  Transfer transfer = memories.get(offset, size);
  for (std::uint32_t i = 0; i < pieces / 2; ++i)
    transfer.move_piece(transfer.pieces_left() / 2, memories.port);
  transfer.move_rest(memories.port);
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
  Transfer transfer = memories.get(112, 272);
  ASSERT_EQ(transfer.pieces_left(), 3u);  // 16, 128 and 128 bytes
  transfer.move_piece(1, memories.port);
  EXPECT_EQ(memories.store[1024 + 15], kUntouched);
  EXPECT_EQ(std::memcmp(&memories.store[1024 + 16], &memories.storage[128], 128), 0);
  EXPECT_EQ(memories.store[1024 + 144], kUntouched);
}

TEST(Transfer, PutGoesTheOtherWay) {
  Memories memories;
  Transfer transfer = Transfer::put(&memories.store[1024], memories.place(0), 32);
  transfer.move_rest(memories.port);
  EXPECT_EQ(memories.storage[31], kUntouched);
  EXPECT_NE(memories.storage[32], kUntouched);
}

TEST(Transfer, PoisonFillsTheDestinationOfAGetAndNothingOfAPut) {
  Memories memories;
  Transfer get = memories.get(0, 32);
  get.poison();
  EXPECT_EQ(memories.store[1024], Transfer::kPoison);
  EXPECT_EQ(memories.store[1024 + 31], Transfer::kPoison);
  EXPECT_EQ(memories.store[1024 + 32], kUntouched);
  get.move_rest(memories.port);
  EXPECT_EQ(std::memcmp(&memories.store[1024], &memories.storage[0], 32), 0);

  const std::vector<std::byte> before = memories.storage;
  Transfer put = Transfer::put(&memories.store[2048], memories.place(0), 32);
  put.poison();
  EXPECT_EQ(memories.storage, before);
  EXPECT_EQ(memories.store[2048], kUntouched);
}

}  // namespace
}  // namespace softcell::dma
