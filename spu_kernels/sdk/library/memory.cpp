// Memory: bytes, and the heap between bss and the declared stack.

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef SOFTCELL_CHECKED
#include "../checked/report.h"

extern "C" void __tsan_write_range(const volatile void* at, size_t bytes);  // sdk/checked
#endif

extern "C" {

// In the checked image sdk/checked has these three, which report a copy as a whole, from the line that calls them. A copy need not
// be of written bytes only, such as the padding of structures.
#ifndef SOFTCELL_CHECKED
void* memcpy(void* to, const void* from, size_t bytes) {
  auto* const destination = static_cast<unsigned char*>(to);
  const auto* const source = static_cast<const unsigned char*>(from);
  size_t i = 0;
  // Sixteen at a time wherever they lie: a loop of this form is no call of memcpy.
  for (; i + 16 <= bytes; i += 16) {
    using Sixteen = unsigned char __attribute__((vector_size(16), aligned(1), may_alias));
    *reinterpret_cast<Sixteen*>(destination + i) = *reinterpret_cast<const Sixteen*>(source + i);
  }
  for (; i < bytes; ++i) destination[i] = source[i];
  return to;
}

void* memmove(void* to, const void* from, size_t bytes) {
  auto* const destination = static_cast<unsigned char*>(to);
  const auto* const source = static_cast<const unsigned char*>(from);
  if (destination <= source) {
    for (size_t i = 0; i < bytes; ++i) destination[i] = source[i];
  } else {
    for (size_t i = bytes; i-- > 0;) destination[i] = source[i];
  }
  return to;
}

void* memset(void* to, int value, size_t bytes) {
  auto* const destination = static_cast<unsigned char*>(to);
  for (size_t i = 0; i < bytes; ++i) destination[i] = static_cast<unsigned char>(value);
  return to;
}
#endif

int memcmp(const void* a, const void* b, size_t bytes) {
  const auto* const left = static_cast<const unsigned char*>(a);
  const auto* const right = static_cast<const unsigned char*>(b);
  for (size_t i = 0; i < bytes; ++i)
    if (left[i] != right[i]) return left[i] < right[i] ? -1 : 1;
  return 0;
}

void* memchr(const void* in, int value, size_t bytes) {
  const auto* const from = static_cast<const unsigned char*>(in);
  for (size_t i = 0; i < bytes; ++i)
    if (from[i] == static_cast<unsigned char>(value)) return const_cast<unsigned char*>(from + i);
  return nullptr;
}

// ---- the heap: blocks one behind the other, each behind a head of 16 bytes

// The checked image tells the checker of each block, and nothing of its own accesses to their heads, which are no block's.
#ifdef SOFTCELL_CHECKED
#define SC_OF_HEAP __attribute__((no_sanitize("thread", "kernel-address")))
#define SC_TELL(block, bytes, what)                                                   \
  softcell_checked::report(block, (bytes) == 0 ? 1 : (bytes), softcell_checked::what, \
                           __builtin_return_address(0), __builtin_dwarf_cfa())
#else
#define SC_OF_HEAP
#define SC_TELL(block, bytes, what) static_cast<void>(0)
#endif

extern char _end[] __attribute__((visibility("hidden")));
extern char softcell_heap_end[] __attribute__((visibility("hidden")));

struct alignas(16) Block {
  uint32_t bytes;  ///< behind the head, a multiple of 16
  uint32_t taken;
};

static Block* heap;

SC_OF_HEAP static Block* next_of(Block* block) {
  return reinterpret_cast<Block*>(reinterpret_cast<char*>(block + 1) + block->bytes);
}
SC_OF_HEAP static Block* end_of_heap() {
  return reinterpret_cast<Block*>(reinterpret_cast<uintptr_t>(softcell_heap_end) & ~uintptr_t{15});
}

SC_OF_HEAP static void make_heap() {
  heap = reinterpret_cast<Block*>((reinterpret_cast<uintptr_t>(_end) + 15) & ~uintptr_t{15});
  const auto room = reinterpret_cast<char*>(end_of_heap()) - reinterpret_cast<char*>(heap);
  if (room < static_cast<int>(2 * sizeof(Block))) {
    heap = end_of_heap();
    return;
  }
  heap->bytes = static_cast<uint32_t>(room) - sizeof(Block);
  heap->taken = 0;
}

/// Makes one free block of this and those behind it.
SC_OF_HEAP static void join(Block* block) {
  for (Block* next = next_of(block); next < end_of_heap() && next->taken == 0; next = next_of(block))
    block->bytes += static_cast<uint32_t>(sizeof(Block)) + next->bytes;
}

/// Leaves the block `bytes`, and makes a free one of the rest where that is worth a head.
SC_OF_HEAP static void cut(Block* block, uint32_t bytes) {
  if (block->bytes < bytes + 2 * sizeof(Block)) return;
  const uint32_t rest = block->bytes - bytes - static_cast<uint32_t>(sizeof(Block));
  block->bytes = bytes;
  next_of(block)->bytes = rest;
  next_of(block)->taken = 0;
}

SC_OF_HEAP static void* take_block(size_t alignment, size_t bytes) {
  if (heap == nullptr) make_heap();
  if (alignment < 16) alignment = 16;
  if (bytes > 0x40000 || alignment > 0x40000) {
    errno = ENOMEM;
    return nullptr;
  }
  const auto wanted = static_cast<uint32_t>((bytes + 15) & ~size_t{15});
  for (Block* block = heap; block < end_of_heap(); block = next_of(block)) {
    if (block->taken != 0) continue;
    join(block);
    const auto begin = reinterpret_cast<uintptr_t>(block + 1);
    uintptr_t aligned = (begin + alignment - 1) & ~(static_cast<uintptr_t>(alignment) - 1);
    // What lies before it becomes a block of its own, which has a head, too.
    if (aligned != begin && aligned - begin < sizeof(Block)) aligned += alignment;
    if (aligned - begin > block->bytes || block->bytes - (aligned - begin) < wanted) continue;
    if (aligned != begin) {
      cut(block, static_cast<uint32_t>(aligned - begin - sizeof(Block)));
      if (next_of(block) != reinterpret_cast<Block*>(aligned) - 1) continue;
      block = next_of(block);
    }
    cut(block, wanted);
    block->taken = 1;
    return block + 1;
  }
  errno = ENOMEM;
  return nullptr;
}

void* memalign(size_t alignment, size_t bytes) {
  void* const block = take_block(alignment, bytes);
  SC_TELL(block, bytes, kHeapBlock);
  return block;
}

void* aligned_alloc(size_t alignment, size_t bytes) {
  void* const block = take_block(alignment, bytes);
  SC_TELL(block, bytes, kHeapBlock);
  return block;
}

int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* const block = take_block(alignment, bytes);
  if (block == nullptr) return ENOMEM;
  SC_TELL(block, bytes, kHeapBlock);
  *memory = block;
  return 0;
}

