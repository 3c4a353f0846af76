/* calls.cpp in C. */
#include <spu_intrinsics.h>
#include <sys/send_to_ppe.h>

int main(unsigned long long spe_id, unsigned long long argp, unsigned long long envp) {
  volatile unsigned int arguments[4] __attribute__((aligned(16)));
  unsigned int sum = 0, i;
  (void)spe_id, (void)argp, (void)envp;
  for (i = 1; i <= 10; ++i) {
    arguments[0] = sum;
    arguments[1] = i;
    arguments[2] = arguments[3] = 0;
    __send_to_ppe(0x2110, 7, (void*)arguments);
    sum = arguments[0];
    if (arguments[1] != i) return 255;
  }
  return (int)sum;
}
