#include "softcell/jobs/job_system.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "arithmetic_results.h"
#include "job_chain.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/timing.h"
#include "softcell/ls_sim/trace.h"
#include "softcell/spu_kernels/images.h"
#include "support/text_file.h"
#include "test_images.h"

extern "C" const std::byte softcell_image_fills_up[], softcell_image_fills_up_end[];

namespace softcell::ppu {
namespace {

using namespace std::chrono_literals;
using ls_sim::KernelImage;
using ls_sim::SpeOptions;
using Words = std::array<std::uint32_t, 32>;

/// What the kernel mixes is given.
struct alignas(128) MixJob {
  std::uint64_t left, right, out, pad[13];
};

KernelImage load_job_loop() {
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files()) {
    if (file.name == "job_loop") return ls_sim::load_image(file.name, file.elf);
  }
  throw std::logic_error("no job_loop");
}

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  }
}

/// Tests that fail jobs do so whether or not SPEs take turns.
constexpr ls_sim::Interleaving kInterleavings[] = {ls_sim::Interleaving::kFree, ls_sim::Interleaving::kTurns};

class JobSystemTest : public testing::Test {
 protected:
  dma::Buffer<Words> make_lines(std::size_t count) {
    dma::Buffer<Words> lines(memory_, "lines", count);
    for (std::size_t i = 0; i < count; ++i) lines[i].fill(static_cast<std::uint32_t>(i));
    return lines;
  }

  void expect_no_failures(const JobChain& chain) {
    for (const JobFailure& failure : chain.failures()) ADD_FAILURE() << failure.message;
  }

  dma::AddressSpace memory_;
  const KernelImage loop_ = load_job_loop();
  const KernelImage adds_ = test_image("echo_arguments");
};

TEST_F(JobSystemTest, RunsEveryJobOnceForAnyNumberOfSpesAndAnySchedule) {
  for (int spes = 1; spes <= 6; ++spes) {
    for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
      JobSystem jobs(memory_, {.spes = spes, .schedule = dma::parse_schedule(schedule)}, loop_);
      auto lines = make_lines(100);
      const JobImage adds = jobs.load(adds_);
      JobChain chain(jobs, "adds", 100);
      for (std::size_t i = 0; i < 100; ++i) chain.add({adds, lines.ea(i)});
      chain.kick();
      chain.wait();
      expect_no_failures(chain);
      for (std::size_t i = 0; i < 100; ++i) {
        for (const std::uint32_t word : lines[i]) ASSERT_EQ(word, i + 1) << spes << " " << schedule;
      }
      std::uint64_t run = 0;
      for (const ls_sim::SpeStatistics& s : jobs.statistics()) run += s.jobs;
      EXPECT_EQ(run, 100u);
    }
  }
}

/// SPEs that take turns run while somebody waits, and not otherwise.
TEST_F(JobSystemTest, OfSpesThatTakeTurnsEndsItsJobs) {
  for (const bool by_time : {false, true}) {
    for (int spes = 1; spes <= 6; ++spes) {
      ls_sim::Timing timing(spes);
      SpeOptions options{.spes = spes, .interleaving = ls_sim::Interleaving::kTurns};
      if (by_time) ls_sim::time_by(&timing, options);
      JobSystem jobs(memory_, options, loop_);
      auto lines = make_lines(40);
      const JobImage adds = jobs.load(adds_);
      JobChain first(jobs, "first", 20), second(jobs, "second", 20);
      for (std::size_t i = 0; i < 40; ++i) (i < 20 ? first : second).add({adds, lines.ea(i)});
      for (int kick = 0; kick < 2; ++kick) {
        first.kick();
        second.kick();
        EXPECT_TRUE(second.finished()) << spes;
        EXPECT_TRUE(first.finished()) << spes;
      }
      for (JobChain* const chain : {&first, &second}) expect_no_failures(*chain);
      for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(lines[i][0], i + 2) << spes;
      if (!by_time) continue;
      const auto kernels = timing.by_kernel();
      ASSERT_EQ(kernels.size(), 1u);
      EXPECT_EQ(kernels[0].kernel, adds_.name);
      EXPECT_EQ(kernels[0].jobs, 80u);
      EXPECT_GT(kernels[0].cycles, kernels[0].waits);
      EXPECT_GT(kernels[0].waits, 0u);
      EXPECT_GT(timing.now(), kernels[0].cycles / static_cast<std::uint64_t>(spes));
    }
  }
}

