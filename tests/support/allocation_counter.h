#pragma once
// Counts calls of operator new in a test program that links allocation_counter.cpp. Such a program is one of
// its own: it replaces operator new for all that is in it.

#include <cstddef>

namespace softcell::test {

/// Since the program began, by the calling thread.
std::size_t allocations();

/// From now on allocations of so many bytes or more fail, by whatever thread.
void refuse_allocations_from(std::size_t bytes);

}  // namespace softcell::test
