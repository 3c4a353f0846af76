// Threads that reach into each other's local stores as SPEs and the PPU do. Runs under thread sanitizer too.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "fake_spe.h"
#include "mfc_fixture.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/mfc.h"
#include "softcell/dma/proxy_queue.h"

namespace softcell::dma {
namespace {

/// One SPE's local store and MFC, mapped while it lives.
struct MappedSpe {
  MappedSpe(AddressSpace& memory, int spe, Schedule schedule = {Schedule::kEager, 0})
      : space(memory), number(spe), mfc(port.store, memory, schedule, static_cast<std::uint64_t>(spe)) {
    space.map_local_store(number, port);
  }
  ~MappedSpe() { space.unmap_local_store(number); }
  MappedSpe(const MappedSpe&) = delete;
  MappedSpe& operator=(const MappedSpe&) = delete;

  void issue(MfcOpcode opcode, std::uint32_t lsa, EffectiveAddress ea, std::uint32_t size) {
    const std::optional<Fault> fault = mfc.issue(command(opcode, lsa, ea, size, 0));
    ASSERT_FALSE(fault) << fault->message();
  }
  void wait() {
    mfc.write_tag_mask(1);
    mfc.write_tag_update(2);
    mfc.read_tag_status();
  }
  // As a kernel looks at its own local store while others write to it.
  std::uint32_t look_at(std::uint32_t lsa) {
    return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(port.store.data() + lsa)).load();
  }
  std::uint32_t* words(std::uint32_t lsa) {
    return reinterpret_cast<std::uint32_t*>(port.store.data() + lsa);
  }

