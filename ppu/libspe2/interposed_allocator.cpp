// Interposes malloc() and its relatives: calls those of the C library and records each block.
//
// Everything here may run within malloc, before main() and in any thread: it allocates nothing but pages of its own.

#include "interposed_allocator.h"

#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <new>
#include <optional>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

constexpr std::size_t kPageBytes = 4096;

/// Nodes of one size, from pages that are never given back.
template <class Node>
struct PageAllocator {
  using value_type = Node;
  PageAllocator() = default;
  template <class Other>
  explicit PageAllocator(const PageAllocator<Other>&) {}

  Node* allocate(std::size_t count) {
    static_assert(sizeof(Node) >= sizeof(void*) && sizeof(Node) < kPageBytes);
    if (count != 1) __builtin_trap();  // a map allocates its nodes one by one
    if (free_list == nullptr) refill();
    void* const node = free_list;
    free_list = *static_cast<void**>(node);
    return static_cast<Node*>(node);
  }
  void deallocate(Node* node, std::size_t) {
    *reinterpret_cast<void**>(node) = free_list;
    free_list = node;
  }
  friend bool operator==(const PageAllocator&, const PageAllocator&) { return true; }

 private:
  static void refill() {
    constexpr std::size_t kBytes = 64 * kPageBytes;
    void* const pages = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    for (std::size_t at = 0; at + sizeof(Node) <= kBytes; at += sizeof(Node)) {
      void** const node = reinterpret_cast<void**>(static_cast<std::byte*>(pages) + at);
      *node = free_list;
      free_list = node;
    }
  }
  static inline void* free_list = nullptr;
};

struct Block {
  std::uint64_t bytes = 0, caller = 0;
  bool live = false;
};
using Blocks =
    std::map<std::uint64_t, Block, std::less<>, PageAllocator<std::pair<const std::uint64_t, Block>>>;

/// The blocks of the program, by address. Freed blocks stay until new ones take their place.
struct Heap {
  std::mutex mutex;                  // guards all below but the generation
  std::atomic<pthread_t> forking{};  // the thread that is in fork(), which holds the mutex there
  Blocks blocks;
  std::uint64_t begin = reinterpret_cast<std::uint64_t>(sbrk(0));
  std::atomic<std::uint64_t> generation{1};

  /// Locks the mutex. Handlers of fork() that allocate run in a thread that holds it already.
  [[nodiscard]] std::unique_lock<std::mutex> lock() {
    return forking.load(std::memory_order_relaxed) == pthread_self() ? std::unique_lock<std::mutex>()
                                                                     : std::unique_lock(mutex);
  }

  Heap() { mallopt(M_ARENA_MAX, 1); }  // all of it lies where sbrk() makes room, or in pages of its own

  void add(void* pointer, std::size_t bytes, void* caller) {
    if (pointer == nullptr) return;
    const auto address = reinterpret_cast<std::uint64_t>(pointer);
    const auto locked = lock();
    // The dead blocks that lay there are forgotten.
    auto at = blocks.lower_bound(address);
    if (at != blocks.begin()) {
      const auto before = std::prev(at);
      if (!before->second.live && before->first + before->second.bytes > address) at = before;
    }
    while (at != blocks.end() && at->first < address + (bytes == 0 ? 1 : bytes)) at = blocks.erase(at);
    blocks.emplace(address, Block{bytes, reinterpret_cast<std::uint64_t>(caller), true});
  }
  /// @return  the block as it was; nothing: there is none.
  std::optional<Block> end(void* pointer) {
    if (pointer == nullptr) return std::nullopt;
    const auto locked = lock();
    const auto found = blocks.find(reinterpret_cast<std::uint64_t>(pointer));
    if (found == blocks.end()) return std::nullopt;
    const Block was = found->second;
    found->second.live = false;
    generation.fetch_add(1, std::memory_order_release);
    return was;
  }
};

Heap& heap() {
  alignas(Heap) static std::byte place[sizeof(Heap)];
  static Heap* const made = new (place) Heap;
  return *made;
}

/// Over fork() no other thread is in the list: the child, which has none, would wait for it for ever.
[[gnu::constructor]] void keep_list_over_fork() {
  const auto release = [] {
    heap().forking.store({}, std::memory_order_relaxed);
    heap().mutex.unlock();
  };
  const auto hold = [] {
    heap().mutex.lock();
    heap().forking.store(pthread_self(), std::memory_order_relaxed);
  };
  pthread_atfork(hold, release, release);
}

