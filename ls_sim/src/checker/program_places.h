#pragma once
// Where in its source a checked kernel is: the line of an instruction, and for an instruction of the C library the line that has called
// the library.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "image/object_map.h"
#include "image/object_padding.h"
#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/source_lines.h"

namespace softcell::ls_sim {

/// Used by one thread.
class ProgramPlaces {
 public:
  using Address = dma::LocalStoreAddress;

  /// @param local_store  of the SPE, all of it; must outlive this object
  explicit ProgramPlaces(std::span<const std::byte> local_store) : local_store_(local_store) {}

  /// Another image runs. It must outlive the run. The other functions need a run.
  /// @param stack  where its functions have their frames
  void begin_run(const KernelImage& image, const StackRange& stack);

  /// The padding of the image's variables.
  const std::vector<PaddingRange>& padding() const { return debug_information_->padding; }

  /// "lab.c:30", or without debug information the function.
  std::string of(Address instruction) const;
  /// The same, but for an instruction of the C library the line of the program that has called the library, and the function that it has
  /// called: "lab.c:30 (strlen)". @param stack_pointer  at the instruction
  std::string in_program(Address instruction, std::uint32_t stack_pointer) const;

 private:
  /// Where a function of the program is, and its stack pointer there.
  struct CallFrame {
    Address instruction;
    std::uint32_t stack_pointer = 0;
    const ImageObject* called = nullptr;  // what it calls there
  };
  /// What an image's file says of its sources and variables.
  struct DebugInformation {
    explicit DebugInformation(const KernelImage& image) : lines(image), padding(padding_of(image)) {}
    SourceLines lines;
    std::vector<PaddingRange> padding;
  };

  const DebugInformation& debug_information_of(const KernelImage& image);
  std::optional<std::uint32_t> target_of(std::uint32_t instruction, std::byte opcode) const;
  std::optional<CallFrame> caller_of(const ImageObject& function, std::uint32_t stack_pointer) const;
  bool in_stack(std::uint32_t lsa) const { return lsa >= stack_.begin && lsa < stack_.end; }

  const std::span<const std::byte> local_store_;
  const KernelImage* image_ = nullptr;
  StackRange stack_;
  /// By the image's file, which its lines keep: a job loop changes between images all the time.
  std::unordered_map<const void*, std::unique_ptr<DebugInformation>> known_files_;
  const DebugInformation* debug_information_ = nullptr;  // of image_
};

}  // namespace softcell::ls_sim
