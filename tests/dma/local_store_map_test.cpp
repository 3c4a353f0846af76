// Local stores and registers of SPEs as places in main storage.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "fake_spe.h"
#include "softcell/dma/address_space.h"
#include "softcell/dma/translation_cache.h"

namespace softcell::dma {
namespace {

constexpr std::uint64_t kSignal1 = static_cast<std::uint64_t>(SpeRegister::kSignal1);
constexpr std::uint64_t kSignal2 = static_cast<std::uint64_t>(SpeRegister::kSignal2);
constexpr std::uint64_t kInMbox = static_cast<std::uint64_t>(SpeRegister::kInMbox);

class LocalStoreMap : public testing::Test {
 protected:
  LocalStoreMap() { space_.map_local_store(2, spe_); }

  EffectiveAddress ea(std::uint64_t offset) const { return local_store_ea(2) + offset; }

  // As an MFC does it.
  std::optional<Fault> put(EffectiveAddress to, const void* from, std::uint32_t bytes) {
    auto resolved = cache_.resolve(to, bytes, SpeAccess::kWrite);
    if (Fault* fault = std::get_if<Fault>(&resolved)) return std::move(*fault);
    space_.reservations().write(holder_, to, std::get<std::byte*>(resolved),
                                static_cast<const std::byte*>(from), bytes);
    return std::nullopt;
  }
  std::optional<Fault> refusal(EffectiveAddress at, std::uint64_t bytes, SpeAccess wanted) {
    auto resolved = cache_.resolve(at, bytes, wanted);
    Fault* fault = std::get_if<Fault>(&resolved);
    return fault == nullptr ? std::nullopt : std::optional(std::move(*fault));
  }
  bool refuses(Rule rule, EffectiveAddress at, std::uint64_t bytes, SpeAccess wanted) {
    const std::optional<Fault> fault = refusal(at, bytes, wanted);
    return fault && fault->rule == rule && !fault->detail.empty();
  }

  AddressSpace space_;
  FakeSpe spe_;
  TranslationCache cache_{space_};
  ReservationHolder holder_{space_.reservations()};
};

TEST_F(LocalStoreMap, AddressesAreThoseOfTheMap) {
  EXPECT_EQ(local_store_ea(0).value, 0x5EA0'F000'0000u);
  EXPECT_EQ(local_store_ea(5).value, 0x5EA0'F050'0000u);
}

TEST_F(LocalStoreMap, ALocalStoreIsReadAndWrittenAsABuffer) {
  alignas(16) std::array<char, 32> text = {"from somebody else's side"};
  EXPECT_FALSE(put(ea(0x1000), text.data(), text.size()));
  EXPECT_EQ(std::memcmp(spe_.store.data() + 0x1000, text.data(), text.size()), 0);
  EXPECT_EQ(spe_.writes, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0x1000, 32}}));

  const auto host = space_.resolve(ea(0x1000), 32, SpeAccess::kRead);
  ASSERT_TRUE(std::holds_alternative<std::byte*>(host));
  EXPECT_EQ(std::get<std::byte*>(host), spe_.store.data() + 0x1000);
}

TEST_F(LocalStoreMap, ItsWholeRangeIsThereAndNothingBehind) {
  EXPECT_FALSE(refusal(ea(0), kLocalStoreBytes, SpeAccess::kReadWrite));
  EXPECT_FALSE(refusal(ea(kLocalStoreBytes - 16), 16, SpeAccess::kWrite));
  EXPECT_TRUE(refuses(Rule::kEaCrossesBuffer, ea(kLocalStoreBytes - 16), 32, SpeAccess::kWrite));
  EXPECT_TRUE(refuses(Rule::kEaNotMapped, local_store_ea(1), 16, SpeAccess::kRead));
  EXPECT_TRUE(refuses(Rule::kEaNotMapped, local_store_ea(3) + kSignal1, 4, SpeAccess::kWrite));
  EXPECT_TRUE(
      refuses(Rule::kEaNotMapped, kLocalStoresBase + 6 * kLocalStoreStrideBytes, 16, SpeAccess::kRead));
}

TEST_F(LocalStoreMap, AnSpeThatIsNotThereIsNamed) {
  EXPECT_NE(refusal(local_store_ea(4), 16, SpeAccess::kRead)->detail.find("SPE 4"), std::string::npos);
  EXPECT_NE(refusal(local_store_ea(4) + kInMbox, 4, SpeAccess::kWrite)->detail.find("SPE 4"),
            std::string::npos);
}

