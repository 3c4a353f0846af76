#pragma once
// The part of main storage that leads to SPEs: local stores and the registers beside them.
//
//   base + n MB   +0x00000  local store of SPE n, 256 KB
//                 +0x40000  its registers, of which others may write three

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/local_store_port.h"

namespace softcell::dma {

/// Where the local stores and registers of SPEs are in main storage, and their ports. Any thread. No thread may write to an SPE while
/// set_port() removes its port.
class LocalStores {
 public:
  /// @param base  of SPE 0; a multiple of kLocalStoreStrideBytes.
  explicit LocalStores(EffectiveAddress base = kLocalStoresBase, int spes = kSpeCount)
      : base_(base), ports_(static_cast<std::size_t>(spes)) {
    SC_ASSERT(base.value % kLocalStoreStrideBytes == 0 && spes > 0, "{} local stores at {}", spes, base);
  }

  EffectiveAddress base() const { return base_; }
  int spes() const { return static_cast<int>(ports_.size()); }
  EffectiveAddress ea_of(int spe) const {
    return base_ + static_cast<std::uint64_t>(spe) * kLocalStoreStrideBytes;
  }
  bool contains(EffectiveAddress ea) const {
    return ea.value - base_.value < ports_.size() * kLocalStoreStrideBytes;
  }
  /// Whether it may be the sum of an SPE's local store and an address in one.
  bool is_sum_of_two(EffectiveAddress ea) const {
    const std::uint64_t above = ea.value - 2 * base_.value;
    return above < 2 * ports_.size() * kLocalStoreStrideBytes &&
           above % kLocalStoreStrideBytes < kLocalStoreBytes;
  }
  /// @pre contains(ea), here and below.
  int spe_of(EffectiveAddress ea) const {
    SC_ASSERT(contains(ea), "{} does not belong to an SPE", ea);
    return static_cast<int>((ea.value - base_.value) / kLocalStoreStrideBytes);
  }
  std::uint32_t offset_of(EffectiveAddress ea) const {
    SC_ASSERT(contains(ea), "{} does not belong to an SPE", ea);
    return static_cast<std::uint32_t>((ea.value - base_.value) % kLocalStoreStrideBytes);
  }
  bool is_register(EffectiveAddress ea) const { return offset_of(ea) >= kLocalStoreBytes; }

  void set_port(int spe, LocalStorePort* port) {
    SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
    ports_[static_cast<std::size_t>(spe)].store(port, std::memory_order_release);
  }

  /// @param writes  whether it is a write, the only access that a register takes.
  /// @pre is_register(ea)
  /// @return  a pointer that stands for the register. No value is stored there: on_write() passes it on.
  std::variant<std::byte*, Fault> resolve_register(EffectiveAddress ea, std::uint64_t bytes, bool writes);

  /// Tells the SPE of a write before its bytes arrive, so that its checker knows of them before its kernel can load them.
  /// @return  whether the write went to a register, which has the value now; then there are no bytes to copy.
  bool on_write(EffectiveAddress ea, const std::byte* from, std::uint32_t bytes);

 private:
  std::atomic<LocalStorePort*>& port_of(EffectiveAddress ea) {
    return ports_[static_cast<std::size_t>(spe_of(ea))];
  }

  const EffectiveAddress base_;
  std::vector<std::atomic<LocalStorePort*>> ports_;
  std::byte register_stand_in_{};
};

}  // namespace softcell::dma