  AddressSpace& space;
  const int number;
  FakeSpe port;
  Mfc mfc;
};

constexpr std::uint32_t kData = 0x1000;
constexpr std::uint32_t kDataBytes = 1024;
constexpr std::uint32_t kFlag = 0x2000;  // a quadword
constexpr std::uint32_t kSource = 0x3000;
constexpr int kWriterRounds = 2000;

// The usual hand-over between SPEs: data, then behind a fence the flag that the other one polls.
class LocalStoreStress : public testing::TestWithParam<Schedule> {};

TEST_P(LocalStoreStress, AFlagBehindAFenceComesAfterItsData) {
  AddressSpace space;
  MappedSpe one(space, 0, GetParam());
  MappedSpe two(space, 1, GetParam());
  // Sends in even rounds, receives in odd ones; `phase` tells which SPE begins.
  const auto run = [](MappedSpe& own, const MappedSpe& other, std::uint32_t phase) {
    int wrong = 0;
    for (std::uint32_t round = 1; round <= kWriterRounds; ++round) {
      if (round % 2 == phase) {
        std::fill_n(own.words(kSource), kDataBytes / 4 + 4, round);
        own.issue(MfcOpcode::put, kSource, local_store_ea(other.number) + kData, kDataBytes);
        own.issue(MfcOpcode::putf, kSource + kDataBytes, local_store_ea(other.number) + kFlag, 16);
        own.wait();
      } else {
        while (own.look_at(kFlag) != round) std::this_thread::yield();
        wrong += static_cast<int>(kDataBytes / 4 -
                                  std::count(own.words(kData), own.words(kData) + kDataBytes / 4, round));
      }
    }
    return wrong;
  };
  std::array<int, 2> wrong{};
  std::thread first([&] { wrong[0] = run(one, two, 0); });
  std::thread second([&] { wrong[1] = run(two, one, 1); });
  first.join();
  second.join();
  EXPECT_EQ(wrong, (std::array<int, 2>{}));
}

INSTANTIATE_TEST_SUITE_P(Schedules, LocalStoreStress,
                         testing::Values(Schedule{Schedule::kEager, 0}, Schedule{Schedule::kLazy, 0},
                                         Schedule{Schedule::kRandom, 1}),
                         schedule_test_name);

// A quadword that some put and others get, while its owner puts it to main storage, has one of the values.
TEST(LocalStoreThreads, AQuadwordArrivesWhole) {
  AddressSpace space;
  Buffer<std::uint32_t> copies(space, "copies", 4);
  std::vector<std::unique_ptr<MappedSpe>> spes;
  for (int number = 0; number < 4; ++number) spes.push_back(std::make_unique<MappedSpe>(space, number));
  const auto is_whole = [](const std::uint32_t* quadword) {
    return std::all_of(quadword, quadword + 4, [&](std::uint32_t word) { return word == quadword[0]; });
  };
  std::atomic<int> torn{0};
  std::vector<std::thread> threads;
  for (int number = 0; number < 4; ++number) {
    threads.emplace_back([&, number] {
      MappedSpe& own = *spes[static_cast<std::size_t>(number)];
      for (std::uint32_t round = 0; round < kWriterRounds; ++round) {
        if (number < 2) {
          std::fill_n(own.words(kSource), 4, round + (number == 0 ? 0 : 1u << 31));
          own.issue(MfcOpcode::put, kSource, local_store_ea(3) + kFlag, 16);
        } else if (number == 2) {
          own.issue(MfcOpcode::get, kFlag, local_store_ea(3) + kFlag, 16);
          if (!is_whole(own.words(kFlag))) ++torn;
        } else {
          own.issue(MfcOpcode::put, kFlag, copies.ea(), 16);
          if (!is_whole(copies.data())) ++torn;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(spes[3]->port.writes.size(), 2u * kWriterRounds);
}

TEST(LocalStoreThreads, NoSignalIsLost) {
  AddressSpace space;
  MappedSpe target(space, 5);
  std::vector<std::thread> threads;
  for (int number = 0; number < 5; ++number) {
    threads.emplace_back([&, number] {
      MappedSpe own(space, number);
      const EffectiveAddress signal = local_store_ea(5) + static_cast<std::uint64_t>(SpeRegister::kSignal1);
      for (std::uint32_t round = 0; round < kWriterRounds; ++round) {
        *own.words(0xC) = round;
        own.issue(MfcOpcode::sndsig, 0xC, signal, 4);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  ASSERT_EQ(target.port.registers.size(), 5u * kWriterRounds);
  std::uint64_t sum = 0;
  for (const auto& [which, value] : target.port.registers) sum += value;
  EXPECT_EQ(sum, 5ull * kWriterRounds * (kWriterRounds - 1) / 2);
}

// Two threads of the PPU side and the SPE's own share one proxy queue.
TEST(ProxyQueueThreads, EveryCommandMovesItsBytesAndStartsOnce) {
  AddressSpace space;
  FakeSpe spe;
  Buffer<std::uint32_t> buffer(space, "buffer", 2 * kWriterRounds * 4);
  for (std::uint32_t i = 0; i < buffer.size(); ++i) buffer[i] = i;
  std::atomic<int> starts{0};
  ProxyQueue queue(spe, space, {Schedule::kRandom, 7}, 0, [&] { ++starts; });

  std::atomic<int> running{2};
  std::vector<std::thread> threads;
  for (std::uint32_t number = 0; number < 2; ++number) {
    threads.emplace_back([&, number] {
      for (std::uint32_t i = 0; i < kWriterRounds; ++i) {
        const std::uint32_t at = (number * kWriterRounds + i) * 16;
        const MfcOpcode opcode = i % 4 == 0 ? MfcOpcode::gets : MfcOpcode::get;
        EXPECT_FALSE(queue.issue(command(opcode, at, buffer.ea() + at, 16, number)));
      }
      EXPECT_EQ(queue.wait_all(1u << number), 1u << number);
      --running;
    });
  }
  while (running.load() != 0) {
    queue.visit();
    std::this_thread::yield();
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(starts, 2 * kWriterRounds / 4);
  EXPECT_TRUE(std::equal(buffer.data(), buffer.data() + buffer.size(),
                         reinterpret_cast<const std::uint32_t*>(spe.store.data())));
}

}  // namespace
}  // namespace softcell::dma
