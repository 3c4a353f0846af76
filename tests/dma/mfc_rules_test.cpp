// Each rule by a command that breaks it and no other, beside the nearest legal one.
#include "softcell/dma/mfc_rules.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <string_view>

namespace softcell::dma {
namespace {

constexpr EffectiveAddress kEa = kMainMemoryBase;

MfcCommand get(std::uint32_t lsa, EffectiveAddress ea, std::uint32_t size, std::uint32_t tag = 0) {
  return {static_cast<std::uint32_t>(MfcOpcode::get), {lsa}, ea, size, tag};
}

MfcCommand of(MfcOpcode opcode, std::uint32_t lsa, EffectiveAddress ea, std::uint32_t size,
              std::uint32_t tag = 0) {
  return {static_cast<std::uint32_t>(opcode), {lsa}, ea, size, tag};
}

/// A list at local-store address `list`.
MfcCommand getl(std::uint32_t lsa, std::uint64_t list, std::uint32_t size, std::uint32_t tag = 0) {
  return of(MfcOpcode::getl, lsa, {kEa.value >> 32 << 32 | list}, size, tag);
}

constexpr EffectiveAddress kSignal1 = kLocalStoresBase + 0x5400C;
constexpr EffectiveAddress kSignal2 = kLocalStoresBase + 2 * kLocalStoreStrideBytes + 0x5C00C;

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
    {"StartForm", get(0, kEa, 16), of(MfcOpcode::gets, 0, kEa, 16), Rule::kProxyFormOnly, "no start form"},
    {"StartFormOfAPut", of(MfcOpcode::putf, 0, kEa, 16), of(MfcOpcode::putfs, 0, kEa, 16),
     Rule::kProxyFormOnly, "no start form"},
    {"ListTag", getl(0, 0x1000, 8, 31), getl(0, 0x1000, 8, 32), Rule::kTagOutOfRange,
     "tag 32 is not in 0..31"},
    {"ListAddress", getl(0, 0x1008, 8), getl(0, 0x1004, 8), Rule::kListAddress,
     "the list's address 0x01004 is 4 bytes past a multiple of 8"},
    {"ListAtTheEndOfLocalStore", getl(0, 0x3FFF0, 16), getl(0, 0x3FFF0, 24), Rule::kListAddress,
     "the list's bytes 0x3FFF0..0x40007 reach past"},
    {"ListPastTheLocalStore", getl(0, 0x3FFF8, 8), getl(0, 0x40000, 8), Rule::kListAddress,
     "the list's bytes 0x40000..0x40007 reach past"},
    {"ListThatIsAnEffectiveAddress", getl(0, 0, 8), getl(0, kEa.value & 0xFFFFFFFF, 8), Rule::kListAddress,
     "the list's bytes 0x10000000..0x10000007 reach past"},
    {"EmptyList", getl(0, 0x1000, 8), getl(0, 0x1000, 0), Rule::kListSize, "a list of 0 bytes"},
    {"ListOfHalfAnElement", getl(0, 0x1000, 16), getl(0, 0x1000, 12), Rule::kListSize, "a list of 12 bytes"},
    {"ListOf2049Elements", getl(0, 0x1000, 2048 * 8), getl(0, 0x1000, 2049 * 8), Rule::kListSize,
     "a list of 16392 bytes"},
    {"ListLsa", getl(0x3FFFF, 0x1000, 8), getl(0x40000, 0x1000, 8), Rule::kLsaOutOfRange,
     "LSA 0x40000 lies past"},
    {"LsaOfGetllar", of(MfcOpcode::getllar, 128, kEa, 128), of(MfcOpcode::getllar, 64, kEa, 128),
     Rule::kAtomicAlignment, "LSA is 64 bytes past a multiple of 128"},
    {"EaOfPutllc", of(MfcOpcode::putllc, 128, kEa + 128, 128), of(MfcOpcode::putllc, 128, kEa + 112, 128),
     Rule::kAtomicAlignment, "EA is 112 bytes past a multiple of 128"},
    {"EaOfPutlluc", of(MfcOpcode::putlluc, 128, kEa, 128), of(MfcOpcode::putlluc, 128, kEa + 1, 128),
     Rule::kAtomicAlignment, "EA is 1 byte past a multiple of 128"},
    {"LsaOfPutqlluc", of(MfcOpcode::putqlluc, 128, kEa, 128, 31), of(MfcOpcode::putqlluc, 132, kEa, 128, 31),
     Rule::kAtomicAlignment, "LSA is 4 bytes past a multiple of 128"},
    {"TagOfPutqlluc", of(MfcOpcode::putqlluc, 128, kEa, 128, 31), of(MfcOpcode::putqlluc, 128, kEa, 128, 32),
     Rule::kTagOutOfRange, "tag 32 is not in 0..31"},
    {"LastLineOfLocalStore", of(MfcOpcode::getllar, 0x3FF80, kEa, 128),
     of(MfcOpcode::getllar, 0x40000, kEa, 128), Rule::kLsaOutOfRange, "0x40000..0x4007F"},
    {"SignalOfEightBytes", of(MfcOpcode::sndsig, 12, kSignal1, 4), of(MfcOpcode::sndsig, 12, kSignal1, 8),
     Rule::kSignalCommand, "8 bytes; a signal has 4"},
    {"SignalToMemory", of(MfcOpcode::sndsigf, 12, kSignal2, 4), of(MfcOpcode::sndsigf, 12, kEa + 12, 4),
     Rule::kSignalCommand, "EA is not a Sig_Notify register of an SPE; they lie 0x5400C and 0x5C00C past"},
    {"SignalToAMailbox", of(MfcOpcode::sndsigb, 12, kSignal2, 4),
     of(MfcOpcode::sndsigb, 12, kLocalStoresBase + 0x4400C, 4), Rule::kSignalCommand,
     "not a Sig_Notify register"},
    {"LowBitsOfASignal", of(MfcOpcode::sndsig, 28, kSignal1, 4), of(MfcOpcode::sndsig, 16, kSignal1, 4),
     Rule::kLowBitsDiffer, "0x0 in LSA and 0xC in EA; a signal's must be equal"},
    {"LsaOfASignal", of(MfcOpcode::sndsig, 28, kSignal1, 4), of(MfcOpcode::sndsig, 30, kSignal1, 4),
     Rule::kLsaAlignment, "LSA is 2 bytes past a multiple of 4"},
    {"EndOfLocalStoreOfASignal", of(MfcOpcode::sndsig, 0x3FFFC, kSignal1, 4),
     of(MfcOpcode::sndsig, 0x4000C, kSignal1, 4), Rule::kLsaOutOfRange, "0x4000C..0x4000F"},
    {"TagOfABarrier", of(MfcOpcode::barrier, 0, {}, 0, 31), of(MfcOpcode::barrier, 0, {}, 0, 32),
     Rule::kTagOutOfRange, "tag 32 is not in 0..31"},
    {"TagOfMfcsync", of(MfcOpcode::mfcsync, 0, {}, 0, 31), of(MfcOpcode::mfcsync, 0, {}, 0, 0xFFFFFFFF),
     Rule::kTagOutOfRange, "tag 4294967295 is not in 0..31"},
    {"SizeOfACacheHint", of(MfcOpcode::sdcrt, 0, kEa, 1), of(MfcOpcode::sdcrt, 0, kEa, 0), Rule::kSizeZero,
     "0 bytes"},
    {"LargestCacheHint", of(MfcOpcode::sdcrz, 0, kEa + 3, 16384), of(MfcOpcode::sdcrz, 0, kEa, 16385),
     Rule::kSizeNotLegal, "16385 bytes are more than the 16384"},
    {"TagOfACacheHint", of(MfcOpcode::sdcrf, 0, kEa, 3, 31), of(MfcOpcode::sdcrf, 0, kEa, 3, 32),
     Rule::kTagOutOfRange, "tag 32 is not in 0..31"},
};

class MfcRule : public testing::TestWithParam<RuleCase> {};

TEST_P(MfcRule, RefusesTheBrokenCommandAndTakesItsLegalTwin) {
  const RuleCase& c = GetParam();
  const std::optional<Fault> none = check_command(c.legal);
  EXPECT_FALSE(none) << none->message();

  const std::optional<Fault> fault = check_command(c.broken);
  const std::string expected =
      "expected: " + Fault{.rule = c.rule, .command = c.broken, .detail = c.detail}.message();
  if (!fault) FAIL() << "a broken command was taken for a legal one\n" << expected;
  EXPECT_EQ(name(fault->rule), name(c.rule)) << expected;
  EXPECT_EQ(fault->command, c.broken) << expected;
  EXPECT_NE(fault->detail.find(c.detail), std::string::npos) << fault->detail << "\n" << expected;
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

// Each has parameters that it does not look at, with anything in them.
TEST(MfcRules, LookOnlyAtTheParametersThatACommandHas) {
  constexpr std::uint32_t kAny = 0xDEADBEEF;
  const MfcCommand unaffected[] = {
      of(MfcOpcode::barrier, kAny, {kAny}, kAny, 0),
      of(MfcOpcode::mfceieio, kAny, {kAny}, kAny, 0),
      of(MfcOpcode::mfcsync, kAny, {kAny}, kAny, 0),
      of(MfcOpcode::sdcrst, kAny, {kAny}, 16, 0),
      of(MfcOpcode::getllar, 128, kEa, kAny, kAny),
      of(MfcOpcode::putllc, 128, kEa, kAny, kAny),
      of(MfcOpcode::putlluc, 128, kEa, kAny, kAny),
      of(MfcOpcode::putqlluc, 128, kEa, kAny, 0),
      {0x12340000u | static_cast<std::uint32_t>(MfcOpcode::get), {0}, kEa, 16, 0},
  };
  for (const MfcCommand& command : unaffected) {
    const std::optional<Fault> fault = check_command(command);
    EXPECT_FALSE(fault) << fault->message();
  }
}

TEST(MfcRules, RefuseEveryStartFormByName) {
  int refused = 0;
  for (std::uint32_t opcode = 0; opcode < 0x100; ++opcode) {
    const std::string_view known = name(static_cast<MfcOpcode>(opcode));
    const std::optional<Fault> fault = check_command({opcode, {128}, kEa, 16, 0});
    if (!fault || fault->rule != Rule::kProxyFormOnly) continue;
    ++refused;
    EXPECT_NE(fault->message().find(": proxy-form-only: " + std::string(known) + " tag 0"), std::string::npos)
        << fault->message();
  }
  EXPECT_EQ(refused, 6) << "gets, getfs, getbs, puts, putfs, putbs";
}

// What a message says of a command is what the command has.
TEST(MfcRules, MessagesNameTheCommandWithItsParameters) {
  const auto message = [](const MfcCommand& command) { return check_command(command)->message(); };
  const std::string who = "SPE unknown, kernel unknown: ";
  EXPECT_EQ(message(getl(0x400, 0x1004, 8, 3)),
            who +
                "list-address: getl tag 3, LSA 0x00400, MFC_EAH 0x00005EA0, list 0x01004, 8 bytes of list: "
                "the list's address 0x01004 is 4 bytes past a multiple of 8");
  EXPECT_EQ(message(of(MfcOpcode::getllar, 64, kEa, 0)),
            who +
                "atomic-alignment: getllar, LSA 0x00040, EA 0x5EA010000000: LSA is 64 bytes past a multiple "
                "of 128; a whole line is moved");
  EXPECT_EQ(message(of(MfcOpcode::putqlluc, 64, kEa, 0, 2)),
            who +
                "atomic-alignment: putqlluc tag 2, LSA 0x00040, EA 0x5EA010000000: LSA is 64 bytes past a "
                "multiple of 128; a whole line is moved");
  EXPECT_EQ(message(of(MfcOpcode::mfcsync, 0, {}, 0, 40)),
            who + "tag-out-of-range: mfcsync tag 40: tag 40 is not in 0..31");
  EXPECT_EQ(message(of(MfcOpcode::sdcrz, 0, kEa, 0, 2)),
            who + "size-zero: sdcrz tag 2, EA 0x5EA010000000, 0 bytes: 0 bytes; leave the command out");
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
