#pragma once
// The two kinds of address on the Cell, as types, so that the compiler tells them apart.

#include <compare>
#include <cstdint>

namespace softcell::dma {

inline constexpr std::uint32_t kLocalStoreBytes = 256 * 1024;           // [CBEA, local store] documented
inline constexpr std::uint32_t kLocalStoreMask = kLocalStoreBytes - 1;  // the LSLR register
inline constexpr std::uint32_t kQuadwordBytes = 16;
inline constexpr std::uint32_t kLineBytes = 128;
inline constexpr int kSpeCount = 6;  // usable on a PS3: eight made, one disabled, one the system's

constexpr std::uint64_t round_up_to_quadword(std::uint64_t bytes) {
  return (bytes + kQuadwordBytes - 1) / kQuadwordBytes * kQuadwordBytes;
}

/// Byte offset into one SPE's local store, 0..0x3FFFF when valid.
struct LocalStoreAddress {
  std::uint32_t value = 0;
  auto operator<=>(const LocalStoreAddress&) const = default;
};

/// 64-bit address in the emulated main storage. Never a host pointer.
struct EffectiveAddress {
  std::uint64_t value = 0;
  auto operator<=>(const EffectiveAddress&) const = default;
};

constexpr EffectiveAddress operator+(EffectiveAddress ea, std::uint64_t bytes) { return {ea.value + bytes}; }

/// The layout of main storage. The low words are those of a PS3 game process (256 MB of XDR, 256 MB of video memory, SPU threads from
/// 0xF0000000 in steps of 1 MB). The high word is not zero, so that a kernel that drops MFC_EAH is caught. No host program has these
/// addresses mapped, so a kernel that follows one as a pointer faults.
inline constexpr EffectiveAddress kMainMemoryBase{0x5EA0'1000'0000};
inline constexpr std::uint64_t kMainMemoryBytes = 256ull << 20;  // unless an AddressSpace says otherwise
inline constexpr EffectiveAddress kVideoMemoryBase{0x5EA0'C000'0000};
/// The most main memory: up to video memory.
inline constexpr std::uint64_t kMaxMainMemoryBytes = kVideoMemoryBase.value - kMainMemoryBase.value;
inline constexpr std::uint64_t kVideoMemoryBytes = 256ull << 20;
inline constexpr EffectiveAddress kLocalStoresBase{0x5EA0'F000'0000};
inline constexpr std::uint64_t kLocalStoreStrideBytes = 1ull << 20;
/// The address at which lv2 maps raw SPUs in the memory of a program. [lv2; PSL1GHT, sys/spu.h] documented
inline constexpr std::uint64_t kRawSpusBase = 0xE000'0000;

/// Effective address of byte 0 of the local store of SPE 0..5. Its registers follow from +0x40000.
constexpr EffectiveAddress local_store_ea(int spe) {
  return kLocalStoresBase + static_cast<std::uint64_t>(spe) * kLocalStoreStrideBytes;
}

/// True if the upper word of `ea` is that of main storage, whether or not anything is allocated there.
constexpr bool is_effective_address(std::uint64_t ea) { return (ea >> 32) == (kMainMemoryBase.value >> 32); }

/// True for a 32-bit number that is the low word of an address in main or video memory or in the local stores, whether or not anything is
/// allocated there: a 32-bit pointer keeps this much of an effective address.
/// @param main_memory_bytes  up to kMaxMainMemoryBytes
constexpr bool is_low_word_of_effective_address(std::uint64_t address,
                                                std::uint64_t main_memory_bytes = kMainMemoryBytes) {
  const auto in = [&](EffectiveAddress base, std::uint64_t bytes) {
    return address - (base.value & 0xFFFF'FFFFu) < bytes;
  };
  return in(kMainMemoryBase, main_memory_bytes) || in(kVideoMemoryBase, kVideoMemoryBytes) ||
         in(kLocalStoresBase, kSpeCount * kLocalStoreStrideBytes);
}

}  // namespace softcell::dma
