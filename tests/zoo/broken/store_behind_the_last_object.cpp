// rule: outside-objects
// twin: legal/last_element_of_an_object
// build: checked
// Writes the fourth row of a table of one row: harmless until something is linked there.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile uint32_t table[32] = {1};
static volatile uint32_t index = 96;

int main(uint64_t, uint64_t, uint64_t) {
  table[index] = 7;  // BROKEN
  return 0;
}