/// Lines that are mixed with their neighbours, stage after stage.
std::vector<Words> mix(dma::AddressSpace& memory, const KernelImage& loop, const SpeOptions& options) {
  constexpr std::size_t kLines = 13, kStages = 20;
  const KernelImage image = test_image(options.findings != nullptr ? "mixes_checked" : "mixes");
  JobSystem jobs(memory, options, loop);
  const JobImage mixes = jobs.load(image);
  std::array<dma::Buffer<Words>, 2> lines{dma::Buffer<Words>(memory, "even", kLines),
                                          dma::Buffer<Words>(memory, "odd", kLines)};
  for (std::size_t i = 0; i < kLines; ++i) lines[0][i].fill(static_cast<std::uint32_t>(i * i + 1));
  dma::Buffer<MixJob> mix_jobs(memory, "jobs", kLines * kStages);
  JobChain chain(jobs, "mix", kLines * kStages);
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    const auto& from = lines[stage % 2];
    for (std::size_t i = 0; i < kLines; ++i) {
      mix_jobs[chain.size()] = {
          from.ea(i).value, from.ea((i + 1) % kLines).value, lines[1 - stage % 2].ea(i).value, {}};
      chain.add({mixes, mix_jobs.ea(chain.size())});
    }
    chain.sync();
  }
  chain.kick();
  chain.wait();
  for (const JobFailure& failure : chain.failures()) ADD_FAILURE() << failure.message;
  return {lines[0].span().begin(), lines[0].span().end()};
}

TEST_F(JobSystemTest, AStageBeginsWhenTheOneBeforeHasEnded) {
  std::vector<std::uint32_t> expected(13), next(13);
  for (std::uint32_t i = 0; i < 13; ++i) expected[i] = i * i + 1;
  for (int stage = 0; stage < 20; ++stage) {
    for (std::size_t i = 0; i < 13; ++i) next[i] = 3 * expected[i] + expected[(i + 1) % 13];
    expected.swap(next);
  }
  for (int spes = 1; spes <= 6; ++spes) {
    for (const char* schedule : {"eager", "lazy", "random:1", "random:2", "random:3"}) {
      const auto lines = mix(memory_, loop_, {.spes = spes, .schedule = dma::parse_schedule(schedule)});
      for (std::size_t i = 0; i < lines.size(); ++i) {
        for (const std::uint32_t word : lines[i]) ASSERT_EQ(word, expected[i]) << spes << " " << schedule;
      }
    }
  }
}

TEST_F(JobSystemTest, ThousandsOfJobsOfTwoImages) {
  constexpr std::size_t kJobs = 3000;
  const KernelImage other = test_image("remembers");
  JobSystem jobs(memory_, {.spes = 3}, loop_);
  auto lines = make_lines(kJobs), counts = make_lines(kJobs);
  const JobImage adds = jobs.load(adds_), remembers = jobs.load(other);
  JobChain chain(jobs, "many", 2 * kJobs);
  for (std::size_t i = 0; i < kJobs; ++i) {
    chain.add({adds, lines.ea(i)});
    chain.add({remembers, counts.ea(i)});
  }
  chain.kick();
  chain.wait();
  expect_no_failures(chain);
  for (std::size_t i = 0; i < kJobs; ++i) {
    ASSERT_EQ(lines[i][0], i + 1);
    ASSERT_EQ(counts[i][0], 101u) << "initialised data are fresh for every job";
  }
}

