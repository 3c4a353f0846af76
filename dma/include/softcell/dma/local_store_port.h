#pragma once
// One SPE as an address in main storage: what other SPEs and the PPU reach by DMA.

#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

/// Registers that a transfer of 4 bytes writes, by their offset from the SPE's base address in main storage.
/// [SPU thread mapping: problem state from 0x40000] documented
enum class SpeRegister : std::uint32_t {
  kInMbox = 0x4400C,
  kSignal1 = 0x5400C,
  kSignal2 = 0x5C00C,
};

/// Implemented by the SPE, called by whoever writes: any thread, with reservation locks held. Calls must be
/// short and must not come back to the address space.
class LocalStorePort {
 public:
  virtual ~LocalStorePort() = default;

  /// kLocalStoreBytes of host memory, for as long as the port is mapped.
  virtual std::span<std::byte> local_store() = 0;

  /// Bytes have arrived that this SPE did not fetch itself.
  virtual void on_external_write(LocalStoreAddress lsa, std::uint32_t bytes) = 0;

  /// A register was written.
  virtual void on_register_write(SpeRegister which, std::uint32_t value) = 0;
};

}  // namespace softcell::dma
