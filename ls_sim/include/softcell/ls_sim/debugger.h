#pragma once
// What runs on an SPE, as a debugger sees it: whole of the interpreter, instruction by instruction of kernels built for the host.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// A register in the order of the SPU: byte 0 is the most significant.
using RegisterBytes = std::array<std::byte, dma::kQuadwordBytes>;
inline constexpr int kSpuRegisters = 128;

/// An SPE in the middle of a program, while it stands still.
class DebuggedSpe {
 public:
  virtual ~DebuggedSpe() = default;

  /// @pre 0 <= number < kSpuRegisters
  virtual RegisterBytes read_register(int number) const = 0;
  virtual void write_register(int number, const RegisterBytes& value) = 0;
  /// Its local store. Instructions that change are executed as they are then.
  virtual std::span<std::byte> local_store() = 0;
};

/// Is told of each step of programs built for the SPU (SpeOptions::debugger), by the threads that run the SPEs, with the
/// host's own arithmetic. A function that does not return keeps the SPE standing; with Interleaving::kTurns all others
/// stand then, too.
///
/// Of a kernel built for the host it is told of each instruction only, at any address, by a handler of signals: on_instruction()
/// then may not allocate, lock or throw, and its result means nothing. A kernel takes some thousand times as long.
class Debugger {
 public:
  virtual ~Debugger() = default;

  /// A run begins. @param state  until on_end()
  virtual void on_begin(int spe, DebuggedSpe& state) = 0;
  virtual void on_end(int spe) = 0;

  /// Before each instruction. @return  false: the run ends at the next branch, with the fault deadline-exceeded.
  virtual bool on_instruction(int spe, dma::LocalStoreAddress pc) = 0;
  /// Before each load and store of a quadword, within its instruction.
  virtual void on_access(int spe, dma::LocalStoreAddress quadword, bool is_store) = 0;
};

}  // namespace softcell::ls_sim