TEST_F(JobSystemTest, AChainIsKickedAgainAndAgain) {
  JobSystem jobs(memory_, {.spes = 2}, loop_);
  auto lines = make_lines(3);
  const JobImage adds = jobs.load(adds_);
  JobChain chain(jobs, "again", 3);
  for (std::size_t i = 0; i < 3; ++i) chain.add({adds, lines.ea(i)}), chain.sync();
  for (int kick = 0; kick < 2000; ++kick) {
    chain.kick();
    chain.wait();
    ASSERT_TRUE(chain.failures().empty());
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(lines[i][31], 2000 + i);
  chain.clear();
  chain.add({adds, lines.ea(1)});
  chain.kick();
  while (!chain.finished()) std::this_thread::yield();
  EXPECT_EQ(lines[1][0], 2002u);
  EXPECT_EQ(lines[2][0], 2002u);
}

TEST_F(JobSystemTest, AChainGetsMoreRoomAndKeepsItsJobs) {
  JobSystem jobs(memory_, {.spes = 2}, loop_);
  auto lines = make_lines(200);
  const JobImage adds = jobs.load(adds_);
  std::vector<std::unique_ptr<JobChain>> others;
  for (std::size_t c = 0; c + 1 < spu::kMaxChains; ++c)
    others.push_back(std::make_unique<JobChain>(jobs, "other", 1));
  JobChain chain(jobs, "grows", 2);  // the last for which there is room
  chain.add({adds, lines.ea(0)});
  chain.add({adds, lines.ea(1)});
  try {
    chain.add({adds, lines.ea(2)});
    ADD_FAILURE() << "a chain has more jobs than room";
  } catch (const std::length_error& error) {
    EXPECT_STREQ(error.what(), "chain 'grows' is full: it has room for 2 jobs; reserve() makes more room");
  }
  chain.kick();
  chain.reserve(200);
  EXPECT_TRUE(chain.finished()) << "it waits for jobs under way";
  for (std::size_t i = 2; i < lines.size(); ++i) chain.add({adds, lines.ea(i)});
  chain.reserve(1);
  EXPECT_EQ(chain.size(), 200u);
  chain.kick();
  chain.wait();
  for (std::size_t i = 0; i < lines.size(); ++i) ASSERT_EQ(lines[i][0], i + (i < 2 ? 2 : 1));
}

TEST_F(JobSystemTest, ChainsRunBesideEachOther) {
  JobSystem jobs(memory_, {.spes = 4}, loop_);
  auto lines = make_lines(15 * 50);
  const JobImage adds = jobs.load(adds_);
  std::vector<std::unique_ptr<JobChain>> chains;
  for (std::size_t c = 0; c < spu::kMaxChains; ++c) {
    chains.push_back(std::make_unique<JobChain>(jobs, "chain", 50));
    for (std::size_t i = 0; i < 50; ++i) chains[c]->add({adds, lines.ea(50 * c + i)});
  }
  EXPECT_THROW(JobChain(jobs, "one too many", 1), std::runtime_error);
  for (int kick = 0; kick < 20; ++kick) {
    for (auto& chain : chains) chain->kick();
    for (auto& chain : chains) chain->wait();
  }
  for (std::size_t i = 0; i < lines.size(); ++i) ASSERT_EQ(lines[i][0], i + 20);
}

TEST_F(JobSystemTest, AnEarlierChainGoesFirst) {
  const KernelImage endless = test_image("endless"), copies = test_image("mixes");
  JobSystem jobs(memory_, {.spes = 1, .deadline = 300ms}, loop_);
  auto lines = make_lines(3);
  const JobImage adds = jobs.load(adds_), mixes = jobs.load(copies), blocks = jobs.load(endless);
  JobChain urgent(jobs, "urgent", 1), later(jobs, "later", 1), blocker(jobs, "blocker", 1);
  blocker.add({blocks, {}});
  blocker.kick();  // the only SPE is busy while both others are kicked
  std::this_thread::sleep_for(50ms);
  dma::Buffer<MixJob> copy(memory_, "copy", 1);
  copy[0] = {lines.ea(1).value, lines.ea(2).value, lines.ea(0).value, {}};
  later.add({mixes, copy.ea()});
  later.kick();
  urgent.add({adds, lines.ea(1)});
  urgent.kick();
  later.wait();
  EXPECT_TRUE(urgent.finished());
  EXPECT_EQ(lines[0][0], 3 * 2 + 2u) << "the later chain's job saw what the urgent one has written";
  blocker.wait();
  EXPECT_EQ(blocker.failures().size(), 1u);
}

TEST_F(JobSystemTest, AnEmptyChainHasEnded) {
  JobSystem jobs(memory_, {.spes = 1}, loop_);
  JobChain chain(jobs, "empty", 0);
  EXPECT_TRUE(chain.finished());
  chain.sync();
  chain.kick();
  chain.wait();
  EXPECT_TRUE(chain.failures().empty());
  EXPECT_THROW(chain.add({jobs.load(adds_), {}}), std::length_error);
}

TEST_F(JobSystemTest, AJobThatReturnsAStatusFailsItsChainAfterItsStage) {
  JobSystem jobs(memory_, {.spes = 2}, loop_);
  auto lines = make_lines(4);
  const JobImage adds = jobs.load(adds_);
  JobChain chain(jobs, "refuses", 4);
  chain.add({adds, lines.ea(0)});
  chain.add({adds, lines.ea(1), {9}});
  chain.add({adds, lines.ea(2)});
  chain.sync();
  chain.add({adds, lines.ea(3)});
  chain.kick();
  chain.wait();
  ASSERT_EQ(chain.failures().size(), 1u);
  EXPECT_EQ(chain.failures()[0].job, 1u);
  expect_parts(chain.failures()[0].message, {"echo_arguments", "status 9"});
  EXPECT_EQ(lines[2][0], 3u) << "jobs of the same stage run all the same";
  EXPECT_EQ(lines[3][0], 3u) << "the next stage does not";
}

/// The numbers 0 to count - 1, up and down, from each of them on.
std::vector<std::vector<std::size_t>> orders_of(std::size_t count) {
  std::vector<std::vector<std::size_t>> orders;
  for (std::size_t first = 0; first < count; ++first) {
    std::vector<std::size_t>& order = orders.emplace_back();
    for (std::size_t i = 0; i < count; ++i) order.push_back((first + i) % count);
    orders.emplace_back(order.rbegin(), order.rend());
  }
  return orders;
}

/// The second stage has a job for each SPE; they end one after the other, in an order of the test's choice.
/// Behind them are jobs that end as they come. Whatever the order, the failure is that of the first in the
/// chain.
TEST_F(JobSystemTest, OfSeveralJobsThatFailTheFirstInTheChainIsNamedInWhateverOrderTheyEnd) {
  const KernelImage image = test_image("takes_turns");
  const auto expect_first = [&](JobSystem& jobs, const std::vector<std::size_t>& turns, std::size_t first) {
    auto lines = make_lines(4);
    const JobImage takes_turns = jobs.load(image), adds = jobs.load(adds_);
    JobChain chain(jobs, "fails", 3 + turns.size());
    chain.add({adds, lines.ea(1)});
    chain.sync();
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const std::uint64_t status = i < first ? 0 : 10 + i;
      chain.add({takes_turns, lines.ea(0), {turns[i] << 8 | status}});
    }
    chain.add({adds, lines.ea(2), {98}});
    chain.add({adds, lines.ea(3), {99}});
    chain.kick();
    chain.wait();
    ASSERT_EQ(chain.failures().size(), 1u);
    EXPECT_EQ(chain.failures()[0].job, 1 + first) << "of all that fail, this is the first in the chain";
    expect_parts(chain.failures()[0].message,
                 {"takes_turns", "status " + std::to_string(10 + first) + ",",
                  std::to_string(turns.size() - first - 1 + 2) + " more jobs failed"});
  };
  for (std::size_t spes = 1; spes <= 6; ++spes) {
    for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
      JobSystem jobs(memory_, {.spes = static_cast<int>(spes), .schedule = dma::parse_schedule(schedule)},
                     loop_);
      for (const std::vector<std::size_t>& turns : orders_of(spes)) {
        for (std::size_t first = 0; first < spes; ++first) {
          SCOPED_TRACE(std::to_string(spes) + " SPEs, " + schedule + ", jobs 1 to " + std::to_string(spes) +
                       " end as number " + testing::PrintToString(turns) + ", those from job " +
                       std::to_string(1 + first) + " on fail");
          expect_first(jobs, turns, first);
          if (HasFailure()) return;
        }
      }
    }
  }
}

