#include "softcell/dma/local_store_bytes.h"

#include <immintrin.h>

#include <cstdint>

#include "softcell/base/assert.h"

namespace softcell::dma {
namespace {

constexpr std::size_t kQuadword = sizeof(__m128i);

/// Keeps the compiler from making a call of memcpy or memset, or a string instruction, of the loop around it.
void keep_loop() { asm volatile("" ::: "memory"); }

__m128i load_quadword(const std::byte* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}
void store_quadword(std::byte* to, __m128i value) { _mm_storeu_si128(reinterpret_cast<__m128i*>(to), value); }

// What is left of a copy or fill when its quadwords are done.
void copy_single_bytes(std::byte* to, const std::byte* from, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; ++at) {
    to[at] = from[at];
    keep_loop();
  }
}
void fill_single_bytes(std::byte* to, std::byte value, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; ++at) {
    to[at] = value;
    keep_loop();
  }
}

void copy_by_quadwords(std::byte* to, const std::byte* from, std::size_t bytes) {
  std::size_t at = 0;
  for (; at + kQuadword <= bytes; at += kQuadword) {
    store_quadword(to + at, load_quadword(from + at));
    keep_loop();
  }
  copy_single_bytes(to + at, from + at, bytes - at);
}

void fill_by_quadwords(std::byte* to, std::byte value, std::size_t bytes) {
  const __m128i quadword = _mm_set1_epi8(static_cast<char>(value));
  std::size_t at = 0;
  for (; at + kQuadword <= bytes; at += kQuadword) {
    store_quadword(to + at, quadword);
    keep_loop();
  }
  fill_single_bytes(to + at, value, bytes - at);
}

// On a processor with AVX a lane is two quadwords, and a round moves a line of main storage. The destination
// is aligned to the lane first, so that no store crosses a boundary of the host's cache lines.
constexpr std::size_t kLane = sizeof(__m256i);
constexpr std::size_t kRound = 4 * kLane;

std::size_t bytes_to_lane(const std::byte* to) { return -reinterpret_cast<std::uintptr_t>(to) % kLane; }

[[gnu::target("avx")]] __m256i* lane(std::byte* at) { return reinterpret_cast<__m256i*>(at); }

[[gnu::target("avx")]] void copy_rounds(std::byte* to, const std::byte* from, std::size_t bytes) {
  SC_ASSERT(bytes_to_lane(to) == 0 && bytes % kRound == 0, "{} bytes to {}", bytes, to);
  const auto* source = reinterpret_cast<const __m256i*>(from);
  for (__m256i* place = lane(to); bytes != 0; bytes -= kRound, place += 4, source += 4) {
    const __m256i a = _mm256_loadu_si256(source), b = _mm256_loadu_si256(source + 1);
    const __m256i c = _mm256_loadu_si256(source + 2), d = _mm256_loadu_si256(source + 3);
    _mm256_store_si256(place, a);
    _mm256_store_si256(place + 1, b);
    _mm256_store_si256(place + 2, c);
    _mm256_store_si256(place + 3, d);
    keep_loop();
  }
}

[[gnu::target("avx")]] void fill_rounds(std::byte* to, std::byte value, std::size_t bytes) {
  SC_ASSERT(bytes_to_lane(to) == 0 && bytes % kRound == 0, "{} bytes at {}", bytes, to);
  const __m256i filling = _mm256_set1_epi8(static_cast<char>(value));
  for (__m256i* place = lane(to); bytes != 0; bytes -= kRound, place += 4) {
    for (int i = 0; i < 4; ++i) _mm256_store_si256(place + i, filling);
    keep_loop();
  }
}

bool has_avx() { return __builtin_cpu_supports("avx") != 0; }

}  // namespace

void copy_to_local_store(std::byte* to, const std::byte* from, std::size_t bytes) {
  const std::size_t head = bytes_to_lane(to);
  if (bytes < head + kRound || !has_avx()) return copy_by_quadwords(to, from, bytes);
  const std::size_t rounds = (bytes - head) / kRound * kRound;
  copy_by_quadwords(to, from, head);
  copy_rounds(to + head, from + head, rounds);
  copy_by_quadwords(to + head + rounds, from + head + rounds, bytes - head - rounds);
}

void fill_local_store(std::byte* to, std::byte value, std::size_t bytes) {
  const std::size_t head = bytes_to_lane(to);
  if (bytes < head + kRound || !has_avx()) return fill_by_quadwords(to, value, bytes);
  const std::size_t rounds = (bytes - head) / kRound * kRound;
  fill_by_quadwords(to, value, head);
  fill_rounds(to + head, value, rounds);
  fill_by_quadwords(to + head + rounds, value, bytes - head - rounds);
}

void flush_local_store(const std::byte* begin, std::size_t bytes) {
  constexpr std::size_t kHostLineBytes = 64;
  for (std::size_t at = 0; at < bytes; at += kHostLineBytes) _mm_clflush(begin + at);
  _mm_mfence();
}

}  // namespace softcell::dma
