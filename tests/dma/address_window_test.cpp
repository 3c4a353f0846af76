#include "softcell/dma/address_window.h"

#include <vector>

#include <gtest/gtest.h>

namespace softcell::dma {
namespace {

constexpr std::uint64_t kMegabyte = kLocalStoreStrideBytes;
const std::vector<EffectiveAddress> kThreads{{0xE000'0000}, {0xE010'0000}, {0xE050'0000}};

TEST(AddressWindow, ChangesNothingWithoutThreads) {
  EXPECT_EQ(AddressWindow().translate({0xF000'0000}).value, 0xF000'0000u);
}

TEST(AddressWindow, LeadsToLocalStoresAndRegistersOfTheGroup) {
  const AddressWindow window(0xE010'0000, kThreads);
  EXPECT_EQ(window.translate({0xF000'0000 + 2 * kMegabyte + 0x123}).value, 0xE050'0123u);
  EXPECT_EQ(window.translate({0xF000'0000 + kMegabyte + 0x5400C}).value, 0xE015'400Cu);
  for (const std::uint64_t elsewhere :
       {0xF000'0000 + 3 * kMegabyte, std::uint64_t{0xEFFF'FFFF}, std::uint64_t{0x40'0000},
        std::uint64_t{0x7F00'0000'0000}, std::uint64_t{0}})
    EXPECT_EQ(window.translate({elsewhere}).value, elsewhere);
}

TEST(AddressWindow, TakesSumsWithAPointerOfTheSpeOf64And32Bits) {
  const AddressWindow window(0xE010'0000, kThreads);
  const std::uint32_t pointer = 0xE010'0000 + 0x3FF00;
  const std::uint64_t sum = 0xF000'0000ull + pointer + kMegabyte * 2;
  EXPECT_EQ(window.translate({sum}).value, 0xE053'FF00u);
  EXPECT_EQ(window.translate({sum & 0xFFFF'FFFFu}).value, 0xE053'FF00u);
  EXPECT_EQ(window.translate({sum + kMegabyte}).value, sum + kMegabyte) << "there is no thread 3";
}

}  // namespace
}  // namespace softcell::dma