TEST_F(JobSystemTest, AJobThatFaultsIsNamedAndTheSpesGoOn) {
  const KernelImage bad = test_image("bad_dma");
  for (const char* schedule : {"eager", "lazy", "random:3"}) {
    JobSystem jobs(memory_, {.spes = 2, .schedule = dma::parse_schedule(schedule)}, loop_);
    auto lines = make_lines(3);
    const JobImage adds = jobs.load(adds_), breaks = jobs.load(bad);
    JobChain chain(jobs, "faults", 4);
    chain.add({adds, lines.ea(0)});
    chain.add({breaks, lines.ea(2), {24}});
    chain.add({adds, lines.ea(1)});
    chain.sync();
    chain.add({adds, lines.ea(2)});
    for (std::uint32_t kick = 1; kick <= 5; ++kick) {
      chain.kick();
      chain.wait();
      ASSERT_EQ(chain.failures().size(), 1u);
      EXPECT_EQ(chain.failures()[0].job, 1u);
      expect_parts(chain.failures()[0].message, {"SPE ", "kernel bad_dma", "bad_dma.cpp:8", "24"});
      EXPECT_EQ(lines[0][0], kick);
      EXPECT_EQ(lines[1][0], 1 + kick);
      EXPECT_EQ(lines[2][0], 2u);
    }
    chain.clear();
    for (std::size_t i = 0; i < 3; ++i) chain.add({adds, lines.ea(i)});
    chain.kick();
    chain.wait();
    expect_no_failures(chain);
    EXPECT_EQ(lines[2][0], 3u);
  }
}

TEST_F(JobSystemTest, EveryWayToCrashIsReported) {
  for (const auto& [kernel, rule] :
       {std::pair{"illegal_instruction", "illegal-instruction"},
        std::pair{"read_effective_address", "effective-address-as-pointer"},
        std::pair{"stack_overflow_deep", "stack-overflow"}, std::pair{"exits", "code 291"}}) {
    const KernelImage image = test_image(kernel);
    for (const ls_sim::Interleaving interleaving : kInterleavings) {
      JobSystem jobs(memory_, {.spes = 1, .interleaving = interleaving}, loop_);
      auto lines = make_lines(1);
      const JobImage crashes = jobs.load(image), adds = jobs.load(adds_);
      JobChain chain(jobs, "crashes", 2);
      chain.add({crashes, lines.ea(), {4096}});  // envp: a depth of stack
      chain.add({adds, lines.ea()});
      chain.kick();
      chain.wait();
      ASSERT_EQ(chain.failures().size(), 1u) << kernel;
      expect_parts(chain.failures()[0].message, {kernel, rule});
      EXPECT_EQ(lines[0][0], 1u) << kernel;
    }
  }
}

