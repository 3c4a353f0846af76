#pragma once
// Memory at a multiple of 2^log2_align bytes. [SDK for Multicore Acceleration, example library, malloc_align] documented

#include <stdlib.h>
#include <string.h>

static __inline__ void* _malloc_align(size_t bytes, unsigned int log2_align) {
  return memalign((size_t)1 << log2_align, bytes);
}
static __inline__ void* malloc_align(size_t bytes, unsigned int log2_align) {
  return _malloc_align(bytes, log2_align);
}
static __inline__ void* _calloc_align(size_t count, size_t bytes, unsigned int log2_align) {
  const unsigned long long all = (unsigned long long)count * bytes;
  void* const memory = all > 0x40000 ? (void*)0 : _malloc_align((size_t)all, log2_align);
  return memory == (void*)0 ? memory : memset(memory, 0, (size_t)all);
}
static __inline__ void* calloc_align(size_t count, size_t bytes, unsigned int log2_align) {
  return _calloc_align(count, bytes, log2_align);
}
__BEGIN_DECLS
void* realloc_align(void* old, size_t bytes, unsigned int log2_align);
__END_DECLS
static __inline__ void* _realloc_align(void* old, size_t bytes, unsigned int log2_align) {
  return realloc_align(old, bytes, log2_align);
}
static __inline__ void _free_align(void* memory) { free(memory); }
static __inline__ void free_align(void* memory) { free(memory); }
