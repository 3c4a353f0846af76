#include "object_map.h"

#include <algorithm>

namespace softcell::ls_sim {
namespace {

std::uint32_t end_of(const ImageObject& object) { return object.begin.value + object.bytes; }

}  // namespace

const ImageObject* ObjectMap::object_at(std::uint32_t lsa) const {
  const auto& objects = image_->objects;
  auto behind = std::upper_bound(objects.begin(), objects.end(), lsa,
                                 [](std::uint32_t at, const ImageObject& o) { return at < o.begin.value; });
  // Two names for one place are the only objects that overlap.
  for (int tries = 0; behind != objects.begin() && tries < 4; ++tries) {
    --behind;
    if (lsa < end_of(*behind)) return &*behind;
  }
  return nullptr;
}

LocalRange ObjectMap::variable_at(std::uint32_t lsa) const {
  if (in_stack(lsa)) return {};
  if (const ImageObject* const object = object_at(lsa)) return {object->begin.value, object->bytes};
  return in_heap(lsa) ? LocalRange{image_->sizes.end, stack_.begin - image_->sizes.end} : LocalRange{};
}

std::string ObjectMap::trespass(std::uint32_t lsa, std::uint32_t bytes, std::uint32_t stack_pointer) const {
  const std::uint32_t end = lsa + bytes;
  if (in_stack(lsa)) {
    if (end > stack_.end) {
      return stack_.end == dma::kLocalStoreBytes ? "it passes the end of the local store"
                                                 : "it passes the end of the stack";
    }
    return lsa < stack_pointer ? "it lies below the stack pointer: what was there is gone" : "";
  }
  if (in_code(lsa)) return end <= image_->rodata_end ? "" : "it passes the end of the image's constants";
  if (const ImageObject* const object = object_at(lsa)) {
    if (end <= end_of(*object)) return "";
    return "it passes the end of " + object->name + " by " + std::to_string(end - end_of(*object)) + " bytes";
  }
  if (in_heap(lsa)) return end <= stack_.begin ? "" : "it passes the end of the heap";
  if (lsa < image_->text_begin) return "nothing of the image lies there";
  if (lsa >= stack_.end) return "it belongs to the kernel that has called this one";
  if (lsa >= image_->sizes.end) return "it is free space between the image and its stack";
  // Without a symbol table all variables are one. Labels of assembly sources do not say what they are.
  const bool knows_all = !image_->objects.empty() && image_->machine == Machine::kHost;
  return !knows_all && end <= image_->sizes.end ? "" : "it belongs to no variable";
}

std::string ObjectMap::describe(std::uint32_t lsa) const {
  if (in_stack(lsa)) return "the stack";
  if (in_heap(lsa)) return "the heap";
  if (const ImageObject* const object = object_at(lsa)) {
    const std::uint32_t offset = lsa - object->begin.value;
    return object->name + (offset == 0 ? "" : " + " + std::to_string(offset));
  }
  return in_code(lsa) ? "the image's code and constants" : "no variable";
}

}  // namespace softcell::ls_sim
