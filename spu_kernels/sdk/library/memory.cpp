// Memory: bytes, and the heap between bss and the declared stack.

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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

extern char _end[] __attribute__((visibility("hidden")));
extern char softcell_heap_end[] __attribute__((visibility("hidden")));

struct alignas(16) Block {
  uint32_t bytes;  ///< behind the head, a multiple of 16
  uint32_t taken;
};

static Block* heap;

static Block* next_of(Block* block) {
  return reinterpret_cast<Block*>(reinterpret_cast<char*>(block + 1) + block->bytes);
}
static Block* end_of_heap() {
  return reinterpret_cast<Block*>(reinterpret_cast<uintptr_t>(softcell_heap_end) & ~uintptr_t{15});
}

static void make_heap() {
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
static void join(Block* block) {
  for (Block* next = next_of(block); next < end_of_heap() && next->taken == 0; next = next_of(block))
    block->bytes += static_cast<uint32_t>(sizeof(Block)) + next->bytes;
}

/// Leaves the block `bytes`, and makes a free one of the rest where that is worth a head.
static void cut(Block* block, uint32_t bytes) {
  if (block->bytes < bytes + 2 * sizeof(Block)) return;
  const uint32_t rest = block->bytes - bytes - static_cast<uint32_t>(sizeof(Block));
  block->bytes = bytes;
  next_of(block)->bytes = rest;
  next_of(block)->taken = 0;
}

void* memalign(size_t alignment, size_t bytes) {
  if (heap == nullptr) make_heap();
  if (alignment < 16) alignment = 16;
  if (bytes > 0x40000 || alignment > 0x40000) return nullptr;
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
  return nullptr;
}

void* aligned_alloc(size_t alignment, size_t bytes) { return memalign(alignment, bytes); }

int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* const block = memalign(alignment, bytes);
  if (block == nullptr) return ENOMEM;
  *memory = block;
  return 0;
}

void* malloc(size_t bytes) { return memalign(16, bytes); }

void free(void* memory) {
  if (memory == nullptr) return;
  Block* const block = static_cast<Block*>(memory) - 1;
  block->taken = 0;
  join(block);
}

void* calloc(size_t count, size_t bytes) {
  const uint64_t all = uint64_t{count} * bytes;
  void* const memory = all > 0x40000 ? nullptr : malloc(static_cast<size_t>(all));
  return memory == nullptr ? nullptr : memset(memory, 0, static_cast<size_t>(all));
}

/// Moves the first bytes of a block to another one, if there is one, and frees the old one.
static void* moved(void* old, void* fresh, size_t bytes) {
  if (fresh == nullptr) return nullptr;
  // The program need not have written any of the bytes, but it is no mistake to copy them with their head, which is written.
  Block* const block = static_cast<Block*>(fresh) - 1;
  const Block head = *block;
  memcpy(block, static_cast<Block*>(old) - 1, sizeof(Block) + bytes);
  *block = head;
  free(old);
  return fresh;
}

void* realloc(void* old, size_t bytes) {
  if (old == nullptr) return malloc(bytes);
  if (bytes == 0) {
    free(old);
    return nullptr;
  }
  const size_t had = (static_cast<Block*>(old) - 1)->bytes;
  if (bytes <= had) return old;
  return moved(old, malloc(bytes), had);
}

void* realloc_align(void* old, size_t bytes, unsigned int log2_align) {
  const size_t alignment = size_t{1} << log2_align;
  if (old == nullptr) return memalign(alignment, bytes);
  const size_t had = (static_cast<Block*>(old) - 1)->bytes;
  if (bytes <= had && (reinterpret_cast<uintptr_t>(old) & (alignment - 1)) == 0) return old;
  return moved(old, memalign(alignment, bytes), had < bytes ? had : bytes);
}

}  // extern "C"
