#pragma once
// Whose bytes of a local store are: the image's code, its variables, its stack, nobody's.

#include <cstdint>
#include <string>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// Where a stack may grow: [begin, end), local-store addresses.
struct StackRange {
  std::uint32_t begin = 0, end = 0;
};

/// Borrows the image.
class ObjectMap {
 public:
  ObjectMap(const KernelImage& image, const StackRange& stack) : image_(&image), stack_(stack) {}

  bool in_code(std::uint32_t lsa) const { return lsa >= image_->text_begin && lsa < image_->rodata_end; }
  bool in_stack(std::uint32_t lsa) const { return lsa >= stack_.begin && lsa < stack_.end; }

  /// Empty when the range belongs to one variable, to code and constants, or to the stack in use; else what
  /// is wrong with it.
  std::string trespass(std::uint32_t lsa, std::uint32_t bytes, std::uint32_t stack_pointer) const;

  /// "buffer + 16", "the stack", "the image's code".
  std::string describe(std::uint32_t lsa) const;

 private:
  /// The variable that holds this byte, or null.
  const ImageObject* object_at(std::uint32_t lsa) const;

  const KernelImage* image_;
  StackRange stack_;
};

}  // namespace softcell::ls_sim
