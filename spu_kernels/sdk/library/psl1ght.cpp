// PSL1GHT's sys/spu_atomic.h and dma/spu_dma.h: numbers that are changed in their line until nobody else has written the line meanwhile,
// and transfers of any size.

#include <dma/spu_dma.h>
#include <spu_mfcio.h>
#include <sys/spu_atomic.h>

namespace {

constexpr uint64_t kLineMask = 127;
constexpr uint32_t kLargestCommand = MAX_DMA_BLOCK_SIZE;

template <class Number>
Number& number_at(Number* line, uint64_t ea) {
  return line[(ea & kLineMask) / sizeof(Number)];
}

template <class Number>
Number reserve(Number* line, uint64_t ea) {
  mfc_getllar(line, ea & ~kLineMask, 0, 0);
  mfc_read_atomic_status();
  return number_at(line, ea);
}

template <class Number>
int store(Number* line, uint64_t ea, Number value) {
  number_at(line, ea) = value;
  mfc_putllc(line, ea & ~kLineMask, 0, 0);
  return static_cast<int>(mfc_read_atomic_status());
}

/// @param change  of the number to the one that is stored.
template <class Number, class Change>
Number update(Number* line, uint64_t ea, Change change) {
  Number before;
  do {
    before = reserve(line, ea);
  } while (store(line, ea, change(before)) != 0);
  return before;
}

/// Stores the changed number if the present one is wanted.
template <class Number, class Wanted, class Change>
Number update_if(Number* line, uint64_t ea, Wanted wanted, Change change) {
  Number before;
  do {
    before = reserve(line, ea);
  } while (wanted(before) && store(line, ea, change(before)) != 0);
  return before;
}

template <class Number>
Number take_one(Number* line, uint64_t ea) {
  return update_if(
      line, ea, [](Number number) { return number != 0; }, [](Number number) { return number - 1; });
}

template <class Number>
Number swap_if_equal(Number* line, uint64_t ea, Number compare, Number value) {
  return update_if(
      line, ea, [compare](Number number) { return number == compare; }, [value](Number) { return value; });
}

/// The largest command of at most `size` bytes that may begin there.
uint32_t next_command(uint32_t ls, uint32_t size) {
  if (ls % 16 == 0 && size >= 16) return size < kLargestCommand ? size & ~15u : kLargestCommand;
  uint32_t bytes = 8;
  while (bytes > size || ls % bytes != 0) bytes /= 2;
  return bytes;
}

}  // namespace

#define SOFTCELL_ATOMIC(name, bits, change)                                                       \
  uint##bits##_t spu_atomic_##name##bits(uint##bits##_t* ls, uint64_t ea, uint##bits##_t value) { \
    return update(                                                                                \
        ls, ea, [value](uint##bits##_t number) -> uint##bits##_t { return change; });             \
  }
#define SOFTCELL_ATOMICS(bits)                                                                              \
  uint##bits##_t spu_atomic_nop##bits(uint##bits##_t* ls, uint64_t ea) {                                    \
    return update(ls, ea, [](uint##bits##_t number) { return number; });                                    \
  }                                                                                                         \
  uint##bits##_t spu_atomic_incr##bits(uint##bits##_t* ls, uint64_t ea) {                                   \
    return update(ls, ea, [](uint##bits##_t number) { return number + 1; });                                \
  }                                                                                                         \
  uint##bits##_t spu_atomic_decr##bits(uint##bits##_t* ls, uint64_t ea) {                                   \
    return update(ls, ea, [](uint##bits##_t number) { return number - 1; });                                \
  }                                                                                                         \
  uint##bits##_t spu_atomic_test_and_decr##bits(uint##bits##_t* ls, uint64_t ea) {                          \
    return take_one(ls, ea);                                                                                \
  }                                                                                                         \
  SOFTCELL_ATOMIC(or, bits, number | value)                                                                 \
  SOFTCELL_ATOMIC(and, bits, number& value)                                                                 \
  SOFTCELL_ATOMIC(add, bits, number + value)                                                                \
  SOFTCELL_ATOMIC(sub, bits, number - value)                                                                \
  uint##bits##_t spu_atomic_store##bits(uint##bits##_t* ls, uint64_t ea, uint##bits##_t value) {            \
    return update(ls, ea, [value](uint##bits##_t) { return value; });                                       \
  }                                                                                                         \
  uint##bits##_t spu_atomic_compare_and_swap##bits(uint##bits##_t* ls, uint64_t ea, uint##bits##_t compare, \
                                                   uint##bits##_t value) {                                  \
    return swap_if_equal(ls, ea, compare, value);                                                           \
  }                                                                                                         \
  uint##bits##_t spu_atomic_lock_line##bits(uint##bits##_t* ls, uint64_t ea) { return reserve(ls, ea); }    \
  int spu_atomic_store_conditional##bits(uint##bits##_t* ls, uint64_t ea, uint##bits##_t value) {           \
    return store(ls, ea, value);                                                                            \
  }
SOFTCELL_ATOMICS(32)
SOFTCELL_ATOMICS(64)

void spu_dma_and_wait(void* ls, uint64_t ea, uint32_t size, uint32_t tag, uint32_t cmd) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), size, tag, cmd);
  mfc_write_tag_mask(1u << tag);
  mfc_read_tag_status_all();
}

void spu_dma_large_cmd(uintptr_t ls, uint64_t ea, uint32_t size, uint32_t tag, uint32_t cmd) {
  while (size != 0) {
    const uint32_t bytes = next_command(static_cast<uint32_t>(ls), size);
    spu_mfcdma64(reinterpret_cast<void*>(ls), mfc_ea2h(ea), mfc_ea2l(ea), bytes, tag, cmd);
    ls += bytes, ea += bytes, size -= bytes;
  }
}
