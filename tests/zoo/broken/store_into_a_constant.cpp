// rule: write-to-code
// twin: legal/constant_read
// flavour: checked
// Casts const away: constants lie beside the code, and nothing protects them.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static const volatile uint32_t table[4] = {1, 2, 3, 4};

int main(uint64_t, uint64_t, uint64_t) {
  const_cast<volatile uint32_t*>(table)[1] = 5;  // BROKEN
  return 0;
}
