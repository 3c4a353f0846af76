// A steady frame allocates nothing on the PPU side outside Bullet, which has an allocator of its own and does
// not use operator new for what it makes in a step.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "scene.h"
#include "simulation_3d.h"

namespace {

thread_local bool counting = false;
thread_local std::size_t allocations = 0;

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (counting) ++allocations;
  void* memory = alignment <= alignof(std::max_align_t)
                     ? std::malloc(bytes == 0 ? 1 : bytes)
                     : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, 1); }
void* operator new[](std::size_t bytes) { return allocate(bytes, 1); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace softcell::demos {
namespace {

TEST(Allocation, TheCounterCounts) {
  counting = true;
  std::free(nullptr);
  auto* volatile p = new int(1);
  counting = false;
  delete p;
  EXPECT_EQ(allocations, 1u);
}

TEST(Allocation, ASteadyFrameAllocatesNothing) {
  const Scene scene = find_scene("arena").make(std::nullopt);
  Simulation3d simulation(scene, {});
  for (int frame = 0; frame < 60; ++frame) simulation.step();
  allocations = 0;
  for (int frame = 0; frame < 120; ++frame) {
    counting = true;
    simulation.step();
    counting = false;
  }
  EXPECT_EQ(allocations, 0u) << "in 120 frames";
}

}  // namespace
}  // namespace softcell::demos
