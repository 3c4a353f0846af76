#include "spu_model/operands.h"

#include <array>
#include <span>
#include <string_view>

namespace softcell::spu_model {
namespace {

constexpr std::uint64_t kIntegerCorners[] = {
    0,          1,          2,          0x7F,       0x80,       0xFF,       0x100,
    0x7FFF,     0x8000,     0xFFFF,     0x10000,    0x7FFFFFFF, 0x80000000, 0x80000001,
    0xFFFFFFFF, 0xFFFFFFFE, 0xFFFF8000, 0xFFFF7FFF, 0x00010001, 0x7FFF7FFF, 0x80008000,
    0x8000FFFF, 0x01010101, 0x7F7F7F7F, 0x80808080, 0xFF00FF00, 0x0000001F, 0x00000020,
    0x0000003F, 0x00000040, 0xFFFFFFE1, 0xFFFFFFE0, 0xFFFFFFC1, 0xFFFFFFC0, 0x0010001F,
    0x0003FFFC, 0x0003FFF0, 0x00040000, 0xC0E08060, 0x1F3F5F9F, 0xBFC0DFE0};
// Zeros, denormals, the least and the largest of each binade's sense, 2^24, 2^31, 2^32 and their neighbours.
constexpr std::uint64_t kSingleCorners[] = {
    0x00000000, 0x00000001, 0x00400000, 0x007FFFFF, 0x00800000, 0x00800001, 0x00FFFFFF, 0x01000000,
    0x0BFFFFFF, 0x1F800000, 0x20000000, 0x337FFFFF, 0x33800000, 0x3F000000, 0x3F7FFFFF, 0x3F800000,
    0x3F800001, 0x3FFFFFFF, 0x40000000, 0x40490FDB, 0x4B7FFFFF, 0x4B800000, 0x4EFFFFFF, 0x4F000000,
    0x4F7FFFFF, 0x4F800000, 0x5F800000, 0x7E7FFFFF, 0x7E800000, 0x7EFFFFFF, 0x7F000000, 0x7F7FFFFF,
    0x7F800000, 0x7F800001, 0x7FC00000, 0x7FFFFFFE, 0x7FFFFFFF};
constexpr std::uint64_t kDoubleCorners[] = {
    0x0000000000000000, 0x0000000000000001, 0x0008000000000000, 0x000FFFFFFFFFFFFF, 0x0010000000000000,
    0x0010000000000001, 0x0020000000000000, 0x0350000000000000, 0x36A0000000000000, 0x3690000000000000,
    0x380FFFFFE0000000, 0x380FFFFFF0000000, 0x3810000000000000, 0x3CA0000000000000, 0x3CA0000000000001,
    0x3FE0000000000000, 0x3FEFFFFFFFFFFFFF, 0x3FF0000000000000, 0x3FF0000000000001, 0x3FF0000010000000,
    0x3FF0000030000000, 0x3FF0000030000001, 0x4000000000000000, 0x4340000000000000, 0x4340000000000001,
    0x47EFFFFFE0000000, 0x47EFFFFFF0000000, 0x47F0000000000000, 0x7FD0000000000000, 0x7FE0000000000000,
    0x7FEFFFFFFFFFFFFF, 0x7FF0000000000000, 0x7FF0000000000001, 0x7FF7FFFFFFFFFFFF, 0x7FF8000000000000,
    0x7FFFFFFFFFFFFFFF};

std::span<const std::uint64_t> corners_of(Kind kind) {
  if (kind == Kind::kSingles) return kSingleCorners;
  if (kind == Kind::kDoubles) return kDoubleCorners;
  return kIntegerCorners;
}

/// A single whose exponent is near that of others, so that sums cancel and align.
std::uint64_t near_single(Random& random) {
  const std::uint64_t bits = random();
  const std::uint64_t exponent = 127 - 15 + bits % 30;
  const std::uint64_t fraction = bits >> 32 & 0x7FFFFF & ~0ull << (bits >> 8 & 31) % 24;
  return bits >> 63 << 31 | exponent << 23 | fraction;
}
std::uint64_t near_double(Random& random) {
  const std::uint64_t bits = random();
  const std::uint64_t exponent = 1023 - 30 + random() % 60;
  return (bits & 0x800FFFFFFFFFFFFF & ~0ull << random() % 53) | exponent << 52;
}

std::uint64_t random_element(Kind kind, Random& random) {
  const std::uint64_t choice = random() % 8;
  if (choice < 2) return corner(kind, random);
  if (kind == Kind::kIntegers || choice < 4) return random();
  return kind == Kind::kSingles ? near_single(random) : near_double(random);
}

}  // namespace

bool is_floating_point(const Instruction& instruction) { return kind_of(instruction) != Kind::kIntegers; }

Kind kind_of(const Instruction& instruction) {
  constexpr std::string_view kSingles[] = {"fa",    "fs",      "fm",    "fma",   "fnms",  "fms",
                                           "frest", "frsqest", "fi",    "cflts", "cfltu", "csflt",
                                           "cuflt", "fceq",    "fcmeq", "fcgt",  "fcmgt", "fesd"};
  for (const std::string_view name : kSingles) {
    if (instruction.mnemonic == name) return Kind::kSingles;
  }
  const bool is_double = instruction.mnemonic == "frds" || instruction.mnemonic.starts_with("df");
  return is_double ? Kind::kDoubles : Kind::kIntegers;
}

std::size_t corners(Kind kind) { return 2 * corners_of(kind).size(); }

std::uint64_t corner_number(Kind kind, std::size_t i) {
  const std::uint64_t value = corners_of(kind)[i / 2];
  if (i % 2 == 0) return value;
  if (kind == Kind::kIntegers) return ~value;
  return value | (kind == Kind::kSingles ? 1ull << 31 : 1ull << 63);
}

std::uint64_t corner(Kind kind, Random& random) { return corner_number(kind, random() % corners(kind)); }

Quadword random_quadword(Kind kind, Random& random) {
  const int size = kind == Kind::kDoubles ? 8 : 4;
  return each_element(size, [&](int) { return random_element(kind, random); });
}

std::uint32_t random_word(const Instruction& instruction, Random& random) {
  constexpr std::uint32_t kRegisters[] = {0, 1, 5, 64, 126, 127};
  const auto any_register = [&] { return kRegisters[random() % std::size(kRegisters)]; };
  Fields fields{.rt = any_register(), .ra = any_register(), .rb = any_register(), .rc = any_register()};
  const int bits = immediate_bits(instruction.format);
  const std::int64_t half = bits == 0 ? 0 : 1ll << (bits - 1);  // of what the immediate can be
  const std::int64_t ends[] = {0, 1, -1, half, half - 1, 2 * half - 1};
  fields.immediate =
      random() % 4 == 0 ? ends[random() % std::size(ends)] : static_cast<std::int64_t>(random());
  std::uint32_t word = encode(instruction, fields);
  // Those without fields for all of this have free bits, of branches the D and E bits.
  const bool is_free = instruction.format == Format::kHintRegister ||
                       instruction.format == Format::kHintImmediate || instruction.action != nullptr;
  if (is_free && random() % 2 == 0) word ^= static_cast<std::uint32_t>(random()) & ~instruction.mask();
  return word;
}

bool is_undefined(std::uint32_t word) {
  const Instruction* const row = decode(word);
  if (row == nullptr || row->format != Format::kRR || row->action == nullptr) return false;
  const bool branches = row->mnemonic.starts_with("bi") || row->mnemonic == "iret";
  return branches && (word >> 18 & 3) == 3;
}

}  // namespace softcell::spu_model
