/* Counts in a line that all threads share, with every function of sys/spu_atomic.h, and moves its share of some bytes with those of
   dma/spu_dma.h. The exit status is the line of what is wrong, or 0. */
#include <dma/spu_dma.h>
#include <stdint.h>
#include <sys/spu_atomic.h>
#include <sys/spu_thread.h>

#define CHECK(condition) \
  if (!(condition)) spu_thread_exit(__LINE__)
#define BYTES 40007 /* more than two commands, and not of 16 bytes */

static uint32_t words[32] __attribute__((aligned(128)));
static uint64_t doublewords[16] __attribute__((aligned(128)));
static uint8_t bytes[BYTES + 16] __attribute__((aligned(128)));

/* Of this thread's own line, where nobody else is. */
static void check_own(uint64_t line) {
  uint64_t word = line + 4, doubleword = line + 16;
  CHECK(spu_atomic_store32(words, word, 0xF0) == 0 && spu_atomic_nop32(words, word) == 0xF0);
  CHECK(spu_atomic_or32(words, word, 0x0F) == 0xF0 && spu_atomic_and32(words, word, 0x3C) == 0xFF);
  CHECK(spu_atomic_sub32(words, word, 0x3B) == 0x3C && spu_atomic_test_and_decr32(words, word) == 1);
  CHECK(spu_atomic_test_and_decr32(words, word) == 0 && spu_atomic_nop32(words, word) == 0);
  CHECK(spu_atomic_compare_and_swap32(words, word, 1, 5) == 0 && spu_atomic_nop32(words, word) == 0);
  CHECK(spu_atomic_compare_and_swap32(words, word, 0, 5) == 0 && spu_atomic_nop32(words, word) == 5);
  CHECK(spu_atomic_lock_line32(words, word) == 5 && spu_atomic_store_conditional32(words, word, 6) == 0);
  CHECK(spu_atomic_nop32(words, word) == 6);
  CHECK(spu_atomic_store64(doublewords, doubleword, 1ull << 40) == 0);
  CHECK(spu_atomic_or64(doublewords, doubleword, 3) == 1ull << 40);
  CHECK(spu_atomic_and64(doublewords, doubleword, ~1ull) == ((1ull << 40) | 3));
  CHECK(spu_atomic_sub64(doublewords, doubleword, 1ull << 40) == ((1ull << 40) | 2));
  CHECK(spu_atomic_test_and_decr64(doublewords, doubleword) == 2 && spu_atomic_decr64(doublewords, doubleword) == 1);
  CHECK(spu_atomic_test_and_decr64(doublewords, doubleword) == 0);
  CHECK(spu_atomic_compare_and_swap64(doublewords, doubleword, 0, 9) == 0);
  CHECK(spu_atomic_lock_line64(doublewords, doubleword) == 9);
  CHECK(spu_atomic_store_conditional64(doublewords, doubleword, 10) == 0);
  CHECK(spu_atomic_nop64(doublewords, doubleword) == 10);
  spu_dma_put_uint8(0x12, line + 33, 3, 0, 0);
  spu_dma_put_uint16(0x3456, line + 34, 3, 0, 0);
  spu_dma_put_uint32(0x789ABCDE, line + 36, 3, 0, 0);
  spu_dma_put_uint64(0x1122334455667788ull, line + 40, 3, 0, 0);
  CHECK(spu_dma_get_uint8(line + 33, 3, 0, 0) == 0x12 && spu_dma_get_uint16(line + 34, 3, 0, 0) == 0x3456);
  CHECK(spu_dma_get_uint32(line + 36, 3, 0, 0) == 0x789ABCDE);
  CHECK(spu_dma_get_uint64(line + 40, 3, 0, 0) == 0x1122334455667788ull);
}

int main(uint64_t shared, uint64_t own, uint64_t from, uint64_t to) {
  static spu_dma_list_element list[2] __attribute__((aligned(8)));
  unsigned i;
  for (i = 0; i < 100; i++) {
    spu_atomic_incr32(words, shared);
    spu_atomic_add32(words, shared + 4, 3);
    spu_atomic_decr32(words, shared + 8);
    spu_atomic_incr64(doublewords, shared + 16);
    spu_atomic_add64(doublewords, shared + 24, 1ull << 33);
  }
  check_own(own);
  spu_dma_assert(from % 16 == 0, "from=%llx\n", from);
  spu_dma_large_get(bytes, from, BYTES, 5, 0, 0);
  CHECK(spu_dma_wait_tag_status_all(1 << 5) == 1 << 5);
  for (i = 0; i < BYTES; i++) bytes[i]++;
  spu_dma_large_put(bytes, to, BYTES, 5, 0, 0);
  CHECK(spu_cma_wait_tag_status_any(1 << 5) == 1 << 5);
  list[0].size = list[1].size = 64;
  list[0].eal = (uint32_t)from + 128;
  list[1].eal = (uint32_t)from;
  spu_dma_list_get(bytes, from, list, sizeof list, 5, 0, 0);
  mfc_write_tag_update_any();
  CHECK(spu_dma_cancel_and_wait_tag_status_all(1 << 5) == 1 << 5);
  CHECK(bytes[0] == (uint8_t)128 && bytes[64] == 0);
  spu_dma_get(bytes, from, 32, 5, 0, 0);
  spu_dma_small_getf(bytes + 32, from + 48, 4, 5, 0, 0);
  CHECK(spu_dma_cancel_and_wait_tag_status_any(1 << 5) == 1 << 5);
  CHECK(bytes[31] == 31 && bytes[32] == 48);
  spu_dma_and_wait(bytes + 16, from, 16, 6, MFC_GET_CMD);
  CHECK(bytes[31] == 15);
  spu_dma_large_cmd((uintptr_t)bytes, from, 20, 6, MFC_GET_CMD);
  CHECK(spu_dma_wait_tag_status_all(1 << 6) == 1 << 6 && bytes[19] == 19 && bytes[20] == 4);
  spu_thread_exit(0);
  return 0;
}
