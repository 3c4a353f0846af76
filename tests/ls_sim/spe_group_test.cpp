#include "softcell/ls_sim/spe_group.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "arithmetic_results.h"
#include "softcell/base/sanitizers.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/local_store_port.h"
#include "softcell/ls_sim/trace.h"
#include "test_images.h"

namespace softcell::ls_sim {

/// For the names of tests.
void PrintTo(Interleaving interleaving, std::ostream* out) {
  *out << (interleaving == Interleaving::kFree ? "free" : "turns");
}

namespace {

using namespace std::chrono_literals;
using Clock_ = std::chrono::steady_clock;

// Channels that the kernel `waits` takes as argp, numbered as in the SDK.
constexpr std::uint64_t kEventStat = 0, kSignal1 = 3, kSignal2 = 4, kDecrementer = 8, kOutMbox = 28,
                        kInMbox = 29, kOutIntrMbox = 30;

constexpr std::uint64_t kInMboxEvent = 0x10, kDecrementerEvent = 0x20, kOutMboxEvent = 0x80,
                        kSignal2Event = 0x100, kLostReservationEvent = 0x400;

/// Limits the number of threads that the process can still create, while this object lives: new stacks are large, and
/// the address space has room for so many only.
class RoomForThreads {
 public:
  explicit RoomForThreads(std::uint64_t threads) {
    pthread_attr_init(&attributes_);
    pthread_getattr_default_np(&attributes_);
    pthread_attr_t large = attributes_;
    pthread_attr_setstacksize(&large, kStackBytes);
    pthread_setattr_default_np(&large);
    getrlimit(RLIMIT_AS, &limit_);
    rlimit low = limit_;
    low.rlim_cur = address_space_in_use() + threads * kStackBytes + kStackBytes / 2;
    setrlimit(RLIMIT_AS, &low);
  }
  ~RoomForThreads() {
    setrlimit(RLIMIT_AS, &limit_);
    pthread_setattr_default_np(&attributes_);
  }
  RoomForThreads(const RoomForThreads&) = delete;
  RoomForThreads& operator=(const RoomForThreads&) = delete;

 private:
  static constexpr std::uint64_t kStackBytes = std::uint64_t{1} << 30;

  static std::uint64_t address_space_in_use() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  }

  pthread_attr_t attributes_{};
  rlimit limit_{};
};

class SpeGroupTest : public testing::Test {
 protected:
  /// Expects that each of the waits, one for each SPE, soon ends with the fault deadlock, with `parts` in its
  /// message.
  void expect_deadlock(SpeGroup& group, const std::vector<EntryArguments>& waits,
                       const std::vector<std::string>& parts) {
    const auto begin = Clock_::now();
    for (std::size_t spe = 0; spe < waits.size(); ++spe)
      group.start(static_cast<int>(spe), waits_, waits[spe]);
    for (std::size_t spe = 0; spe < waits.size(); ++spe) {
      const RunResult result = group.wait(static_cast<int>(spe));
      ASSERT_TRUE(result.fault);
      EXPECT_EQ(result.fault->rule, dma::Rule::kDeadlock) << result.fault->message();
      EXPECT_EQ(result.fault->spe, static_cast<int>(spe));
      EXPECT_EQ(result.fault->kernel, "waits");
      for (const std::string& part : parts) {
        EXPECT_NE(result.fault->message().find(part), std::string::npos)
            << part << " is not in: " << result.fault->message();
      }
    }
    EXPECT_LT(Clock_::now() - begin, 900ms);
  }

