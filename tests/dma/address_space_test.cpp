#include "softcell/dma/address_space.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace softcell::dma {
namespace {

using Resolved = std::variant<std::byte*, Fault>;

std::byte* host(const Resolved& resolved) {
  EXPECT_TRUE(std::holds_alternative<std::byte*>(resolved)) << std::get<Fault>(resolved).message();
  return std::get<std::byte*>(resolved);
}

void expect_fault(const Resolved& resolved, Rule rule, std::string_view detail) {
  ASSERT_TRUE(std::holds_alternative<Fault>(resolved)) << "expected " << name(rule);
  const Fault& fault = std::get<Fault>(resolved);
  EXPECT_EQ(name(fault.rule), name(rule));
  EXPECT_NE(fault.detail.find(detail), std::string::npos) << fault.detail;
}

TEST(AddressSpace, AllocatesFirstFitInLines) {
  AddressSpace space;
  const EffectiveAddress a = space.allocate("a", 1);
  const EffectiveAddress b = space.allocate("b", 129);
  const EffectiveAddress c = space.allocate("c", 128);
  EXPECT_EQ(a, kMainMemoryBase);
  EXPECT_EQ(b, a + 128);
  EXPECT_EQ(c, b + 256);
  EXPECT_EQ(space.free_bytes(Memory::kMain), kMainMemoryBytes - 512);

  space.free(b);
  EXPECT_EQ(space.allocate("too large for the gap", 257), c + 128);
  EXPECT_EQ(space.allocate("fits the gap", 256), b);
}

TEST(AddressSpace, JoinsFreeNeighboursInAnyOrderOfFreeing) {
  std::vector<int> order{0, 1, 2, 3};
  do {
    AddressSpace space;
    std::vector<EffectiveAddress> buffers;
    buffers.reserve(4);
    for (int i = 0; i < 4; ++i) buffers.push_back(space.allocate("piece", 1000));
    for (const int i : order) space.free(buffers[i]);
    EXPECT_EQ(space.largest_free_range(Memory::kMain), kMainMemoryBytes);
    EXPECT_EQ(space.free_bytes(Memory::kMain), kMainMemoryBytes);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(AddressSpace, HandsOutZeroBytesAgainAndAgain) {
  AddressSpace space;
  for (int round = 0; round < 3; ++round) {
    const EffectiveAddress ea = space.allocate("reused", 4096 + 256 * round);
    std::byte* bytes = host(space.resolve(ea, 4096, SpeAccess::kNone));
    EXPECT_EQ(std::count(bytes, bytes + 4096, std::byte{0}), 4096) << "round " << round;
    std::memset(bytes, 0xAB, 4096);
    space.free(ea);
  }
}

TEST(AddressSpace, ThrowsWithSizesWhenMemoryIsExhausted) {
  AddressSpace space;
  const EffectiveAddress all = space.allocate("all", kMainMemoryBytes);
  try {
    space.allocate("one more", 1);
    FAIL() << "allocated beyond the end";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(
        error.what(),
        "no room in main memory for buffer 'one more' of 1 byte: 0 bytes of 268435456 are free, 0 in the "
        "largest piece");
  }
  EXPECT_NO_THROW(space.allocate("elsewhere", 128, {.memory = Memory::kVideo}));
  space.free(all);
  EXPECT_EQ(space.allocate("again", 1), kMainMemoryBase);
  EXPECT_THROW(space.allocate("huge", ~std::uint64_t{0}), std::runtime_error);
}

TEST(AddressSpace, ThrowsWhenMemoryIsInPieces) {
  AddressSpace space;
  const std::uint64_t quarter = kMainMemoryBytes / 4;
  const EffectiveAddress low = space.allocate("low", quarter);
  space.allocate("middle", 2 * quarter);
  space.free(low);
  EXPECT_EQ(space.free_bytes(Memory::kMain), 2 * quarter);
  EXPECT_THROW(space.allocate("both ends", 2 * quarter), std::runtime_error);
}

TEST(AddressSpace, RefusesSenselessBuffers) {
  AddressSpace space;
  EXPECT_THROW(space.allocate("none", 0), std::invalid_argument);
  EXPECT_THROW(space.allocate("odd elements", 12, {.element_bytes = 3}), std::invalid_argument);
  EXPECT_THROW(space.free(kMainMemoryBase), std::invalid_argument);
  const EffectiveAddress ea = space.allocate("a", 256);
  EXPECT_THROW(space.free(ea + 128), std::invalid_argument);
}

TEST(AddressSpace, ResolvesWithinOneBuffer) {
  AddressSpace space;
  const EffectiveAddress ea = space.allocate("a", 256);
  std::byte* begin = host(space.resolve(ea, 256, SpeAccess::kReadWrite));
  EXPECT_EQ(host(space.resolve(ea + 240, 16, SpeAccess::kRead)), begin + 240);
  EXPECT_NE(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(begin)), ea.value)
      << "an effective address must be no host pointer";
}

TEST(AddressSpace, FaultsWhenATransferCrossesTheEndOfABuffer) {
  AddressSpace space;
  const EffectiveAddress a = space.allocate("a", 256);
  space.allocate("neighbour", 256);
  host(space.resolve(a + 128, 128, SpeAccess::kRead));
  expect_fault(space.resolve(a + 128, 144, SpeAccess::kRead), Rule::kEaCrossesBuffer,
               "128 of 144 bytes lie in buffer 'a' (256 bytes at 0x5EA010000000)");
  const EffectiveAddress odd = space.allocate("odd", 8);
  expect_fault(space.resolve(odd, 128, SpeAccess::kRead), Rule::kEaCrossesBuffer,
               "8 of 128 bytes lie in buffer 'odd' (8 bytes at");
}

// Otherwise the last 4 of 100 bytes could not be fetched by any legal command.
TEST(AddressSpace, LetsATransferReachTheQuadwordThatABufferEndsIn) {
  AddressSpace space;
  const EffectiveAddress ea = space.allocate("a", 100);
  host(space.resolve(ea, 112, SpeAccess::kRead));
  expect_fault(space.resolve(ea, 128, SpeAccess::kRead), Rule::kEaCrossesBuffer, "100 of 128 bytes");
}

TEST(AddressSpace, FaultsOutsideOfBuffersAndSaysWhereThatIs) {
  AddressSpace space;
  expect_fault(space.resolve(kMainMemoryBase, 16, SpeAccess::kRead), Rule::kEaNotMapped,
               "no buffer lies there or below");
  const EffectiveAddress ea = space.allocate("a", 256);
  host(space.resolve(ea + 240, 16, SpeAccess::kRead));
  expect_fault(space.resolve(ea + 256, 16, SpeAccess::kRead), Rule::kEaNotMapped,
               "nearest below is 'a' (256 bytes at 0x5EA010000000), 0 bytes past its end");
  expect_fault(space.resolve({ea.value & 0xFFFFFFFF}, 16, SpeAccess::kRead), Rule::kEaNotMapped, "MFC_EAH");
  expect_fault(space.resolve({0}, 16, SpeAccess::kRead), Rule::kEaNotMapped,
               "was the address of the data given");
  expect_fault(space.resolve({0x7FFF'1234'5670}, 16, SpeAccess::kRead), Rule::kEaNotMapped, "host pointer");
  expect_fault(space.resolve({~std::uint64_t{15}}, 16, SpeAccess::kRead), Rule::kEaNotMapped, "host pointer");
}

TEST(AddressSpace, FaultsInAFreedBuffer) {
  AddressSpace space;
  const EffectiveAddress ea = space.allocate("a", 256);
  const std::uint64_t generation = space.generation();
  space.free(ea);
  EXPECT_NE(space.generation(), generation);
  expect_fault(space.resolve(ea, 16, SpeAccess::kRead), Rule::kEaNotMapped, "");
}

TEST(AddressSpace, KeepsPermissions) {
  AddressSpace space;
  const EffectiveAddress input = space.allocate("input", 128, {.spe_access = SpeAccess::kRead});
  const EffectiveAddress output = space.allocate("output", 128, {.spe_access = SpeAccess::kWrite});
  host(space.resolve(input, 128, SpeAccess::kRead));
  host(space.resolve(output, 128, SpeAccess::kWrite));
  expect_fault(space.resolve(input, 128, SpeAccess::kWrite), Rule::kEaNotWritable, "'input' (128 bytes");
  expect_fault(space.resolve(output, 128, SpeAccess::kRead), Rule::kEaNotReadable, "'output' (128 bytes");
  host(space.resolve(output, 128, SpeAccess::kNone));
}

TEST(AddressSpace, RefusesWritesToVideoMemory) {
  AddressSpace space;
  const EffectiveAddress ea =
      space.allocate("vertices", 128, {.spe_access = SpeAccess::kReadWrite, .memory = Memory::kVideo});
  EXPECT_EQ(ea, kVideoMemoryBase);
  host(space.resolve(ea, 128, SpeAccess::kRead));
  expect_fault(space.resolve(ea, 128, SpeAccess::kWrite), Rule::kVideoMemoryWrite,
               "put results to main memory, the PPU uploads them");
}

TEST(AddressSpace, KeepsElementWidths) {
  AddressSpace space;
  const EffectiveAddress ea = space.allocate("halves", 128, {.element_bytes = 2});
  ASSERT_TRUE(space.mapping_at(ea + 64));
  EXPECT_EQ(space.mapping_at(ea + 64)->element_bytes, 2u);
  EXPECT_FALSE(space.mapping_at(ea + 128));
}

TEST(AddressSpace, SeveralHaveTheSameAddressesAndTheirOwnBytes) {
  AddressSpace first;
  AddressSpace second;
  const EffectiveAddress a = first.allocate("a", 16);
  const EffectiveAddress b = second.allocate("b", 16);
  EXPECT_EQ(a, b);
  *host(first.resolve(a, 1, SpeAccess::kWrite)) = std::byte{1};
  EXPECT_EQ(*host(second.resolve(b, 1, SpeAccess::kRead)), std::byte{0});
}

TEST(AddressSpace, MainMemoryHasTheSizeThatWasAskedFor) {
  AddressSpace small(1 << 20);
  EXPECT_EQ(small.free_bytes(Memory::kMain), 1u << 20);
  EXPECT_EQ(small.free_bytes(Memory::kVideo), kVideoMemoryBytes);
  small.allocate("all", 1 << 20);
  EXPECT_THROW(small.allocate("one line", 128), std::runtime_error);
  EXPECT_FALSE(small.mapping_at(kMainMemoryBase + (1 << 20)));

  AddressSpace largest(kMaxMainMemoryBytes);
  const EffectiveAddress all = largest.allocate("all", kMaxMainMemoryBytes);
  const EffectiveAddress last = all + (kMaxMainMemoryBytes - 16);
  *host(largest.resolve(last, 16, SpeAccess::kWrite)) = std::byte{1};
  EXPECT_EQ(largest.allocate("video", 16, {.memory = Memory::kVideo}), last + 16);
}

TEST(AddressSpace, RefusesOtherSizesOfMainMemory) {
  const auto refusal = [](std::uint64_t bytes) -> std::string {
    try {
      const AddressSpace space(bytes);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  const std::string expected = "; it must have whole megabytes (of 1048576 bytes), from 1 to 2816";
  EXPECT_EQ(refusal(0), "main memory of 0 bytes" + expected);
  EXPECT_EQ(refusal(1'000'000), "main memory of 1000000 bytes" + expected);
  EXPECT_EQ(refusal(kMaxMainMemoryBytes + (1 << 20)), "main memory of 2953838592 bytes" + expected);
}

TEST(AddressSpace, KeepsTheHostAddressesEqualToEffectiveOnesForItself) {
  const AddressSpace space;
  for (const EffectiveAddress ea :
       {kMainMemoryBase, kMainMemoryBase + (kMaxMainMemoryBytes - 4096), kVideoMemoryBase, kLocalStoresBase,
        kLocalStoresBase + 5 * kLocalStoreStrideBytes}) {
    errno = 0;
    const long result = syscall(SYS_mmap, ea.value, 4096, PROT_NONE,
                                MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE, -1, 0);
    EXPECT_EQ(result, -1) << std::hex << ea.value << " could still be mapped by somebody else";
    EXPECT_EQ(errno, EEXIST);
    if (result != -1) syscall(SYS_munmap, result, 4096);
  }
}

TEST(AddressSpaceDeathTest, AnEffectiveAddressFollowedAsAPointerFaults) {
  AddressSpace space;
  const EffectiveAddress ea = space.allocate("a", 128);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the mistake under test
  EXPECT_DEATH(*reinterpret_cast<volatile char*>(ea.value) = 1, "");
}

}  // namespace
}  // namespace softcell::dma
