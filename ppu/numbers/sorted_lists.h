#pragma once
// Sorts numbers into lists that lie in one array.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace softcell::ppu {

/// Counts, then fills in: list i consists of items[begin[i]] .. items[begin[i + 1]], ascending.
/// @param count          sorts the numbers from 0 to count - 1
/// @param for_each_list  for_each_list(number, work) calls work(list) for each list that the number is in, the same in every call
/// @param begin, items   results; their allocated room is reused
template <class ForEachList>
void sort_into_lists(std::size_t lists, std::size_t count, const ForEachList& for_each_list,
                     std::vector<std::uint32_t>& begin, std::vector<std::uint32_t>& items) {
  begin.assign(lists + 1, 0);
  for (std::size_t n = 0; n < count; ++n) for_each_list(n, [&](std::size_t list) { ++begin[list]; });
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  items.resize(begin.back());
  // Fills lists from their ends back to their begins.
  for (std::size_t n = count; n-- > 0;)
    for_each_list(n, [&](std::size_t list) { items[--begin[list]] = static_cast<std::uint32_t>(n); });
}

}  // namespace softcell::ppu
