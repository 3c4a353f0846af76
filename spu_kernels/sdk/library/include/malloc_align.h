#pragma once
// Memory at a multiple of 2^log2_align bytes. [SDK for Multicore Acceleration, example library, malloc_align] documented

#include <stdlib.h>

static __inline__ void* _malloc_align(size_t bytes, unsigned int log2_align) {
  return memalign((size_t)1 << log2_align, bytes);
}
static __inline__ void* malloc_align(size_t bytes, unsigned int log2_align) {
  return _malloc_align(bytes, log2_align);
}
static __inline__ void _free_align(void* memory) { free(memory); }
static __inline__ void free_align(void* memory) { free(memory); }
