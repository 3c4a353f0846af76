#pragma once
// Objects that are handed out by handle.

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace softcell::render {

/// Objects in slots. A slot whose object was removed gets the next object that is added; its generation tells handles of the two apart.
/// @tparam Handle  with the fields `value`, the slot's number, and `generation`, from 1 on
template <class Handle, class Object>
class Numbered {
 public:
  /// @param what  "mesh", for messages
  explicit Numbered(const char* what) : what_(what) {}

  Handle add(Object object) {
    if (free_.empty()) {
      free_.push_back(static_cast<std::uint32_t>(slots_.size()));
      slots_.emplace_back();
    }
    const std::uint32_t number = free_.back();
    free_.pop_back();
    Slot& slot = slots_[number];
    slot.object.emplace(std::move(object));
    return {number, slot.generation};
  }
  /// @throws std::invalid_argument  as at()
  void remove(Handle handle) {
    at(handle);
    Slot& slot = slots_[handle.value];
    slot.object.reset();
    ++slot.generation;
    free_.push_back(handle.value);
  }
  /// @throws std::invalid_argument  the object was removed, or there was never one with this handle
  const Object& at(Handle handle) const {
    const Slot* const slot = handle.value < slots_.size() ? &slots_[handle.value] : nullptr;
    if (slot == nullptr || handle.generation == 0 || handle.generation > slot->generation)
      throw std::invalid_argument(std::string("no ") + what_ + " " + std::to_string(handle.value));
    if (handle.generation < slot->generation || !slot->object)
      throw std::invalid_argument(std::string("the ") + what_ + " " + std::to_string(handle.value) +
                                  " was removed");
    return *slot->object;
  }
  Object& at(Handle handle) { return const_cast<Object&>(std::as_const(*this).at(handle)); }

 private:
  struct Slot {
    std::optional<Object> object;  // none: it was removed
    std::uint32_t generation = 1;  // of the object, or of the next one
  };
  const char* what_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;  // numbers of slots without an object
};

}  // namespace softcell::render
