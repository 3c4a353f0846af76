#pragma once
// One element of a DMA list as it lies in local store.
//
//   word 0   | stall-and-notify: 1 bit | reserved: 16 bits, zero | size in bytes: 15 bits |
//   word 1   | low half of the element's effective address                                |

#include <cstdint>

#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// An element. Its words have the byte order of the engine that runs the kernel. [CBEA, MFC list commands]
/// documented
struct ListElement {
  std::uint32_t head = 0;
  std::uint32_t eal = 0;

  static constexpr std::uint32_t kStallBit = 0x8000'0000;
  static constexpr std::uint32_t kReservedBits = 0x7FFF'8000;
  static constexpr std::uint32_t kSizeBits = 0x0000'7FFF;

  constexpr bool stalls() const { return (head & kStallBit) != 0; }
  constexpr std::uint32_t reserved() const { return head & kReservedBits; }
  constexpr std::uint32_t size() const { return head & kSizeBits; }

  /// The element's 64-bit effective address. All elements of a list share MFC_EAH.
  constexpr EffectiveAddress ea(const MfcCommand& list) const {
    return {(list.ea.value & 0xFFFF'FFFF'0000'0000) | eal};
  }

  /// Local-store address of the element's bytes when the list has reached `cursor`. An element of less than a quadword has the same offset
  /// in its quadword as in main storage.
  constexpr LocalStoreAddress local_address(LocalStoreAddress cursor) const {
    return size() < kQuadwordBytes ? LocalStoreAddress{quadword_of(cursor.value) | offset_in_quadword(eal)}
                                   : cursor;
  }

  /// Local-store address where the next element begins: after this one, at the next quadword. [CBEA, MFC list
  /// commands] documented
  constexpr LocalStoreAddress next(LocalStoreAddress cursor) const {
    return {quadword_of(cursor.value) + quadword_of(size() + kQuadwordBytes - 1)};
  }

  bool operator==(const ListElement&) const = default;

 private:
  static constexpr std::uint32_t quadword_of(std::uint32_t n) { return n & ~(kQuadwordBytes - 1); }
  static constexpr std::uint32_t offset_in_quadword(std::uint32_t n) { return n & (kQuadwordBytes - 1); }
};
static_assert(sizeof(ListElement) == kListElementBytes);

}  // namespace softcell::dma
