// The judge is judged: by what is published of the instructions, by the host's arithmetic where it must
// agree, and by its own table.

#include <gtest/gtest.h>

#include <bit>
#include <cfenv>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string_view>

#include "spu_model/encode.h"
#include "support/published_estimates.h"

namespace softcell::spu_model {
namespace {

Quadword words(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  Quadword result;
  result.set_word(0, a);
  result.set_word(1, b);
  result.set_word(2, c);
  result.set_word(3, d);
  return result;
}
Quadword all_words(std::uint32_t word) { return words(word, word, word, word); }

/// RT of an instruction on registers 1 (RA), 2 (RB), 3 (RC); what RT held before is `rt`.
Quadword result_of(std::string_view mnemonic, const Quadword& ra, const Quadword& rb = {},
                   const Quadword& rc = {}, const Quadword& rt = {}, std::int64_t immediate = 0,
                   Quadword* fpscr = nullptr) {
  static Machine machine;
  machine.enhanced_double = true;
  machine.registers[1] = ra;
  machine.registers[2] = rb;
  machine.registers[3] = rc;
  machine.registers[4] = rt;
  machine.fpscr = fpscr != nullptr ? *fpscr : Quadword{};
  execute(machine, encode(mnemonic, {.rt = 4, .ra = 1, .rb = 2, .rc = 3, .immediate = immediate}));
  if (fpscr != nullptr) *fpscr = machine.fpscr;
  return machine.registers[4];
}

TEST(SpuModelTable, HasEachOf199InstructionsOnce) {
  ASSERT_EQ(instructions().size(), 199u);
  std::set<std::string_view> names;
  int filled = 0;
  for (std::uint32_t opcode = 0; opcode < 2048; ++opcode) {
    int matches = 0;
    for (const Instruction& row : instructions())
      matches += (opcode << 21 & row.mask()) == row.pattern() ? 1 : 0;
    ASSERT_LE(matches, 1) << "two instructions have opcode " << opcode;
    filled += matches;
  }
  EXPECT_EQ(filled, 1264);  // of 2048; the others are invalid instructions
  for (const Instruction& row : instructions()) {
    EXPECT_TRUE(names.insert(row.mnemonic).second) << row.mnemonic;
    EXPECT_EQ((row.value != nullptr) + (row.float_value != nullptr) + (row.action != nullptr), 1)
        << row.mnemonic;
    EXPECT_TRUE(row.evidence == Evidence::kArchitecture || !row.note.empty() ||
                row.evidence == Evidence::kTwoSources)
        << row.mnemonic << " says not why it rests on less than the architecture";
  }
}

TEST(SpuModelTable, WidthsOfOpcodesAreThoseOfTheirFormats) {
  const std::map<Format, std::size_t> widths{
      {Format::kRRR, 4},  {Format::kRR, 11},           {Format::kRI7, 11},
      {Format::kRI8, 10}, {Format::kRI10, 8},          {Format::kRI16, 9},
      {Format::kRI18, 7}, {Format::kHintRegister, 11}, {Format::kHintImmediate, 7}};
  for (const Instruction& row : instructions())
    EXPECT_EQ(row.opcode.size(), widths.at(row.format)) << row.mnemonic;
}

TEST(SpuModelSingle, EstimatesAreThosePublished) {
  for (const auto& [x, reciprocal, interpolated, root, interpolated_root] : test::kPublishedEstimates) {
    const Quadword argument = all_words(x);
    EXPECT_EQ(result_of("frest", argument), all_words(reciprocal)) << std::hex << x;
    EXPECT_EQ(result_of("fi", argument, all_words(reciprocal)), all_words(interpolated)) << std::hex << x;
    EXPECT_EQ(result_of("frsqest", argument), all_words(root)) << std::hex << x;
    EXPECT_EQ(result_of("fi", argument, all_words(root)), all_words(interpolated_root)) << std::hex << x;
  }
}

// What the architecture promises of them: 12 bits [SPU-ISA, 9, fi].
TEST(SpuModelSingle, InterpolatedEstimatesAreWithinTheirBounds) {
  for (std::uint32_t fraction = 0; fraction < 0x800000; fraction += 997) {
    for (const std::uint32_t exponent : {0x3F000000u, 0x3F800000u}) {
      const std::uint32_t word = exponent | fraction;
      const double x = std::bit_cast<float>(word);
      const Quadword argument = all_words(word);
      const auto value = [&](const char* estimate) {
        return double{std::bit_cast<float>(result_of("fi", argument, result_of(estimate, argument)).word(0))};
      };
      ASSERT_NEAR(value("frest") * x, 1, 2.1e-4) << std::hex << word;
      ASSERT_NEAR(value("frsqest") * std::sqrt(x), 1, 1.72e-4) << std::hex << word;
    }
  }
}

TEST(SpuModelSingle, TruncatesWhatIsTinyAndSaturatesWhatIsLarge) {
  const auto one = all_words(0x3F800000);
  EXPECT_EQ(result_of("fs", one, all_words(0x21800000)), all_words(0x3F7FFFFF)) << "1 - 2^-60";
  EXPECT_EQ(result_of("fa", all_words(0x7FFFFFFF), all_words(0x7FFFFFFF)), all_words(0x7FFFFFFF));
  EXPECT_EQ(result_of("fm", all_words(0xFFFFFFFF), all_words(0x40000000)), all_words(0xFFFFFFFF));
  EXPECT_EQ(result_of("fm", all_words(0x80800000), all_words(0x3F000000)), all_words(0))
      << "no -0, no denormal";
  EXPECT_EQ(result_of("fm", all_words(0x7F800000), one), all_words(0x7F800000)) << "2^128 is a number";
  EXPECT_EQ(result_of("fa", all_words(0x807FFFFF), all_words(0x80000000)), all_words(0))
      << "denormals are zero";
}

TEST(SpuModelSingle, FlagsSayWhereIeeeDiffers) {
  const auto flags = [](const char* mnemonic, std::uint32_t a, std::uint32_t b) {
    Quadword fpscr;
    result_of(mnemonic, words(0, a, 0, 0), words(0, b, 0, 0), {}, {}, 0, &fpscr);
    return fpscr;
  };
  EXPECT_EQ(flags("fa", 0x3F800000, 0x3F800000), Quadword{});
  EXPECT_EQ(flags("fa", 0x00000001, 0x3F800000), words(0, 1, 0, 0)) << "a denormal";
  EXPECT_EQ(flags("fm", 0x00800000, 0x3F000000), words(0, 3, 0, 0)) << "underflow";
  EXPECT_EQ(flags("fm", 0x7F000000, 0x7F000000), words(0, 5, 0, 0)) << "overflow";
  EXPECT_EQ(flags("frest", 0, 0).word(3), 0xF00u) << "zeros in all lanes";
}

/// What the host makes of a and b in its own doubles, in a rounding mode of the SPU's numbering.
double on_host(int mode, const std::function<double()>& operation) {
  constexpr int kModes[] = {FE_TONEAREST, FE_TOWARDZERO, FE_UPWARD, FE_DOWNWARD};
  std::fesetround(kModes[mode]);
  std::feclearexcept(FE_ALL_EXCEPT);
  const double result = operation();
  std::fesetround(FE_TONEAREST);
  return result;
}

std::uint64_t random_double(std::mt19937_64& random) {
  const std::uint64_t bits = random();
  const std::uint64_t near = (bits & 0x800FFFFFFFFFFFFF) | (1023 - 8 + random() % 16) << 52;
  switch (random() % 8) {
    case 0:
      return bits;
    case 1:
      return (bits & 0x8000000000000000) | (random() % 3 == 0 ? 0x7FEFFFFFFFFFFFFF : random() % 2 << 52);
    case 2:
      return near & ~0ull << random() % 52;
    default:
      return near;
  }
}
bool is_denormal(std::uint64_t word) { return (word >> 52 & 0x7FF) == 0 && (word << 12) != 0; }

TEST(SpuModelDouble, AgreesWithTheHostWhereIeeeAndTheSpuDo) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 20000; ++i) {
    const int mode = i % 4;
    const std::uint64_t bits[] = {random_double(random), random_double(random), random_double(random)};
    if (is_denormal(bits[0]) || is_denormal(bits[1]) || is_denormal(bits[2])) continue;
    // Volatile: the compiler may not compute before the rounding mode is set.
    volatile double a = std::bit_cast<double>(bits[0]);
    volatile double b = std::bit_cast<double>(bits[1]);
    volatile double c = std::bit_cast<double>(bits[2]);
    const auto check = [&](const char* mnemonic, const std::function<double()>& operation) {
      const double expected = on_host(mode, operation);
      const bool inexact = std::fetestexcept(FE_INEXACT) != 0;
      const bool underflow = std::fetestexcept(FE_UNDERFLOW) != 0;
      const bool overflow = std::fetestexcept(FE_OVERFLOW) != 0;
      Quadword ra, rb, rt, fpscr;
      ra.set_doubleword(1, bits[0]);
      rb.set_doubleword(1, bits[1]);
      rt.set_doubleword(1, bits[2]);
      fpscr.set_word(0, static_cast<std::uint32_t>(mode) << 8);
      const std::uint64_t found = result_of(mnemonic, ra, rb, {}, rt, 0, &fpscr).doubleword(1);
      if (std::isnan(expected)) {
        ASSERT_EQ(found, 0x7FF8000000000000) << mnemonic;
        return;
      }
      ASSERT_EQ(found, std::bit_cast<std::uint64_t>(expected))
          << mnemonic << std::hex << " " << bits[0] << " " << bits[1] << " " << bits[2] << " mode " << mode;
      ASSERT_EQ(fpscr.bit(84), inexact) << mnemonic << std::hex << " " << bits[0] << " " << bits[1];
      ASSERT_EQ(fpscr.bit(83), underflow) << mnemonic << std::hex << " " << bits[0] << " " << bits[1];
      ASSERT_EQ(fpscr.bit(82), overflow) << mnemonic << std::hex << " " << bits[0] << " " << bits[1];
    };
    check("dfa", [&] { return a + b; });
    check("dfs", [&] { return a - b; });
    check("dfm", [&] { return a * b; });
    check("dfma", [&] { return std::fma(a, b, c); });
    check("dfms", [&] { return std::fma(a, b, -c); });
    check("dfnma", [&] { return -std::fma(a, b, c); });
    check("dfnms", [&] { return -std::fma(a, b, -c); });
  }
}