TEST_F(JobSystemTest, TheDeadlineIsThatOfAJobNotOfTheLoop) {
  const KernelImage endless = test_image("endless");
  JobSystem jobs(memory_, {.spes = 2, .deadline = 100ms}, loop_);
  std::this_thread::sleep_for(300ms);  // idle for longer than the deadline
  auto lines = make_lines(1);
  const JobImage hangs = jobs.load(endless), adds = jobs.load(adds_);
  JobChain chain(jobs, "hangs", 3);
  chain.add({hangs, {}, {0}});
  chain.add({hangs, {}, {1}});
  chain.add({adds, lines.ea()});
  chain.kick();
  chain.wait();
  ASSERT_EQ(chain.failures().size(), 2u);
  for (const JobFailure& failure : chain.failures()) {
    expect_parts(failure.message, {"kernel endless", "deadline-exceeded", "endless.cpp:"});
  }
  EXPECT_EQ(lines[0][0], 1u);
}

TEST_F(JobSystemTest, AJobThatWaitsForWhatNeverComesEndsAtTheDeadline) {
  const KernelImage image = test_image("waits");
  for (const ls_sim::Interleaving interleaving : kInterleavings) {
    JobSystem jobs(memory_, {.spes = 2, .deadline = 100ms, .interleaving = interleaving}, loop_);
    JobChain chain(jobs, "waits", 3);
    const JobImage waits = jobs.load(image);
    for (const std::uint64_t channel : {29, 3, 0}) chain.add({waits, {channel}, {0x2}});
    chain.kick();
    chain.wait();
    ASSERT_EQ(chain.failures().size(), 3u);
    for (const JobFailure& failure : chain.failures()) {
      expect_parts(failure.message, {"SPE ", "kernel waits", "deadline-exceeded", "waits.cpp:"});
    }
  }
}

TEST_F(JobSystemTest, AJobThatOverwritesTheLoopIsNamed) {
  const KernelImage image = test_image("overwrites");
  JobSystem jobs(memory_, {.spes = 2}, loop_);
  auto lines = make_lines(1);
  const JobImage overwrites = jobs.load(image), adds = jobs.load(adds_);
  std::uint32_t kick = 0;
  for (std::uint32_t lsa = loop_.begin; lsa < loop_.sizes.end; lsa += 16) {
    JobChain chain(jobs, "overwrites", 2), good(jobs, "good", 1);
    chain.add({overwrites, {lsa}});
    chain.kick();
    chain.wait();
    ASSERT_EQ(chain.failures().size(), 1u) << std::hex << lsa;
    expect_parts(chain.failures()[0].message, {"SPE ", "kernel overwrites", "outside-objects", "job_loop"});
    good.add({adds, lines.ea()});
    good.kick();
    good.wait();
    expect_no_failures(good);
    ASSERT_EQ(lines[0][0], ++kick);
  }
}

/// An SPE that has found a chain on the board may look at its state when the chain is no more.
TEST_F(JobSystemTest, ChainsMayGoWhileSpesLookForWork) {
  JobSystem jobs(memory_, {.spes = 6}, loop_);
  auto lines = make_lines(6);
  const JobImage adds = jobs.load(adds_);
  for (int i = 0; i < 10000; ++i) {
    JobChain chain(jobs, "short", 6);
    for (std::size_t line = 0; line < 6; ++line) chain.add({adds, lines.ea(line)});
    chain.kick();
    chain.wait();
    ASSERT_TRUE(chain.failures().empty()) << i << ": " << chain.failures()[0].message;
  }
}

TEST_F(JobSystemTest, ATransferIntoTheLoopIsNamed) {
  const KernelImage image = test_image("gets_over");
  for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
    for (const std::uint32_t lsa : {loop_.begin, loop_.data_end, loop_.sizes.end - 256}) {
      JobSystem jobs(memory_, {.spes = 1, .schedule = dma::parse_schedule(schedule)}, loop_);
      auto lines = make_lines(100);
      JobChain chain(jobs, "gets over", 1);
      chain.add({jobs.load(image), lines.ea(99), {lsa & ~127u}});
      chain.kick();
      chain.wait();
      ASSERT_EQ(chain.failures().size(), 1u) << schedule << " " << std::hex << lsa;
      expect_parts(chain.failures()[0].message, {"kernel gets_over", "outside-objects", "job_loop"});
    }
  }
}

TEST_F(JobSystemTest, AJobThatLeavesAStalledListIsNamed) {
  const KernelImage image = test_image("leaves_a_stall");
  for (const char* schedule : {"eager", "lazy", "random:1"}) {
    JobSystem jobs(memory_, {.spes = 1, .schedule = dma::parse_schedule(schedule)}, loop_);
    auto lines = make_lines(1);
    JobChain chain(jobs, "stalls", 2);
    chain.add({jobs.load(image), lines.ea()});
    chain.add({jobs.load(adds_), lines.ea()});
    chain.kick();
    chain.wait();
    ASSERT_EQ(chain.failures().size(), 1u);
    expect_parts(chain.failures()[0].message, {"kernel leaves_a_stall", "list-stalled-for-ever"});
    EXPECT_EQ(lines[0][0], 1u);
  }
}

