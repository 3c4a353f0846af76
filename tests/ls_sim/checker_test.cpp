#include "checker/checker.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/dma/address_space.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/spe_group.h"
#include "test_images.h"

namespace softcell::ls_sim {
namespace {

/// "rule place xcount" of every finding of a kernel that runs once, with two buffers of zeros.
std::vector<std::string> findings_of(const std::string& kernel, const std::string& schedule) {
  dma::AddressSpace memory;
  Findings findings;
  const KernelImage image = test_image(kernel + "_checked");
  const dma::Buffer<std::uint32_t> in(memory, "in", 1024), out(memory, "out", 1024);
  SpeGroup spes(memory, {.spes = 1, .schedule = dma::parse_schedule(schedule), .findings = &findings});
  spes.start(0, image, {.spe_id = 0, .argp = in.ea().value, .envp = out.ea().value});
  const RunResult result = spes.wait(0);
  EXPECT_FALSE(result.fault) << result.fault->message();
  std::vector<std::string> texts;
  for (const Finding& finding : findings.list()) {
    texts.push_back(std::string(name(finding.fault.rule)) + " " + finding.fault.place + " x" +
                    std::to_string(finding.count));
  }
  return texts;
}

/// The stack of an image that runs alone.
StackRange stack_of(const KernelImage& image) {
  return {image.stack_top - image.sizes.stack, image.stack_top};
}

class CheckedKernels : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Schedules, CheckedKernels, testing::Values("eager", "lazy", "random:7"));

using Texts = std::vector<std::string>;

TEST_P(CheckedKernels, AForgottenWaitIsFoundWhateverTheScheduleMadeOfIt) {
  EXPECT_EQ(findings_of("no_wait", GetParam()), Texts{"load-in-flight no_wait.cpp:12 x32"});
}

TEST_P(CheckedKernels, BssTakenForZeroAndPutUnwrittenAreFound) {
  EXPECT_EQ(findings_of("remembers", GetParam()),
            (Texts{"load-never-written remembers.cpp:15 x1", "put-never-written remembers.cpp:16 x1"}));
}

TEST_P(CheckedKernels, PaddingNeedsNotBeWritten) { EXPECT_EQ(findings_of("padded", GetParam()), Texts{}); }

/// The checker alone. The tests report accesses and commands to it as an engine would. Positions are the addresses of
/// the entry and of the instructions after it.
class CheckerTest : public testing::Test {
 protected:
  class Quiet final : public ChannelPort {
   public:
    ChannelReply read(std::uint32_t) override { return {answer, {}}; }
    ChannelReply write(std::uint32_t, std::uint32_t) override { return {}; }
    ChannelReply count(std::uint32_t) override { return {1, {}}; }
    ChannelReply issue(const dma::MfcCommand&) override { return {}; }
    void sync() override {}
    std::uint32_t answer = 0;
  };
  class Still final : public Engine {
   public:
    void load(const KernelImage&) override {}
    RunResult run(const EntryArguments&, ChannelPort&, AccessObserver*, JobObserver*) override { return {}; }
    dma::LocalStoreAddress position() const override { return at; }
    dma::LocalStoreAddress stack_pointer() const override { return {dma::kLocalStoreBytes - 512}; }
    void interrupt() override {}
    std::uint32_t stack_high_water() const override { return 0; }
    dma::LocalStoreAddress at;
  };

  CheckerTest() {
    engine_.at = {image_.entry};
    checker_.on_load();
    checker_.begin_run(image_, stack_of(image_));
  }

  std::uint32_t object(const std::string& name) const {
    for (const ImageObject& o : image_.objects) {
      if (o.name == name) return o.begin.value;
    }
    throw std::logic_error("no object " + name);
  }

