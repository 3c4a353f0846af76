#pragma once
// The owners of the bytes of a local store: the image's code, its variables, its stack, or nobody.

#include <cstdint>
#include <string>

#include "softcell/base/assert.h"
#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// Where a stack may grow: [begin, end), local-store addresses.
struct StackRange {
  std::uint32_t begin = 0, end = 0;
};

/// Bytes of a local store.
struct LocalRange {
  std::uint32_t lsa = 0, bytes = 0;
};

/// Borrows the image.
class ObjectMap {
 public:
  ObjectMap(const KernelImage& image, const StackRange& stack) : image_(&image), stack_(stack) {
    SC_ASSERT(stack.begin <= stack.end, "the stack of {} is {} to {}", image.name, stack.begin, stack.end);
  }

  bool in_code(std::uint32_t lsa) const { return lsa >= image_->text_begin && lsa < image_->rodata_end; }
  bool in_heap(std::uint32_t lsa) const {
    return image_->program && lsa >= image_->sizes.end && lsa < stack_.begin;
  }
  bool in_stack(std::uint32_t lsa) const { return lsa >= stack_.begin && lsa < stack_.end; }

  /// Empty if the range lies in one variable, in code and constants, or in the used part of the stack; else a
  /// sentence that says what is wrong.
  std::string trespass(std::uint32_t lsa, std::uint32_t bytes, std::uint32_t stack_pointer) const;

  /// The variable that holds this byte, or all of the heap, whose blocks have quadwords of their own; else empty.
  LocalRange variable_at(std::uint32_t lsa) const;

  /// "buffer + 16", "the stack", "the image's code".
  std::string describe(std::uint32_t lsa) const;

 private:
  /// The variable that holds this byte, or null.
  const ImageObject* object_at(std::uint32_t lsa) const;

  const KernelImage* image_;
  StackRange stack_;
};

}  // namespace softcell::ls_sim
