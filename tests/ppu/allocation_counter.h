#pragma once
// Counts calls of operator new in a test program that links allocation_counter.cpp.

#include <cstddef>

namespace softcell::ppu::test {

std::size_t allocations();

}  // namespace softcell::ppu::test
