// Threads that fight for lines as six SPEs and the PPU do. Runs under thread sanitizer too.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <functional>
#include <thread>
#include <vector>

#include "softcell/dma/atomics.h"
#include "softcell/dma/buffer.h"

namespace softcell::dma {
namespace {

constexpr std::uint32_t kWordsPerLine = kLineBytes / sizeof(std::uint32_t);

struct LossCounter : ReservationListener {
  void on_reservation_lost() override { losses.fetch_add(1); }
  std::atomic<int> losses{0};
};

/// What a kernel has: one line of its local store, and the line commands for buffers of main storage.
class SpeLike {
 public:
  explicit SpeLike(Buffer<std::uint32_t>& storage, AddressSpace& space,
                   ReservationListener* listener = nullptr)
      : storage_(storage), reservations_(space.reservations()), holder_(reservations_, listener) {}

  void getllar(std::uint32_t index) {
    reservations_.load_and_reserve(holder_, storage_.ea(index), host(index), bytes(line.data()));
  }
  bool putllc(std::uint32_t index) {
    return reservations_.store_conditional(holder_, storage_.ea(index), host(index), bytes(line.data()));
  }
  void putlluc(std::uint32_t index) {
    reservations_.store_line(holder_, storage_.ea(index), host(index), bytes(line.data()));
  }
  void get(std::uint32_t index, std::uint32_t* to, std::uint32_t words) {
    reservations_.read(holder_, storage_.ea(index), host(index), bytes(to), words * 4);
  }
  void put(std::uint32_t index, const std::uint32_t* from, std::uint32_t words) {
    reservations_.write(holder_, storage_.ea(index), host(index), reinterpret_cast<const std::byte*>(from),
                        words * 4);
  }

  /// getllar, change(line), putllc, until it has stored; change() may say that there is nothing to store yet.
  template <class Change>
  void update(std::uint32_t index, Change&& change) {
    for (;;) {
      getllar(index);
      if (!change(line)) {
        std::this_thread::yield();
      } else if (putllc(index)) {
        return;
      }
    }
  }

  alignas(kLineBytes) std::array<std::uint32_t, kWordsPerLine> line{};

 private:
  static std::byte* bytes(std::uint32_t* words) { return reinterpret_cast<std::byte*>(words); }
  std::byte* host(std::uint32_t index) { return bytes(storage_.data() + index); }

  Buffer<std::uint32_t>& storage_;
  Reservations& reservations_;
  ReservationHolder holder_;
};

void run_threads(int count, const std::function<void(int)>& body) {
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) threads.emplace_back(body, i);
  for (std::thread& thread : threads) thread.join();
}

class ReservationsStress : public testing::Test {
 protected:
  static constexpr std::uint32_t kLines = 64;