TEST_F(LocalStoreMap, FourBytesToARegisterArriveAsItsValue) {
  const std::uint32_t values[] = {7, 0xFFFF'0001, 0x1234'5678};
  EXPECT_FALSE(put(ea(kSignal1), &values[0], 4));
  EXPECT_FALSE(put(ea(kSignal2), &values[1], 4));
  EXPECT_FALSE(put(ea(kInMbox), &values[2], 4));
  EXPECT_EQ(spe_.registers,
            (std::vector<std::pair<SpeRegister, std::uint32_t>>{{SpeRegister::kSignal1, 7},
                                                                {SpeRegister::kSignal2, 0xFFFF'0001},
                                                                {SpeRegister::kInMbox, 0x1234'5678}}));
  EXPECT_TRUE(spe_.writes.empty());
}

TEST_F(LocalStoreMap, AnythingElseWithARegisterIsRefused) {
  EXPECT_TRUE(refuses(Rule::kRegisterAccess, ea(kSignal1), 4, SpeAccess::kRead));
  EXPECT_TRUE(refuses(Rule::kRegisterAccess, ea(kSignal1), 4, SpeAccess::kNone));
  EXPECT_TRUE(refuses(Rule::kRegisterAccess, ea(kSignal1), 2, SpeAccess::kWrite));
  EXPECT_TRUE(refuses(Rule::kRegisterAccess, ea(kSignal1 - 4), 8, SpeAccess::kWrite));
  EXPECT_TRUE(refuses(Rule::kRegisterAccess, ea(kSignal1 + 4), 4, SpeAccess::kWrite));
  EXPECT_TRUE(refuses(Rule::kRegisterAccess, ea(kLocalStoreBytes), 16, SpeAccess::kWrite));
}

TEST_F(LocalStoreMap, APutllcToALocalStoreIsToldToo) {
  alignas(16) std::array<std::byte, kLineBytes> line{};
  std::byte* host = spe_.store.data() + 0x800;
  space_.reservations().load_and_reserve(holder_, ea(0x800), host, line.data());
  EXPECT_TRUE(spe_.writes.empty());
  EXPECT_TRUE(space_.reservations().store_conditional(holder_, ea(0x800), host, line.data()));
  EXPECT_EQ(spe_.writes.size(), 1u);
  EXPECT_FALSE(space_.reservations().store_conditional(holder_, ea(0x800), host, line.data()));
  EXPECT_EQ(spe_.writes.size(), 1u) << "a putllc that fails writes nothing";
}

// To a kernel that asks for it: an SPE whose put overlaps its own source is no matter of the host's.
TEST_F(LocalStoreMap, AnSpeMayPutToItsOwnLocalStore) {
  EXPECT_FALSE(put(ea(0x100), spe_.store.data(), 0x1000));
  EXPECT_EQ(spe_.writes.size(), 1u);
}

TEST_F(LocalStoreMap, AnUnmappedLocalStoreIsGone) {
  EXPECT_FALSE(refusal(ea(0), 16, SpeAccess::kRead));
  space_.unmap_local_store(2);
  EXPECT_TRUE(refuses(Rule::kEaNotMapped, ea(0), 16, SpeAccess::kRead)) << "from the cache";
  EXPECT_TRUE(refuses(Rule::kEaNotMapped, ea(kSignal1), 4, SpeAccess::kWrite));
  space_.map_local_store(2, spe_);
  EXPECT_FALSE(refusal(ea(0), 16, SpeAccess::kRead));
}

TEST_F(LocalStoreMap, MappingSaysWhatIsWrong) {
  FakeSpe other;
  FakeSpe small(1024);
  EXPECT_THROW(space_.map_local_store(2, other), std::invalid_argument);
  EXPECT_THROW(space_.map_local_store(6, other), std::invalid_argument);
  EXPECT_THROW(space_.map_local_store(-1, other), std::invalid_argument);
  EXPECT_THROW(space_.map_local_store(1, small), std::invalid_argument);
  EXPECT_THROW(space_.unmap_local_store(1), std::invalid_argument);
  EXPECT_THROW(space_.unmap_local_store(6), std::invalid_argument);
  EXPECT_THROW(space_.free(local_store_ea(2)), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::dma