/// Wherever the loop's stack is damaged: where its frames are the job is named, below them nothing happens.
TEST_F(JobSystemTest, ADamagedStackOfTheLoopHangsNobody) {
  const KernelImage image = test_image("overwrites");
  JobSystem jobs(memory_, {.spes = 2, .deadline = 500ms}, loop_);
  auto lines = make_lines(1);
  const JobImage overwrites = jobs.load(image), adds = jobs.load(adds_);
  std::size_t failed = 0;
  for (std::uint32_t lsa = loop_.begin - loop_.sizes.stack; lsa < loop_.begin; lsa += 16) {
    JobChain chain(jobs, "overwrites", 4);
    chain.add({overwrites, {lsa}});
    chain.add({adds, lines.ea()});
    chain.sync();
    chain.add({overwrites, {lsa}});
    chain.kick();
    chain.wait();
    failed += chain.failures().size();
    for (const JobFailure& failure : chain.failures()) expect_parts(failure.message, {"kernel overwrites"});
    chain.clear();
    chain.add({adds, lines.ea()});
    chain.kick();
    chain.wait();
    ASSERT_TRUE(chain.failures().empty()) << chain.failures()[0].message;
  }
  EXPECT_GT(failed, 2u);
}

TEST_F(JobSystemTest, AFaultThatNamesNoJobFailsTheChainsUnderWay) {
  const KernelImage broken = test_image("breaks_down");
  for (int spes = 1; spes <= 6; ++spes) {
    JobSystem jobs(memory_, {.spes = spes}, broken);
    JobChain first(jobs, "first", 3), second(jobs, "second", 1);
    const JobImage adds = jobs.load(adds_);
    auto lines = make_lines(4);
    for (std::size_t i = 0; i < 3; ++i) first.add({adds, lines.ea(i)});
    second.add({adds, lines.ea(3)});
    for (int kick = 0; kick < 20; ++kick) {
      first.kick();
      first.wait();
      ASSERT_EQ(first.failures().size(), 1u);
      expect_parts(first.failures()[0].message, {"SPE ", "breaks_down", "without naming a job"});
    }
    first.kick();
    second.kick();
    second.wait();
    first.wait();
    ASSERT_EQ(second.failures().size(), 1u);
    ASSERT_EQ(first.failures().size(), 1u);
  }
}

TEST_F(JobSystemTest, AChainMayBeFilledWhileTheLoopsBreakDown) {
  const KernelImage broken = test_image("breaks_down");
  JobSystem jobs(memory_, {.spes = 2}, broken);
  JobChain kicked(jobs, "kicked", 1), filled(jobs, "filled", 100);
  const JobImage adds = jobs.load(adds_);
  auto lines = make_lines(2);
  kicked.add({adds, lines.ea(0)});
  for (int kick = 0; kick < 20; ++kick) {
    kicked.kick();
    for (int job = 0; job < 2000; ++job) {  // no look at the chain between: it would put both in an order
      if (filled.size() == 100) filled.clear();
      filled.add({adds, lines.ea(1)});
    }
    kicked.wait();
    ASSERT_EQ(kicked.failures().size(), 1u);
    ASSERT_TRUE(filled.failures().empty());
  }
}

/// Jobs have their stacks where the loop keeps a watch when it runs alone.
TEST_F(JobSystemTest, LoopsThatHaveRunJobsEndWithoutAFault) {
  ls_sim::Trace trace(2);
  JobSystem jobs(memory_, {.spes = 2, .trace = &trace}, loop_);
  const auto lines = make_lines(8);
  JobChain chain(jobs, "adds", lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) chain.add({jobs.load(adds_), lines.ea(i)});
  chain.kick();
  chain.wait();
  expect_no_failures(chain);
  jobs.stop();
  const std::filesystem::path file = testing::TempDir() + "loops_end_" + std::to_string(getpid()) + ".json";
  trace.write(file);
  const std::string text = test::text_of(file);
  std::filesystem::remove(file);
  EXPECT_NE(text.find("echo_arguments"), std::string::npos);
  EXPECT_EQ(text.find("stack-overflow"), std::string::npos);
}

TEST_F(JobSystemTest, AJobBeginsWithAnEmptyEventMaskThoughItsLoopHasSlept) {
  JobSystem jobs(memory_, {.spes = 1}, loop_);
  const KernelImage image = test_image("sees_mask");
  const JobImage sees_mask = jobs.load(image);
  JobChain chain(jobs, "sees_mask", 1);
  chain.add({sees_mask, {}});
  for (int kick = 0; kick < 3; ++kick) {
    std::this_thread::sleep_for(20ms);  // the loop finds nothing to do
    chain.kick();
    chain.wait();
    expect_no_failures(chain);
  }
}

