// The interpreter against the model: each instruction with corner values and random ones, aliased registers,
// ends of immediates and bits that an instruction ignores; then streams of random instructions.
//
// SOFTCELL_SPU_TRIPLES=10000000 asks for as many random operand triples of each floating-point instruction
// (100,000 usually).

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spu_model/operands.h"
#include "spu_model/twins.h"
#include "support/slow_build.h"

namespace softcell::spu_model {
namespace {

constexpr std::uint64_t kLess = kSlowBuild ? 10 : 1;  // where all is slow
constexpr std::uint64_t kUsualTriples = 100000 / kLess;
/// For an instruction that is none of floating point: four words each.
constexpr std::uint64_t kUsualQuadwords = 20000 / kLess;

std::uint64_t triples() {
  const char* const asked = std::getenv("SOFTCELL_SPU_TRIPLES");
  return asked == nullptr ? kUsualTriples : std::strtoull(asked, nullptr, 10);
}

/// Local store and registers full of random bits, some of FPSCR's set.
void randomize(Twins& twins, Random& random) {
  std::vector<std::uint8_t> bytes(kLocalStoreLimit + 1);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  twins.set_memory(0, bytes);
  for (std::uint32_t number = 0; number < 128; ++number) {
    twins.set_register(number, random_quadword(Kind::kIntegers, random));
  }
  twins.set_fpscr({});
}

/// FPSCR with any rounding modes and no flags.
Quadword rounding_modes(Random& random) {
  Quadword fpscr;
  fpscr.set_word(0, static_cast<std::uint32_t>(random() & 0xF00));
  return fpscr;
}

/// The register fields of a word.
std::array<std::uint32_t, 4> registers_of(std::uint32_t word) {
  return {word >> 7 & 127, word >> 14 & 127, word & 127, word >> 21 & 127};
}

/// `count` quadwords of random operands; stops at the first difference.
void compare_randomly(std::string_view mnemonic, std::uint64_t count) {
  const Instruction& row = instruction(mnemonic);
  Random random(std::hash<std::string_view>{}(mnemonic));
  static Twins twins;
  randomize(twins, random);
  const Kind kind = kind_of(row);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint32_t word = random_word(row, random);
    if (is_undefined(word)) continue;
    for (const std::uint32_t number : registers_of(word))
      twins.set_register(number, random_quadword(kind, random));
    if (kind == Kind::kDoubles || i % 16 == 0) twins.set_fpscr(rounding_modes(random));
    if (i % 16 == 0) {
      twins.set_pc(static_cast<std::uint32_t>(i % 64 == 0 ? 0x3FFFC : random()));
      twins.set_srr0(static_cast<std::uint32_t>(random()));
      twins.set_interrupts(random() % 2 == 0);
    }
    ASSERT_EQ(twins.execute_word(word), "") << "case " << i;
    if (i % 1024 == 0) {
      ASSERT_EQ(twins.difference(), "") << mnemonic << ", case " << i;
    }
  }
  ASSERT_EQ(twins.difference(), "") << mnemonic;
}

/// Each pair of corner values in RA and RB, each corner in RC and RT; every lane has another pair.
void compare_corners(std::string_view mnemonic) {
  const Instruction& row = instruction(mnemonic);
  static Twins twins;
  const Kind kind = kind_of(row);
  const std::size_t count = corners(kind);
  const int size = kind == Kind::kDoubles ? 8 : 4;
  const std::uint32_t word =
      encode(row, {.rt = 4, .ra = 1, .rb = 2, .rc = 3, .immediate = kind == Kind::kSingles ? 155 : 7});
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a % kLess; b < count; b += kLess) {
      const auto fill = [&](std::size_t first, std::size_t stride) {
        return each_element(size, [&](int lane) {
          return corner_number(kind, (first + stride * static_cast<std::size_t>(lane)) % count);
        });
      };
      twins.set_register(1, fill(a, 1));
      twins.set_register(2, fill(b, 0));
      twins.set_register(3, fill(a + 3 * b, 5));
      twins.set_register(4, fill(a + 7 * b, 3));
      Quadword modes;
      modes.set_word(0, static_cast<std::uint32_t>((a + b) % 16) << 8);
      twins.set_fpscr(modes);
      twins.set_pc(0x100);
      ASSERT_EQ(twins.execute_word(word), "") << "corners " << a << " and " << b;
    }
  }
}

