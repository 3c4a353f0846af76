#pragma once
// Lists in which nothing stands twice.

#include <algorithm>
#include <functional>

namespace softcell::ppu {

/// Sorts the items, and keeps one of those that are equal.
/// @param before  orders them so that equal ones stand beside each other
template <class Items, class Before = std::less<>>
void keep_each_once(Items& items, const Before& before = {}) {
  std::sort(items.begin(), items.end(), before);
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace softcell::ppu