TEST_F(JobSystemTest, AResidentJobKeepsItsVariablesUpToItsCallersStack) {
  JobSystem jobs(memory_, {.spes = 1}, loop_);
  const KernelImage image =
      ls_sim::load_image("fills_up", {softcell_image_fills_up, softcell_image_fills_up_end});
  const JobImage fills_up = jobs.load(image);
  JobChain chain(jobs, "fills_up", 1);
  chain.add({fills_up, {}});
  chain.kick();
  chain.wait();
  for (int kick = 0; kick < 2; ++kick) {
    chain.kick();
    chain.wait();
    ASSERT_EQ(chain.failures().size(), 1u);
    EXPECT_NE(chain.failures().front().message.find('7'), std::string::npos)
        << chain.failures().front().message;
  }
}

TEST_F(JobSystemTest, RefusesALoopThatLeavesNoRoomForJobs) {
  EXPECT_THROW(JobSystem(memory_, {.spes = 1}, adds_), std::invalid_argument);
}

TEST_F(JobSystemTest, AnIdleSystemTakesNoTimeAndIsNoDeadlock) {
  const auto cpu_time = [] {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return std::chrono::seconds(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           std::chrono::microseconds(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  };
  JobSystem jobs(memory_, {.spes = 6}, loop_);
  auto lines = make_lines(1);
  const JobImage adds = jobs.load(adds_);
  JobChain chain(jobs, "once in a while", 1);
  chain.add({adds, lines.ea()});
  chain.kick();
  chain.wait();
  std::this_thread::sleep_for(20ms);  // the SPEs go to sleep
  const auto before = cpu_time();
  std::this_thread::sleep_for(300ms);
  EXPECT_LT(cpu_time() - before, 30ms);
  chain.kick();
  chain.wait();
  expect_no_failures(chain);
  EXPECT_EQ(lines[0][0], 2u);
}

TEST_F(JobSystemTest, NoMoreSpesAreWokenThanThereAreJobs) {
  constexpr std::size_t kEventStatus = 0;  // the channel at which a loop sleeps
  constexpr std::uint64_t kKicks = 100;
  for (const std::size_t count : {1u, 2u, 4u}) {
    JobSystem jobs(memory_, {.spes = 6}, loop_);
    auto lines = make_lines(count);
    const JobImage adds = jobs.load(adds_);
    JobChain chain(jobs, "few", count);
    for (std::size_t i = 0; i < count; ++i) chain.add({adds, lines.ea(i)});
    for (std::uint64_t kick = 0; kick < kKicks; ++kick) {
      std::this_thread::sleep_for(1ms);  // the SPEs go to sleep
      chain.kick();
      chain.wait();
    }
    expect_no_failures(chain);
    jobs.stop();
    std::uint64_t sleeps = 0;
    for (const ls_sim::SpeStatistics& spe : jobs.statistics()) sleeps += spe.waits[kEventStatus].count;
    EXPECT_GE(sleeps, 6u);
    EXPECT_LE(sleeps, kKicks * count + 6) << "each SPE sleeps once more, until it is told to end";
  }
}

TEST_F(JobSystemTest, AllSpesAreWokenWhenThereIsWorkForAll) {
  const KernelImage image = test_image("meets");
  JobSystem jobs(memory_, {.spes = 6, .deadline = 20s}, loop_);
  auto lines = make_lines(7);  // a barrier, and a line of each SPE
  const JobImage meets = jobs.load(image), adds = jobs.load(adds_);
  auto alone = make_lines(1);
  JobChain chain(jobs, "meets", 13);
  for (int i = 0; i < 6; ++i) chain.add({meets, lines.ea(), {1}});
  chain.sync();
  chain.add({adds, alone.ea()});  // one goes on, and wakes the others for the next stage
  chain.sync();
  for (int i = 0; i < 6; ++i) chain.add({meets, lines.ea(), {1}});
  for (int kick = 0; kick < 50; ++kick) {
    lines[0] = {0, 0, 6};
    if (kick % 10 == 0) std::this_thread::sleep_for(2ms);  // the SPEs go to sleep
    chain.kick();
    chain.wait();
    expect_no_failures(chain);
    ASSERT_TRUE(chain.failures().empty());
  }
}

TEST_F(JobSystemTest, CheckedJobsAreChecked) {
  for (const char* schedule : {"eager", "lazy", "random:7"}) {
    ls_sim::Findings findings;
    const SpeOptions options{.spes = 3, .schedule = dma::parse_schedule(schedule), .findings = &findings};
    mix(memory_, loop_, options);
    for (const ls_sim::Finding& finding : findings.list()) ADD_FAILURE() << finding.fault.message();

    const KernelImage no_wait = test_image("no_wait_checked");
    JobSystem jobs(memory_, options, loop_);
    auto lines = make_lines(2);
    JobChain chain(jobs, "finds", 2);
    chain.add({jobs.load(no_wait), lines.ea(1), lines.ea(0)});
    chain.sync();
    chain.add({jobs.load(no_wait), lines.ea(1), lines.ea(0)});
    chain.kick();
    chain.wait();
    expect_no_failures(chain);
    const auto found = findings.list();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].count, 64u);
    EXPECT_EQ(found[0].fault.place, "no_wait.cpp:12");
    EXPECT_EQ(found[0].fault.kernel, "no_wait_checked");
    EXPECT_THROW(jobs.load(adds_), std::invalid_argument);
  }
}