  AddressSpace space_;
  Buffer<std::uint32_t> storage_{space_, "storage", kLines* kWordsPerLine};
};

TEST_F(ReservationsStress, SixSpesAndThePpuCountToAMillion) {
  constexpr std::uint32_t kAll = 1'000'000;
  constexpr std::uint32_t kEach = kAll / (kSpeCount + 1);
  run_threads(kSpeCount + 1, [&](int number) {
    if (number < kSpeCount) {
      SpeLike spe(storage_, space_);
      for (std::uint32_t i = 0; i < kEach; ++i) {
        spe.update(0, [](auto& line) {
          ++line[5];
          return true;
        });
      }
    } else {
      Atomics ppu(space_);
      for (std::uint32_t i = 0; i < kAll - kSpeCount * kEach; ++i) {
        ppu.fetch_add<std::uint32_t>(storage_.ea(5), 1);
      }
    }
  });
  EXPECT_EQ(storage_[5], kAll);
}

// The lock guards 512 bytes that only long copies touch.
TEST_F(ReservationsStress, ALockLetsOneInAtATime) {
  constexpr std::uint32_t kLock = 0;
  constexpr std::uint32_t kGuarded = kWordsPerLine;
  constexpr std::uint32_t kGuardedWords = 4 * kWordsPerLine;
  constexpr std::uint32_t kEach = 2000;
  std::atomic<int> torn{0};
  run_threads(kSpeCount, [&](int) {
    SpeLike spe(storage_, space_);
    alignas(kLineBytes) std::array<std::uint32_t, kGuardedWords> guarded;
    for (std::uint32_t i = 0; i < kEach; ++i) {
      spe.update(kLock, [](auto& line) { return line[0] == 0 && ++line[0] == 1; });
      spe.get(kGuarded, guarded.data(), kGuardedWords);
      for (std::uint32_t& word : guarded) {
        if (word != guarded[0]) ++torn;
      }
      for (std::uint32_t& word : guarded) ++word;
      spe.put(kGuarded, guarded.data(), kGuardedWords);
      spe.line.fill(0);
      spe.putlluc(kLock);
    }
  });
  EXPECT_EQ(torn, 0);
  for (std::uint32_t word = 0; word < kGuardedWords; ++word) {
    ASSERT_EQ(storage_[kGuarded + word], kSpeCount * kEach) << word;
  }
}

// A queue in one line: words 0 and 1 count what was put and taken, the others hold it.
TEST_F(ReservationsStress, AQueueLosesAndDoublesNothing) {
  constexpr std::uint32_t kSlots = kWordsPerLine - 2;
  constexpr std::uint32_t kProducers = 3;
  constexpr std::uint32_t kEach = 5000;
  std::vector<std::vector<std::uint32_t>> taken(kProducers);
  run_threads(2 * kProducers, [&](int number) {
    SpeLike spe(storage_, space_);
    const auto producer = static_cast<std::uint32_t>(number);
    if (producer < kProducers) {
      for (std::uint32_t i = 0; i < kEach; ++i) {
        spe.update(0, [&](auto& line) {
          if (line[0] - line[1] == kSlots) return false;
          line[2 + line[0]++ % kSlots] = producer * kEach + i;
          return true;
        });
      }
    } else {
      for (std::uint32_t i = 0; i < kEach; ++i) {
        std::uint32_t value = 0;
        spe.update(0, [&](auto& line) {
          if (line[0] == line[1]) return false;
          value = line[2 + line[1]++ % kSlots];
          return true;
        });
        taken[producer - kProducers].push_back(value);
      }
    }
  });
  std::vector<std::uint32_t> all;
  for (const auto& values : taken) {
    for (std::uint32_t from = 0; from < kProducers; ++from) {
      std::vector<std::uint32_t> mine;
      std::copy_if(values.begin(), values.end(), std::back_inserter(mine),
                   [&](std::uint32_t value) { return value / kEach == from; });
      EXPECT_TRUE(std::is_sorted(mine.begin(), mine.end())) << "first in, first out";
    }
    all.insert(all.end(), values.begin(), values.end());
  }
  std::sort(all.begin(), all.end());
  ASSERT_EQ(all.size(), kProducers * kEach);
  for (std::uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i);
}

// Word 0 counts arrivals, word 1 phases. Waiting is polling by small gets.
TEST_F(ReservationsStress, ABarrierLetsNobodyRunAhead) {
  constexpr std::uint32_t kPhases = 1000;
  constexpr std::uint32_t kOwnLines = kWordsPerLine;
  std::atomic<int> wrong{0};
  run_threads(kSpeCount, [&](int number) {
    SpeLike spe(storage_, space_);
    const std::uint32_t own = kOwnLines + static_cast<std::uint32_t>(number) * 2 * kWordsPerLine;
    alignas(kLineBytes) std::array<std::uint32_t, 2 * kWordsPerLine> lines;
    const auto meet = [&](std::uint32_t phase) {
      spe.update(0, [](auto& line) {
        if (++line[0] == kSpeCount) {
          line[0] = 0;
          ++line[1];
        }
        return true;
      });
      alignas(16) std::array<std::uint32_t, 4> state;
      for (spe.get(0, state.data(), 4); state[1] != phase; spe.get(0, state.data(), 4)) {
        std::this_thread::yield();
      }
    };
    for (std::uint32_t phase = 0; phase < kPhases; ++phase) {
      lines.fill(phase);
      spe.put(own, lines.data(), 2 * kWordsPerLine);
      meet(2 * phase + 1);
      const auto other = (static_cast<std::uint32_t>(number) + 1 + phase % (kSpeCount - 1)) % kSpeCount;
      spe.get(kOwnLines + other * 2 * kWordsPerLine, lines.data(), 2 * kWordsPerLine);
      wrong += static_cast<int>(
          std::count_if(lines.begin(), lines.end(), [&](std::uint32_t word) { return word != phase; }));
      meet(2 * phase + 2);
    }
  });
  EXPECT_EQ(wrong, 0);
}

// The line in the middle is reserved and stored whole by some, while others copy all five, until both have
// happened often enough.
class LongCopy : public ReservationsStress {
 protected:
  static constexpr std::uint32_t kReserved = 2 * kWordsPerLine;
  static constexpr std::uint32_t kWords = 5 * kWordsPerLine;
  static constexpr int kRounds = 20'000;

  template <class Words>
  static bool is_uniform(const Words& words) {
    return std::all_of(words.begin(), words.end(), [&](std::uint32_t word) { return word == words[0]; });
  }

  // Reserves, looks, and stores the line with another value, until `running` is over.
  void store_whole_lines(const std::atomic<int>& running, std::uint32_t first_value) {
    SpeLike spe(storage_, space_);
    for (std::uint32_t value = first_value; running.load() != 0; ++value) {
      spe.getllar(kReserved);
      if (!is_uniform(spe.line)) ++torn_;
      spe.line.fill(value);
      stored_ += spe.putllc(kReserved) ? 1 : 0;
    }
  }

