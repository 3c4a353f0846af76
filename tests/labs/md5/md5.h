#include <stdint.h>
typedef struct {
  uint64_t text; /* of `bytes`, 128-byte aligned */
  uint32_t bytes;
  uint32_t digest[4];
  uint32_t pad;
} message_t;
