#pragma once
// PSL1GHT's atomic operations on words and doublewords in main storage.  [PSL1GHT, sys/spu_atomic.h] documented
//
// `ls` is room for the line in which the number lies: 128 bytes of the caller's, aligned to 128. `ea` is the number's own address.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdint.h>
#include <sys/cdefs.h>

__BEGIN_DECLS
// Each returns what the number was before.
uint32_t spu_atomic_nop32(uint32_t* ls, uint64_t ea);
uint64_t spu_atomic_nop64(uint64_t* ls, uint64_t ea);
uint32_t spu_atomic_incr32(uint32_t* ls, uint64_t ea);
uint64_t spu_atomic_incr64(uint64_t* ls, uint64_t ea);
uint32_t spu_atomic_decr32(uint32_t* ls, uint64_t ea);
uint64_t spu_atomic_decr64(uint64_t* ls, uint64_t ea);
/// These leave 0 as it is.
uint32_t spu_atomic_test_and_decr32(uint32_t* ls, uint64_t ea);
uint64_t spu_atomic_test_and_decr64(uint64_t* ls, uint64_t ea);
uint32_t spu_atomic_or32(uint32_t* ls, uint64_t ea, uint32_t value);
uint64_t spu_atomic_or64(uint64_t* ls, uint64_t ea, uint64_t value);
uint32_t spu_atomic_and32(uint32_t* ls, uint64_t ea, uint32_t value);
uint64_t spu_atomic_and64(uint64_t* ls, uint64_t ea, uint64_t value);
uint32_t spu_atomic_add32(uint32_t* ls, uint64_t ea, uint32_t value);
uint64_t spu_atomic_add64(uint64_t* ls, uint64_t ea, uint64_t value);
uint32_t spu_atomic_sub32(uint32_t* ls, uint64_t ea, uint32_t value);
uint64_t spu_atomic_sub64(uint64_t* ls, uint64_t ea, uint64_t value);
uint32_t spu_atomic_store32(uint32_t* ls, uint64_t ea, uint32_t value);
uint64_t spu_atomic_store64(uint64_t* ls, uint64_t ea, uint64_t value);
/// These store `value` if the number is `compare`.
uint32_t spu_atomic_compare_and_swap32(uint32_t* ls, uint64_t ea, uint32_t compare, uint32_t value);
uint64_t spu_atomic_compare_and_swap64(uint64_t* ls, uint64_t ea, uint64_t compare, uint64_t value);

/// Reserves the number's line. @return  the number.
uint32_t spu_atomic_lock_line32(uint32_t* ls, uint64_t ea);
uint64_t spu_atomic_lock_line64(uint64_t* ls, uint64_t ea);
/// Stores the number if the line is still reserved. @return  0: it has.
int spu_atomic_store_conditional32(uint32_t* ls, uint64_t ea, uint32_t value);
int spu_atomic_store_conditional64(uint64_t* ls, uint64_t ea, uint64_t value);
__END_DECLS