TEST(SpuModelDouble, NarrowsAsTheHostDoes) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    const int mode = i % 4;
    const std::uint64_t bits = (random() & 0x800FFFFFFFFFFFFF) |
                               (random() % 2 == 0 ? 1023 - 160 + random() % 320 : random() % 2048) << 52;
    if (is_denormal(bits)) continue;
    volatile double a = std::bit_cast<double>(bits);
    volatile float narrowed = 0;
    on_host(mode, [&] {
      narrowed = static_cast<float>(a);
      return 0.0;
    });
    Quadword ra, fpscr;
    ra.set_doubleword(0, bits);
    fpscr.set_word(0, static_cast<std::uint32_t>(mode) << 10);
    const std::uint64_t found = result_of("frds", ra, {}, {}, {}, 0, &fpscr).doubleword(0);
    const std::uint32_t expected =
        std::isnan(a) ? 0x7FC00000u : std::bit_cast<std::uint32_t>(float{narrowed});
    ASSERT_EQ(found, std::uint64_t{expected} << 32) << std::hex << bits << " mode " << mode;
  }
}

TEST(SpuModelShifts, CountsPastTheLimits) {
  const Quadword value = all_words(0x80000001);
  EXPECT_EQ(result_of("shl", value, words(0, 31, 32, 64)), words(0x80000001, 0x80000000, 0, 0x80000001));
  EXPECT_EQ(result_of("rotm", value, words(0, 0u - 31, 0u - 32, 0u - 64)),
            words(0x80000001, 1, 0, 0x80000001));
  EXPECT_EQ(result_of("rotma", value, words(0, 0u - 31, 0u - 32, 0u - 64)),
            words(0x80000001, ~0u, ~0u, 0x80000001));
  EXPECT_EQ(result_of("rotqbyi", words(1, 2, 3, 4), {}, {}, {}, 4), words(2, 3, 4, 1));
  EXPECT_EQ(result_of("rotqmbyi", words(1, 2, 3, 4), {}, {}, {}, -4), words(0, 1, 2, 3));
  EXPECT_EQ(result_of("shlqbyi", words(1, 2, 3, 4), {}, {}, {}, 16), Quadword{});
}

TEST(SpuModelBranches, LinkAndWrap) {
  Machine machine;
  machine.pc = 0x3FFFC;
  EXPECT_EQ(execute(machine, encode("brsl", {.rt = 5, .immediate = 2})), StepResult{});
  EXPECT_EQ(machine.pc, 4u);
  EXPECT_EQ(machine.registers[5], words(0, 0, 0, 0)) << "the address behind the last word is 0";
  machine.registers[6] = words(0xFFFFFFFF, 0, 0, 0);
  EXPECT_EQ(execute(machine, encode("bisl", {.rt = 6, .ra = 6})), StepResult{});
  EXPECT_EQ(machine.pc, 0x3FFFCu) << "RA is read before RT is written";
  EXPECT_EQ(machine.registers[6].word(0), 8u);
}

}  // namespace
}  // namespace softcell::spu_model
