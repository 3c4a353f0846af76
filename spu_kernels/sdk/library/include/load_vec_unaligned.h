#pragma once
// The sixteen bytes at any address. [SDK for Multicore Acceleration, example library, load_vec_unaligned] documented

#include <spu_intrinsics.h>

static __inline__ __attribute__((unused)) vec_uchar16 load_vec_unaligned(const unsigned char* bytes) {
  vec_uchar16 v_;
  __builtin_memcpy(&v_, bytes, sizeof v_);
  return v_;
}
#define _load_vec_unaligned load_vec_unaligned
