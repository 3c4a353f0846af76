#pragma once

#include <cstdint>

namespace softcell::ppu {

/// The hash FNV-1a, fed with words of 32 bits.
class NumberHash {
 public:
  void add(std::uint32_t number) { hash_ = (hash_ ^ number) * 0x100000001b3u; }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// The hash of a list of numbers, also for the standard library's tables.
struct HashOfNumbers {
  template <typename Numbers>
  std::uint64_t operator()(const Numbers& numbers) const {
    NumberHash hash;
    for (const std::uint32_t number : numbers) hash.add(number);
    return hash.value();
  }
};

}  // namespace softcell::ppu
