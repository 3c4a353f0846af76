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

/// Implemented by the SPE, called by whoever writes: any thread, perhaps with reservation locks held. Calls
/// must be short and must not come back to the address space.
///
/// What arrives whole: 1, 2, 4 or 8 bytes, each quadword of a transfer within one line, and each quadword of
/// a longer one as far as the host's memcpy keeps them whole, which it does on x86. So a kernel may poll a
/// quadword of its local store that another SPE puts to; of several quadwords, any may come first unless a
/// fence or barrier orders their commands.
class LocalStorePort {
 public:
  virtual ~LocalStorePort() = default;

  /// kLocalStoreBytes of host memory, for as long as the port is mapped.
  virtual std::span<std::byte> local_store() = 0;

  /// Bytes arrive that this SPE did not fetch itself. Called just before, so that no kernel that finds them
  /// is ahead of this account.
  virtual void on_external_write(LocalStoreAddress lsa, std::uint32_t bytes) = 0;

  /// A register was written.
  virtual void on_register_write(SpeRegister which, std::uint32_t value) = 0;
};

}  // namespace softcell::dma
