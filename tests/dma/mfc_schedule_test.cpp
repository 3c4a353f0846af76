// The promise of schedules: a correct kernel gives the same bits under each, a wrong one does not.
#include <algorithm>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

constexpr Schedule random_schedule(std::uint64_t seed) { return {Schedule::kRandom, seed}; }

constexpr std::uint32_t kWindow = 8192;  // programs work on the first bytes of local store and buffer

/// One step of a program: a command, a wait, or the SPU changing bytes of its local store.
struct Step {
  enum Kind { kIssue, kWaitAll, kWaitAny, kCompute } kind;
  MfcOpcode opcode{};
  std::uint32_t lsa = 0;
  std::uint32_t offset = 0;  // in the buffer
  std::uint32_t size = 0;
  std::uint32_t tag = 0;
  std::uint32_t mask = 0;
};

bool overlap(std::uint32_t a, std::uint32_t a_size, std::uint32_t b, std::uint32_t b_size) {
  return a < b + b_size && b < a + a_size;
}

bool is_get(const Step& step) { return MfcCommand{.word = static_cast<std::uint32_t>(step.opcode)}.is_get(); }

/// True when the two commands touch the same bytes and at least one writes them.
bool conflict(const Step& a, const Step& b) {
  const bool in_store = overlap(a.lsa, a.size, b.lsa, b.size) && (is_get(a) || is_get(b));
  const bool in_buffer = overlap(a.offset, a.size, b.offset, b.size) && !(is_get(a) && is_get(b));
  return in_store || in_buffer;
}

/// Random programs that keep the rules of the MFC: whatever touches the bytes of a command in flight is
/// ordered behind it, by a fence or barrier when the tag is the same, by a wait otherwise.
class ProgramMaker {
 public:
  explicit ProgramMaker(unsigned seed) : random_(seed) {}

  std::vector<Step> make(int commands) {
    for (int i = 0; i < commands; ++i) {
      if (below(5) == 0) add_compute();
      if (below(12) == 0) program_.push_back({.kind = Step::kWaitAny, .mask = 1u + below(255)});
      add_command();
    }
    wait(~0u);
    return std::move(program_);
  }

 private:
  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random_() % bound); }

  void wait(std::uint32_t mask) {
    program_.push_back({.kind = Step::kWaitAll, .mask = mask});
    std::erase_if(in_flight_, [&](const Step& step) { return mask >> step.tag & 1; });
  }

  void add_compute() {
    const std::uint32_t size = 16 * (1 + below(32));
    const std::uint32_t lsa = 16 * below((kWindow - size) / 16);
    std::uint32_t mask = 0;
    for (const Step& step : in_flight_) {
      if (overlap(lsa, size, step.lsa, step.size)) mask |= 1u << step.tag;
    }
    if (mask != 0) wait(mask);
    program_.push_back({.kind = Step::kCompute, .lsa = lsa, .size = size});
  }

  void add_command() {
    Step step{.kind = Step::kIssue, .opcode = below(2) == 0 ? MfcOpcode::get : MfcOpcode::put};
    if (below(4) == 0) {
      step.size = 1u << below(4);
      const std::uint32_t low = step.size * below(16 / step.size);
      step.lsa = 16 * below(kWindow / 16) + low;
      step.offset = 16 * below(kWindow / 16) + low;
    } else {
      step.size = 16 * (1 + below(64));
      step.lsa = 16 * below((kWindow - step.size) / 16);
      step.offset = 16 * below((kWindow - step.size) / 16);
    }
    step.tag = below(4);

    bool conflicts = false;
    std::uint32_t others = 0;
    for (const Step& earlier : in_flight_) {
      if (!conflict(step, earlier)) continue;
      (earlier.tag == step.tag ? conflicts = true : (others |= 1u << earlier.tag) != 0);
    }
    if (others != 0) wait(others);
    // 1: barrier, 2: fence, as in the opcode; some where none is needed.
    const std::uint32_t order = conflicts ? 1 + below(2) : below(8) == 0 ? 1 + below(2) : 0;
    step.opcode = static_cast<MfcOpcode>(static_cast<std::uint32_t>(step.opcode) | order);
    program_.push_back(step);
    in_flight_.push_back(step);
  }

  std::mt19937 random_;
  std::vector<Step> program_;
  std::vector<Step> in_flight_;
};

void compute(std::span<std::byte> bytes) {
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(std::to_integer<unsigned>(byte) * 5 + 1);
}

struct Outcome {
  std::vector<std::byte> store, buffer;
  bool operator==(const Outcome&) const = default;
};

Outcome initial_contents() {
  Outcome contents{std::vector<std::byte>(kWindow), std::vector<std::byte>(kWindow)};
  for (std::size_t i = 0; i < kWindow; ++i) {
    contents.store[i] = static_cast<std::byte>(i * 3 % 251);
    contents.buffer[i] = static_cast<std::byte>(i * 7 % 241 + 1);
  }
  return contents;
}

