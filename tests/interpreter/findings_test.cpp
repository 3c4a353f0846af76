// What --checked finds in programs built for the SPU.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/spe_group.h"
#include "spu_words.h"

namespace softcell::ls_sim::interpreter {
namespace {

using enum Mnemonic;

struct Checked {
  RunResult result;
  std::vector<Finding> findings;

  int count(dma::Rule rule) const {
    return static_cast<int>(
        std::ranges::count(findings, rule, [](const Finding& each) { return each.fault.rule; }));
  }
};

Checked run_checked(const std::vector<std::uint32_t>& words, const EntryArguments& arguments,
                    dma::AddressSpace& memory) {
  KernelImage image = program_of(words);
  image.checked = true;
  image.functions.push_back({"main", {0x80}, 0});
  Findings findings;
  Checked checked;
  {
    SpeGroup group(memory, {.spes = 1, .findings = &findings});
    group.start(0, image, arguments);
    checked.result = group.wait(0);
  }
  checked.findings = findings.list();
  return checked;
}

Checked run_checked(const std::vector<std::uint32_t>& words) {
  dma::AddressSpace memory;
  return run_checked(words, {}, memory);
}

TEST(SpuFindings, AnAddressFromARegisterThatIsNotSet) {
  const Checked checked =
      run_checked({ri10(lqd, 3, 50, 0), ri16(il, 51, 64), ri10(lqd, 3, 51, 0), stop_with(0x2000)});
  EXPECT_TRUE(checked.result.ended_normally());
  ASSERT_EQ(checked.count(dma::Rule::kUninitialisedAddress), 1);
  const auto found = std::ranges::find(checked.findings, dma::Rule::kUninitialisedAddress,
                                       [](const Finding& each) { return each.fault.rule; });
  EXPECT_EQ(found->fault.place, "main");
  EXPECT_NE(found->fault.detail.find("$50"), std::string::npos) << found->fault.detail;
}

TEST(SpuFindings, AJumpOutsideOfTheCode) {
  const Checked checked = run_checked({ri18(ila, 3, 0x2000), rr(bi, 0, 3)});
  EXPECT_EQ(checked.count(dma::Rule::kJumpOutsideCode), 1);
  ASSERT_TRUE(checked.result.fault.has_value());
  EXPECT_EQ(checked.result.fault->rule, dma::Rule::kIllegalInstruction);
}

TEST(SpuFindings, CodeThatTheProgramHasWrittenItselfIsNoJumpOutside) {
  // Stores a quadword with `stop 0x2004` at 0x2000, syncs and goes there.
  const Checked checked = run_checked({ri16(lqa, 3, 0xA0 / 4), ri16(stqa, 3, 0x2000 / 4), opcode(sync),
                                       ri18(ila, 4, 0x2000), rr(bi, 0, 4), 0x40200000, 0x40200000, 0x40200000,
                                       stop_with(0x2004), 0x40200000, 0x40200000, 0x40200000});
  EXPECT_EQ(checked.result.stop_code, 0x2004u);
  EXPECT_TRUE(checked.findings.empty()) << checked.findings.front().fault.message();
}

TEST(SpuFindings, CodeThatIsExecutedWithoutASync) {
  EXPECT_EQ(run_checked(overwrites_its_code(0x40200000)).count(dma::Rule::kCodeWithoutSync), 1);
  EXPECT_EQ(run_checked(overwrites_its_code(opcode(sync))).count(dma::Rule::kCodeWithoutSync), 0);
}

TEST(SpuFindings, AStackThatGrowsIntoTheProgram) {
  const Checked checked = run_checked({ri18(ila, 1, 0x60), 0x40200000, 0x40200000, stop_with(0x2000)});
  ASSERT_EQ(checked.count(dma::Rule::kStackOverflow), 1);
  EXPECT_EQ(checked.findings.front().count, 1u);
}

/// Gets 128 bytes from argp to 0x1000, waits perhaps, and loads them.
std::vector<std::uint32_t> fetching(bool waits) {
  std::vector<std::uint32_t> words = {ri18(ila, 10, 0x1000),  rr(wrch, 10, 16), rr(wrch, 4, 17),
                                      ri7(rotqbyi, 11, 4, 4), rr(wrch, 11, 18), ri18(ila, 12, 128),
                                      rr(wrch, 12, 19),       ri16(il, 13, 1),  rr(wrch, 13, 20),
                                      ri16(il, 14, 0x40),     rr(wrch, 14, 21), ri16(il, 15, 2)};
  const std::vector<std::uint32_t> wait = {rr(wrch, 15, 22), rr(wrch, 15, 23), rr(rdch, 16, 24)};
  const std::uint32_t load = ri16(lqa, 17, 0x1000 / 4);
  if (!waits) words.push_back(load);
  words.insert(words.end(), wait.begin(), wait.end());
  if (waits) words.push_back(load);
  words.push_back(stop_with(0x2000));
  return words;
}

TEST(SpuFindings, ALoadOfWhatHasNotArrived) {
  dma::AddressSpace memory;
  const dma::Buffer<std::uint32_t> data(memory, "data", 32);
  EXPECT_EQ(run_checked(fetching(false), {.argp = data.ea().value}, memory).count(dma::Rule::kLoadInFlight),
            1);
  EXPECT_TRUE(run_checked(fetching(true), {.argp = data.ea().value}, memory).findings.empty());
}

}  // namespace
}  // namespace softcell::ls_sim::interpreter
