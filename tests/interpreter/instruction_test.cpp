// Instructions executed alone: a few of each class, mostly those that are easily got wrong. tests/spu_model compares all of them
// with a model of its own.

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "interpreter/execute.h"
#include "interpreter/instruction_set.h"
#include "interpreter/spu_state.h"
#include "spu_words.h"
#include "support/published_estimates.h"

namespace softcell::ls_sim::interpreter {
namespace {

using Words = std::array<std::uint32_t, 4>;

class Instruction : public testing::Test {
 protected:
  void set(int number, const Words& words) {
    state_.registers[number] = from_words(words[0], words[1], words[2], words[3]);
  }
  Words get(int number) const {
    const Quadword q = state_.registers[number];
    return {word(q, 0), word(q, 1), word(q, 2), word(q, 3)};
  }
  Step run(std::uint32_t instruction) {
    return execute(state_, std::span<std::byte, dma::kLocalStoreBytes>(local_store_), instruction);
  }
  Words result(std::uint32_t instruction) {
    EXPECT_EQ(run(instruction).ending, Ending::kNone);
    return get(3);
  }

  SpuState state_;
  std::vector<std::byte> local_store_ = std::vector<std::byte>(dma::kLocalStoreBytes);
};

TEST_F(Instruction, LoadsAndStoresQuadwordsInTheOrderOfTheSpu) {
  for (int i = 0; i < 16; ++i) local_store_[0x120 + i] = static_cast<std::byte>(i);
  set(4, {0x128, 0, 0, 0});
  EXPECT_EQ(result(ri10(Mnemonic::lqd, 3, 4, 0)), (Words{0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F}));
  set(4, {0x0FFFFFFF, 0, 0, 0});  // the address wraps around
  run(ri10(Mnemonic::stqd, 3, 4, 1));
  EXPECT_EQ(std::memcmp(local_store_.data(), local_store_.data() + 0x120, 16), 0);
}

TEST_F(Instruction, SubtractsTheFirstOperandFromTheSecond) {
  set(4, {1, 2, 0, 0xFFFFFFFF});
  set(5, {3, 1, 0, 0});
  EXPECT_EQ(result(rr(Mnemonic::sf, 3, 4, 5)), (Words{2, 0xFFFFFFFF, 0, 1}));
  EXPECT_EQ(result(rr(Mnemonic::bg, 3, 4, 5)), (Words{1, 0, 1, 0}));
  EXPECT_EQ(result(ri10(Mnemonic::sfi, 3, 4, -1)), (Words{0xFFFFFFFE, 0xFFFFFFFD, 0xFFFFFFFF, 0}));
}

TEST_F(Instruction, CarriesFromTheTargetsLastBit) {
  set(4, {0xFFFFFFFF, 0xFFFFFFFF, 5, 5});
  set(5, {0, 1, 5, 6});
  set(3, {1, 0xFFFFFFFE, 0, 1});
  EXPECT_EQ(result(rr(Mnemonic::cgx, 3, 4, 5)), (Words{1, 1, 0, 0}));
  set(3, {1, 2, 0, 1});
  EXPECT_EQ(result(rr(Mnemonic::addx, 3, 4, 5)), (Words{0, 0, 10, 12}));
  set(3, {0, 1, 0, 1});
  EXPECT_EQ(result(rr(Mnemonic::bgx, 3, 4, 5)), (Words{0, 0, 0, 1}));
}

TEST_F(Instruction, MultipliesHalves) {
  set(4, {0xFFFE0003, 0x8000FFFF, 0, 0});
  set(5, {0x0005FFFF, 0x80007FFF, 0, 0});
  EXPECT_EQ(result(rr(Mnemonic::mpy, 3, 4, 5)), (Words{0xFFFFFFFD, 0xFFFF8001, 0, 0}));
  EXPECT_EQ(result(rr(Mnemonic::mpyu, 3, 4, 5)), (Words{0x0002FFFD, 0x7FFE8001, 0, 0}));
  EXPECT_EQ(result(rr(Mnemonic::mpyhh, 3, 4, 5)), (Words{0xFFFFFFF6, 0x40000000, 0, 0}));
  EXPECT_EQ(result(rr(Mnemonic::mpyh, 3, 4, 5)), (Words{0x00020000, 0x80000000, 0, 0}));
}

TEST_F(Instruction, ShiftsByMaskedCounts) {
  set(4, {0x80000001, 0x80000001, 0x80000001, 0x80000001});
  set(5, {31, 32, 64, 63});
  EXPECT_EQ(result(rr(Mnemonic::shl, 3, 4, 5)), (Words{0x80000000, 0, 0x80000001, 0}));
  set(5, {0xFFFFFFFF, 0xFFFFFFE0, 0xFFFFFFC0, 1});  // -1, -32, -64, -63 in six bits
  EXPECT_EQ(result(rr(Mnemonic::rotm, 3, 4, 5)), (Words{0x40000000, 0, 0x80000001, 0}));
  EXPECT_EQ(result(rr(Mnemonic::rotma, 3, 4, 5)), (Words{0xC0000000, 0xFFFFFFFF, 0x80000001, 0xFFFFFFFF}));
  EXPECT_EQ(result(ri7(Mnemonic::rothmi, 3, 4, -15)),
            (Words{0x00010000, 0x00010000, 0x00010000, 0x00010000}));
  EXPECT_EQ(result(ri7(Mnemonic::rotmahi, 3, 4, -16)),
            (Words{0xFFFF0000, 0xFFFF0000, 0xFFFF0000, 0xFFFF0000}));
}

TEST_F(Instruction, ShiftsTheQuadword) {
  set(4, {0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F});
  EXPECT_EQ(result(ri7(Mnemonic::shlqbyi, 3, 4, 5)), (Words{0x05060708, 0x090A0B0C, 0x0D0E0F00, 0}));
  EXPECT_EQ(result(ri7(Mnemonic::shlqbyi, 3, 4, 16)), (Words{0, 0, 0, 0}));
  EXPECT_EQ(result(ri7(Mnemonic::rotqbyi, 3, 4, -1)),
            (Words{0x0F000102, 0x03040506, 0x0708090A, 0x0B0C0D0E}));
  EXPECT_EQ(result(ri7(Mnemonic::rotqmbyi, 3, 4, -4)), (Words{0, 0x00010203, 0x04050607, 0x08090A0B}));
  EXPECT_EQ(result(ri7(Mnemonic::shlqbii, 3, 4, 4)), (Words{0x00102030, 0x40506070, 0x8090A0B0, 0xC0D0E0F0}));
  EXPECT_EQ(result(ri7(Mnemonic::rotqmbii, 3, 4, -4)),
            (Words{0x00001020, 0x30405060, 0x708090A0, 0xB0C0D0E0}));
  EXPECT_EQ(result(ri7(Mnemonic::rotqbii, 3, 4, 4)), (Words{0x00102030, 0x40506070, 0x8090A0B0, 0xC0D0E0F0}));
}

TEST_F(Instruction, ShufflesBytesAndConstants) {
  set(4, {0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F});
  set(5, {0x10111213, 0x14151617, 0x18191A1B, 0x1C1D1E1F});
  set(6, {0x001F100F, 0x80C0E0FF, 0x607F4321, 0xBFDF9FA0});
  EXPECT_EQ(result(rrr(Mnemonic::shufb, 3, 4, 5, 6)),
            (Words{0x001F100F, 0x00FF8080, 0x001F0301, 0x00FF0000}));
}

TEST_F(Instruction, InsertsThePreferredSlot) {
  set(4, {0x1000A, 0, 0, 0});
  EXPECT_EQ(result(ri7(Mnemonic::chd, 3, 4, 1)), (Words{0x10111213, 0x14151617, 0x18190203, 0x1C1D1E1F}));
  EXPECT_EQ(result(ri7(Mnemonic::cbd, 3, 4, -10)), (Words{0x03111213, 0x14151617, 0x18191A1B, 0x1C1D1E1F}));
  EXPECT_EQ(result(ri7(Mnemonic::cdd, 3, 4, 0)), (Words{0x10111213, 0x14151617, 0x00010203, 0x04050607}));
}

TEST_F(Instruction, FormsMasksAndGathersBitsInTheOrderOfElements) {
  EXPECT_EQ(result(ri16(Mnemonic::fsmbi, 3, 0x8001)), (Words{0xFF000000, 0, 0, 0x000000FF}));
  set(4, {0x9, 0, 0, 0});
  EXPECT_EQ(result(rr(Mnemonic::fsm, 3, 4)), (Words{0xFFFFFFFF, 0, 0, 0xFFFFFFFF}));
  set(4, {1, 0, 3, 2});
  EXPECT_EQ(result(rr(Mnemonic::gb, 3, 4)), (Words{0xA, 0, 0, 0}));
  EXPECT_EQ(result(rr(Mnemonic::gbh, 3, 4)), (Words{0x44, 0, 0, 0}));
  EXPECT_EQ(result(rr(Mnemonic::gbb, 3, 4)), (Words{0x1010, 0, 0, 0}));
}

TEST_F(Instruction, SumsBytesOfBothOperands) {
  set(4, {0x01020304, 0xFFFFFFFF, 0, 0});
  set(5, {0x10203040, 0, 0, 0});
  EXPECT_EQ(result(rr(Mnemonic::sumb, 3, 4, 5)), (Words{0x00A0000A, 0x000003FC, 0, 0}));
}

TEST_F(Instruction, TruncatesSinglePrecisionAndHasNoInfinity) {
  set(4, {0x3F800000, 0x7F7FFFFF, 0x00800000, 0x7FFFFFFF});
  set(5, {0xA1800000, 0x7F7FFFFF, 0x80800001, 0x3F800000});  // the first is -2^-60
  EXPECT_EQ(result(rr(Mnemonic::fa, 3, 4, 5)), (Words{0x3F7FFFFF, 0x7FFFFFFF, 0, 0x7FFFFFFF}));
  set(4, {0x7F800000, 0x00000001, 0x80000000, 0x20000000});
  set(5, {0x3F000000, 0x7F000000, 0x3F800000, 0x1F000000});
  EXPECT_EQ(result(rr(Mnemonic::fm, 3, 4, 5)), (Words{0x7F000000, 0, 0, 0}));
}

TEST_F(Instruction, FusesWithOneRounding) {
  set(4, {0x3F800001, 0x3F800001, 0x7FFFFFFF, 0});
  set(5, {0x3F800001, 0x3F800001, 0x40000000, 0});
  set(6, {0xBF800002, 0x00800000, 0xFFFFFFFF, 0x80000000});
  EXPECT_EQ(result(rrr(Mnemonic::fma, 3, 4, 5, 6)), (Words{0x28800000, 0x3F800002, 0x7FFFFFFF, 0}));
  EXPECT_EQ(result(rrr(Mnemonic::fnms, 3, 4, 5, 6)), (Words{0xC0000002, 0xBF800002, 0xFFFFFFFF, 0}));
}

TEST_F(Instruction, EstimatesAsConsolesDo) {
  for (const test::PublishedEstimate& known : test::kPublishedEstimates) {
    set(4, {known.x, 0, 0, 0});
    EXPECT_EQ(result(rr(Mnemonic::frest, 3, 4))[0], known.reciprocal) << std::hex << known.x;
    EXPECT_EQ(result(rr(Mnemonic::fi, 3, 4, 3))[0], known.interpolated_reciprocal) << std::hex << known.x;
    EXPECT_EQ(result(rr(Mnemonic::frsqest, 3, 4))[0], known.root) << std::hex << known.x;
    EXPECT_EQ(result(rr(Mnemonic::fi, 3, 4, 3))[0], known.interpolated_root) << std::hex << known.x;
  }
}

TEST_F(Instruction, ConvertsWithScales) {
  set(4, {0x80000000, 0x7FFFFFFF, 3, 0xFFFFFFFF});
  EXPECT_EQ(result(ri8(Mnemonic::csflt, 3, 4, 155)), (Words{0xCF000000, 0x4EFFFFFF, 0x40400000, 0xBF800000}));
  EXPECT_EQ(result(ri8(Mnemonic::cuflt, 3, 4, 155 - 32)),
            (Words{0x3F000000, 0x3EFFFFFF, 0x30400000, 0x3F7FFFFF}));
  set(4, {0x4F000000, 0xFF000000, 0x3FC00000, 0xBFC00000});
  EXPECT_EQ(result(ri8(Mnemonic::cflts, 3, 4, 173)), (Words{0x7FFFFFFF, 0x80000000, 1, 0xFFFFFFFF}));
  EXPECT_EQ(result(ri8(Mnemonic::cfltu, 3, 4, 173)), (Words{0x80000000, 0, 1, 0}));
  EXPECT_EQ(result(ri8(Mnemonic::cfltu, 3, 4, 172)), (Words{0xFFFFFFFF, 0, 3, 0}));
}

TEST_F(Instruction, ComparesSingleWithDenormalsAsZero) {
  set(4, {0x00000001, 0x7FFFFFFF, 0x80000000, 0xBF800000});
  set(5, {0x80000000, 0x7F800000, 0x00000000, 0x3F800000});
  EXPECT_EQ(result(rr(Mnemonic::fceq, 3, 4, 5)), (Words{0xFFFFFFFF, 0, 0xFFFFFFFF, 0}));
  EXPECT_EQ(result(rr(Mnemonic::fcgt, 3, 4, 5)), (Words{0, 0xFFFFFFFF, 0, 0}));
  EXPECT_EQ(result(rr(Mnemonic::fcmeq, 3, 4, 5)), (Words{0xFFFFFFFF, 0, 0xFFFFFFFF, 0xFFFFFFFF}));
}

TEST_F(Instruction, RoundsEachDoubleInItsMode) {
  set(4, {0x3FF00000, 0, 0x3FF00000, 0});  // 1.0
  set(5, {0x3C000000, 0, 0x3C000000, 0});  // 2^-63
  set(6, {0x00000900, 0, 0, 0});           // lane 0 up, lane 1 towards zero
  run(rr(Mnemonic::fscrwr, 0, 6));
  EXPECT_EQ(result(rr(Mnemonic::dfa, 3, 4, 5)), (Words{0x3FF00000, 1, 0x3FF00000, 0}));
  EXPECT_EQ(result(rr(Mnemonic::fscrrd, 3, 0)), (Words{0x900, 0x800, 0x800, 0}));  // inexact twice
}

TEST_F(Instruction, HasOneNanAndNoDenormalOperands) {
  set(4, {0x7FF00000, 0, 0x000FFFFF, 0xFFFFFFFF});
  set(5, {0xFFF00000, 0, 0x7FE00000, 0});
  EXPECT_EQ(result(rr(Mnemonic::dfa, 3, 4, 5)), (Words{0x7FF80000, 0, 0x7FE00000, 0}));
  EXPECT_EQ(result(rr(Mnemonic::fscrrd, 3, 0)),
            (Words{0, 0x400, 0x100, 0}));  // invalid, the NaN of IEEE 754; denormal
}

TEST_F(Instruction, ConvertsBetweenSingleAndDouble) {
  set(4, {0x3F800001, 9, 0x7F800000, 9});
  EXPECT_EQ(result(rr(Mnemonic::fesd, 3, 4)), (Words{0x3FF00000, 0x20000000, 0x7FF00000, 0}));
  EXPECT_EQ(result(rr(Mnemonic::frds, 3, 3)), (Words{0x3F800001, 0, 0x7F800000, 0}));
}

TEST_F(Instruction, LeavesComparesOfDoublesToPowerXCell) {
  set(4, {0x3FF00000, 0, 0x7FF80000, 0});
  EXPECT_EQ(run(rr(Mnemonic::dfceq, 3, 4, 4)).ending, Ending::kInvalid);
  state_.has_enhanced_double = true;
  EXPECT_EQ(result(rr(Mnemonic::dfceq, 3, 4, 4)), (Words{0xFFFFFFFF, 0xFFFFFFFF, 0, 0}));
}

TEST_F(Instruction, KeepsFlagsOfSinglePrecision) {
  set(4, {0x7FFFFFFF, 0x00800000, 0x3F800000, 0x00000001});
  run(rr(Mnemonic::fm, 3, 4, 4));
  EXPECT_EQ(result(rr(Mnemonic::fscrrd, 3, 0)),
            (Words{5, 3, 0, 1}));  // overflow, underflow, a denormal operand
  set(4, {0, 0x3F800000, 0, 0x3F800000});
  run(rr(Mnemonic::frest, 3, 4));
  EXPECT_EQ(result(rr(Mnemonic::fscrrd, 3, 0)), (Words{5, 3, 0, 0xA01}));  // divided by zero in words 0 and 2
}

TEST_F(Instruction, LinksBeforeItJumps) {
  state_.pc = 0x3FFFC;
  set(4, {0x12347, 0, 0, 0});
  run(rr(Mnemonic::bisl, 4, 4));
  EXPECT_EQ(state_.pc, 0x12344u);
  EXPECT_EQ(get(4), (Words{0, 0, 0, 0}));  // the next address wraps around
  run(ri16(Mnemonic::brsl, 3, -1));
  EXPECT_EQ(state_.pc, 0x12340u);
  EXPECT_EQ(get(3), (Words{0x12348, 0, 0, 0}));
}

TEST_F(Instruction, TestsHalvesAndWords) {
  set(4, {0xFFFF0000, 0, 0, 0});
  run(ri16(Mnemonic::brhz, 4, 4));
  EXPECT_EQ(state_.pc, 16u);
  run(ri16(Mnemonic::brz, 4, 4));
  EXPECT_EQ(state_.pc, 20u);
}

TEST_F(Instruction, ChangesInterruptsOnlyWhenTheBranchIsTaken) {
  set(4, {0, 0, 0, 0});
  run(rr(Mnemonic::binz, 4, 4, kEnableInterrupts));
  EXPECT_FALSE(state_.interrupts_enabled);
  run(rr(Mnemonic::biz, 4, 4, kEnableInterrupts));
  EXPECT_TRUE(state_.interrupts_enabled);
  state_.srr0 = 0x400;
  run(rr(Mnemonic::iret, 0, 0, kDisableInterrupts));
  EXPECT_FALSE(state_.interrupts_enabled);
  EXPECT_EQ(state_.pc, 0x400u);
}

TEST_F(Instruction, StopsWithTheNextAddress) {
  state_.pc = 0x80;
  const Step step = run(opcode(Mnemonic::stop) | 0x2001);
  EXPECT_EQ(step.ending, Ending::kStop);
  EXPECT_EQ(step.stop_code, 0x2001u);
  EXPECT_EQ(state_.pc, 0x84u);
  EXPECT_EQ(run(rr(Mnemonic::stopd, 0, 0)).stop_code, 0x3FFFu);
}

TEST_F(Instruction, HaltsWhereItIs) {
  state_.pc = 0x80;
  set(4, {5, 0, 0, 0});
  EXPECT_EQ(run(ri10(Mnemonic::hlgti, 0, 4, -1)).ending, Ending::kNone);
  EXPECT_EQ(run(ri10(Mnemonic::hgti, 0, 4, -1)).ending, Ending::kHalt);
  EXPECT_EQ(state_.pc, 0x84u);
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