int last_at_or_below(std::uint64_t address, SoftcellAllocation* block) {
  Heap& all = heap();
  const auto locked = all.lock();
  const auto above = all.blocks.upper_bound(address);
  if (above == all.blocks.begin()) return 0;
  const auto& [begin, found] = *std::prev(above);
  *block = {begin, found.bytes, found.caller, found.live ? 1 : 0};
  return 1;
}

/// The heap of sbrk(), and the pages of large blocks.
int owns(std::uint64_t address) {
  Heap& all = heap();
  if (address >= all.begin && address < reinterpret_cast<std::uint64_t>(sbrk(0))) return 1;
  SoftcellAllocation block{};
  if (last_at_or_below(address, &block) == 0) return 0;
  const std::uint64_t end = (block.begin + block.bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
  if (address >= end) return 0;
  if (block.live != 0) return 1;
  // The C library unmaps the pages of a large block when it is freed. What is mapped there now belongs to another: mmap(), a stack.
  unsigned char resident = 0;
  void* const page = reinterpret_cast<void*>(address / kPageBytes * kPageBytes);
  return mincore(page, kPageBytes, &resident) == 0 ? 0 : 1;
}

std::uint64_t generation() { return heap().generation.load(std::memory_order_acquire); }

void* add(void* pointer, std::size_t bytes, void* caller) {
  heap().add(pointer, bytes, caller);
  return pointer;
}

void* add_new(std::size_t bytes, void* caller) {
  void* const pointer = __libc_malloc(bytes == 0 ? 1 : bytes);
  if (pointer == nullptr) throw std::bad_alloc();
  return add(pointer, bytes, caller);
}

}  // namespace

#define SC_EXPORT [[gnu::visibility("default")]]

extern "C" {

SC_EXPORT extern const SoftcellAllocator softcell_interposed_allocator;
const SoftcellAllocator softcell_interposed_allocator{last_at_or_below, owns, generation};

SC_EXPORT void* malloc(std::size_t bytes) {
  return add(__libc_malloc(bytes), bytes, __builtin_return_address(0));
}

SC_EXPORT void* calloc(std::size_t count, std::size_t bytes) {
  return add(__libc_calloc(count, bytes), count * bytes, __builtin_return_address(0));
}

SC_EXPORT void free(void* pointer) {
  heap().end(pointer);
  __libc_free(pointer);
}

SC_EXPORT void* realloc(void* pointer, std::size_t bytes) {
  const std::optional<Block> was = heap().end(pointer);
  void* const moved = __libc_realloc(pointer, bytes);
  if (moved == nullptr && bytes != 0 && was && was->live) {  // it stays as it was
    heap().add(pointer, was->bytes, reinterpret_cast<void*>(was->caller));
    return nullptr;
  }
  return add(moved, bytes, __builtin_return_address(0));
}

SC_EXPORT void* memalign(std::size_t alignment, std::size_t bytes) {
  return add(__libc_memalign(alignment, bytes), bytes, __builtin_return_address(0));
}

SC_EXPORT void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return add(__libc_memalign(alignment, bytes), bytes, __builtin_return_address(0));
}

SC_EXPORT void* valloc(std::size_t bytes) {
  return add(__libc_memalign(kPageBytes, bytes), bytes, __builtin_return_address(0));
}

SC_EXPORT void* pvalloc(std::size_t bytes) {
  const std::size_t whole_pages = (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
  if (whole_pages < bytes) {
    errno = ENOMEM;
    return nullptr;
  }
  return add(__libc_memalign(kPageBytes, whole_pages), whole_pages, __builtin_return_address(0));
}

SC_EXPORT int posix_memalign(void** pointer, std::size_t alignment, std::size_t bytes) {
  if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* const made = __libc_memalign(alignment, bytes);
  if (made == nullptr) return ENOMEM;
  *pointer = add(made, bytes, __builtin_return_address(0));
  return 0;
}

}  // extern "C"

// Records the caller of `new` and not operator new itself. All other forms call these two or memalign.
SC_EXPORT void* operator new(std::size_t bytes) { return add_new(bytes, __builtin_return_address(0)); }
SC_EXPORT void* operator new[](std::size_t bytes) { return add_new(bytes, __builtin_return_address(0)); }
