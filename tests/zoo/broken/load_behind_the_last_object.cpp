// rule: outside-objects
// twin: legal/last_element_of_an_object
// build: checked
// Reads the fourth row of a table of one row: local store that belongs to nobody.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t table[32] = {1};
static volatile uint32_t index = 96;

int main(uint64_t, uint64_t, uint64_t) {
  return table[index] == 0xFFFFFFFFu ? 1 : 0;  // BROKEN
}
