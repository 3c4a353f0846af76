#pragma once
// Objects that are handed out by number.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::render {

/// Objects with numbers from 0 on. The number of one that was removed is given to the next one that is added.
template <class Object>
class Numbered {
 public:
  std::uint32_t add(Object object) {
    if (removed_.empty()) {
      objects_.emplace_back(std::move(object));
      return static_cast<std::uint32_t>(objects_.size() - 1);
    }
    const std::uint32_t number = removed_.back();
    removed_.pop_back();
    objects_[number].emplace(std::move(object));
    return number;
  }
  /// @pre it has one of that number
  void remove(std::uint32_t number) {
    SC_ASSERT(find(number) != nullptr, "object {} of {} is removed", number, objects_.size());
    objects_[number].reset();
    removed_.push_back(number);
  }
  /// Null: there is none of that number.
  const Object* find(std::uint32_t number) const {
    return number < objects_.size() && objects_[number] ? &*objects_[number] : nullptr;
  }
  Object* find(std::uint32_t number) { return const_cast<Object*>(std::as_const(*this).find(number)); }

 private:
  std::vector<std::optional<Object>> objects_;  // none: it was removed
  std::vector<std::uint32_t> removed_;          // numbers of these
};

}  // namespace softcell::render
