#include "arena.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"

namespace softcell::dma {
namespace {

constexpr std::uint64_t round_up_to_line(std::uint64_t bytes) {
  return (bytes + kLineBytes - 1) / kLineBytes * kLineBytes;
}

}  // namespace

Arena::Arena(EffectiveAddress base, std::uint64_t bytes) : base_(base), bytes_(bytes) {
  SC_ASSERT(base.value % kLineBytes == 0 && bytes % kLineBytes == 0,
            "{} bytes from {} on are not whole lines", bytes, base);
  void* pages =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (pages == MAP_FAILED) {
    throw std::runtime_error("cannot reserve " + std::to_string(bytes >> 20) +
                             " MB of host address space for emulated memory");
  }
  // What SPEs stream through is far more than the host's translation buffers cover with small pages.
  madvise(pages, bytes, MADV_HUGEPAGE);
  host_ = static_cast<std::byte*>(pages);
  free_.emplace(0, bytes);
}

Arena::~Arena() { munmap(host_, bytes_); }

std::optional<EffectiveAddress> Arena::allocate(std::uint64_t bytes) {
  SC_ASSERT(bytes != 0, "an allocation of 0 bytes from the {} at {}", bytes_, base_);
  if (bytes > bytes_) return std::nullopt;  // also keeps the rounding below from overflowing
  const std::uint64_t needed = round_up_to_line(bytes);
  const auto fit =
      std::find_if(free_.begin(), free_.end(), [&](const auto& range) { return range.second >= needed; });
  if (fit == free_.end()) return std::nullopt;

  const auto [offset, available] = *fit;
  free_.erase(fit);
  if (available > needed) free_.emplace(offset + needed, available - needed);

  const std::uint64_t end = offset + needed;
  if (offset < touched_) std::memset(host_ + offset, 0, std::min(end, touched_) - offset);
  touched_ = std::max(touched_, end);
  return base_ + offset;
}

void Arena::free(EffectiveAddress ea, std::uint64_t bytes) {
  std::uint64_t begin = ea.value - base_.value;
  std::uint64_t end = begin + round_up_to_line(bytes);
  SC_ASSERT(ea >= base_ && begin % kLineBytes == 0 && end <= bytes_,
            "{} bytes at {} were never allocated from the {} at {}", bytes, ea, bytes_, base_);
  const auto next = free_.lower_bound(begin);
  SC_ASSERT(next == free_.end() || next->first >= end, "{} bytes at {} are freed a second time", bytes, ea);
  if (next != free_.begin()) {
    const auto previous = std::prev(next);
    SC_ASSERT(previous->first + previous->second <= begin, "{} bytes at {} are freed a second time", bytes,
              ea);
    if (previous->first + previous->second == begin) {
      begin = previous->first;
      free_.erase(previous);
    }
  }
  if (next != free_.end() && next->first == end) {
    end += next->second;
    free_.erase(next);
  }
  free_.emplace(begin, end - begin);
}

std::uint64_t Arena::free_bytes() const {
  std::uint64_t sum = 0;
  for (const auto& [offset, bytes] : free_) sum += bytes;
  return sum;
}

std::uint64_t Arena::largest_free_range() const {
  std::uint64_t largest = 0;
  for (const auto& [offset, bytes] : free_) largest = std::max(largest, bytes);
  return largest;
}

}  // namespace softcell::dma
