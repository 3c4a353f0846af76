// keeps: outside-objects, outside-local-store
// The last element of its table.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t table[32] = {1};
static volatile uint32_t last = 31;

int main(uint64_t, uint64_t, uint64_t) {
  table[last] = 5;
  return table[last] == 5 ? 0 : 1;
}
