#pragma once
// Effective addresses that differ for each SPE: those of its own thread group.
//
//   0xF0000000 + n MB   SPU thread n of the group: its local store, and its registers behind it

#include <cstdint>
#include <utility>
#include <vector>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

/// The addresses at which one SPE finds the threads of its group. A plain value; without threads it changes no address.
///
/// A program adds the address of a variable to that of a thread. On the Cell, a variable's address is its offset in the local store; on a
/// host, the pointer also contains the address of the SPE's own local store. An address that contains it means the same as one that does
/// not, even if the sum was cut to 32 bits.
/// @source  [lv2, SPU thread mapping; PSL1GHT, sys/spu_thread.h] documented
class AddressWindow {
 public:
  static constexpr std::uint64_t kThreads = 0xF000'0000;

  AddressWindow() = default;
  /// @param own      the low 32 bits of the pointer to byte 0 of the SPE's own local store.
  /// @param threads  effective addresses of the local stores of the group, by the threads' numbers.
  AddressWindow(std::uint32_t own, std::vector<EffectiveAddress> threads)
      : own_(own), threads_(std::move(threads)) {}

  EffectiveAddress translate(EffectiveAddress ea) const {
    const std::uint64_t room = threads_.size() * kLocalStoreStrideBytes;
    if (room == 0) return ea;
    std::uint64_t offset = ea.value - kThreads;
    if (offset >= room) offset = ea.value - kThreads - own_;
    if (offset >= room && ea.value >> 32 == 0)
      offset = static_cast<std::uint32_t>(ea.value - kThreads - own_);
    if (offset >= room) return ea;
    return threads_[offset / kLocalStoreStrideBytes] + offset % kLocalStoreStrideBytes;
  }

 private:
  std::uint64_t own_ = 0;
  std::vector<EffectiveAddress> threads_;
};

}  // namespace softcell::dma
