#include <array>
#include <atomic>

#include "run_in_thread.h"

extern "C" spe_program_handle_t takes_tickets;

namespace {

constexpr unsigned int kTickets = 2000;
constexpr int kSpes = 5;

struct alignas(128) Line {
  unsigned int next, end, others[30];
};
struct alignas(128) Job {
  unsigned long long line, sum;
};
struct alignas(128) Sum {
  unsigned long long value, other;
};

}  // namespace

int main() {
  static Line line{0, kTickets, {}};
  static std::array<Job, kSpes> jobs;
  static std::array<Sum, kSpes> sums;
  std::array<spe_thread_t, kSpes> spes;
  for (std::size_t i = 0; i < kSpes; ++i) {
    jobs[i] = {reinterpret_cast<std::uintptr_t>(&line), reinterpret_cast<std::uintptr_t>(&sums[i])};
    start_spe(&spes[i], &takes_tickets, 0, &jobs[i], nullptr);
  }
  // The PPU takes tickets, too, with the host's own atomic operations.
  unsigned long long sum = 0;
  for (;;) {
    unsigned int index = __atomic_load_n(&line.next, __ATOMIC_RELAXED);
    if (index == kTickets) break;
    if (__atomic_compare_exchange_n(&line.next, &index, index + 1, false, __ATOMIC_ACQ_REL, __ATOMIC_RELAXED))
      sum += static_cast<unsigned long long>(index) * index;
  }
  for (std::size_t i = 0; i < kSpes; ++i) {
    CHECK(end_spe(&spes[i]) == 0);
    sum += sums[i].value;
  }
  constexpr unsigned long long n = kTickets - 1;
  CHECK(sum == n * (n + 1) * (2 * n + 1) / 6);
  std::puts("ok");
}
