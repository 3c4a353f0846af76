// Linked to lie in the middle of the local store. Puts to argp where it finds itself: the local-store
// addresses of main, of a variable and of its stack, and the variable's value.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct alignas(128) Report {
  uint32_t code, data, stack, value, pad[28];
};
static Report report;
static uint32_t variable = 7;

static uint32_t address(const volatile void* pointer) {
  return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(pointer) & 0x3FFFF);
}

int main(uint64_t, uint64_t argp, uint64_t) {
  volatile uint32_t on_stack = 0;
  report.code = address(reinterpret_cast<const void*>(&main));
  report.data = address(&variable);
  report.stack = address(&on_stack);
  report.value = variable;
  mfc_put(&report, argp, sizeof report, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  return 0;
}
