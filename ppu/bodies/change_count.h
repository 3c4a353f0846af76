#pragma once

#include <cstdint>

namespace softcell::ppu {

/// Counts the changes of the object that it is a member of. To assign to that object is one more, whatever is
/// assigned; a copy begins with the count of the original.
class ChangeCount {
 public:
  ChangeCount() = default;
  ChangeCount(const ChangeCount&) = default;
  ChangeCount& operator=(const ChangeCount&) { return ++*this; }

  ChangeCount& operator++() {
    ++count_;
    return *this;
  }
  std::uint32_t count() const { return count_; }

 private:
  std::uint32_t count_ = 0;
};

}  // namespace softcell::ppu
