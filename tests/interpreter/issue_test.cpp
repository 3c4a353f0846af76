// In which cycle instructions issue: by the published listing of IBM's tutorial, and rule by rule.

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/spu_listing.h"
#include "softcell/ls_sim/timing.h"
#include "spu_words.h"

namespace softcell::ls_sim::interpreter {
namespace {

using enum Mnemonic;

std::vector<ListedInstruction> listed(const KernelImage& image) {
  return list_instructions(image, {image.text_begin}, {image.text_end});
}

/// The inner loop of the particle system in IBM's tutorial (static analysis of SPE threads), from the listing's
/// cycle 47 on. Two dependencies of the listing come from before its first line.
const std::vector<std::uint32_t> kPublishedLoop = {
    rr(a, 49, 8, 10),            // 47 D
    rr(lqx, 51, 6, 9),           // 47 D
    ri18(ila, 47, 66051),        // 48 D
    rr(lqx, 52, 6, 11),          // 48 D
    ri10(ai, 7, 7, -1),          // 49
    rrr(fma, 50, 51, 12, 52),    // 54
    rr(stqx, 50, 6, 11),         // 60
    rr(lqx, 48, 8, 10),          // 61
    ri10(ai, 8, 8, 4),           // 62 D
    ri16(lqa, 44, 0x100),        // 62 D
    rr(lqx, 43, 6, 9),           // 63
    rr(rotqby, 46, 48, 49),      // 67
    rrr(shufb, 45, 46, 46, 47),  // 71
    rr(fm, 42, 12, 45),          // 75
    rrr(fma, 41, 42, 44, 43),    // 81 d
    rr(stqx, 41, 6, 9),          // 87 d
    ri10(ai, 6, 6, 16),          // 88 D
    ri16(brnz, 7, -16),          // 88 D
};

TEST(StaticSchedule, IsThatOfThePublishedListing) {
  const std::vector<ListedInstruction> loop = listed(program_of(kPublishedLoop));
  const std::vector<std::uint64_t> cycles = {47, 47, 48, 48, 49, 54, 60, 61, 62,
                                             62, 63, 67, 71, 75, 81, 87, 88, 88};
  const std::string dual = "DDDD    DD    ddDD";
  ASSERT_EQ(loop.size(), cycles.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    EXPECT_EQ(loop[i].issue.cycle + 47, cycles[i]) << loop[i].mnemonic << " " << loop[i].operands;
    const char mark = loop[i].issue.dual == DualIssue::kYes         ? 'D'
                      : loop[i].issue.dual == DualIssue::kPrevented ? 'd'
                                                                    : ' ';
    EXPECT_EQ(mark, dual[i]) << i;
  }
}

/// Columns, digits and dashes of the same listing.
TEST(StaticSchedule, HasTheLayoutOfThePublishedListing) {
  std::vector<ListedInstruction> loop = listed(program_of(kPublishedLoop));
  for (ListedInstruction& line : loop) {
    line.issue.cycle += 47;
    line.issue.waited_from += 47;
  }
  const auto line = [&](std::size_t i) {
    std::string text = timing_line(loop[i]);
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  };
  EXPECT_EQ(line(0), "0D " + std::string(47, ' ') + "78");
  EXPECT_EQ(line(1), "1D 012" + std::string(44, ' ') + "789");
  EXPECT_EQ(line(4), "0  0" + std::string(48, ' ') + "9");
  EXPECT_EQ(line(5), "0  ----456789");
  EXPECT_EQ(line(6), "1       -----012345");
  EXPECT_EQ(line(11), "1                ---7890");
  EXPECT_EQ(line(14), "0d                           -----123456");
  EXPECT_EQ(line(15), "1d                                ------789012");
}

/// Its branch goes on.
std::vector<std::uint32_t> one_round() {
  std::vector<std::uint32_t> words = kPublishedLoop;
  words.back() = ri16(brz, 7, -16);
  return words;
}

TEST(TimingParameters, AreThoseOfTheReferencePage) {
  std::ifstream file(SOFTCELL_TIMING_PAGE);
  ASSERT_TRUE(file.is_open());
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  std::size_t rows = 0;
  for (std::size_t at = page.find("\n| `"); at != std::string::npos; at = page.find("\n| `", at + 1)) ++rows;
  EXPECT_EQ(rows, timing_parameters().size());
  for (const TimingParameterInfo& info : timing_parameters()) {
    std::string row = "| `" + std::string(info.name) + "` | " + std::to_string(info.value);
    for (const std::string_view cell : {info.unit, info.confidence, info.source, info.meaning})
      row += " | " + std::string(cell);
    EXPECT_NE(page.find(row + " |\n"), std::string::npos) << row;
    EXPECT_TRUE(info.confidence == "documented" || info.confidence == "second-hand" ||
                info.confidence == "assumed");
  }
}

/// A program on one SPE, timed.
class Timed : public testing::Test {
 protected:
  /// Cycles between the issue of the first instruction and that of the instruction at `index`.
  void run(std::vector<std::uint32_t> words, const EntryArguments& arguments = {}) {
    words.push_back(stop_with(0x2000));
    image_ = program_of(words);
    run_image(arguments);
  }
  void run_image(const EntryArguments& arguments) {
    timing_ = std::make_unique<Timing>(1, parameters_);
    dma::AddressSpace memory;
    SpeGroup group(memory, {.spes = 1,
                            .clock = Clock::kSimulated,
                            .interleaving = Interleaving::kByTime,
                            .timing = timing_.get()});
    group.start(0, image_, arguments);
    const RunResult result = group.wait(0);
    EXPECT_TRUE(result.ended_normally()) << (result.fault ? result.fault->message() : "");
    EXPECT_EQ(timing_->total(0).instructions, group.statistics(0).instructions);
  }
  /// The cycles that the instruction at `index` of the words took.
  CycleCounts at(std::uint32_t index) const { return timing_->at(0, {image_.begin + 4 * index}); }
  std::uint64_t stalled(std::uint32_t index, Stall why) const { return at(index).stalled(why); }

