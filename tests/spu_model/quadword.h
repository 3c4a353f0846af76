#pragma once

// A register or quadword of storage as the architecture draws it: 16 bytes, the leftmost first, each element
// big-endian. Bits, bytes and elements are numbered from the left, as in [SPU-ISA].

#include <array>
#include <cstdint>

namespace softcell::spu_model {

struct Quadword {
  std::array<std::uint8_t, 16> bytes{};

  /// The big-endian number in `count` bytes from byte `first` on. @pre first + count <= 16, count <= 8.
  std::uint64_t number(int first, int count) const {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | bytes.at(static_cast<std::size_t>(first + i));
    return value;
  }
  void set_number(int first, int count, std::uint64_t value) {
    for (int i = count; i-- > 0; value >>= 8) {
      bytes.at(static_cast<std::size_t>(first + i)) = static_cast<std::uint8_t>(value & 0xFF);
    }
  }

  std::uint8_t byte(int i) const { return static_cast<std::uint8_t>(number(i, 1)); }
  std::uint16_t half(int i) const { return static_cast<std::uint16_t>(number(2 * i, 2)); }
  std::uint32_t word(int i) const { return static_cast<std::uint32_t>(number(4 * i, 4)); }
  std::uint64_t doubleword(int i) const { return number(8 * i, 8); }
  void set_word(int i, std::uint32_t value) { set_number(4 * i, 4, value); }
  void set_doubleword(int i, std::uint64_t value) { set_number(8 * i, 8, value); }

  /// Bit n, 0..127, 0 the leftmost.
  bool bit(int n) const { return (byte(n / 8) >> (7 - n % 8) & 1) != 0; }
  void set_bit(int n, bool value) {
    const auto mask = static_cast<std::uint8_t>(0x80 >> n % 8);
    std::uint8_t& place = bytes.at(static_cast<std::size_t>(n / 8));
    place = static_cast<std::uint8_t>(value ? place | mask : place & ~mask);
  }

  friend bool operator==(const Quadword&, const Quadword&) = default;
};

/// A quadword whose element i of `size` bytes is the low part of value(i).
template <class Value>
Quadword each_element(int size, Value value) {
  Quadword result;
  for (int i = 0; i < 16 / size; ++i) {
    result.set_number(i * size, size, static_cast<std::uint64_t>(value(i)));
  }
  return result;
}
template <class Value>
Quadword each_byte(Value value) {
  return each_element(1, value);
}
template <class Value>
Quadword each_half(Value value) {
  return each_element(2, value);
}
template <class Value>
Quadword each_word(Value value) {
  return each_element(4, value);
}
template <class Value>
Quadword each_doubleword(Value value) {
  return each_element(8, value);
}

/// The word in the preferred slot, zeros elsewhere.
inline Quadword preferred_word(std::uint32_t value) {
  Quadword result;
  result.set_word(0, value);
  return result;
}

/// `value`'s rightmost `width` bits as a two's-complement number.
constexpr std::int64_t sign_extended(std::uint64_t value, int width) {
  const std::uint64_t sign = 1ull << (width - 1);
  const std::uint64_t low = value & ((sign << 1) - 1);
  return static_cast<std::int64_t>(low ^ sign) - static_cast<std::int64_t>(sign);
}
constexpr std::int64_t s8(std::uint64_t value) { return sign_extended(value, 8); }
constexpr std::int64_t s16(std::uint64_t value) { return sign_extended(value, 16); }
constexpr std::int64_t s32(std::uint64_t value) { return sign_extended(value, 32); }

}  // namespace softcell::spu_model
