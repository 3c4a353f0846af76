#pragma once
// The part of main storage that leads to SPEs: local stores and the registers beside them.
//
//   kLocalStoresBase + n MB   +0x00000  local store of SPE n, 256 KB
//                             +0x40000  its registers, of which others may write three

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/local_store_port.h"

namespace softcell::dma {

/// Any thread. Nobody may write to an SPE while its port is taken away.
class LocalStores {
 public:
  static constexpr bool contains(EffectiveAddress ea) {
    return ea.value - kLocalStoresBase.value < kSpeCount * kLocalStoreStrideBytes;
  }
  /// @pre contains(ea), here and below.
  static constexpr int spe_of(EffectiveAddress ea) {
    SC_ASSERT(contains(ea), "{} does not belong to an SPE", ea);
    return static_cast<int>((ea.value - kLocalStoresBase.value) / kLocalStoreStrideBytes);
  }
  static constexpr std::uint32_t offset_of(EffectiveAddress ea) {
    SC_ASSERT(contains(ea), "{} does not belong to an SPE", ea);
    return static_cast<std::uint32_t>((ea.value - kLocalStoresBase.value) % kLocalStoreStrideBytes);
  }
  static constexpr bool is_register(EffectiveAddress ea) { return offset_of(ea) >= kLocalStoreBytes; }

  void set_port(int spe, LocalStorePort* port) {
    SC_ASSERT(spe >= 0 && spe < kSpeCount, "SPE {} of {}", spe, kSpeCount);
    ports_[spe].store(port, std::memory_order_release);
  }

  /// @param writes  whether it is a write, the only access that a register takes.
  /// @pre is_register(ea)
  /// @return  a pointer to stand for the register, behind which is nothing: on_write() takes the value.
  std::variant<std::byte*, Fault> resolve_register(EffectiveAddress ea, std::uint64_t bytes, bool writes);

  /// Tells the SPE of a write, before its bytes arrive: whoever sees them finds them announced.
  /// @return  whether it went to a register, which has taken the value; then there are no bytes to copy.
  bool on_write(EffectiveAddress ea, const std::byte* from, std::uint32_t bytes);

 private:
  std::array<std::atomic<LocalStorePort*>, kSpeCount> ports_{};
  std::byte register_stand_in_{};
};

}  // namespace softcell::dma
