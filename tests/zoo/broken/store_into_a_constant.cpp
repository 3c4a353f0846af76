// rule: write-to-code
// twin: legal/constant_read
// build: checked
// Takes the defaults themselves for the settings that may be changed: constants lie beside the code, and
// nothing protects them.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static const uint32_t defaults[4] = {1, 2, 3, 4};
static uint32_t* volatile settings;

int main(uint64_t, uint64_t, uint64_t) {
  settings = const_cast<uint32_t*>(defaults);
  settings[1] = 5;  // BROKEN
  return 0;
}