/// What the program means: every command at once, in program order.
Outcome run_in_program_order(const std::vector<Step>& program) {
  Outcome now = initial_contents();
  for (const Step& step : program) {
    if (step.kind == Step::kCompute) compute(std::span(now.store).subspan(step.lsa, step.size));
    if (step.kind != Step::kIssue) continue;
    const bool get = is_get(step);
    const auto from = get ? now.buffer.begin() + step.offset : now.store.begin() + step.lsa;
    std::copy_n(from, step.size, get ? now.store.begin() + step.lsa : now.buffer.begin() + step.offset);
  }
  return now;
}

Outcome run(const std::vector<Step>& program, Schedule schedule) {
  MfcBench bench(schedule);
  const Outcome initial = initial_contents();
  std::copy(initial.store.begin(), initial.store.end(), bench.store.begin());
  std::copy(initial.buffer.begin(), initial.buffer.end(), bench.buffer.data());
  for (const Step& step : program) {
    switch (step.kind) {
      case Step::kIssue:
        bench.issue(step.opcode, step.lsa, step.offset, step.size, step.tag);
        break;
      case Step::kWaitAll:
        bench.wait_all(step.mask);
        break;
      case Step::kWaitAny:
        bench.wait_any(step.mask);
        break;
      case Step::kCompute:
        compute(std::span(bench.store).subspan(step.lsa, step.size));
        break;
    }
  }
  return {{bench.store.begin(), bench.store.begin() + kWindow},
          {bench.buffer.data(), bench.buffer.data() + kWindow}};
}

TEST(MfcSchedules, CorrectProgramsGiveTheBitsOfProgramOrder) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const std::vector<Step> program = ProgramMaker(seed).make(60);
    const Outcome expected = run_in_program_order(program);
    for (const Schedule& schedule : {kEager, kLazy, random_schedule(seed), random_schedule(seed + 1000)}) {
      ASSERT_TRUE(run(program, schedule) == expected)
          << "program " << seed << " under " << to_string(schedule);
    }
  }
}

// The generator's fences are needed: without them, programs differ.
TEST(MfcSchedules, ProgramsWithTheirFencesRemovedAreFound) {
  int found_lazy = 0;
  int found_random = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::vector<Step> program = ProgramMaker(seed).make(60);
    const Outcome expected = run_in_program_order(program);
    for (Step& step : program) {
      step.opcode = static_cast<MfcOpcode>(static_cast<std::uint32_t>(step.opcode) & ~3u);
    }
    EXPECT_TRUE(run(program, kEager) == expected) << "eager is program order";
    found_lazy += run(program, kLazy) != expected;
    for (const std::uint64_t random_seed : {1, 2, 3, 4}) {
      if (run(program, random_schedule(random_seed)) == expected) continue;
      ++found_random;
      break;
    }
  }
  EXPECT_GE(found_lazy, 35);
  EXPECT_GE(found_random, 35);
}

TEST(MfcSchedules, ReadingBeforeTheWaitIsFound) {
  const auto early_read = [](Schedule schedule) {
    MfcBench bench(schedule);
    bench.fill_buffer(0, 1024, 1);
    bench.issue(MfcOpcode::get, 0, 0, 1024, 0);
    const auto arrived = bench.count_in_store(0, 1024, 1);
    bench.wait_all(1);
    EXPECT_EQ(bench.count_in_store(0, 1024, 1), 1024);
    return arrived;
  };
  EXPECT_EQ(early_read(kEager), 1024);
  EXPECT_EQ(early_read(kLazy), 0);
  std::set<std::ptrdiff_t> seen;
  for (std::uint64_t seed = 0; seed < 200; ++seed) seen.insert(early_read(random_schedule(seed)));
  EXPECT_TRUE(seen.contains(0));
  EXPECT_TRUE(seen.contains(1024));
  EXPECT_EQ(seen.size(), 9u) << "0 to 8 of the 8 lines";
}

// What is in a get's destination until its tag was waited for is nobody's business. Poison there makes a
// kernel fail that would come away with old bytes, and only the random schedule has it.
TEST(MfcSchedules, RandomPoisonsTheDestinationOfAGetInFlight) {
  const auto early_look = [](MfcBench& bench) {
    bench.fill_store(0, 1024, 1);
    bench.fill_buffer(0, 1024, 1);
    bench.issue(MfcOpcode::get, 128, 128, 512, 0);
    const auto poisoned = bench.count_in_store(0, 1024, std::to_integer<int>(Transfer::kPoison));
    EXPECT_LE(poisoned, 512);
    bench.wait_all(1);
    EXPECT_EQ(bench.count_in_store(0, 1024, 1), 1024);
    return poisoned;
  };
  std::set<std::ptrdiff_t> seen;
  MfcBench bench(random_schedule(1));
  for (std::uint64_t job = 0; job < 200; ++job) {
    bench.mfc.begin_job(job);
    seen.insert(early_look(bench));
  }
  EXPECT_EQ(seen, (std::set<std::ptrdiff_t>{0, 128, 256, 384, 512}));
  for (const Schedule& schedule : {kEager, kLazy}) {
    MfcBench calm(schedule);
    EXPECT_EQ(early_look(calm), 0);
  }
}

