#pragma once
// A task's buffers in main storage, and the arguments that hold their addresses.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "kernel_task.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/engine.h"
#include "verb/output_files.h"

namespace softcell::tool {

class KernelBuffers {
 public:
  /// Allocates each buffer at a line of 128 bytes and reads its file.
  /// @param task  checked; must outlive this object.
  /// @throws std::runtime_error  a file cannot be read or is empty, or main memory is full.
  KernelBuffers(dma::AddressSpace& memory, const KernelTask& task);

  /// Restores the initial contents of every buffer, for another run.
  void reset();

  /// argp is the address of the task's arguments, an array of 64-bit words, and envp their number; both are 0 if there are none. In a
  /// thread group the words themselves are the arguments.
  ls_sim::EntryArguments arguments(int spe) const;

  struct Slot {
    const BufferSpec* spec = nullptr;
    dma::Buffer<std::byte> memory;
    std::vector<std::byte> initial;
  };
  std::span<const Slot> slots() const { return slots_; }

  /// Writes the files of --out and --inout, which the caller commits.
  /// @throws std::runtime_error  names the file.
  void write_files(OutputFiles& files) const;

 private:
  const Slot& slot(std::string_view buffer) const;
  std::uint64_t word(const ArgumentSpec& argument) const;

  std::vector<Slot> slots_;
  dma::Buffer<std::uint64_t> words_;  ///< the arguments; empty if there are none
  std::size_t word_count_ = 0;
  ls_sim::EntryState entry_state_;
};

}  // namespace softcell::tool