void* malloc(size_t bytes) {
  void* const block = take_block(16, bytes);
  SC_TELL(block, bytes, kHeapBlock);
  return block;
}

SC_OF_HEAP static void give_back(void* memory) {
  Block* const block = static_cast<Block*>(memory) - 1;
  block->taken = 0;
  join(block);
}

void free(void* memory) {
  if (memory == nullptr) return;
  SC_TELL(memory, 1, kFreedBlock);
  give_back(memory);
}

void* calloc(size_t count, size_t bytes) {
  const uint64_t all = uint64_t{count} * bytes;
  void* const memory = take_block(16, all > 0x40000 ? 0x40001 : static_cast<size_t>(all));
  SC_TELL(memory, static_cast<size_t>(all), kHeapBlock);
  return memory == nullptr ? nullptr : memset(memory, 0, static_cast<size_t>(all));
}

/// Copies the first bytes of a block to another one, if there is one, and gives the old one back. The program need not have written any of
/// the bytes.
SC_OF_HEAP static void* moved(void* old, void* fresh, size_t bytes) {
  if (fresh == nullptr) return nullptr;
#ifdef SOFTCELL_CHECKED
  __tsan_write_range(fresh, bytes);
  for (size_t i = 0; i < bytes; ++i)
    static_cast<unsigned char*>(fresh)[i] = static_cast<unsigned char*>(old)[i];
#else
  memcpy(fresh, old, bytes);
#endif
  give_back(old);
  return fresh;
}

SC_OF_HEAP static size_t room_of(void* memory) { return (static_cast<Block*>(memory) - 1)->bytes; }

void* realloc(void* old, size_t bytes) {
  if (old == nullptr) {
    void* const block = take_block(16, bytes);
    SC_TELL(block, bytes, kHeapBlock);
    return block;
  }
  if (bytes == 0) {
    free(old);
    return nullptr;
  }
  const size_t had = room_of(old);
  void* const block = bytes <= had ? old : take_block(16, bytes);
  if (block != nullptr) SC_TELL(old, 1, kFreedBlock);
  SC_TELL(block, bytes, kHeapBlock);
  return block == old ? old : moved(old, block, had);
}

void* realloc_align(void* old, size_t bytes, unsigned int log2_align) {
  const size_t alignment = size_t{1} << log2_align;
  const bool stays =
      old != nullptr && bytes <= room_of(old) && (reinterpret_cast<uintptr_t>(old) & (alignment - 1)) == 0;
  void* const block = stays ? old : take_block(alignment, bytes);
  if (block != nullptr && old != nullptr) SC_TELL(old, 1, kFreedBlock);
  SC_TELL(block, bytes, kHeapBlock);
  if (stays || old == nullptr) return block;
  const size_t had = room_of(old);
  return moved(old, block, had < bytes ? had : bytes);
}

}  // extern "C"
