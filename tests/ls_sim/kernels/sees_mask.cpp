// Ends with 1 when the event mask that it begins with has anything in it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) { return spu_read_event_mask() != 0 ? 1 : 0; }
