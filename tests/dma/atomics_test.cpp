#include "softcell/dma/atomics.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <stdexcept>

#include "softcell/dma/buffer.h"

namespace softcell::dma {
namespace {

template <class T>
class AtomicsOf : public testing::Test {
 protected:
  AddressSpace space_;
  Buffer<T> words_{space_, "words", 64};
  Atomics one_{space_};
  Atomics two_{space_};
};

using Words = testing::Types<std::uint32_t, std::int32_t, std::uint64_t, std::int64_t>;
TYPED_TEST_SUITE(AtomicsOf, Words);

TYPED_TEST(AtomicsOf, AStoreConditionalAfterItsLoadStores) {
  this->words_[3] = 41;
  EXPECT_EQ(this->one_.template load_and_reserve<TypeParam>(this->words_.ea(3)), TypeParam{41});
  EXPECT_TRUE(this->one_.store_conditional(this->words_.ea(3), TypeParam{42}));
  EXPECT_FALSE(this->one_.store_conditional(this->words_.ea(3), TypeParam{43}));
  EXPECT_EQ(this->words_[2], TypeParam{0});
  EXPECT_EQ(this->words_[3], TypeParam{42});
  EXPECT_EQ(this->words_[4], TypeParam{0});
}

// The granule of the PPU is the line, too.
TYPED_TEST(AtomicsOf, AStoreAnywhereInTheLineFailsIt) {
  const std::size_t words_in_line = kLineBytes / sizeof(TypeParam);
  this->one_.template load_and_reserve<TypeParam>(this->words_.ea(0));
  this->two_.store(this->words_.ea(words_in_line), TypeParam{5});
  EXPECT_TRUE(this->one_.store_conditional(this->words_.ea(0), TypeParam{1}));

  this->one_.template load_and_reserve<TypeParam>(this->words_.ea(0));
  this->two_.store(this->words_.ea(words_in_line - 1), TypeParam{5});
  EXPECT_FALSE(this->one_.store_conditional(this->words_.ea(0), TypeParam{2}));
  EXPECT_EQ(this->words_[0], TypeParam{1});
}

TYPED_TEST(AtomicsOf, AnSpesPutFailsItAndItFailsAnSpesPutllc) {
  Reservations& reservations = this->space_.reservations();
  ReservationHolder spe(reservations);
  alignas(16) std::byte line[kLineBytes]{};
  const EffectiveAddress ea = this->words_.ea();
  auto* host = reinterpret_cast<std::byte*>(this->words_.data());

  this->one_.template load_and_reserve<TypeParam>(ea);
  reservations.write(spe, ea, host, line, 16);
  EXPECT_FALSE(this->one_.store_conditional(ea, TypeParam{1}));

  reservations.load_and_reserve(spe, ea, host, line);
  this->one_.fetch_add(ea, TypeParam{1});
  EXPECT_FALSE(reservations.store_conditional(spe, ea, host, line));
  EXPECT_EQ(this->words_[0], TypeParam{1});
}

TYPED_TEST(AtomicsOf, FetchAddWrapsAround) {
  const EffectiveAddress ea = this->words_.ea(1);
  this->words_[1] = std::numeric_limits<TypeParam>::max();
  EXPECT_EQ(this->one_.fetch_add(ea, TypeParam{2}), std::numeric_limits<TypeParam>::max());
  EXPECT_EQ(this->words_[1], static_cast<TypeParam>(std::numeric_limits<TypeParam>::min() + 1));
  EXPECT_EQ(this->words_[0], TypeParam{0});
  EXPECT_EQ(this->words_[2], TypeParam{0});
}

TYPED_TEST(AtomicsOf, ExchangeAndCompareAndSwapGiveTheWordBefore) {
  const EffectiveAddress ea = this->words_.ea(7);
  EXPECT_EQ(this->one_.exchange(ea, TypeParam{5}), TypeParam{0});
  EXPECT_EQ(this->one_.compare_and_swap(ea, TypeParam{4}, TypeParam{9}), TypeParam{5});
  EXPECT_EQ(this->one_.template load<TypeParam>(ea), TypeParam{5});
  EXPECT_EQ(this->one_.compare_and_swap(ea, TypeParam{5}, TypeParam{9}), TypeParam{5});
  EXPECT_EQ(this->one_.template load<TypeParam>(ea), TypeParam{9});
}

// Another write comes in the middle, as often as it likes.
TYPED_TEST(AtomicsOf, UpdateBeginsAgainWhenItWasTooLate) {
  const EffectiveAddress ea = this->words_.ea();
  int interruptions = 0;
  const TypeParam before = this->one_.template update<TypeParam>(ea, [&](TypeParam word) {
    if (interruptions < 3) {
      ++interruptions;
      this->two_.fetch_add(ea, TypeParam{10});
    }
    return static_cast<TypeParam>(word + 1);
  });
  EXPECT_EQ(before, TypeParam{30});
  EXPECT_EQ(this->words_[0], TypeParam{31});
}

TYPED_TEST(AtomicsOf, ABadAddressIsRefused) {
  EXPECT_THROW(this->one_.template load<TypeParam>(this->words_.ea() + 2), std::invalid_argument);
  EXPECT_THROW(this->one_.template load<TypeParam>(this->words_.ea() + 4096), std::invalid_argument);
  EXPECT_THROW(this->one_.store(local_store_ea(0) + 0x5400C, TypeParam{1}), std::invalid_argument);
}

// Permissions are the SPEs'.
TYPED_TEST(AtomicsOf, ThePpuMayWriteWhatSpesMayOnlyRead) {
  const Buffer<TypeParam> closed(this->space_, "closed", 4, {.spe_access = SpeAccess::kRead});
  EXPECT_EQ(this->one_.fetch_add(closed.ea(), TypeParam{3}), TypeParam{0});
  EXPECT_EQ(closed[0], TypeParam{3});
}

}  // namespace
}  // namespace softcell::dma
