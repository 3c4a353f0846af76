// Random command streams against a model that knows only which command must come before which: whatever an
// MFC leaves in memory, some order that the rules allow explains it; and the random schedule finds every such
// result of a small stream.
//
// Memory is seen in lines of 128 bytes, four in the local store and four in a buffer, each filled with one
// value. A stream is cut into events, which are indivisible: a get poisons its destination and then moves its
// lines, a put moves its lines, in any order.
#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

constexpr int kLines = 4;  // of local store and buffer each

/// What each line holds: those of the local store first.
using Contents = std::array<std::uint8_t, 2 * kLines>;

constexpr Contents kInitial{10, 11, 12, 13, 20, 21, 22, 23};

/// One command, or a wait for tags.
struct Step {
  MfcOpcode opcode{};
  std::uint32_t line = 0;     // of the local store; those of lists are behind each other from here on
  std::uint32_t ea_line = 0;  // of the buffer
  std::uint32_t lines = 1;    // 1 or 2; of a list: elements of one line each, in reverse order
  std::uint32_t tag = 0;
  std::uint32_t wait_mask = 0;  // not 0: no command, but a wait for all of these tags

  MfcCommand command() const { return {.word = static_cast<std::uint32_t>(opcode), .tag = tag}; }
  bool is_list() const { return command().kind() == CommandKind::kList; }
  bool moves() const { return command().is_get() || command().is_put(); }
};

std::string to_text(const std::vector<Step>& stream) {
  std::string text;
  for (const Step& step : stream) {
    text += step.wait_mask != 0 ? "wait " + std::to_string(step.wait_mask)
                                : std::string(name(step.opcode)) + " tag " + std::to_string(step.tag) +
                                      " lines " + std::to_string(step.line) + ", " +
                                      std::to_string(step.ea_line) + " x " + std::to_string(step.lines);
    text += "; ";
  }
  return text;
}

// The model.

constexpr int kPoisoned = -1;

/// A line arrives, or a few are poisoned.
struct Event {
  int from = kPoisoned;
  int to = 0;
  std::uint32_t lines = 1;
  std::uint64_t after = 0;  // events that come first
};

int local_line(const Step& step, std::uint32_t k) { return static_cast<int>(step.line + k); }

/// [CBEA, MFC command ordering] in one line for each way to order two commands, the first issued earlier.
bool must_precede(const Step& first, const Step& second) {
  const MfcCommand a = first.command();
  const MfcCommand b = second.command();
  if (a.opcode() == MfcOpcode::barrier || b.opcode() == MfcOpcode::barrier) return true;
  const auto is_sync = [](const MfcCommand& c) {
    return c.opcode() == MfcOpcode::mfcsync || c.opcode() == MfcOpcode::mfceieio;
  };
  const bool orders_both = is_sync(a) || is_sync(b) || (a.word & 1) != 0 || (b.word & 1) != 0;
  const bool fences = (b.word & 2) != 0;
  return a.tag == b.tag && (orders_both || fences);
}

std::vector<Event> events_of(const std::vector<Step>& stream) {
  std::vector<Event> events;
  std::vector<std::uint64_t> own(stream.size());     // the events of each step
  std::vector<std::uint64_t> before(stream.size());  // those that come before it
  std::uint64_t waited_for = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const Step& step = stream[i];
    if (step.wait_mask != 0) {
      for (std::size_t j = 0; j < i; ++j) {
        if (stream[j].wait_mask == 0 && (step.wait_mask >> stream[j].tag & 1) != 0) {
          waited_for |= own[j] | before[j];
        }
      }
      continue;
    }
    before[i] = waited_for;
    for (std::size_t j = 0; j < i; ++j) {
      if (stream[j].wait_mask == 0 && must_precede(stream[j], step)) before[i] |= own[j] | before[j];
    }
    if (!step.moves()) continue;
    const auto add = [&](Event event) {
      event.after |= before[i];
      own[i] |= std::uint64_t{1} << events.size();
      events.push_back(event);
      return std::uint64_t{1} << (events.size() - 1);
    };
    const bool get = step.command().is_get();
    // The lines of one get are poisoned together, before any of them arrives; those of a list's elements as
    // one element after the other is opened.
    std::uint64_t poisoned = 0;
    const auto poison = [&](std::uint32_t first, std::uint32_t lines) {
      if (get) poisoned = add({kPoisoned, local_line(step, first), lines, poisoned});
    };
    if (!step.is_list()) poison(0, step.lines);
    for (std::uint32_t k = 0; k < step.lines; ++k) {
      if (step.is_list()) poison(k, 1);
      const int local = local_line(step, k);
      const int ea = kLines + static_cast<int>(step.ea_line + (step.is_list() ? step.lines - 1 - k : k));
      add(get ? Event{ea, local, 1, poisoned} : Event{local, ea, 1, 0});
    }
  }
  return events;
}