  dma::AddressSpace memory_;
  const KernelImage waits_ = test_image("waits");
};

TEST_F(SpeGroupTest, RunsAnImageWithItsArgumentsAndGivesItsStatus) {
  const KernelImage image = test_image("echo_arguments");
  const dma::Buffer<std::array<std::uint32_t, 32>> line(memory_, "line", 1);
  SpeGroup group(memory_, {.spes = 2});
  for (const std::uint64_t status : {42u, 7u}) {
    group.start(1, image, {.spe_id = 1, .argp = line.ea().value, .envp = status});
    const RunResult result = group.wait(1);
    ASSERT_FALSE(result.fault) << result.fault->message();
    EXPECT_EQ(result.status(), status);
    EXPECT_EQ(group.wait(1).status(), status) << "asked again";
  }
  EXPECT_EQ(line.span()[0][0], 2u);
  EXPECT_EQ(group.statistics(1).jobs, 2u);
  EXPECT_EQ(group.statistics(1).dma.bytes(), 512u);
  EXPECT_EQ(group.statistics(0).jobs, 0u);
}

TEST_F(SpeGroupTest, EachRunBeginsWithLinkedDataAndZeroBss) {
  const KernelImage image = test_image("remembers");
  dma::Buffer<std::uint32_t> counts(memory_, "counts", 32);
  SpeGroup group(memory_, {.spes = 1});
  for (int run = 0; run < 3; ++run) {
    group.start(0, image, {.argp = counts.ea().value});
    ASSERT_FALSE(group.wait(0).fault);
    EXPECT_EQ(counts[0], 101u);
    EXPECT_EQ(counts[1], 1u);
  }
}

TEST_F(SpeGroupTest, APointerAsANumberIsALocalStoreAddressToDmaCommands) {
  const KernelImage image = test_image("lists_by_number");
  dma::Buffer<std::array<std::uint32_t, 32>> line(memory_, "line", 1);
  SpeGroup group(memory_, {.spes = 1});
  for (const std::uint64_t way : {0u, 1u}) {
    std::iota(line.span()[0].begin(), line.span()[0].end(), 0u);
    group.start(0, image, {.argp = line.ea().value, .envp = way});
    const RunResult result = group.wait(0);
    ASSERT_FALSE(result.fault) << result.fault->message();
    EXPECT_EQ(line.span()[0][0], 16u);
    EXPECT_EQ(line.span()[0][16], 0u);
  }
}

TEST_F(SpeGroupTest, AKernelRoundsAndFlushesAsAnSpuDoes) {
  const KernelImage image = test_image("arithmetic");
  const dma::Buffer<ArithmeticResults> results(memory_, "results", 1);
  SpeGroup group(memory_, {.spes = 1});
  group.start(0, image, {.argp = results.ea().value});
  const RunResult result = group.wait(0);
  ASSERT_FALSE(result.fault) << result.fault->message();
  expect_arithmetic_of_an_spu(results.span()[0]);
}

TEST_F(SpeGroupTest, ATalkThroughMailboxes) {
  const KernelImage image = test_image("doubles");
  for (const Interleaving interleaving : {Interleaving::kFree, Interleaving::kTurns}) {
    SpeGroup group(memory_, {.spes = 1, .interleaving = interleaving});
    group.start(0, image, {});
    ProblemState& spe = group.problem_state(0);
    for (std::uint32_t value = 1; value <= 100; ++value) {
      spe.write_in_mbox(value);
      EXPECT_EQ(spe.wait_out_mbox(), 2 * value);
    }
    spe.write_in_mbox(0);
    EXPECT_EQ(group.wait(0).status(), 0u);
    EXPECT_EQ(spe.wait_out_mbox(), std::nullopt) << "nobody is left to write";
  }
}

TEST_F(SpeGroupTest, PollingAMailboxIsEnoughForAnAnswer) {
  const KernelImage image = test_image("doubles");
  for (const Interleaving interleaving : {Interleaving::kFree, Interleaving::kTurns}) {
    SpeGroup group(memory_, {.spes = 1, .interleaving = interleaving});
    group.start(0, image, {});
    ProblemState& spe = group.problem_state(0);
    spe.write_in_mbox(21);
    std::optional<std::uint32_t> answer;
    while (!answer) answer = spe.read_out_mbox();
    EXPECT_EQ(*answer, 42u);
    spe.write_in_mbox(0);
    group.wait(0);
  }
}

TEST_F(SpeGroupTest, MailboxStatusCountsWhatIsThere) {
  SpeGroup group(memory_, {.spes = 1});
  ProblemState& spe = group.problem_state(0);
  EXPECT_EQ(spe.mbox_status(), 0x000400u);
  for (std::uint32_t i = 1; i <= 3; ++i) spe.write_in_mbox(i);
  EXPECT_EQ(spe.mbox_status(), 0x000100u);
  group.start(0, waits_, {.argp = kOutMbox, .envp = 1});
  group.wait(0);
  group.start(0, waits_, {.argp = kOutIntrMbox, .envp = 1});
  group.wait(0);
  EXPECT_EQ(spe.mbox_status(), 0x010101u);
  EXPECT_EQ(spe.read_out_intr_mbox(), 1u);
  EXPECT_EQ(spe.read_out_intr_mbox(), std::nullopt);
  EXPECT_EQ(spe.mbox_status(), 0x000101u);
}

TEST_F(SpeGroupTest, AFullMailboxMakesTheSpeWaitUntilItIsRead) {
  SpeGroup group(memory_, {.spes = 1});
  ProblemState& spe = group.problem_state(0);
  group.start(0, waits_, {.argp = kOutMbox, .envp = 5});
  for (std::uint32_t i = 1; i <= 5; ++i) EXPECT_EQ(spe.wait_out_mbox(), i);
  EXPECT_EQ(group.wait(0).status(), 0u);
}

TEST_F(SpeGroupTest, SignalsFromThePpuCollectOrReplace) {
  SpeGroup group(memory_, {.spes = 1});
  ProblemState& spe = group.problem_state(0);
  for (const auto& [mode, expected] :
       {std::pair{SignalMode::kOverwrite, 0x20u}, std::pair{SignalMode::kOr, 0x21u}}) {
    for (const int which : {1, 2}) {
      spe.set_signal_mode(which, mode);
      spe.write_signal(which, 0x01);
      spe.write_signal(which, 0x20);
      group.start(0, waits_, {.argp = which == 1 ? kSignal1 : kSignal2});
      EXPECT_EQ(group.wait(0).status(), expected);
    }
  }
  EXPECT_THROW(spe.write_signal(3, 0), std::invalid_argument);
}

TEST_F(SpeGroupTest, SpesThatSleepLeaveTheProcessorToOthers) {
  SpeGroup group(memory_, {.spes = 6});
  for (int spe = 0; spe < 6; ++spe) group.start(spe, waits_, {.argp = kInMbox});
  const auto processor_time = [] {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  };
  std::this_thread::sleep_for(50ms);  // SPEs poll for a while before they sleep
  const auto before = processor_time();
  std::this_thread::sleep_for(200ms);
  EXPECT_LT(processor_time() - before, 20ms);
  for (int spe = 0; spe < 6; ++spe) group.problem_state(spe).write_in_mbox(7);
  for (int spe = 0; spe < 6; ++spe) EXPECT_EQ(group.wait(spe).status(), 7u);
}

TEST_F(SpeGroupTest, EventsWakeAnSpeThatSleeps) {
  SpeGroup group(memory_, {.spes = 1});
  ProblemState& spe = group.problem_state(0);
  struct Case {
    std::uint64_t event;
    std::function<void()> cause;
  };
  const std::vector<Case> cases{{kInMboxEvent, [&] { spe.write_in_mbox(1); }},
                                {kSignal2Event, [&] { spe.write_signal(2, 1); }}};
  for (const auto& [event, cause] : cases) {
    group.start(0, waits_, {.argp = kEventStat, .envp = event});
    cause();
    EXPECT_EQ(group.wait(0).status(), event & 0xFF);
  }
}

TEST_F(SpeGroupTest, WhatCameBeforeTheStartIsPending) {
  SpeGroup group(memory_, {.spes = 1});
  group.problem_state(0).write_in_mbox(1);
  group.start(0, waits_, {.argp = kEventStat, .envp = kInMboxEvent});
  EXPECT_EQ(group.wait(0).status(), kInMboxEvent);
}

TEST_F(SpeGroupTest, TheDecrementerEndsASleepByItself) {
  for (const Clock clock : {Clock::kHost, Clock::kSimulated}) {
    for (const Interleaving interleaving : {Interleaving::kFree, Interleaving::kTurns}) {
      SpeGroup group(memory_, {.spes = 2, .clock = clock, .interleaving = interleaving});
      const auto begin = Clock_::now();
      group.start(0, waits_, {.argp = kDecrementer, .envp = 3 * 79'800});
      group.start(1, waits_, {.argp = kDecrementer, .envp = 1 * 79'800});
      for (const int spe : {0, 1}) {
        const RunResult result = group.wait(spe);
        ASSERT_FALSE(result.fault) << result.fault->message();
        EXPECT_EQ(result.status(), kDecrementerEvent);
      }
      if (clock == Clock::kHost) {
        EXPECT_GE(Clock_::now() - begin, 3ms);
      }
    }
  }
}

TEST_F(SpeGroupTest, AnEffectiveAddressAboveTheUsualMainMemoryIsNamedAsOne) {
  dma::AddressSpace large(std::uint64_t{1} << 30);
  SpeGroup group(large, {.spes = 1});
  const KernelImage image = test_image("read_effective_address");
  // Below 1 GB, from where on the host maps what asks for a low address.
  for (const std::uint64_t offset : {0x80u, 0x1000'0080u, 0x2FFF'FF80u}) {
    group.start(0, image, {.argp = dma::kMainMemoryBase.value + offset});
    const RunResult result = group.wait(0);
    ASSERT_TRUE(result.fault) << offset;
    EXPECT_EQ(result.fault->rule, dma::Rule::kEffectiveAddressAsPointer) << result.fault->message();
  }
}

TEST_F(SpeGroupTest, AMinuteOfSimulatedTimePassesAtOnce) {
  SpeGroup group(memory_, {.spes = 1, .deadline = 500ms, .clock = Clock::kSimulated});
  const auto begin = Clock_::now();
  group.start(0, waits_, {.argp = kDecrementer, .envp = 0xFFFF'FFFE});  // 53.8 s
  const RunResult result = group.wait(0);
  ASSERT_FALSE(result.fault) << result.fault->message();
  EXPECT_EQ(result.status(), kDecrementerEvent);
  EXPECT_LT(Clock_::now() - begin, 5s) << "of the host, which may be busy";
}

class SimulatedSleep : public SpeGroupTest, public testing::WithParamInterface<Interleaving> {
 protected:
  /// Runs the kernel `sleeps` on two SPEs; SPE 1 sleeps `others_ticks` and then signals. @return  the result of SPE 0
  RunResult sleep_beside(std::uint64_t own_ticks, std::uint64_t others_ticks) {
    const KernelImage image = test_image("sleeps");
    SpeGroup group(memory_,
                   {.spes = 2, .deadline = 500ms, .clock = Clock::kSimulated, .interleaving = GetParam()});
    const auto signal = group.problem_state(0).local_store_ea().value +
                        static_cast<std::uint64_t>(dma::SpeRegister::kSignal1);
    const SpeGroup::Outside until_both_run(group);
    group.start(1, image, {.spe_id = 1, .argp = signal, .envp = others_ticks});
    group.start(0, image, {.spe_id = 0, .envp = own_ticks});
    return group.wait(0);
  }
};

TEST_P(SimulatedSleep, PassesForAllWhoSleep) {
  for (const std::uint64_t longer : {100u, 101u, 150u}) {  // 100: both sleep for the same time
    const RunResult result = sleep_beside(100, longer);
    ASSERT_FALSE(result.fault) << result.fault->message();
    EXPECT_LE(result.status(), 2u) << longer;
  }
}

TEST_P(SimulatedSleep, CountsForOneThatIsWokenBySomethingElse) {
  const RunResult result = sleep_beside(0, 1500);
  ASSERT_FALSE(result.fault) << result.fault->message();
  // If the SPEs do not take turns, the other may have slept before this one began to count.
  if (GetParam() == Interleaving::kTurns) {
    EXPECT_GE(result.status(), 140u);
  }
  EXPECT_LE(result.status(), 160u);
}

INSTANTIATE_TEST_SUITE_P(Interleavings, SimulatedSleep,
                         testing::Values(Interleaving::kFree, Interleaving::kTurns));

// ---- deadlocks

TEST_F(SpeGroupTest, TwoThatWaitForEachOthersSignalsAreADeadlock) {
  for (const Interleaving interleaving : {Interleaving::kFree, Interleaving::kTurns}) {
    SpeGroup group(memory_, {.spes = 2, .interleaving = interleaving});
    expect_deadlock(group, {{.argp = kSignal1}, {.argp = kSignal2}},
                    {"SPE 0 (waits, waits.cpp:", "waits to read SPU_RdSigNotify1",
                     "SPE 1 (waits, waits.cpp:", "waits to read SPU_RdSigNotify2"});
  }
}

TEST_F(SpeGroupTest, EveryChannelThatWaitsIsNamed) {
  const std::vector<std::pair<EntryArguments, std::string>> cases{
      {{.argp = kInMbox}, "read SPU_RdInMbox"},
      {{.argp = kOutMbox, .envp = 2}, "write SPU_WrOutMbox"},
      {{.argp = kOutIntrMbox, .envp = 2}, "write SPU_WrOutIntrMbox"},
      {{.argp = kEventStat, .envp = kLostReservationEvent}, "read SPU_RdEventStat"},
      {{.argp = kEventStat, .envp = kOutMboxEvent}, "read SPU_RdEventStat"},
      // The event is in the mask, but the decrementer was never started.
      {{.argp = kEventStat, .envp = kDecrementerEvent}, "read SPU_RdEventStat"}};
  for (const auto& [arguments, part] : cases) {
    SpeGroup group(memory_, {.spes = 1});
    expect_deadlock(group, {arguments}, {part});
  }
}

TEST_F(SpeGroupTest, OneThatStillRunsCouldEndTheOthersWait) {
  const KernelImage endless = test_image("endless");
  SpeGroup group(memory_, {.spes = 2, .deadline = 150ms});
  group.start(0, waits_, {.argp = kSignal1});
  group.start(1, endless, {});
  for (const int spe : {0, 1}) {
    const RunResult result = group.wait(spe);
    ASSERT_TRUE(result.fault);
    EXPECT_EQ(result.fault->rule, dma::Rule::kDeadlineExceeded) << result.fault->message();
  }
}

TEST_F(SpeGroupTest, SomebodyOutsideCouldEndTheWait) {
  SpeGroup group(memory_, {.spes = 1});
  std::optional<SpeGroup::Outside> outside(group);
  std::jthread other([&] {
    std::this_thread::sleep_for(50ms);
    group.problem_state(0).write_in_mbox(9);
    outside.reset();
  });
  group.start(0, waits_, {.argp = kInMbox});
  EXPECT_EQ(group.wait(0).status(), 9u);
}

TEST_F(SpeGroupTest, WhenTheLastOneOutsideLeavesItIsADeadlock) {
  SpeGroup group(memory_, {.spes = 1});
  std::optional<SpeGroup::Outside> outside(group);
  std::jthread other([&] {
    std::this_thread::sleep_for(50ms);
    outside.reset();
  });
  group.start(0, waits_, {.argp = kInMbox});
  const RunResult result = group.wait(0);
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->rule, dma::Rule::kDeadlock);
}

TEST_F(SpeGroupTest, ThePpuThatWaitsForAMailboxIsPartOfTheDeadlock) {
  SpeGroup group(memory_, {.spes = 1});
  group.start(0, waits_, {.argp = kInMbox});
  EXPECT_EQ(group.problem_state(0).wait_out_mbox(), std::nullopt);
  EXPECT_EQ(group.wait(0).fault->rule, dma::Rule::kDeadlock);
}

TEST_F(SpeGroupTest, AfterADeadlockTheGroupGoesOn) {
  SpeGroup group(memory_, {.spes = 2});
  expect_deadlock(group, {{.argp = kSignal1}, {.argp = kSignal1}}, {});
  group.problem_state(1).write_signal(1, 5);
  group.start(1, waits_, {.argp = kSignal1});
  EXPECT_EQ(group.wait(1).status(), 5u);
}

TEST_F(SpeGroupTest, ASleepPastTheDeadlineIsStopped) {
  SpeGroup group(memory_, {.spes = 1, .deadline = 100ms});
  const SpeGroup::Outside outside(group);
  group.start(0, waits_, {.argp = kInMbox});
  const RunResult result = group.wait(0);
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->rule, dma::Rule::kDeadlineExceeded);
  EXPECT_NE(result.fault->message().find("SPU_RdInMbox"), std::string::npos) << result.fault->message();
}

// ---- local stores and the proxy queue

TEST_F(SpeGroupTest, SignalsGoRoundBetweenSpes) {
  const KernelImage image = test_image("pings");
  for (const Interleaving interleaving : {Interleaving::kFree, Interleaving::kTurns}) {
    for (const char* schedule : {"eager", "lazy", "random:5"}) {
      constexpr int kSpes = 3;
      constexpr std::uint64_t kRounds = 50;
      SpeGroup group(
          memory_, {.spes = kSpes, .schedule = dma::parse_schedule(schedule), .interleaving = interleaving});
      for (int spe = 0; spe < kSpes; ++spe) {
        const auto next = group.problem_state((spe + 1) % kSpes).local_store_ea().value;
        group.start(spe, image,
                    {.spe_id = static_cast<std::uint64_t>(spe),
                     .argp = next + static_cast<std::uint64_t>(dma::SpeRegister::kSignal1),
                     .envp = kRounds});
      }
      for (int spe = 0; spe < kSpes; ++spe) {
        const RunResult result = group.wait(spe);
        ASSERT_FALSE(result.fault) << result.fault->message();
        EXPECT_EQ(result.status(), spe == 0 ? (kSpes * kRounds) & 0xFF : kSpes * (kRounds - 1) + spe);
      }
      const SpeStatistics statistics = group.statistics(1);
      EXPECT_EQ(statistics.dma.signals, kRounds);
      EXPECT_LE(statistics.waits[kSignal1].count, kRounds);
    }
  }
}

TEST_F(SpeGroupTest, TheProxyQueueMovesWhileTheSpeSleeps) {
  // A put of the PPU side into the SPE's own mailbox must arrive although nobody waits for its tag.
  for (const char* schedule : {"eager", "lazy", "random:3"}) {
    SpeGroup group(memory_, {.spes = 1, .schedule = dma::parse_schedule(schedule)});
    ProblemState& spe = group.problem_state(0);
    constexpr std::uint32_t kLetter = 0x3000C;
    group.prepare(0, waits_, {.argp = kInMbox});
    const std::uint32_t value = 77;
    std::memcpy(&spe.local_store()[kLetter], &value, sizeof value);
    group.start(0);
    const auto fault =
        spe.issue_proxy({.word = 0x20,
                         .lsa = {kLetter},
                         .ea = spe.local_store_ea() + static_cast<std::uint64_t>(dma::SpeRegister::kInMbox),
                         .size = 4,
                         .tag = 1});
    ASSERT_FALSE(fault) << fault->message();
    EXPECT_EQ(group.wait(0).status(), value) << schedule;
    EXPECT_EQ(spe.wait_proxy(1u << 1), 1u << 1);
    EXPECT_EQ(spe.free_proxy_slots(), 8);
  }
}

TEST_F(SpeGroupTest, AProxyCommandWithStartBeginsThePreparedRun) {
  SpeGroup group(memory_, {.spes = 1});
  const dma::Buffer<std::array<std::uint32_t, 32>> line(memory_, "line", 1);
  ProblemState& spe = group.problem_state(0);
  spe.write_in_mbox(3);
  group.prepare(0, waits_, {.argp = kInMbox});
  EXPECT_THROW(group.wait(0), std::logic_error) << "nothing has run yet";
  ASSERT_FALSE(spe.issue_proxy({.word = 0x48, .lsa = {0x30000}, .ea = line.ea(), .size = 128, .tag = 0}));
  EXPECT_EQ(group.wait(0).status(), 3u);
}

TEST_F(SpeGroupTest, AProxyCommandWithStartWaitsForTheWholeImage) {
  if (SC_THREAD_SANITIZER)
    GTEST_SKIP() << "the thread sanitizer reports the race that this test makes on purpose";
  const dma::Buffer<std::array<std::uint32_t, 32>> line(memory_, "line", 1);
  SpeGroup group(memory_, {.spes = 1});
  const KernelImage image = test_image("echo_arguments");
  std::jthread other([&](const std::stop_token& over) {
    while (!over.stop_requested()) {
      group.problem_state(0).issue_proxy(
          {.word = 0x48, .lsa = {0x30000}, .ea = line.ea(), .size = 128, .tag = 0});
    }
  });
  for (std::uint64_t run = 1; run <= 300; ++run) {
    group.prepare(0, image, {.argp = line.ea().value, .envp = run & 0xFF});
    while (group.statistics(0).jobs != run) std::this_thread::yield();
    const RunResult result = group.wait(0);
    ASSERT_FALSE(result.fault) << result.fault->message();
    ASSERT_EQ(result.status(), run & 0xFF);
  }
}

TEST_F(SpeGroupTest, RefusesProxyCommandsWithTheSpesNumber) {
  SpeGroup group(memory_, {.spes = 2});
  const auto fault = group.problem_state(1).issue_proxy({.word = 0xD0});
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, dma::Rule::kNotOnProxyQueue);
  EXPECT_EQ(fault->spe, 1);
}

// ---- misuse and ends

TEST_F(SpeGroupTest, RefusesWhatMakesNoSense) {
  SpeGroup group(memory_, {.spes = 2});
  EXPECT_THROW(group.problem_state(2), std::invalid_argument);
  EXPECT_THROW(group.start(-1, waits_, {}), std::invalid_argument);
  EXPECT_THROW(group.start(0), std::logic_error);
  EXPECT_THROW(group.wait(0), std::logic_error);
  group.start(0, waits_, {.argp = kInMbox});
  EXPECT_THROW(group.prepare(0, waits_, {}), std::logic_error);
  group.problem_state(0).write_in_mbox(0);
  group.wait(0);
  EXPECT_THROW(SpeGroup(memory_, {.spes = 1}), std::invalid_argument) << "SPE 0 of this memory exists";
  EXPECT_THROW(SpeGroup(memory_, {.spes = 7}), std::invalid_argument);
  Trace trace(1);
  EXPECT_THROW(SpeGroup(memory_, {.spes = 2, .trace = &trace}), std::invalid_argument);
}

TEST_F(SpeGroupTest, AnEndOfNoJobIsAFault) {
  const KernelImage image = test_image("marks_jobs");
  SpeGroup group(memory_, {.spes = 1});
  const auto run = [&](const EntryArguments& arguments) {
    group.start_resident(0, image, arguments);
    return group.wait(0);
  };
  for (const std::uint64_t before : {0u, 2u}) {
    EXPECT_FALSE(run({.argp = before}).fault);
    const RunResult result = run({.argp = before, .envp = 1});
    ASSERT_TRUE(result.fault);
    EXPECT_EQ(result.fault->rule, dma::Rule::kIllegalChannel);
    EXPECT_NE(result.fault->message().find("no job was in progress"), std::string::npos)
        << result.fault->message();
  }
}

TEST_F(SpeGroupTest, LeavesNobodyBehind) {
  const KernelImage endless = test_image("endless");
  for (const Interleaving interleaving : {Interleaving::kFree, Interleaving::kTurns}) {
    SpeGroup group(memory_, {.spes = 3, .interleaving = interleaving});
    group.start(0, endless, {});
    group.start(1, endless, {.envp = 1});
    group.start(2, waits_, {.argp = kInMbox});
  }  // the destructor stops each of them
  SpeGroup again(memory_, {.spes = 3});
  EXPECT_EQ(again.spes(), 3);
}

TEST_F(SpeGroupTest, AThreadThatCannotBeMadeIsAnErrorAndNoWait) {
  if (SC_ADDRESS_SANITIZER || SC_THREAD_SANITIZER)
    GTEST_SKIP() << "a sanitizer needs more address space than the test leaves";
  const RoomForThreads room_for_two(2);
  EXPECT_THROW(SpeGroup(memory_, {.spes = 6}), std::runtime_error);
}

TEST_F(SpeGroupTest, AFaultNamesSpeKernelAndPlace) {
  const KernelImage image = test_image("bad_dma");
  SpeGroup group(memory_, {.spes = 2});
  group.start(1, image, {.argp = dma::kMainMemoryBase.value, .envp = 24});
  const RunResult result = group.wait(1);
  ASSERT_TRUE(result.fault);
  EXPECT_EQ(result.fault->spe, 1);
  EXPECT_EQ(result.fault->kernel, "bad_dma");
  EXPECT_EQ(result.fault->place.find("bad_dma.cpp:"), 0u) << result.fault->message();
}

TEST_F(SpeGroupTest, TheTraceHasTheRunItsWaitAndItsFault) {
  Trace trace(1);
  {
    SpeGroup group(memory_, {.spes = 1, .trace = &trace});
    expect_deadlock(group, {{.argp = kInMbox}}, {});
  }
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "spe_group_test.trace.json";
  trace.write(file);
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::filesystem::remove(file);
  for (const char* part : {"waits", "SPU_RdInMbox", "deadlock"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace softcell::ls_sim