  std::atomic<int> torn_{0};
  std::atomic<int> stored_{0};
};

TEST_F(LongCopy, ReadsNoHalfStoredLine) {
  std::atomic<int> running{2};
  run_threads(4, [&](int number) {
    if (number < 2) return store_whole_lines(running, static_cast<std::uint32_t>(number) << 31);
    SpeLike reader(storage_, space_);
    alignas(kLineBytes) std::array<std::uint32_t, kWords> words;
    for (int round = 0; round < kRounds || stored_ == 0; ++round) {
      reader.get(0, words.data(), kWords);
      std::copy_n(words.begin() + kReserved, kWordsPerLine, reader.line.begin());
      if (!is_uniform(reader.line)) ++torn_;
    }
    --running;
  });
  EXPECT_EQ(torn_, 0);
}

TEST_F(LongCopy, WritesNoHalfLineUnderAReservation) {
  std::atomic<int> running{1};
  run_threads(4, [&](int number) {
    if (number < 3) return store_whole_lines(running, static_cast<std::uint32_t>(number) << 30);
    SpeLike writer(storage_, space_);
    alignas(kLineBytes) std::array<std::uint32_t, kWords> words;
    for (int round = 0; round < kRounds || stored_ == 0; ++round) {
      words.fill(0xC000'0000 + static_cast<std::uint32_t>(round));
      writer.put(0, words.data(), kWords);
    }
    --running;
  });
  EXPECT_EQ(torn_, 0);
}

// Between a getllar and a putllc that stores, a long put must not slip in: what it wrote would be lost.
TEST_F(LongCopy, IsNeverOverwrittenByAPutllcThatCameBefore) {
  constexpr int kPuts = 5000;
  std::atomic<int> running{1};
  std::atomic<int> lost{0};
  run_threads(3, [&](int number) {
    SpeLike spe(storage_, space_);
    if (number < 2) {
      // Word 1 is the writer's; a putllc stores it as it was read.
      while (running.load() != 0) {
        spe.getllar(kReserved);
        ++spe.line[0];
        spe.putllc(kReserved);
      }
      return;
    }
    alignas(kLineBytes) std::array<std::uint32_t, kWords> words{};
    for (std::uint32_t round = 1; round <= kPuts; ++round) {
      words.fill(round);
      spe.put(0, words.data(), kWords);
      alignas(16) std::array<std::uint32_t, 4> back;
      spe.get(kReserved, back.data(), 4);
      if (back[1] != round) ++lost;
    }
    --running;
  });
  EXPECT_EQ(lost, 0);
}

TEST_F(ReservationsStress, EveryLossIsToldOnceAndByThen) {
  constexpr int kRounds = 3000;
  LossCounter counter;
  std::atomic<int> armed{0};
  run_threads(2, [&](int number) {
    if (number == 0) {
      SpeLike spe(storage_, space_, &counter);
      for (int round = 1; round <= kRounds; ++round) {
        spe.getllar(0);
        armed.store(round);
        while (counter.losses.load() != round) std::this_thread::yield();
        EXPECT_FALSE(spe.putllc(0));
      }
    } else {
      SpeLike writer(storage_, space_);
      alignas(16) const std::array<std::uint32_t, 2 * kWordsPerLine> words{};
      for (int round = 1; round <= kRounds; ++round) {
        while (armed.load() != round) std::this_thread::yield();
        writer.put(0, words.data(), round % 2 == 0 ? 4 : 2 * kWordsPerLine);
      }
    }
  });
  EXPECT_EQ(counter.losses, kRounds);
}

// The listener takes its time, so that whoever does not wait for it is ahead of it.
TEST_F(ReservationsStress, NothingIsHeardOfAReservationGivenUp) {
  struct SlowCounter : LossCounter {
    void on_reservation_lost() override {
      std::this_thread::yield();
      LossCounter::on_reservation_lost();
    }
  };
  constexpr int kRounds = 500;
  SlowCounter counter;
  std::atomic<bool> running{true};
  int late = 0;
  run_threads(2, [&](int number) {
    if (number == 0) {
      SpeLike spe(storage_, space_, &counter);
      for (int round = 0; round < kRounds; ++round) {
        spe.getllar(0);
        std::this_thread::yield();
        spe.getllar(kWordsPerLine);  // which nobody writes
        const int before = counter.losses.load();
        std::this_thread::yield();
        if (counter.losses.load() != before) ++late;
      }
      running = false;
    } else {
      SpeLike writer(storage_, space_);
      while (running.load()) writer.putlluc(0);
    }
  });
  EXPECT_EQ(late, 0);
}

}  // namespace
}  // namespace softcell::dma
