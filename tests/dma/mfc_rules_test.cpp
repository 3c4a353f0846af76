// Each rule by a command that breaks it and no other, beside the nearest legal one.
#include "softcell/dma/mfc_rules.h"

#include <gtest/gtest.h>

#include <string>

namespace softcell::dma {
namespace {

constexpr EffectiveAddress kEa = kMainMemoryBase;

MfcCommand get(std::uint32_t lsa, EffectiveAddress ea, std::uint32_t size, std::uint32_t tag = 0) {
  return {static_cast<std::uint32_t>(MfcOpcode::get), {lsa}, ea, size, tag};
}

struct RuleCase {
  const char* name;
  MfcCommand legal;
  MfcCommand broken;
  Rule rule;
  const char* detail;  // a part of it
};

void PrintTo(const RuleCase& c, std::ostream* out) { *out << c.name; }

const RuleCase kCases[] = {
    {"LargestSize", get(0, kEa, 16384), get(0, kEa, 16400), Rule::kSizeNotLegal,
     "16400 bytes are more than the 16384"},
    {"SizeZero", get(0, kEa, 1), get(0, kEa, 0), Rule::kSizeZero, "0 bytes"},
    {"SizeThree", get(0, kEa, 2), get(0, kEa, 3), Rule::kSizeNotLegal, "3 bytes is neither 1, 2, 4, 8"},
    {"SizeTwelve", get(0, kEa, 8), get(0, kEa, 12), Rule::kSizeNotLegal, "12 bytes"},
    {"SizeTwenty", get(0, kEa, 16), get(0, kEa, 20), Rule::kSizeNotLegal, "20 bytes"},
    {"SizeTwentyFour", get(0, kEa, 32), get(0, kEa, 24), Rule::kSizeNotLegal, "24 bytes"},
    {"SizeOfSixteenBitRegisterOnly", get(0, kEa, 16384), get(0, kEa, 0x10010), Rule::kSizeNotLegal,
     "65552 bytes"},
    {"LsaOfTwoBytes", get(14, kEa + 14, 2), get(13, kEa + 14, 2), Rule::kLsaAlignment,
     "LSA is 1 byte past a multiple of 2"},
    {"EaOfTwoBytes", get(14, kEa + 14, 2), get(14, kEa + 15, 2), Rule::kEaAlignment,
     "EA is 1 byte past a multiple of 2"},
    {"LsaOfFourBytes", get(8, kEa + 8, 4), get(10, kEa + 8, 4), Rule::kLsaAlignment,
     "LSA is 2 bytes past a multiple of 4"},
    {"EaOfFourBytes", get(8, kEa + 8, 4), get(8, kEa + 11, 4), Rule::kEaAlignment,
     "EA is 3 bytes past a multiple of 4"},
    {"LsaOfEightBytes", get(8, kEa + 8, 8), get(12, kEa + 8, 8), Rule::kLsaAlignment,
     "LSA is 4 bytes past a multiple of 8"},
    {"EaOfEightBytes", get(8, kEa + 8, 8), get(8, kEa + 12, 8), Rule::kEaAlignment,
     "EA is 4 bytes past a multiple of 8"},
    {"LsaOfSixteenBytes", get(16, kEa, 16), get(8, kEa, 16), Rule::kLsaAlignment,
     "LSA is 8 bytes past a multiple of 16"},
    {"EaOfSixteenBytes", get(0, kEa + 16, 16), get(0, kEa + 8, 16), Rule::kEaAlignment,
     "EA is 8 bytes past a multiple of 16"},
    {"EaOfALongTransfer", get(0, kEa + 48, 4096), get(0, kEa + 49, 4096), Rule::kEaAlignment,
     "EA is 1 byte past"},
    {"LowBitsOfOneByte", get(7, kEa + 23, 1), get(7, kEa + 24, 1), Rule::kLowBitsDiffer,
     "0x7 in LSA and 0x8 in EA"},
    {"LowBitsOfFourBytes", get(4, kEa + 20, 4), get(4, kEa + 8, 4), Rule::kLowBitsDiffer,
     "0x4 in LSA and 0x8 in EA"},
    {"LowBitsOfEightBytes", get(8, kEa + 8, 8), get(8, kEa, 8), Rule::kLowBitsDiffer,
     "0x8 in LSA and 0x0 in EA"},
    {"Tag", get(0, kEa, 16, 31), get(0, kEa, 16, 32), Rule::kTagOutOfRange, "tag 32 is not in 0..31"},
    {"EndOfLocalStore", get(0x3C000, kEa, 16384), get(0x3C010, kEa, 16384), Rule::kLsaOutOfRange,
     "0x3C010..0x4000F"},
    {"LastByteOfLocalStore", get(0x3FFFF, kEa + 15, 1), get(0x40000, kEa, 1), Rule::kLsaOutOfRange,
     "0x40000..0x40000"},
    {"LsaThatWouldWrap", get(0, kEa, 16), get(0xFFFFFFF0, kEa, 16), Rule::kLsaOutOfRange,
     "0xFFFFFFF0..0xFFFFFFFF"},
};

class MfcRule : public testing::TestWithParam<RuleCase> {};

TEST_P(MfcRule, RefusesTheBrokenCommandAndTakesItsLegalTwin) {
  const RuleCase& c = GetParam();
  const std::optional<Fault> none = check_command(c.legal);
  EXPECT_FALSE(none) << none->message();

  const std::optional<Fault> fault = check_command(c.broken);
  ASSERT_TRUE(fault);
  EXPECT_EQ(name(fault->rule), name(c.rule));
  EXPECT_EQ(fault->command, c.broken);
  EXPECT_NE(fault->detail.find(c.detail), std::string::npos) << fault->detail;
}

INSTANTIATE_TEST_SUITE_P(Cases, MfcRule, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

// The definition, written out: every size and every pair of low address bits.
TEST(MfcRules, AgreeWithTheirDefinitionForEverySizeAndPlaceInTheQuadword) {
  for (std::uint32_t size = 0; size <= 16384 + 64; size = size < 70 ? size + 1 : size + 13) {
    for (std::uint32_t low_lsa = 0; low_lsa < 16; ++low_lsa) {
      for (std::uint32_t low_ea = 0; low_ea < 16; ++low_ea) {
        const bool small = size == 1 || size == 2 || size == 4 || size == 8;
        const bool large = size >= 16 && size <= 16384 && size % 16 == 0;
        const bool legal =
            (small && low_lsa == low_ea && low_lsa % size == 0) || (large && low_lsa == 0 && low_ea == 0);
        ASSERT_EQ(!check_command(get(64 + low_lsa, kEa + low_ea, size)), legal)
            << "size " << size << ", low bits " << low_lsa << " and " << low_ea;
      }
    }
  }
}

TEST(MfcRules, TakeGetPutAndPutrInAllOrders) {
  for (const std::uint32_t opcode :
       {0x20u, 0x21u, 0x22u, 0x30u, 0x31u, 0x32u, 0x40u, 0x41u, 0x42u, 0x12340040u}) {
    const std::optional<Fault> fault = check_command({opcode, {0}, kEa, 16, 0});
    EXPECT_FALSE(fault) << fault->message();
  }
}

TEST(MfcRules, RefuseUnknownOpcodes) {
  for (const std::uint32_t word : {0x00u, 0x23u, 0x43u, 0xFFu, 0x140u, 0x4000u}) {
    const std::optional<Fault> fault = check_command({word, {0}, kEa, 16, 0});
    ASSERT_TRUE(fault) << std::hex << word;
    EXPECT_EQ(fault->rule, Rule::kUnknownCommand) << std::hex << word;
  }
}

}  // namespace
}  // namespace softcell::dma
