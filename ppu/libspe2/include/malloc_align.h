/* Memory at a multiple of 2^log2_align bytes. [SDK for Multicore Acceleration, example library, malloc_align] documented */
#ifndef SOFTCELL_MALLOC_ALIGN_H
#define SOFTCELL_MALLOC_ALIGN_H

#include <stdlib.h>

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
static __inline__ __attribute__((unused)) void _free_align(void* memory) { free(memory); }
static __inline__ __attribute__((unused)) void free_align(void* memory) { free(memory); }

#endif
