// rule: commands-outstanding
// names: put
// twin: legal/wait_at_the_end
// build: checked
// Returns while its results are on their way: whoever reads them may be too early.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t results[32] = {1};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(results, envp, sizeof results, 3, 0, 0);  // BROKEN
  return 0;
}