  void store(std::uint32_t lsa, std::uint32_t bytes) { access(lsa, bytes, true); }
  void load(std::uint32_t lsa, std::uint32_t bytes) { access(lsa, bytes, false); }
  void access(std::uint32_t lsa, std::uint32_t bytes, bool is_store) {
    checker_.on_access({{lsa}, bytes, is_store, engine_.at, engine_.stack_pointer()});
  }
  void issue(dma::MfcOpcode opcode, std::uint32_t lsa, std::uint64_t ea, std::uint32_t size,
             std::uint32_t tag) {
    checker_.issue({static_cast<std::uint32_t>(opcode), {lsa}, {ea}, size, tag});
  }
  void wait_for(std::uint32_t tag, std::uint32_t condition = 2) {
    checker_.write(22, 1u << tag);
    checker_.write(23, condition);
    channels_.answer = 1u << tag;
    checker_.read(24);
  }
  void read_atomic_status() { checker_.read(27); }

  std::vector<std::string> rules() const {
    std::vector<std::string> names;
    for (const Finding& finding : findings_.list()) names.emplace_back(name(finding.fault.rule));
    return names;
  }

  static constexpr std::uint64_t kEa = dma::kMainMemoryBase.value;
  const KernelImage image_ = test_image("no_wait_checked");
  const std::uint32_t buffer_ = object("buffer"), out_ = object("out");
  Quiet channels_;
  Still engine_;
  Findings findings_;
  LocalStore local_store_;
  Checker checker_{{.spe = 0,
                    .local_store = local_store_.bytes(),
                    .channels = channels_,
                    .engine = engine_,
                    .findings = findings_}};
};

using dma::MfcOpcode;

/// Calls a channel from an instruction in `buffer_`, as if the kernel executed code there.
class CheckerOfCode : public CheckerTest {
 protected:
  void run_in_buffer(std::uint32_t offset) {
    engine_.at = {buffer_ + offset};
    checker_.count(28);
    engine_.at = {image_.entry};
  }
  static inline const std::vector<std::string> kFound{"code-without-sync"};
};

TEST_F(CheckerOfCode, CodeThatWasFetchedNeedsASync) {
  issue(MfcOpcode::get, buffer_, kEa, 128, 3);
  wait_for(3);
  run_in_buffer(128);
  EXPECT_TRUE(rules().empty()) << "nothing was fetched there";
  run_in_buffer(127);
  EXPECT_EQ(rules(), kFound);
}

TEST_F(CheckerOfCode, CodeThatWasStoredNeedsASync) {
  store(buffer_ + 8, 4);
  run_in_buffer(7);
  run_in_buffer(12);
  EXPECT_TRUE(rules().empty());
  run_in_buffer(8);
  EXPECT_EQ(rules(), kFound);
}

TEST_F(CheckerOfCode, CodeFromOutsideNeedsASync) {
  checker_.on_external_write({buffer_}, 16);
  run_in_buffer(15);
  EXPECT_EQ(rules(), kFound);
}

TEST_F(CheckerOfCode, AfterASyncItIsFree) {
  issue(MfcOpcode::get, buffer_, kEa, 128, 3);
  wait_for(3);
  store(buffer_ + 64, 4);
  checker_.sync();
  run_in_buffer(0);
  run_in_buffer(64);
  EXPECT_TRUE(rules().empty());
}

TEST_F(CheckerOfCode, ASyncBeforeTheWaitDoesNotCoverAGet) {
  issue(MfcOpcode::get, buffer_, kEa, 128, 3);
  checker_.sync();
  wait_for(3);
  run_in_buffer(0);
  EXPECT_EQ(rules(), kFound);
}

TEST_F(CheckerOfCode, AJobWhoseImageWasFetchedWithoutASyncIsFound) {
  checker_.on_unchecked_issue({static_cast<std::uint32_t>(MfcOpcode::get), {image_.begin}, {kEa}, 1024, 3});
  checker_.begin_run(image_, stack_of(image_));
  EXPECT_EQ(rules(), kFound);
}

TEST_F(CheckerOfCode, AJobWhoseImageWasFetchedBeforeASyncIsFree) {
  checker_.on_unchecked_issue({static_cast<std::uint32_t>(MfcOpcode::get), {image_.begin}, {kEa}, 1024, 3});
  checker_.sync();
  checker_.begin_run(image_, stack_of(image_));
  EXPECT_TRUE(rules().empty());
}

TEST_F(CheckerTest, ALoadIsFreeAfterTheWaitAndNotAfterThatOfAnotherTag) {
  issue(MfcOpcode::get, buffer_, kEa, 128, 3);
  wait_for(3);
  load(buffer_, 4);
  EXPECT_EQ(rules(), Texts{});
  issue(MfcOpcode::get, buffer_, kEa, 128, 3);
  issue(MfcOpcode::get, out_, kEa + 128, 128, 4);
  wait_for(4);
  load(buffer_ + 124, 4);
  EXPECT_EQ(rules(), Texts{"load-in-flight"});
}

/// The count of the channel, or the event, says that the status is there: then the tags that were waited for are complete.
TEST_F(CheckerTest, ALoadIsFreeAsSoonAsTheStatusIsThere) {
  const auto ask = [&](std::uint32_t mask, std::uint32_t condition) {
    for (const std::uint32_t tag : {3u, 4u}) issue(MfcOpcode::get, buffer_ + 64 * (tag - 3), kEa, 64, tag);
    checker_.write(22, mask);
    checker_.write(23, condition);
  };
  const auto read_status = [&](std::uint32_t tags) {
    channels_.answer = tags;
    checker_.read(24);
  };
  ask(1u << 3 | 1u << 4, 2);
  checker_.count(24);
  load(buffer_, 128);
  EXPECT_TRUE(rules().empty());
  read_status(1u << 3 | 1u << 4);
  ask(1u << 3, 1);
  channels_.answer = 1;  // the event of the tag status
  checker_.read(0);
  load(buffer_, 64);
  EXPECT_TRUE(rules().empty());
  load(buffer_ + 64, 64);
  EXPECT_EQ(rules(), std::vector<std::string>{"load-in-flight"}) << "of the other tag";
}

/// Any one of several tags may be complete.
TEST_F(CheckerTest, AStatusThatIsThereDoesNotSayWhichOfSeveralTagsIsComplete) {
  issue(MfcOpcode::get, buffer_, kEa, 64, 3);
  issue(MfcOpcode::get, buffer_ + 64, kEa, 64, 4);
  checker_.write(22, 1u << 3 | 1u << 4);
  checker_.write(23, 1);
  checker_.count(24);
  load(buffer_, 64);
  EXPECT_EQ(rules(), std::vector<std::string>{"load-in-flight"});
}

TEST_F(CheckerTest, AStatusThatDoesNotWaitSaysNothingByBeingThere) {
  issue(MfcOpcode::get, buffer_, kEa, 64, 3);
  checker_.write(22, 1u << 3);
  checker_.write(23, 0);
  checker_.count(24);
  load(buffer_, 64);
  EXPECT_EQ(rules(), std::vector<std::string>{"load-in-flight"});
}

TEST_F(CheckerTest, AWaitForATagThatHasNoCommandAtAllIsFound) {
  wait_for(3);  // the first round of two buffers
  issue(MfcOpcode::get, buffer_, kEa, 64, 3);
  wait_for(3);
  wait_for(3);
  wait_for(4);
  checker_.write(22, ~0u);
  checker_.write(23, 2);
  EXPECT_EQ(rules(), Texts{}) << "commands may come";
  checker_.end_run();
  ASSERT_EQ(rules(), Texts{"tag-without-command"});
  EXPECT_NE(findings_.list().front().fault.message().find("tag 4: the program has issued no command of it"),
            std::string::npos);
}

TEST_F(CheckerTest, AListOfAFunctionThatHasReturnedIsFound) {
  const std::uint32_t list = dma::kLocalStoreBytes - 384;
  store(list, 16);
  issue(MfcOpcode::getl, buffer_, (kEa & ~0xFFFFFFFFull) | list, 16, 3);
  checker_.on_access({{out_}, 4, true, engine_.at, {list - 64}});
  EXPECT_EQ(rules(), Texts{}) << "its function runs, and calls others";
  checker_.on_access({{out_}, 4, true, engine_.at, {list + 16}});
  checker_.on_access({{out_}, 4, true, engine_.at, {list + 16}});
  EXPECT_EQ(rules(), Texts{"list-in-flight"}) << "once";
}

/// An SPU stores the whole quadword: of a get of a part of it, it writes back what was there before.
TEST_F(CheckerTest, AStoreBesideAGetOfAPartOfTheQuadwordIsFound) {
  store(buffer_, 128);
  issue(MfcOpcode::get, buffer_ + 20, kEa + 4, 4, 3);
  load(buffer_ + 16, 4);
  store(buffer_ + 32, 4);
  store(buffer_ + 12, 4);
  EXPECT_EQ(rules(), Texts{}) << "in other quadwords, or only loaded";
  store(buffer_ + 24, 8);
  ASSERT_EQ(rules(), Texts{"store-in-flight"});
  const std::string message = findings_.list().front().fault.message();
  EXPECT_NE(message.find("store of 8 bytes at buffer + 24"), std::string::npos) << message;
  EXPECT_NE(message.find("an SPU stores the whole quadword; in flight: get of 4 bytes, tag 3"),
            std::string::npos)
      << message;
  wait_for(3);
  store(buffer_ + 24, 8);
  EXPECT_EQ(findings_.list().front().count, 1u);
}

TEST_F(CheckerTest, AVariableOfAFunctionThatHasReturnedIsNoBuffer) {
  const std::uint32_t variable = dma::kLocalStoreBytes - 384;
  store(variable, 128);
  issue(MfcOpcode::put, variable, kEa, 128, 3);
  checker_.on_access({{buffer_}, 4, true, engine_.at, {variable - 64}});
  checker_.on_access({{buffer_}, 4, true, engine_.at, {variable + 64}});
  EXPECT_EQ(rules(), Texts{}) << "its function runs, and calls others";
  checker_.on_access({{buffer_}, 4, true, engine_.at, {variable + 128}});
  checker_.on_access({{buffer_}, 4, true, engine_.at, {variable + 128}});
  EXPECT_EQ(rules(), Texts{"store-in-flight"}) << "once";
}

TEST_F(CheckerTest, TheFindingSaysWhichCommandAndWhereItWasIssued) {
  issue(MfcOpcode::get, buffer_, kEa, 128, 3);
  load(buffer_ + 16, 4);
  ASSERT_EQ(findings_.list().size(), 1u);
  const std::string message = findings_.list().front().fault.message();
  EXPECT_NE(message.find("load of 4 bytes at buffer + 16"), std::string::npos) << message;
  EXPECT_NE(message.find("in flight: get of 128 bytes, tag 3, issued at no_wait.cpp:"), std::string::npos);
}

TEST_F(CheckerTest, APutsSourceMayBeLoadedAndNotStored) {
  store(buffer_, 128);
  issue(MfcOpcode::put, buffer_, kEa, 128, 3);
  load(buffer_, 4);
  EXPECT_EQ(rules(), Texts{});
  store(buffer_, 4);
  EXPECT_EQ(rules(), Texts{"store-in-flight"});
}

TEST_F(CheckerTest, AFenceOrdersItsTagAndTellsOfWhatIsBeforeIt) {
  store(buffer_, 128);
  issue(MfcOpcode::put, buffer_, kEa, 128, 3);
  issue(MfcOpcode::getf, buffer_, kEa + 128, 128, 3);
  wait_for(3);
  store(buffer_, 4);
  EXPECT_EQ(rules(), Texts{});
  issue(MfcOpcode::put, buffer_, kEa, 128, 3);
  issue(MfcOpcode::getf, buffer_, kEa + 128, 128, 4);
  EXPECT_EQ(rules(), Texts{"transfers-overlap"});
}

TEST_F(CheckerTest, WhatIsBeforeABarrierIsCompleteWithWhatIsBehindIt) {
  store(buffer_, 128);
  issue(MfcOpcode::put, buffer_, kEa, 128, 3);
  issue(MfcOpcode::barrier, 0, 0, 0, 5);
  issue(MfcOpcode::get, out_, kEa + 128, 128, 4);
  wait_for(4);
  store(buffer_, 4);
  checker_.end_run();
  EXPECT_EQ(rules(), Texts{});
}

TEST_F(CheckerTest, TransfersOfTheSameMainStorageOverlapWhenOneIsAPut) {
  store(buffer_, 128);
  issue(MfcOpcode::put, buffer_, kEa, 128, 0);
  issue(MfcOpcode::get, out_, kEa + 64, 64, 1);
  EXPECT_EQ(rules(), Texts{"transfers-overlap"});
}

TEST_F(CheckerTest, LineCommandsDoNotWaitForTransfersOfTheirBytes) {
  constexpr std::uint32_t kStatus = 27;
  store(buffer_, 128);
  store(out_, 128);
  const auto line_command = [&](MfcOpcode opcode, std::uint32_t lsa, std::uint64_t ea) {
    issue(opcode, lsa, ea, 0, 0);
    checker_.read(kStatus);
  };
  issue(MfcOpcode::put, buffer_, kEa, 128, 1);
  line_command(MfcOpcode::getllar, out_, kEa + 128);  // other bytes
  line_command(MfcOpcode::putllc, out_, kEa + 128);
  EXPECT_EQ(rules(), Texts{});
  line_command(MfcOpcode::getllar, buffer_, kEa + 128);
  line_command(MfcOpcode::getllar, out_, kEa);
  line_command(MfcOpcode::putlluc, out_, kEa);
  wait_for(1);
  EXPECT_EQ(rules(), Texts{"transfers-overlap"});
  EXPECT_EQ(findings_.list().front().count, 3u);
  issue(MfcOpcode::get, buffer_, kEa, 128, 1);
  line_command(MfcOpcode::putlluc, buffer_, kEa + 128);
  wait_for(1);
  EXPECT_EQ(findings_.list().front().count, 4u);
  line_command(MfcOpcode::getllar, buffer_, kEa);
  EXPECT_EQ(findings_.list().front().count, 4u) << "after the wait";
}

TEST_F(CheckerTest, LockThatIsGivenUpByAQueuedCommandMayBeTakenAgain) {
  constexpr std::uint32_t kStatus = 27;
  store(buffer_, 128);
  store(out_, 128);
  issue(MfcOpcode::putqlluc, buffer_, kEa, 0, 1);
  issue(MfcOpcode::getllar, out_, kEa, 0, 0);
  checker_.read(kStatus);
  issue(MfcOpcode::putllc, out_, kEa, 0, 0);
  checker_.read(kStatus);
  EXPECT_EQ(rules(), Texts{});
  issue(MfcOpcode::getllar, buffer_, kEa, 0, 0);
  checker_.read(kStatus);
  EXPECT_EQ(rules(), Texts{"transfers-overlap"}) << "its copy of the line";
}

TEST_F(CheckerTest, ZerosOverTheLinesOfATransferOverlapIt) {
  store(buffer_, 128);
  issue(MfcOpcode::sdcrz, 0, kEa, 256, 1);
  issue(MfcOpcode::put, buffer_, kEa + 256, 128, 1);
  issue(MfcOpcode::get, out_, kEa + 512, 128, 1);
  EXPECT_EQ(rules(), Texts{}) << "they have no bytes in the local store";
  issue(MfcOpcode::put, buffer_, kEa + 128, 128, 1);
  EXPECT_EQ(rules(), Texts{"transfers-overlap"});
  wait_for(1);
  issue(MfcOpcode::sdcrz, 0, kEa, 256, 1);
  issue(MfcOpcode::putf, buffer_, kEa, 128, 1);
  wait_for(1);
  issue(MfcOpcode::sdcrz, 0, kEa, 256, 1);
  checker_.end_run();
  EXPECT_EQ(rules(), Texts{"transfers-overlap"});
  EXPECT_EQ(findings_.list().front().count, 1u);
}

TEST_F(CheckerTest, BytesFromOutsideCountAsWritten) {
  checker_.on_external_write({buffer_}, 4);
  load(buffer_, 4);
  EXPECT_EQ(rules(), Texts{});
  checker_.begin_run(image_, stack_of(image_));
  load(buffer_, 4);
  EXPECT_EQ(rules(), Texts{});
  checker_.on_load();
  checker_.begin_run(image_, stack_of(image_));
  load(buffer_, 4);
  EXPECT_EQ(rules(), Texts{"load-never-written"});
}

TEST_F(CheckerTest, BytesThatThePpuSideWritesByAPointerCountAsWritten) {
  std::memset(&local_store_.bytes()[buffer_], std::to_integer<int>(kFiller), 128);
  local_store_.bytes()[buffer_ + 20] = std::byte{1};
  checker_.on_shared();
  load(buffer_ + 16, 4);  // the filler, in a quadword that was written
  load(buffer_ + 20, 1);
  EXPECT_EQ(rules(), Texts{});
  load(buffer_ + 32, 4);
  EXPECT_EQ(rules(), Texts{"load-never-written"});
}

TEST_F(CheckerTest, OutsideObjectsKnowsVariablesAndTheStackPointer) {
  store(buffer_, 128);
  store(dma::kLocalStoreBytes - 512, 512);
  issue(MfcOpcode::get, dma::kLocalStoreBytes - 512, kEa, 512, 0);
  wait_for(0);
  EXPECT_EQ(rules(), Texts{});
  issue(MfcOpcode::get, dma::kLocalStoreBytes - 1024, kEa, 512, 0);
  wait_for(0);
  store(image_.sizes.end + 16, 4);
  EXPECT_EQ(findings_.list().front().count, 2u);
  EXPECT_EQ(rules(), Texts{"outside-objects"});
}

TEST_F(CheckerTest, CodeMayBeReadAndNotWritten) {
  load(image_.text_begin, 16);
  EXPECT_EQ(rules(), Texts{});
  store(image_.text_begin, 16);
  issue(MfcOpcode::get, image_.text_begin, kEa, 16, 0);
  wait_for(0);
  EXPECT_EQ(rules(), Texts{"write-to-code"});
  EXPECT_EQ(findings_.list().front().count, 2u);
}

TEST_F(CheckerTest, TheEndWaitsForEverything) {
  issue(MfcOpcode::get, buffer_, kEa, 128, 3);
  issue(MfcOpcode::barrier, 0, 0, 0, 5);
  checker_.end_run();
  EXPECT_EQ(rules(), Texts{"commands-outstanding"});
}

TEST_F(CheckerTest, AtomicsAreReadUsedAndPaired) {
  issue(MfcOpcode::getllar, buffer_, kEa, 128, 0);
  read_atomic_status();
  store(buffer_, 4);
  issue(MfcOpcode::putllc, buffer_, kEa, 128, 0);
  read_atomic_status();
  checker_.end_run();
  EXPECT_EQ(rules(), Texts{});
}

TEST_F(CheckerTest, AtomicsThatAreNot) {
  issue(MfcOpcode::getllar, buffer_, kEa, 128, 0);
  read_atomic_status();
  store(buffer_, 4);
  issue(MfcOpcode::getllar, buffer_, kEa, 128, 0);
  EXPECT_EQ(rules(), Texts{"reservation-not-used"});
  issue(MfcOpcode::putllc, buffer_, kEa + 128, 128, 0);
  EXPECT_EQ(rules(), (Texts{"atomic-status-not-read", "reservation-not-used", "putllc-without-reservation"}));
}

TEST_F(CheckerTest, AListMayBeChangedBehindAnElementThatHasStalled) {
  const auto element = [&](std::uint32_t index, std::uint32_t head, std::uint32_t eal) {
    store(out_ + 8 * index, 8);
    std::memcpy(&local_store_.bytes()[out_ + 8 * index], &head, 4);
    std::memcpy(&local_store_.bytes()[out_ + 8 * index + 4], &eal, 4);
  };
  element(0, 0x8000'0000u | 64, static_cast<std::uint32_t>(kEa));
  element(1, 64, 0);
  issue(MfcOpcode::getl, buffer_, (kEa & ~0xFFFFFFFFull) | out_, 16, 5);
  channels_.answer = 1u << 5;
  checker_.read(25);
  element(1, 64, static_cast<std::uint32_t>(kEa) + 256);
  load(buffer_, 4);
  checker_.write(26, 5);
  EXPECT_EQ(rules(), Texts{});
  load(buffer_ + 64, 4);
  EXPECT_EQ(rules(), Texts{"load-in-flight"});
  store(out_ + 8, 8);
  EXPECT_EQ(rules(), (Texts{"load-in-flight", "list-in-flight"}));
}

}  // namespace
}  // namespace softcell::ls_sim
