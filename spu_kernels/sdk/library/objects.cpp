// What compilers of C++ call: memory for objects, static variables of functions, virtual tables.

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <new>

const std::nothrow_t std::nothrow{};

static void* room_for(size_t bytes, size_t alignment) {
  void* const memory = memalign(alignment, bytes);
  if (memory != nullptr) return memory;
  fprintf(stderr, "operator new: the heap of the local store has no room for %lu bytes\n",
          static_cast<unsigned long>(bytes));
  _exit(1);
}

void* operator new(size_t bytes) { return room_for(bytes, 16); }
void* operator new[](size_t bytes) { return room_for(bytes, 16); }
void* operator new(size_t bytes, std::align_val_t alignment) {
  return room_for(bytes, static_cast<size_t>(alignment));
}
void* operator new[](size_t bytes, std::align_val_t alignment) {
  return room_for(bytes, static_cast<size_t>(alignment));
}
void* operator new(size_t bytes, const std::nothrow_t&) noexcept { return malloc(bytes); }
void* operator new[](size_t bytes, const std::nothrow_t&) noexcept { return malloc(bytes); }
void* operator new(size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return memalign(static_cast<size_t>(alignment), bytes);
}
void* operator new[](size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return memalign(static_cast<size_t>(alignment), bytes);
}
void operator delete(void* memory) noexcept { free(memory); }
void operator delete[](void* memory) noexcept { free(memory); }
void operator delete(void* memory, size_t) noexcept { free(memory); }
void operator delete[](void* memory, size_t) noexcept { free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { free(memory); }
void operator delete(void* memory, size_t, std::align_val_t) noexcept { free(memory); }
void operator delete[](void* memory, size_t, std::align_val_t) noexcept { free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { free(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept { free(memory); }
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept { free(memory); }

extern "C" {

// For objects that were compiled without -fno-threadsafe-statics. A static variable of a function has a guard, whose first byte says that
// the variable is there. [Itanium C++ ABI, 3.3.2] There is one thread in a local store: if the second byte is set, a constructor has come
// to its own variable.

static uint8_t& is_there(uint64_t* guard) { return reinterpret_cast<uint8_t*>(guard)[0]; }
static uint8_t& is_begun(uint64_t* guard) { return reinterpret_cast<uint8_t*>(guard)[1]; }

int __cxa_guard_acquire(uint64_t* guard) {
  if (is_there(guard) != 0) return 0;
  if (is_begun(guard) != 0) {
    fputs("a static variable of a function needs itself to be made\n", stderr);
    _exit(1);
  }
  is_begun(guard) = 1;
  return 1;
}

void __cxa_guard_release(uint64_t* guard) {
  is_begun(guard) = 0;
  is_there(guard) = 1;
}

void __cxa_guard_abort(uint64_t* guard) { is_begun(guard) = 0; }

void __cxa_pure_virtual() {
  fputs("a pure virtual function was called\n", stderr);
  _exit(1);
}

void __cxa_deleted_virtual() { __cxa_pure_virtual(); }

}  // extern "C"
