// Widths of numbers place by place, and transfers to a local store of the other byte order that follow them.

#include "softcell/dma/element_layout.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/dma/storage_port.h"

namespace softcell::dma {
namespace {

constexpr ElementRun kRecord[] = {{8, 8}, {16, 4}, {8, 2}};

TEST(ElementLayout, KnowsTheRunAtEachPlaceOfEachRepetition) {
  const ElementLayout layout(kRecord);
  for (const std::uint64_t repetition : {0u, 32u, 3200u}) {
    EXPECT_EQ(layout.run_at(repetition).element_bytes, 8u);
    EXPECT_EQ(layout.run_at(repetition + 8).element_bytes, 4u);
    EXPECT_EQ(layout.run_at(repetition + 8).bytes, 16u);
    EXPECT_EQ(layout.run_at(repetition + 20).bytes, 4u);
    EXPECT_EQ(layout.run_at(repetition + 24).element_bytes, 2u);
    EXPECT_EQ(layout.run_at(repetition + 31).bytes, 1u);
  }
}

std::string refusal(const std::vector<ElementRun>& record) {
  try {
    const ElementLayout layout(record);
  } catch (const std::invalid_argument& wrong) {
    return wrong.what();
  }
  return "taken";
}

TEST(ElementLayout, RefusesRecordsWhoseElementsAreNotAligned) {
  EXPECT_EQ(refusal({}), "a record without elements");
  EXPECT_EQ(refusal({{12, 3}}), "a record with elements of 3 bytes; allowed are 1, 2, 4 and 8");
  EXPECT_EQ(
      refusal({{4, 4}, {8, 8}}),
      "a record with 8 bytes of elements of 8 at 4; expected whole elements at multiples of their width");
  EXPECT_EQ(
      refusal({{6, 4}}),
      "a record with 6 bytes of elements of 4 at 0; expected whole elements at multiples of their width");
  EXPECT_EQ(
      refusal({{0, 4}}),
      "a record with 0 bytes of elements of 4 at 0; expected whole elements at multiples of their width");
  EXPECT_EQ(refusal({{8, 8}, {4, 4}}),
            "a record of 12 bytes with elements of 8: expected a multiple of each width, since the record "
            "repeats");
}

TEST(ElementLayout, ABufferHasAWidthOrARecord) {
  AddressSpace space;
  EXPECT_THROW(space.allocate("both", 32, {.element_bytes = 4, .record = kRecord}), std::invalid_argument);
  try {
    constexpr ElementRun kWrong[] = {{12, 3}};
    space.allocate("odd", 32, {.record = kWrong});
    ADD_FAILURE() << "an odd record was taken";
  } catch (const std::invalid_argument& wrong) {
    EXPECT_EQ(std::string(wrong.what()),
              "buffer 'odd': a record with elements of 3 bytes; allowed are 1, 2, 4 and 8");
  }
}

struct LaidOut {
  std::uint64_t address;
  std::uint32_t words[4];
  std::uint16_t halves[4];
};
static_assert(sizeof(LaidOut) == 32);

/// Four records in main memory, and a big-endian local store.
class BigEndianPort : public testing::Test {
 protected:
  BigEndianPort() {
    port_.set_big_endian(true);
    for (std::size_t i = 0; i < records_.size(); ++i) {
      records_[i].address = 0x0102030405060708u + i;
      for (std::size_t k = 0; k < 4; ++k) {
        records_[i].words[k] = static_cast<std::uint32_t>(0x11223344u + i + 16 * k);
        records_[i].halves[k] = static_cast<std::uint16_t>(0xA1B2u + i + 16 * k);
      }
    }
  }

  StoragePlace place(std::uint32_t offset, std::uint32_t bytes) {
    return std::get<StoragePlace>(port_.resolve(records_.ea() + offset, bytes, SpeAccess::kReadWrite));
  }
  template <class Element>
  Element at(std::uint32_t offset) const {
    Element value;
    std::memcpy(&value, store_->data() + offset, sizeof value);
    return value;
  }

  AddressSpace space_;
  Buffer<LaidOut> records_{space_, "records", 4, {.record = kRecord}};
  std::unique_ptr<std::array<std::byte, kLocalStoreBytes>> store_ =
      std::make_unique<std::array<std::byte, kLocalStoreBytes>>();
  StoragePort port_{store_->data(), space_, nullptr};
};

TEST_F(BigEndianPort, SwapsEachMemberByItsWidthWhereverATransferBegins) {
  for (const std::uint32_t begin : {0u, 16u, 48u}) {
    port_.read(place(begin, 64), store_->data() + begin, 64);
    for (std::uint32_t offset = begin; offset < begin + 64; offset += 8) {
      const LaidOut& record = records_[offset / 32];
      const std::uint32_t within = offset % 32;
      if (within == 0) {
        EXPECT_EQ(at<std::uint64_t>(offset), __builtin_bswap64(record.address));
      }
      if (within == 8 || within == 16) {
        EXPECT_EQ(at<std::uint32_t>(offset), __builtin_bswap32(record.words[(within - 8) / 4]));
      }
      if (within == 24) {
        EXPECT_EQ(at<std::uint16_t>(offset), __builtin_bswap16(record.halves[0]));
        EXPECT_EQ(at<std::uint16_t>(offset + 6), __builtin_bswap16(record.halves[3]));
      }
    }
  }
}

TEST_F(BigEndianPort, WritesBackWhatItRead) {
  std::array<LaidOut, 4> before;
  std::memcpy(before.data(), records_.data(), sizeof before);
  port_.read(place(0, 128), store_->data(), 128);
  for (LaidOut& record : records_.span()) record = {};
  port_.write(place(0, 128), store_->data(), 128);
  EXPECT_EQ(std::memcmp(before.data(), records_.data(), sizeof before), 0);
}

TEST_F(BigEndianPort, MovesPartsOfMembers) {
  // Bytes 0 and 7 of an address are its most and its least significant one for an SPU.
  port_.read(place(32, 1), store_->data(), 1);
  EXPECT_EQ(at<std::uint8_t>(0), 0x01u);
  port_.read(place(39, 1), store_->data() + 7, 1);
  EXPECT_EQ(at<std::uint8_t>(7), 0x09u);
  port_.read(place(36, 4), store_->data() + 4, 4);
  EXPECT_EQ(at<std::uint32_t>(4), __builtin_bswap32(0x05060709u));
  // Eight bytes of words are two words, and four of halfwords two halfwords.
  port_.read(place(8, 8), store_->data() + 8, 8);
  EXPECT_EQ(at<std::uint32_t>(12), __builtin_bswap32(records_[0].words[1]));
  port_.read(place(28, 4), store_->data() + 28, 4);
  EXPECT_EQ(at<std::uint16_t>(30), __builtin_bswap16(records_[0].halves[3]));
}

TEST_F(BigEndianPort, MovesLinesByTheRecord) {
  port_.load_and_reserve(place(0, 128), store_->data());
  EXPECT_EQ(at<std::uint64_t>(96), __builtin_bswap64(records_[3].address));
  EXPECT_EQ(at<std::uint16_t>(126), __builtin_bswap16(records_[3].halves[3]));
  (*store_)[127] = std::byte{0x77};
  EXPECT_TRUE(port_.store_conditional(place(0, 128), store_->data()));
  EXPECT_EQ(records_[3].halves[3] & 0xFF, 0x77);
}

}  // namespace
}  // namespace softcell::dma