  TimingParameters parameters_;
  KernelImage image_;
  std::unique_ptr<Timing> timing_;
};

TEST_F(Timed, EachCycleBelongsToOneInstructionOrStall) {
  run(one_round());
  const CycleCounts total = timing_->total(0);
  EXPECT_EQ(total.cycles, timing_->now(0));
  EXPECT_EQ(total.cycles, total.instructions - total.pairs + total.stalled());
}

TEST_F(Timed, PairsIssueTogetherByPipeAndPlace) {
  run({ri10(ai, 10, 3, 1), ri10(lqd, 11, 3, 0),   // even, odd: together
       ri10(lqd, 12, 3, 0), ri10(ai, 13, 3, 1),   // odd, even: not
       ri10(ai, 14, 3, 1), ri10(ai, 15, 3, 1)});  // twice the same pipe: not
  EXPECT_EQ(at(0).pairs, 1u);
  EXPECT_EQ(at(1).cycles, 0u);
  EXPECT_EQ(at(2).pairs + at(3).pairs + at(4).pairs, 0u);
  EXPECT_EQ(at(3).cycles, 1u);
  EXPECT_EQ(at(5).cycles, 1u);
}

TEST_F(Timed, AnOddPipeInstructionDoesNotPairWithItsOwnOperand) {
  run({ri10(ai, 10, 3, 1), ri10(lqd, 11, 10, 0)});
  EXPECT_EQ(at(0).pairs, 0u);
  EXPECT_EQ(stalled(1, Stall::kDependency), 1u);  // the sum can be used after two cycles
}

TEST_F(Timed, ResultsComeAfterTheLatencyOfTheirClass) {
  const auto latency_of = [&](std::uint32_t producer) {
    run({producer, opcode(nop), rr(and_, 20, 10, 10)});
    return 2 + stalled(2, Stall::kDependency);
  };
  EXPECT_EQ(latency_of(rr(a, 10, 3, 3)), 2u);
  EXPECT_EQ(latency_of(ri7(shli, 10, 3, 3)), 4u);
  EXPECT_EQ(latency_of(rr(cntb, 10, 3)), 4u);
  EXPECT_EQ(latency_of(rr(fm, 10, 3, 3)), 6u);
  EXPECT_EQ(latency_of(rr(mpy, 10, 3, 3)), 7u);
  EXPECT_EQ(latency_of(rr(fi, 10, 3, 3)), 7u);
  EXPECT_EQ(latency_of(rr(shlqby, 10, 3, 3)), 4u);
  EXPECT_EQ(latency_of(ri10(lqd, 10, 3, 0)), 6u);
  EXPECT_EQ(latency_of(rr(mfspr, 10, 3)), 6u);
}

TEST_F(Timed, StoresAndChannelWritesReadTheirTarget) {
  run({rr(fm, 10, 3, 3), opcode(lnop), ri10(stqd, 10, 4, 0)});
  EXPECT_EQ(stalled(2, Stall::kDependency), 5u);
}

TEST_F(Timed, DoublePrecisionLetsNothingIssue) {
  run({rr(dfa, 10, 3, 3), opcode(lnop), rr(and_, 11, 10, 10)});
  EXPECT_EQ(at(0).pairs, 0u);
  EXPECT_EQ(stalled(1, Stall::kDoublePrecision), 6u);
  EXPECT_EQ(stalled(2, Stall::kDependency), 5u);  // 13 after the issue
}

TEST_F(Timed, SinglePrecisionWaitsForTheFloatUnitBehindAMultiply) {
  run({rr(mpy, 10, 3, 3), rr(fm, 11, 4, 4), rr(fm, 12, 4, 4), rr(mpy, 13, 3, 3)});
  EXPECT_EQ(stalled(1, Stall::kFloatUnit), 1u);
  EXPECT_EQ(stalled(2, Stall::kFloatUnit), 0u);
  EXPECT_EQ(stalled(3, Stall::kFloatUnit), 0u);
}

TEST_F(Timed, TakenBranchesMissUnlessTheyAreHinted) {
  // 0x80: to 0x90, an even word, and from 0x98 to 0xA4, an odd one.
  run({ri16(br, 0, 4), opcode(nop), opcode(nop), opcode(nop),  //
       opcode(nop), opcode(nop), ri16(br, 0, 3), opcode(nop),  //
       opcode(nop), opcode(nop)});
  EXPECT_EQ(stalled(4, Stall::kBranchMiss), 18u);
  EXPECT_EQ(stalled(9, Stall::kBranchMiss), 19u);
  EXPECT_EQ(timing_->pipeline(0).branch_misses, 2u);
  EXPECT_EQ(timing_->pipeline(0).branches_taken, 2u);
}

std::uint32_t hint_to(std::int32_t branch, std::int32_t target) {
  return opcode(hbrr) | (static_cast<std::uint32_t>(branch >> 7 & 3) << 23) |
         (static_cast<std::uint32_t>(target) & 0xFFFF) << 7 | (static_cast<std::uint32_t>(branch) & 0x7F);
}

/// A hint, `between` nops, a branch over two words, and what it goes to.
std::vector<std::uint32_t> hinted_branch(std::uint32_t between) {
  std::vector<std::uint32_t> words{
      hint_to(static_cast<std::int32_t>(between) + 1, static_cast<std::int32_t>(between) + 4)};
  words.insert(words.end(), between, opcode(nop));
  words.insert(words.end(), {ri16(br, 0, 3), opcode(nop), opcode(nop), opcode(nop)});
  return words;
}

TEST_F(Timed, AHintSavesTheMissIfItComesInTime) {
  run(hinted_branch(20));
  EXPECT_EQ(at(24).stalled(), 0u);
  EXPECT_EQ(timing_->pipeline(0).hints_used, 1u);
  run(hinted_branch(9));  // ten cycles ahead; 15 were needed
  EXPECT_EQ(stalled(13, Stall::kHintTarget), 5u);
  EXPECT_EQ(stalled(13, Stall::kBranchMiss), 0u);
  run(hinted_branch(5));  // too close: not used
  EXPECT_EQ(stalled(9, Stall::kBranchMiss), 19u);
  EXPECT_EQ(timing_->pipeline(0).hints_used, 0u);
}

TEST_F(Timed, AHintForABranchThatIsNotTakenCostsAMiss) {
  std::vector<std::uint32_t> words{hint_to(21, 30)};
  words.insert(words.end(), 20, opcode(nop));
  words.insert(words.end(), {ri16(brnz, 9, 9), opcode(nop)});  // $9 is zero
  run(words);
  EXPECT_EQ(stalled(22, Stall::kBranchMiss), 18u);
  EXPECT_EQ(timing_->pipeline(0).branches_taken, 0u);
}

TEST_F(Timed, LoadsInEachCycleStarveTheFetch) {
  std::vector<std::uint32_t> words;
  for (int i = 0; i < 96; ++i) words.push_back(i % 2 == 0 ? ri10(ai, 10, 3, 1) : ri10(lqd, 11, 3, 0));
  run(words);  // three lines, two instructions in each cycle
  EXPECT_GT(timing_->total(0).stalled(Stall::kFetch), 10u);
  words[1] = words[33] = words[65] = opcode(lnop);  // a cycle without load at the beginning of each line
  run(words);
  EXPECT_EQ(timing_->total(0).stalled(Stall::kFetch), 0u);
}

TEST_F(Timed, SyncFetchesAgain) {
  run({opcode(Mnemonic::sync), opcode(nop)});
  EXPECT_EQ(stalled(1, Stall::kSync), 18u);
}

TEST_F(Timed, IsTheSameInEveryRunAndByParameters) {
  run(one_round());
  const std::uint64_t cycles = timing_->total(0).cycles;
  run(one_round());
  EXPECT_EQ(timing_->total(0).cycles, cycles);
  parameters_.latency_fp6 += 10;
  run(one_round());
  EXPECT_EQ(timing_->total(0).cycles, cycles + 30);  // three in a chain
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
