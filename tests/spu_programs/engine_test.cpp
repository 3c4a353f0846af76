// The programs on SPEs, by the interpreter, under each schedule of DMA; each checks itself, and the tests
// check what it gave to the PPU side.

#include <gtest/gtest.h>

#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "softcell/dma/address_space.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/local_store_port.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/spe_group.h"
#include "spu_programs/spu_executable.h"

namespace softcell::spu_programs {
namespace {

using ls_sim::KernelImage;
using ls_sim::RunResult;
using ls_sim::SpeGroup;

/// Status 0, or a failure that says which check failed.
void expect_success(const RunResult& result) {
  ASSERT_FALSE(result.fault) << result.fault->message();
  ASSERT_TRUE(result.ended_normally()) << "stop code " << result.stop_code;
  EXPECT_EQ(result.status(), 0u) << "is the number of the check that failed";
}

std::uint64_t high(std::uint64_t address) { return address >> 32; }

struct Way {
  const char* schedule;
  bool checked;
  friend std::ostream& operator<<(std::ostream& out, const Way& way) {
    return out << way.schedule << (way.checked ? ", checked" : "");
  }
};

/// Under a schedule, checked or not. No program but the one without a sync makes a mistake that a checker
/// finds.
class Programs : public testing::TestWithParam<Way> {
 protected:
  void TearDown() override {
    for (const ls_sim::Finding& finding : findings_.list()) {
      if (finding.fault.rule != expected_rule_) ADD_FAILURE() << finding.fault.message();
    }
  }
  KernelImage program(const std::string& name) const {
    const std::vector<std::uint8_t> file = read_bytes(SPU_PROGRAMS + ("/" + name) + ".elf");
    KernelImage image = ls_sim::load_spu_program(name, std::as_bytes(std::span(file)));
    image.checked = GetParam().checked;
    return image;
  }
  ls_sim::SpeOptions options(int spes = 1) {
    return {.spes = spes,
            .schedule = dma::parse_schedule(GetParam().schedule),
            .findings = GetParam().checked ? &findings_ : nullptr};
  }
  dma::AddressSpace memory_;
  ls_sim::Findings findings_;
  std::optional<dma::Rule> expected_rule_;
};
INSTANTIATE_TEST_SUITE_P(Spu, Programs,
                         testing::Values(Way{"eager", false}, Way{"lazy", false}, Way{"random:7", false},
                                         Way{"eager", true}, Way{"lazy", true}, Way{"random:7", true}),
                         [](const auto& way) {
                           return std::string(way.param.schedule).substr(0, 4) +
                                  (way.param.checked ? "Checked" : "");
                         });

TEST_P(Programs, WithoutDmaEndWithoutAFailedCheck) {
  for (const char* const name :
       {"loops", "calls", "indirect_branches", "self_modified", "doubles", "singles"}) {
    SCOPED_TRACE(name);
    const KernelImage image = program(name);
    SpeGroup group(memory_, options());
    group.start(0, image, {});
    expect_success(group.wait(0));
  }
}

TEST_P(Programs, OldAndNewInstructionAreBothRightWithoutASync) {
  const KernelImage image = program("self_modified_unsynced");
  SpeGroup group(memory_, options());
  group.start(0, image, {});
  const RunResult result = group.wait(0);
  ASSERT_TRUE(result.ended_normally());
  expected_rule_ = dma::Rule::kCodeWithoutSync;
  EXPECT_EQ(findings_.list().size(), GetParam().checked ? 1u : 0u);
  EXPECT_TRUE(result.status() == 1 || result.status() == 2) << result.status();
}

TEST_P(Programs, DoubleBufferComputesEachBlock) {
  constexpr std::uint32_t kWordsOfABlock = 256;
  const KernelImage image = program("double_buffer");
  for (const std::uint32_t blocks : {0u, 1u, 2u, 7u}) {
    dma::Buffer<std::uint32_t> in(memory_, "in", kWordsOfABlock * 8);
    dma::Buffer<std::uint32_t> out(memory_, "out", kWordsOfABlock * 8);
    dma::Buffer<std::uint32_t> parameters(memory_, "parameters", 8);
    for (std::uint32_t i = 0; i < kWordsOfABlock * 8; ++i) in[i] = i * 0x9E3779B9;
    const std::uint64_t addresses[] = {in.ea().value, out.ea().value};
    for (std::size_t i = 0; i < 2; ++i) {
      parameters[2 * i] = static_cast<std::uint32_t>(high(addresses[i]));
      parameters[2 * i + 1] = static_cast<std::uint32_t>(addresses[i]);
    }
    parameters[4] = blocks;
    SpeGroup group(memory_, options());
    group.start(0, image, {.argp = parameters.ea().value});
    expect_success(group.wait(0));
    for (std::uint32_t i = 0; i < kWordsOfABlock * 8; ++i) {
      ASSERT_EQ(out[i], i < blocks * kWordsOfABlock ? 3 * in[i] + 7 : 0) << blocks << " blocks, word " << i;
    }
  }
}

TEST_P(Programs, ListsGatherStallAndScatter) {
  const KernelImage image = program("lists");
  dma::Buffer<std::uint32_t> data(memory_, "data", 256);
  dma::Buffer<std::uint32_t> pieces(memory_, "pieces", 256);
  for (std::uint32_t i = 0; i < 256; ++i) data[i] = i;
  SpeGroup group(memory_, options());
  group.start(0, image, {.argp = data.ea().value, .envp = pieces.ea().value});
  expect_success(group.wait(0));
  // Pieces of 16 words from words 0, 64, 128 and, changed during the stall, 32; scattered by 4 words, 4 left
  // free.
  constexpr std::uint32_t kFrom[] = {0, 64, 128, 32};
  for (std::uint32_t i = 0; i < 256; ++i) {
    const std::uint32_t gathered = i / 8 * 4 + i % 8;
    const bool written = i % 8 < 4 && i < 128;
    ASSERT_EQ(pieces[i], written ? kFrom[gathered / 16] + gathered % 16 : 0) << i;
  }
}

TEST_P(Programs, MailboxesAnswerEachWord) {
  const KernelImage image = program("mailboxes");
  SpeGroup group(memory_, options());
  group.start(0, image, {});
  ls_sim::ProblemState& spe = group.problem_state(0);
  constexpr std::uint32_t kWords = 20;
  spe.write_in_mbox(kWords);
  std::uint32_t sum = 0;
  for (std::uint32_t i = 0; i < kWords; ++i) {
    spe.write_in_mbox(i * i);
    sum += i * i;
    ASSERT_EQ(spe.wait_out_mbox(), sum) << i;
  }
  EXPECT_EQ(spe.wait_out_intr_mbox(), sum);
  expect_success(group.wait(0));
}

TEST_P(Programs, InterruptsArriveWhereTheyAreEnabled) {
  const KernelImage image = program("interrupts");
  SpeGroup group(memory_, options());
  group.start(0, image, {});
  ls_sim::ProblemState& spe = group.problem_state(0);
  const SpeGroup::Outside outside(group);
  ASSERT_EQ(spe.wait_out_mbox(), 0x10u);
  for (std::uint32_t word = 1; word <= 6; ++word) {
    while ((spe.mbox_status() >> 8 & 0xFF) == 0)
      std::this_thread::yield();  // a full mailbox would lose a word
    spe.write_in_mbox(word);
  }
  ASSERT_EQ(spe.wait_out_mbox(), 0x10u);
  spe.write_in_mbox(0);
  expect_success(group.wait(0));
}

TEST_P(Programs, SignalsGoToAndFro) {
  const KernelImage image = program("signals");
  SpeGroup group(memory_, options(2));
  for (const int spe : {0, 1}) {
    const std::uint64_t peer = group.problem_state(1 - spe).local_store_ea().value;
    group.prepare(
        spe, image,
        {.argp = peer + static_cast<std::uint64_t>(dma::SpeRegister::kSignal1), .envp = spe == 0 ? 1u : 0u});
  }
  for (const int spe : {0, 1}) group.start(spe);
  for (const int spe : {0, 1}) expect_success(group.wait(spe));
  EXPECT_EQ(group.statistics(0).dma.signals + group.statistics(1).dma.signals, 19u);
}

TEST_P(Programs, AtomicsCountWithSixSpes) {
  constexpr int kSpes = 6;
  constexpr std::uint32_t kTimes = 150;
  const KernelImage image = program("atomics");
  dma::Buffer<std::uint32_t> line(memory_, "line", 32);
  SpeGroup group(memory_, options(kSpes));
  for (int spe = 0; spe < kSpes; ++spe) {
    group.start(spe, image, {.argp = line.ea().value, .envp = kTimes});
  }
  for (int spe = 0; spe < kSpes; ++spe) expect_success(group.wait(spe));
  EXPECT_EQ(line[0], kSpes * kTimes);
}

}  // namespace
}  // namespace softcell::spu_programs
