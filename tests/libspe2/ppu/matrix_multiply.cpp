#include <array>
#include <memory>

#include "run_in_thread.h"

extern "C" spe_program_handle_t multiplies;

namespace {

constexpr std::size_t kSize = 32, kSpes = 6;
struct alignas(128) Matrix {
  float rows[kSize][kSize];
};
struct alignas(128) Job {
  unsigned long long a, b, c;
  unsigned int first, rows;
};

}  // namespace

int main() {
  const auto a = std::make_unique<Matrix>(), b = std::make_unique<Matrix>(), c = std::make_unique<Matrix>();
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t k = 0; k < kSize; ++k) {
      a->rows[i][k] = static_cast<float>(i + k);
      b->rows[i][k] = static_cast<float>(i) - static_cast<float>(k);
    }
  }
  std::array<Job, kSpes> jobs{};
  std::array<spe_thread_t, kSpes> spes{};
  for (std::size_t i = 0; i < kSpes; ++i) {
    const auto first = static_cast<unsigned int>(i * kSize / kSpes);
    jobs[i] = {reinterpret_cast<std::uintptr_t>(a.get()), reinterpret_cast<std::uintptr_t>(b.get()),
               reinterpret_cast<std::uintptr_t>(c.get()), first,
               static_cast<unsigned int>((i + 1) * kSize / kSpes) - first};
    start_spe(&spes[i], &multiplies, 0, &jobs[i], nullptr);
  }
  for (spe_thread_t& spe : spes) CHECK(end_spe(&spe) == 0);
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t k = 0; k < kSize; ++k) {
      float sum = 0;  // whole numbers below 2^24: exact
      for (std::size_t j = 0; j < kSize; ++j) sum += a->rows[i][j] * b->rows[j][k];
      CHECK(c->rows[i][k] == sum);
    }
  }
  std::puts("ok");
}
