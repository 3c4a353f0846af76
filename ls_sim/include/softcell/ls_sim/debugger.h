#pragma once
// The interface of debuggers: they see all of a program on the interpreter, and each instruction of kernels built for the host.

#include <array>
#include <cstddef>
#include <span>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// A register in the byte order of the SPU: byte 0 is the most significant.
using RegisterBytes = std::array<std::byte, dma::kQuadwordBytes>;
inline constexpr int kSpuRegisters = 128;  ///< their number

/// An SPE in the middle of a program, while it is stopped.
class DebuggedSpe {
 public:
  virtual ~DebuggedSpe() = default;

  /// @pre 0 <= number < kSpuRegisters
  virtual RegisterBytes read_register(int number) const = 0;
  virtual void write_register(int number, const RegisterBytes& value) = 0;
  /// Its local store. The SPE executes instructions that are changed there.
  virtual std::span<std::byte> local_store() = 0;
};

/// Called for each step of programs built for the SPU (SpeOptions::debugger), by the threads that run the SPEs, with the host's own
/// arithmetic. While a function does not return, the SPE is stopped; with Interleaving::kTurns all others are stopped, too.
///
/// For a kernel built for the host, only on_instruction() is called, at any address, from a signal handler: it must not allocate, lock or
/// throw, and its result is ignored. A kernel then takes some thousand times as long.
class Debugger {
 public:
  virtual ~Debugger() = default;

  /// A run begins. @param state  valid until on_end()
  virtual void on_begin(int spe, DebuggedSpe& state) = 0;
  virtual void on_end(int spe) = 0;

  /// Before each instruction. @return  false: the run ends at the next branch, with the fault deadline-exceeded.
  virtual bool on_instruction(int spe, dma::LocalStoreAddress pc) = 0;
  /// Before each load and store of a quadword, within its instruction.
  virtual void on_access(int spe, dma::LocalStoreAddress quadword, bool is_store) = 0;
};

}  // namespace softcell::ls_sim
