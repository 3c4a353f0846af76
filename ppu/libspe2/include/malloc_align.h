/* Memory at a multiple of 2^log2_align bytes. [SDK for Multicore Acceleration, example library, malloc_align] documented */
#ifndef SOFTCELL_MALLOC_ALIGN_H
#define SOFTCELL_MALLOC_ALIGN_H

#include <malloc.h>
#include <stdlib.h>
#include <string.h>

/* posix_memalign by a name of ours, as <stdlib.h> hides it from a program of strict C. */
extern int softcell_place_aligned(void** memory, size_t alignment, size_t bytes) __asm__("posix_memalign");
/* Null: there is no room. */
static __inline__ __attribute__((unused)) void* _malloc_align(size_t bytes, unsigned int log2_align) {
  void* memory = 0;
  const size_t alignment = (size_t)1 << (log2_align < 4 ? 4 : log2_align);
  return softcell_place_aligned(&memory, alignment, bytes) == 0 ? memory : 0;
}
static __inline__ __attribute__((unused)) void* malloc_align(size_t bytes, unsigned int log2_align) {
  return _malloc_align(bytes, log2_align);
}
static __inline__ __attribute__((unused)) void* _calloc_align(size_t count, size_t bytes,
                                                              unsigned int log2_align) {
  size_t all = 0;
  void* const memory = __builtin_mul_overflow(count, bytes, &all) ? (void*)0 : _malloc_align(all, log2_align);
  return memory == 0 ? memory : memset(memory, 0, all);
}
static __inline__ __attribute__((unused)) void* calloc_align(size_t count, size_t bytes,
                                                             unsigned int log2_align) {
  return _calloc_align(count, bytes, log2_align);
}
static __inline__ __attribute__((unused)) void* _realloc_align(void* old, size_t bytes,
                                                               unsigned int log2_align) {
  const size_t had = malloc_usable_size(old);
  void* const memory = _malloc_align(bytes, log2_align);
  if (memory == 0 || old == 0) return memory;
  memcpy(memory, old, had < bytes ? had : bytes);
  free(old);
  return memory;
}
static __inline__ __attribute__((unused)) void* realloc_align(void* old, size_t bytes,
                                                              unsigned int log2_align) {
  return _realloc_align(old, bytes, log2_align);
}
static __inline__ __attribute__((unused)) void _free_align(void* memory) { free(memory); }
static __inline__ __attribute__((unused)) void free_align(void* memory) { free(memory); }

#endif