/// What the registers cannot vary: each immediate of up to ten bits, the ends and the powers of two of wider
/// ones.
void compare_immediates(std::string_view mnemonic) {
  const Instruction& row = instruction(mnemonic);
  const int bits = immediate_bits(row.format);
  if (bits == 0) return;
  Random random(bits);
  static Twins twins;
  randomize(twins, random);
  std::vector<std::int64_t> immediates;
  if (bits <= 10) {
    for (std::int64_t value = 0; value < 1ll << bits; ++value) immediates.push_back(value);
  } else {
    for (int bit = 0; bit < bits; ++bit) {
      for (const std::int64_t near : {-1, 0, 1}) immediates.push_back((1ll << bit) + near);
      immediates.push_back(-(1ll << bit));
    }
  }
  for (const std::int64_t immediate : immediates) {
    twins.set_register(1, random_quadword(kind_of(row), random));
    twins.set_pc(0x1000);
    ASSERT_EQ(twins.execute_word(encode(row, {.rt = 4, .ra = 1, .immediate = immediate})), "") << immediate;
  }
  ASSERT_EQ(twins.difference(), "") << mnemonic;
}

class FloatingPoint : public testing::TestWithParam<std::string_view> {};

TEST_P(FloatingPoint, AgreesWithExactArithmetic) {
  compare_corners(GetParam());
  compare_immediates(GetParam());
  const std::uint64_t lanes = kind_of(instruction(GetParam())) == Kind::kDoubles ? 2 : 4;
  compare_randomly(GetParam(), triples() / lanes);
}

std::vector<std::string_view> floating_point() {
  std::vector<std::string_view> names;
  for (const Instruction& row : instructions()) {
    if (is_floating_point(row)) names.push_back(row.mnemonic);
  }
  return names;
}
INSTANTIATE_TEST_SUITE_P(Interpreter, FloatingPoint, testing::ValuesIn(floating_point()),
                         [](const auto& row) { return std::string(row.param); });

/// All others, a twelfth of them in each test.
class Others : public testing::TestWithParam<int> {};
constexpr int kParts = 12;

TEST_P(Others, AgreeWithTheirDefinitions) {
  int number = 0;
  for (const Instruction& row : instructions()) {
    if (is_floating_point(row) || number++ % kParts != GetParam()) continue;
    SCOPED_TRACE(row.mnemonic);
    compare_corners(row.mnemonic);
    compare_immediates(row.mnemonic);
    compare_randomly(row.mnemonic, kUsualQuadwords);
  }
}
INSTANTIATE_TEST_SUITE_P(Interpreter, Others, testing::Range(0, kParts));

TEST(Interpreter, KnowsTheSameWordsAsTheModel) {
  Random random(5);
  Twins twins;
  for (std::uint32_t opcode = 0; opcode < 2048; ++opcode) {
    for (int i = 0; i < 8; ++i) {
      const std::uint32_t word = opcode << 21 | static_cast<std::uint32_t>(random() & 0x1FFFFF);
      if (is_undefined(word)) continue;
      ASSERT_EQ(twins.execute_word(word), "");
    }
  }
}

TEST(Interpreter, HasTheComparesOfDoublesOnAPowerXCellOnly) {
  ls_sim::interpreter::SpuState state;
  std::vector<std::byte> local_store(kLocalStoreLimit + 1);
  const std::span<std::byte, kLocalStoreLimit + 1> bytes(local_store.data(), local_store.size());
  for (const char* const mnemonic : {"dfceq", "dfcmeq", "dfcgt", "dfcmgt", "dftsv"}) {
    const auto step = ls_sim::interpreter::execute(state, bytes, encode(mnemonic, {}));
    EXPECT_EQ(step.ending, ls_sim::interpreter::Ending::kInvalid) << mnemonic;
  }
}

TEST(Interpreter, AgreesOnStreamsOfRandomInstructions) {
  constexpr int kStreams = kLess == 1 ? 30 : 3;
  constexpr int kInstructions = 20000;
  for (int stream = 0; stream < kStreams; ++stream) {
    Random random(static_cast<std::uint64_t>(stream));
    static Twins twins;
    randomize(twins, random);
    twins.set_fpscr(rounding_modes(random));
    twins.set_pc(0);
    // Half of the local store is code, so that loads and branches meet data and stores meet code, too.
    std::vector<std::uint8_t> code;
    for (int i = 0; i < 0x8000; ++i) {
      std::uint32_t word = 0;
      do {
        word = random_word(instructions()[random() % instructions().size()], random);
      } while (is_undefined(word));
      for (int shift = 24; shift >= 0; shift -= 8) code.push_back(static_cast<std::uint8_t>(word >> shift));
    }
    twins.set_memory(0, code);
    for (int i = 0; i < kInstructions; ++i) {
      const std::uint32_t pc = twins.model().pc;
      if (is_undefined(twins.model().fetch(pc))) twins.set_pc(pc + 4);
      ASSERT_EQ(twins.step(), "") << "stream " << stream << ", instruction " << i;
      // What ends a run, or stays where it is, is stepped over.
      if (twins.model().pc == pc) twins.set_pc(pc + 4);
    }
    ASSERT_EQ(twins.difference(), "") << "stream " << stream;
  }
}

}  // namespace
}  // namespace softcell::spu_model
