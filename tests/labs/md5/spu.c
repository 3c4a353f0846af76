/* MD5 of messages that the PPU side names through the mailbox; strings and memory by the C library. */
#include <spu_mfcio.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include "md5.h"

static message_t message __attribute__((aligned(128)));
static uint8_t text[4096] __attribute__((aligned(128)));

static const uint8_t shifts[4][4] = {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};
static uint32_t sines[64];

static uint32_t rotate(uint32_t x, unsigned n) { return x << n | x >> (32 - n); }

static void block(uint32_t state[4], const uint8_t *data) {
  uint32_t m[16], a = state[0], b = state[1], c = state[2], d = state[3];
  int i;
  for (i = 0; i < 16; i++)
    m[i] = data[4 * i] | (uint32_t)data[4 * i + 1] << 8 | (uint32_t)data[4 * i + 2] << 16 | (uint32_t)data[4 * i + 3] << 24;
  for (i = 0; i < 64; i++) {
    uint32_t f, g, t;
    switch (i / 16) {
      case 0: f = (b & c) | (~b & d); g = i; break;
      case 1: f = (d & b) | (~d & c); g = 5 * i + 1; break;
      case 2: f = b ^ c ^ d; g = 3 * i + 5; break;
      default: f = c ^ (b | ~d); g = 7 * i; break;
    }
    t = d;
    d = c;
    c = b;
    b += rotate(a + f + sines[i] + m[g % 16], shifts[i / 16][i % 4]);
    a = t;
  }
  state[0] += a; state[1] += b; state[2] += c; state[3] += d;
}

static void md5(uint32_t digest[4], uint32_t bytes) {
  uint64_t bits = (uint64_t)bytes * 8;
  uint32_t padded = (bytes + 8) / 64 * 64 + 64, i;
  memset(text + bytes, 0, padded - bytes);
  text[bytes] = 0x80;
  for (i = 0; i < 8; i++) text[padded - 8 + i] = (uint8_t)(bits >> (8 * i));
  digest[0] = 0x67452301; digest[1] = 0xefcdab89; digest[2] = 0x98badcfe; digest[3] = 0x10325476;
  for (i = 0; i < padded; i += 64) block(digest, text + i);
}

static void wait_tag(unsigned tag) {
  spu_writech(MFC_WrTagMask, 1 << tag);
  spu_mfcstat(MFC_TAG_UPDATE_ALL);
}

int main(unsigned long long id, unsigned long long argp) {
  uint32_t low;
  (void)id;
  /* the constants come from the PPU side: 64 words */
  spu_mfcdma64(sines, mfc_ea2h(argp), mfc_ea2l(argp), sizeof sines, 5, MFC_GET_CMD);
  wait_tag(5);
  while ((low = spu_read_in_mbox()) != 0) {
    uint64_t ea = mfc_hl2ea(spu_read_in_mbox(), low);
    char line[80];
    mfc_get(&message, ea, sizeof message, 3, 0, 0);
    wait_tag(3);
    if (message.bytes != 0) {
      mfc_get(text, message.text, (message.bytes + 15) & ~15u, 3, 0, 0);
      wait_tag(3);
    }
    md5(message.digest, message.bytes);
    sprintf(line, "%u bytes", (unsigned)message.bytes);
    if (strlen(line) < 7) return 1;
    mfc_put(&message, ea, sizeof message, 4, 0, 0);
    wait_tag(4);
    spu_write_out_mbox(1);
  }
  return 0;
}
