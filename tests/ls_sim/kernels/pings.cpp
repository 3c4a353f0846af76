// Signals go round: SPE 0 begins, every other one waits for its own first. argp is the address of the next
// SPE's Sig_Notify_1, envp the number of rounds. A signal says how many SPEs it has passed; the SPE ends with
// the low byte of the last it got.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static volatile uint32_t signal[4];

static void send(uint64_t ea, uint32_t value) {
  signal[3] = value;  // where the low four bits are those of the register's address
  mfc_sndsig(&signal[3], ea, 1, 0, 0);
  mfc_write_tag_mask(1u << 1);
  mfc_read_tag_status_all();
}

int main(uint64_t spe_id, uint64_t argp, uint64_t envp) {
  uint32_t value = 0;
  for (uint64_t round = 0; round < envp; ++round) {
    if (spe_id == 0) send(argp, value + 1);
    value = spu_read_signal1();
    if (spe_id != 0) send(argp, value + 1);
  }
  return static_cast<int>(value);
}