// A fenced get has not started while the put before it reads its destination.
TEST(MfcSchedules, RandomPoisonsNothingBeforeATransferMayStart) {
  MfcBench bench(random_schedule(1));
  for (std::uint64_t job = 0; job < 300; ++job) {
    bench.mfc.begin_job(job);
    bench.fill_store(0, 1024, 1);
    bench.issue(MfcOpcode::put, 0, 0, 1024, 0);
    bench.issue(MfcOpcode::getf, 0, 4096, 1024, 0);
    bench.wait_all(1);
    ASSERT_EQ(std::count(bench.buffer.data(), bench.buffer.data() + 1024, std::byte{1}), 1024) << job;
  }
}

TEST(MfcSchedules, OverwritingTheSourceOfAPutIsFound) {
  const auto early_write = [](Schedule schedule) {
    MfcBench bench(schedule);
    bench.fill_store(0, 1024, 1);
    bench.issue(MfcOpcode::put, 0, 0, 1024, 0);
    bench.fill_store(0, 1024, 2);
    bench.wait_all(1);
    return std::count(bench.buffer.data(), bench.buffer.data() + 1024, std::byte{2});
  };
  EXPECT_EQ(early_write(kEager), 0);
  EXPECT_EQ(early_write(kLazy), 1024);
}

TEST(MfcSchedules, RandomMovesTheLinesOfOneCommandInManyOrders) {
  std::set<std::vector<bool>> arrivals;  // which lines were there while some were missing
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    MfcBench bench(random_schedule(seed));
    bench.fill_buffer(0, 512, 1);
    bench.issue(MfcOpcode::get, 0, 0, 512, 0);
    std::vector<bool> lines;
    for (std::uint32_t line = 0; line < 4; ++line) {
      const auto there = bench.count_in_store(line * 128, 128, 1);
      ASSERT_TRUE(there == 0 || there == 128) << "a line moves as a whole";
      lines.push_back(there == 128);
    }
    arrivals.insert(lines);
  }
  EXPECT_EQ(arrivals.size(), 16u) << "every subset of four lines";
}

TEST(MfcSchedules, RandomCompletesTwoTagsInBothOrders) {
  std::set<std::uint32_t> first_done;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    MfcBench bench(random_schedule(seed));
    bench.issue(MfcOpcode::get, 0, 0, 512, 0);
    bench.issue(MfcOpcode::get, 512, 512, 512, 1);
    first_done.insert(bench.wait_any(3));
  }
  EXPECT_EQ(first_done, (std::set<std::uint32_t>{1, 2, 3}));
}

// Fifteen commands of tag 1 fill the local store while one of tag 0 is waited for. A visit to the MFC moves
// fewer than 128 lines, so more than that have moved during the wait itself.
TEST(MfcSchedules, RandomMovesOtherTagsDuringAWaitToo) {
  constexpr std::uint32_t kCommandBytes = 16384;
  int seeds_with_others_moving = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    MfcBench bench(random_schedule(seed));
    bench.fill_buffer(0, kCommandBytes, 1);
    const auto lines_of_others = [&] {
      return bench.count_in_store(kCommandBytes, 15 * kCommandBytes, 1) / kLineBytes;
    };
    for (std::uint32_t i = 1; i < 16; ++i)
      bench.issue(MfcOpcode::get, i * kCommandBytes, 0, kCommandBytes, 1);
    bench.issue(MfcOpcode::get, 0, 0, kCommandBytes, 0);
    const auto before = lines_of_others();
    bench.wait_all(1);
    seeds_with_others_moving += lines_of_others() - before > 128;
  }
  EXPECT_GE(seeds_with_others_moving, 15);
}

// What an early reader sees after each of some commands: a fingerprint of the decisions taken.
std::vector<std::ptrdiff_t> decisions(MfcBench& bench) {
  std::vector<std::ptrdiff_t> seen;
  bench.fill_store(0, 16384, 0);
  bench.fill_buffer(0, 16384, 1);
  for (std::uint32_t i = 0; i < 8; ++i) {
    bench.issue(MfcOpcode::get, i * 2048, i * 2048, 2048, i);
    seen.push_back(bench.count_in_store(0, 16384, 1));
  }
  bench.wait_all(0xFF);
  return seen;
}

TEST(MfcSchedules, RandomDependsOnSeedAndJobAndNotOnTheSpe) {
  MfcBench first(random_schedule(7), 0);
  MfcBench second(random_schedule(7), 5);
  EXPECT_NE(decisions(first), decisions(second)) << "before any job, streams are told apart by the SPE";

  first.mfc.begin_job(41);
  second.mfc.begin_job(40);
  const auto of_job_41 = decisions(first);
  EXPECT_NE(of_job_41, decisions(second));
  second.mfc.begin_job(41);
  EXPECT_EQ(of_job_41, decisions(second));

  MfcBench other_seed(random_schedule(8), 0);
  other_seed.mfc.begin_job(41);
  EXPECT_NE(of_job_41, decisions(other_seed));
}

}  // namespace
}  // namespace softcell::dma