/// Every result that some order of the events has.
std::set<Contents> possible_results(const std::vector<Step>& stream) {
  const std::vector<Event> events = events_of(stream);
  const std::uint64_t all = (std::uint64_t{1} << events.size()) - 1;
  std::set<std::pair<std::uint64_t, Contents>> seen;
  std::vector<std::pair<std::uint64_t, Contents>> open{{0, kInitial}};
  std::set<Contents> results;
  while (!open.empty()) {
    const auto [done, contents] = open.back();
    open.pop_back();
    if (done == all) results.insert(contents);
    for (std::size_t e = 0; e < events.size(); ++e) {
      if ((done >> e & 1) != 0 || (events[e].after & ~done) != 0) continue;
      Contents next = contents;
      std::fill_n(next.begin() + events[e].to, events[e].lines,
                  events[e].from == kPoisoned ? std::to_integer<std::uint8_t>(Transfer::kPoison)
                                              : contents[events[e].from]);
      const std::pair state{done | std::uint64_t{1} << e, next};
      if (seen.insert(state).second) open.push_back(state);
    }
  }
  return results;
}

// The MFC.

class ModelBench : public MfcBench {
 public:
  using MfcBench::MfcBench;

  Contents run(const std::vector<Step>& stream, std::uint64_t job) {
    mfc.begin_job(job);
    for (int line = 0; line < kLines; ++line) {
      fill_store(line * kLineBytes, kLineBytes, kInitial[line]);
      fill_buffer(line * kLineBytes, kLineBytes, kInitial[kLines + line]);
    }
    std::uint32_t list = kListLsa;
    for (const Step& step : stream) {
      if (step.wait_mask != 0) {
        wait_all(step.wait_mask);
      } else if (step.is_list()) {
        std::vector<ListElement> elements;
        for (std::uint32_t k = step.lines; k-- > 0;) {
          elements.push_back(element(kLineBytes, (step.ea_line + k) * kLineBytes));
        }
        issue_list(step.opcode, step.line * kLineBytes, elements, step.tag, list);
        list += 64;
      } else {
        issue(step.opcode, step.line * kLineBytes, step.ea_line * kLineBytes, step.lines * kLineBytes,
              step.tag);
      }
    }
    EXPECT_FALSE(mfc.drain());
    Contents contents;
    for (int line = 0; line < kLines; ++line) {
      contents[line] = static_cast<std::uint8_t>(store_at(line * kLineBytes));
      contents[kLines + line] = static_cast<std::uint8_t>(buffer_at(line * kLineBytes));
      EXPECT_EQ(count_in_store(line * kLineBytes, kLineBytes, contents[line]), kLineBytes) << "a torn line";
    }
    return contents;
  }
};

