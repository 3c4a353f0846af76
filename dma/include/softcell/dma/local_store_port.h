#pragma once
// One SPE as a range of main storage, which other SPEs and the PPU access by DMA.

#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

/// The registers that a put of 4 bytes can write, as offsets from the SPE's base address in main storage.
/// [SPU thread mapping: problem state from 0x40000] documented
enum class SpeRegister : std::uint32_t {
  kInMbox = 0x4400C,
  kSignal1 = 0x5400C,
  kSignal2 = 0x5C00C,
};

/// The SPE implements this interface, and the writer calls it: on any thread, perhaps with reservation locks held. An implementation must
/// be short and must not call the address space.
///
/// The writer writes each of these in one access, so a kernel may poll them in its local store:
/// - a transfer of 1, 2, 4 or 8 bytes;
/// - each quadword of a transfer within one line;
/// - each quadword of a longer transfer, if the host's memcpy does so, which it does on x86.
///
/// Several quadwords may arrive in any order unless a fence or barrier orders their commands.
class LocalStorePort {
 public:
  virtual ~LocalStorePort() = default;

  /// The local store: kLocalStoreBytes of host memory, aligned to 16, valid as long as the port is mapped.
  virtual std::span<std::byte> local_store() = 0;

  /// Somebody else is about to write to this local store. Called just before the bytes change, so that the SPE knows of the write before
  /// its kernel can read the bytes.
  virtual void on_external_write(LocalStoreAddress lsa, std::uint32_t bytes) = 0;

  /// Somebody writes `value` to a register.
  virtual void on_register_write(SpeRegister which, std::uint32_t value) = 0;
};

}  // namespace softcell::dma
