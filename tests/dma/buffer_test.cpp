#include "softcell/dma/buffer.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>
#include <variant>

namespace softcell::dma {
namespace {

struct Record {
  float position[3];
  std::uint32_t flags;
};

TEST(Buffer, ShowsTheSameBytesToBothSides) {
  AddressSpace space;
  Buffer<float> buffer(space, "heights", 10);
  EXPECT_EQ(buffer.size(), 10u);
  EXPECT_EQ(buffer.size_bytes(), 40u);
  EXPECT_EQ(buffer[9], 0.0f);
  buffer.span()[9] = 2.5f;
  const auto resolved = space.resolve(buffer.ea(9), sizeof(float), SpeAccess::kRead);
  ASSERT_TRUE(std::holds_alternative<std::byte*>(resolved));
  EXPECT_EQ(*reinterpret_cast<float*>(std::get<std::byte*>(resolved)), 2.5f);
  EXPECT_EQ(buffer.ea(9), buffer.ea() + 36);
}

TEST(Buffer, FreesItselfOnceHoweverItWasMoved) {
  AddressSpace space;
  {
    Buffer<int> a(space, "a", 100);
    Buffer<int> b(std::move(a));
    Buffer<int> c;
    c = std::move(b);
    c = Buffer<int>(space, "other", 7);
    EXPECT_EQ(space.free_bytes(Memory::kMain), kMainMemoryBytes - 128);
    EXPECT_EQ(c.size(), 7u);
    EXPECT_TRUE(a.empty());  // NOLINT(bugprone-use-after-move): a moved-from buffer owns nothing
  }
  EXPECT_EQ(space.largest_free_range(Memory::kMain), kMainMemoryBytes);
}

TEST(Buffer, KnowsTheElementWidthOfNumbersOnly) {
  AddressSpace space;
  const Buffer<std::uint16_t> halves(space, "halves", 4);
  const Buffer<double> doubles(space, "doubles", 4);
  const Buffer<Record> records(space, "records", 4);
  const Buffer<Record> words(space, "words", 4, {.element_bytes = 4});
  EXPECT_EQ(space.mapping_at(halves.ea())->element_bytes, 2u);
  EXPECT_EQ(space.mapping_at(doubles.ea())->element_bytes, 8u);
  EXPECT_EQ(space.mapping_at(records.ea())->element_bytes, 0u);
  EXPECT_EQ(space.mapping_at(words.ea())->element_bytes, 4u);
}

TEST(Buffer, RefusesWhatDoesNotFit) {
  AddressSpace space;
  EXPECT_THROW(Buffer<Record>(space, "large", kMainMemoryBytes / sizeof(Record) + 1), std::runtime_error);
  try {
    Buffer<float>(space, "x", std::size_t{1} << 62);
    FAIL() << "its bytes are no number of 64 bits";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "buffer 'x' of 4611686018427387904 elements of 4 bytes: no memory is so large");
  }
  EXPECT_THROW(Buffer<Record>(space, "empty", 0), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::dma