std::vector<Step> random_stream(unsigned seed, std::size_t commands) {
  std::mt19937 random(seed);
  const auto below = [&](std::uint32_t bound) { return static_cast<std::uint32_t>(random() % bound); };
  constexpr MfcOpcode kMoves[] = {
      MfcOpcode::get,   MfcOpcode::get,  MfcOpcode::getf,  MfcOpcode::getb,  MfcOpcode::getl,
      MfcOpcode::getlf, MfcOpcode::put,  MfcOpcode::put,   MfcOpcode::putf,  MfcOpcode::putb,
      MfcOpcode::putr,  MfcOpcode::putl, MfcOpcode::putrb, MfcOpcode::putlb,
  };
  constexpr MfcOpcode kOrders[] = {MfcOpcode::barrier, MfcOpcode::mfcsync, MfcOpcode::mfceieio};
  std::vector<Step> stream;
  while (stream.size() < commands) {
    if (below(8) == 0) {
      stream.push_back({.wait_mask = 1 + below(3)});
    } else if (below(6) == 0) {
      stream.push_back({.opcode = kOrders[below(3)], .tag = below(2)});
    } else {
      const std::uint32_t lines = 1 + below(2);
      stream.push_back({.opcode = kMoves[below(std::size(kMoves))],
                        .line = below(kLines - lines + 1),
                        .ea_line = below(kLines - lines + 1),
                        .lines = lines,
                        .tag = below(2)});
    }
  }
  return stream;
}

TEST(MfcModel, SomeAllowedOrderExplainsWhatEveryScheduleDoes) {
  std::vector<Schedule> schedules = all_schedules();
  std::map<std::size_t, ModelBench> benches;
  for (std::size_t i = 0; i < schedules.size(); ++i) benches.try_emplace(i, schedules[i]);
  std::size_t most_results = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const std::vector<Step> stream = random_stream(seed, 6);
    std::set<Contents> possible = possible_results(stream);
    most_results = std::max(most_results, possible.size());
    for (auto& [i, bench] : benches) {
      const Contents result = bench.run(stream, seed);
      ASSERT_TRUE(possible.contains(result))
          << to_text(stream) << "under " << to_string(schedules[i]) << ": " << testing::PrintToString(result);
    }
  }
  EXPECT_GT(most_results, 20u) << "the streams have something to choose from";
}

TEST(MfcModel, TheRandomScheduleFindsEveryResultOfASmallStream) {
  ModelBench bench({Schedule::kRandom, 1});
  std::size_t results = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const std::vector<Step> stream = random_stream(seed, 4);
    const std::set<Contents> possible = possible_results(stream);
    std::set<Contents> found;
    for (std::uint64_t job = 0; job < 100000 && found != possible; ++job) {
      found.insert(bench.run(stream, job));
    }
    ASSERT_EQ(found, possible) << to_text(stream);
    results += possible.size();
  }
  EXPECT_GT(results, 250u);
}

// The model's own sanity: what it says of streams whose results can be told by hand.
TEST(MfcModel, KnowsTheResultsOfKnownStreams) {
  const Step put{.opcode = MfcOpcode::put, .line = 0, .ea_line = 0};
  const Step other_put{.opcode = MfcOpcode::put, .line = 1, .ea_line = 0};
  const auto results_in_line = [](const std::vector<Step>& stream, int line) {
    std::set<int> values;
    for (const Contents& contents : possible_results(stream)) values.insert(contents[line]);
    return values;
  };
  EXPECT_EQ(results_in_line({put, other_put}, kLines), (std::set<int>{10, 11}));
  Step fenced = other_put;
  fenced.opcode = MfcOpcode::putf;
  EXPECT_EQ(results_in_line({put, fenced}, kLines), (std::set<int>{11}));
  EXPECT_EQ(results_in_line({put, {.wait_mask = 1}, other_put}, kLines), (std::set<int>{11}));
  EXPECT_EQ(results_in_line({put, {.opcode = MfcOpcode::barrier, .tag = 7}, other_put}, kLines),
            (std::set<int>{11}));
  EXPECT_EQ(results_in_line({put, {.opcode = MfcOpcode::mfcsync, .tag = 7}, other_put}, kLines),
            (std::set<int>{10, 11}));
  const Step get{.opcode = MfcOpcode::get, .line = 0, .ea_line = 3};
  EXPECT_EQ(results_in_line({get, put}, kLines), (std::set<int>{10, 23, 0xDB}));
}

}  // namespace
}  // namespace softcell::dma