TEST_F(JobSystemTest, RefusesImagesThatAreNoJobs) {
  JobSystem jobs(memory_, {.spes = 1}, loop_);
  EXPECT_THROW(jobs.load(loop_), std::invalid_argument);
  ls_sim::KernelImage program = adds_;
  program.program = true;
  EXPECT_THROW(jobs.load(program), std::invalid_argument) << "a program is loaded whole";
  KernelImage large = adds_;
  large.sizes.stack = loop_.begin - loop_.sizes.stack - large.sizes.end + 16;
  EXPECT_THROW(jobs.load(large), std::invalid_argument);
}

TEST_F(JobSystemTest, RefusesOptionsOutOfRange) {
  EXPECT_THROW(JobSystem(memory_, {.spes = 0}, loop_), std::invalid_argument);
  EXPECT_THROW(JobSystem(memory_, {.spes = 7}, loop_), std::invalid_argument);
  EXPECT_THROW(JobSystem(memory_, {.deadline = 0ms}, loop_), std::invalid_argument);
}

TEST_F(JobSystemTest, EndsAtOnceWhateverIsUnderWay) {
  for (int round = 0; round < 50; ++round) {
    JobSystem jobs(memory_, {.spes = 1 + round % 6}, loop_);
    auto lines = make_lines(20);
    const JobImage adds = jobs.load(adds_);
    std::optional<JobChain> first(std::in_place, jobs, "first", 20),
        second(std::in_place, jobs, "second", 20);
    for (std::size_t i = 0; i < 10; ++i) first->add({adds, lines.ea(i)});
    for (std::size_t i = 10; i < 20; ++i) second->add({adds, lines.ea(i)});
    first->kick();
    second->kick();
    if (round % 2 == 0) first.reset();  // which waits
    second.reset();
    first.reset();
    for (std::size_t i = 0; i < 20; ++i) ASSERT_EQ(lines[i][0], i + 1);
  }
}

TEST_F(JobSystemTest, AKickAfterStopFailsAndDoesNotHang) {
  for (const ls_sim::Interleaving interleaving : kInterleavings) {
    JobSystem jobs(memory_, {.spes = 2, .interleaving = interleaving}, loop_);
    auto lines = make_lines(2);
    const JobImage adds = jobs.load(adds_);
    JobChain chain(jobs, "late", 2), other(jobs, "other", 1);
    for (std::size_t i = 0; i < 2; ++i) chain.add({adds, lines.ea(i)}), chain.sync();
    other.add({adds, lines.ea()});
    other.kick();
    jobs.stop();
    EXPECT_EQ(lines[0][0], 1u) << "what was kicked before has run";
    for (int kick = 0; kick < 2; ++kick) {
      chain.kick();
      chain.wait();
      EXPECT_TRUE(chain.finished());
      ASSERT_EQ(chain.failures().size(), 1u);
      EXPECT_EQ(chain.failures()[0].job, chain.size()) << "no job is to blame";
      expect_parts(chain.failures()[0].message, {"chain 'late'", "JobSystem::stop()"});
    }
    other.wait();
    expect_no_failures(other);
    EXPECT_EQ(lines[0][0], 1u);
    jobs.stop();  // does nothing more
  }
}

TEST_F(JobSystemTest, AReadWithoutAWaitShowsUnderTheLazySchedule) {
  const KernelImage image = test_image("no_wait");
  for (const auto& [schedule, expected] : {std::pair{"eager", 1u}, std::pair{"lazy", 0u}}) {
    JobSystem jobs(memory_, {.spes = 1, .schedule = dma::parse_schedule(schedule)}, loop_);
    auto lines = make_lines(2);
    JobChain chain(jobs, "no wait", 1);
    chain.add({jobs.load(image), lines.ea(1), lines.ea()});
    chain.kick();
    chain.wait();
    expect_no_failures(chain);
    EXPECT_EQ(lines[0][0], expected) << schedule;
  }
}

TEST_F(JobSystemTest, ComputesWithTheArithmeticOfTheSpu) {
  const KernelImage image = test_image("arithmetic");
  JobSystem jobs(memory_, {.spes = 1}, loop_);
  dma::Buffer<ls_sim::ArithmeticResults> results(memory_, "results", 1);
  JobChain chain(jobs, "arithmetic", 1);
  chain.add({jobs.load(image), results.ea()});
  chain.kick();
  chain.wait();
  expect_no_failures(chain);
  ls_sim::expect_arithmetic_of_an_spu(results[0]);
}

}  // namespace
}  // namespace softcell::ppu
