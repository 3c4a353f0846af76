#pragma once
// Writes sixteen bytes to any address. [SDK for Multicore Acceleration, example library, store_vec_unaligned] documented

#include <spu_intrinsics.h>

static __inline__ __attribute__((unused)) void store_vec_unaligned(unsigned char* bytes, vec_uchar16 v_) {
  __builtin_memcpy(bytes, &v_, sizeof v_);
}
#define _store_vec_unaligned store_vec_unaligned
