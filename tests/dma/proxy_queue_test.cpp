#include "softcell/dma/proxy_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "fake_spe.h"
#include "mfc_fixture.h"
#include "softcell/dma/buffer.h"

namespace softcell::dma {
namespace {

/// The queue of an SPE that is mapped as number 0, and a buffer.
struct ProxyBench {
  explicit ProxyBench(Schedule schedule)
      : queue(spe, space, schedule, 0, [this] { starts.push_back(seen_at_start()); }) {
    space.map_local_store(0, spe);
  }

  std::optional<Fault> issue(MfcOpcode opcode, std::uint32_t lsa, std::uint32_t offset, std::uint32_t size,
                             std::uint32_t tag) {
    return queue.issue(command(opcode, lsa, buffer.ea() + offset, size, tag));
  }
  void fill_buffer(std::uint32_t offset, std::uint32_t bytes, int value) {
    std::fill_n(buffer.data() + offset, bytes, static_cast<std::byte>(value));
  }
  // How many of the local store's bytes hold `value`.
  std::ptrdiff_t count(int value) const {
    return std::count(spe.store.begin(), spe.store.end(), static_cast<std::byte>(value));
  }
  std::ptrdiff_t seen_at_start() const { return count(1); }

  AddressSpace space;
  Buffer<std::byte> buffer{space, "buffer", 65536};
  FakeSpe spe;
  std::vector<std::ptrdiff_t> starts;  // what the local store held when the SPU was started
  ProxyQueue queue;
};

class ProxyUnderEverySchedule : public testing::TestWithParam<Schedule> {
 protected:
  ProxyBench bench_{GetParam()};
};

TEST_P(ProxyUnderEverySchedule, MovesBytesBothWays) {
  bench_.fill_buffer(0, 16384, 1);
  EXPECT_FALSE(bench_.issue(MfcOpcode::get, 0x1000, 0, 16384, 3));
  EXPECT_EQ(bench_.queue.wait_all(1u << 3), 1u << 3);
  EXPECT_EQ(bench_.count(1), 16384);

  EXPECT_FALSE(bench_.issue(MfcOpcode::put, 0x1000, 32768, 16384, 4));
  EXPECT_EQ(bench_.queue.wait_any(1u << 4 | 1u << 5) & 1u << 5, 1u << 5) << "it has nothing to wait for";
  EXPECT_EQ(bench_.queue.wait_any(1u << 4), 1u << 4);
  EXPECT_EQ(std::count(bench_.buffer.data() + 32768, bench_.buffer.data() + 49152, std::byte{1}), 16384);
}

TEST_P(ProxyUnderEverySchedule, StartsTheSpuWhenTheBytesAreThere) {
  bench_.fill_buffer(0, 4096, 1);
  EXPECT_FALSE(bench_.issue(MfcOpcode::gets, 0, 0, 4096, 0));
  bench_.queue.wait_all(1);
  EXPECT_EQ(bench_.starts, std::vector<std::ptrdiff_t>{4096});
}

// The usual way to load a program: pieces, then a get with fence and start.
TEST_P(ProxyUnderEverySchedule, AFencedStartComesAfterItsTag) {
  bench_.fill_buffer(0, 65536, 1);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(bench_.issue(MfcOpcode::get, i * 16384, i * 16384, 16384, 7));
  }
  EXPECT_FALSE(bench_.issue(MfcOpcode::getfs, 3 * 16384, 3 * 16384, 128, 7));
  bench_.queue.wait_all(1u << 7);
  EXPECT_EQ(bench_.starts, std::vector<std::ptrdiff_t>{3 * 16384 + 128});
}

TEST_P(ProxyUnderEverySchedule, ABarrierHoldsBackLaterCommandsOfItsTag) {
  for (int round = 0; round < 20; ++round) {
    bench_.fill_buffer(0, 16384, 1);
    EXPECT_FALSE(bench_.issue(MfcOpcode::getb, 0, 0, 4096, 1));
    EXPECT_FALSE(bench_.issue(MfcOpcode::put, 0, 32768, 4096, 1));
    bench_.queue.wait_all(1u << 1);
    EXPECT_EQ(std::count(bench_.buffer.data() + 32768, bench_.buffer.data() + 36864, std::byte{1}), 4096);
    std::fill(bench_.spe.store.begin(), bench_.spe.store.end(), std::byte{0});
    bench_.fill_buffer(32768, 4096, 0);
  }
}

TEST_P(ProxyUnderEverySchedule, TakesMoreCommandsThanItHasSlots) {
  bench_.fill_buffer(0, 65536, 1);
  for (std::uint32_t i = 0; i < 40; ++i) {
    EXPECT_FALSE(bench_.issue(MfcOpcode::get, i * 1024, i * 1024, 1024, i % 32));
    EXPECT_GE(bench_.queue.free_slots(), 0);
    EXPECT_LE(bench_.queue.free_slots(), ProxyQueue::kSlots);
  }
  EXPECT_EQ(bench_.queue.wait_all(~0u), ~0u);
  EXPECT_EQ(bench_.count(1), 40 * 1024);
  EXPECT_EQ(bench_.queue.free_slots(), ProxyQueue::kSlots);
}

TEST_P(ProxyUnderEverySchedule, WhoeverOnlyAsksSeesItEnd) {
  const auto ends_within = [&](int visits, auto&& done) {
    bench_.fill_buffer(0, 16384, 1);
    EXPECT_FALSE(bench_.issue(MfcOpcode::get, 0, 0, 16384, 0));
    for (; visits != 0 && !done(); --visits) {
    }
    return visits != 0;
  };
  constexpr int kEnough = 2 * static_cast<int>(Mfc::kMostVisits);
  EXPECT_TRUE(ends_within(kEnough, [&] { return bench_.queue.complete_tags(1) == 1; }));
  EXPECT_TRUE(ends_within(kEnough, [&] { return bench_.queue.free_slots() == ProxyQueue::kSlots; }));
  EXPECT_TRUE(ends_within(kEnough, [&] {
    bench_.queue.visit();
    return bench_.count(1) == 16384;
  }));
  EXPECT_TRUE(ends_within(kEnough, [&] { return !bench_.queue.advance(); }));
}

TEST_P(ProxyUnderEverySchedule, SignalsAnotherSpe) {
  FakeSpe other;
  bench_.space.map_local_store(1, other);
  bench_.spe.store[0x10C] = std::byte{0x2A};
  EXPECT_FALSE(bench_.queue.issue(
      command(MfcOpcode::sndsig, 0x10C, local_store_ea(1) + static_cast<std::uint64_t>(SpeRegister::kSignal2),
              4, 9)));
  bench_.queue.wait_all(1u << 9);
  ASSERT_EQ(other.registers.size(), 1u);
  EXPECT_EQ(other.registers[0], std::pair(SpeRegister::kSignal2, 0x2Au));
}

TEST_P(ProxyUnderEverySchedule, TheSpeHearsOfWhatAGetWrites) {
  EXPECT_FALSE(bench_.issue(MfcOpcode::get, 0x400, 0, 256, 0));
  EXPECT_FALSE(bench_.issue(MfcOpcode::put, 0x800, 0, 256, 0));
  bench_.queue.wait_all(1);
  EXPECT_EQ(bench_.spe.writes, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0x400, 256}}));
}

INSTANTIATE_TEST_SUITE_P(Schedules, ProxyUnderEverySchedule, testing::ValuesIn(all_schedules()),
                         schedule_test_name);

TEST(ProxyQueue, KeepsCommandsQueuedWhenLazy) {
  ProxyBench bench({Schedule::kLazy, 0});
  for (std::uint32_t tag = 0; tag < ProxyQueue::kSlots; ++tag) {
    EXPECT_EQ(bench.queue.free_slots(), ProxyQueue::kSlots - static_cast<int>(tag));
    EXPECT_FALSE(bench.issue(MfcOpcode::get, tag * 128, 0, 128, tag));
  }
  EXPECT_EQ(bench.queue.free_slots(), 0);
  EXPECT_EQ(bench.queue.wait_all(1u << 2), 1u << 2);
  EXPECT_EQ(bench.queue.free_slots(), 1);
}

TEST(ProxyQueue, RefusesWhatIsTheSpusOwn) {
  ProxyBench bench({Schedule::kEager, 0});
  for (const MfcOpcode opcode : {MfcOpcode::getl, MfcOpcode::putlf, MfcOpcode::putrlb, MfcOpcode::getllar,
                                 MfcOpcode::putllc, MfcOpcode::putlluc}) {
    const std::optional<Fault> fault = bench.issue(opcode, 0, 0, 128, 0);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->rule, Rule::kNotOnProxyQueue);
    EXPECT_NE(fault->message().find(name(opcode)), std::string::npos);
  }
  EXPECT_FALSE(bench.issue(MfcOpcode::putqlluc, 0, 0, 128, 0)) << "which is queued and answers nowhere";
}

TEST(ProxyQueue, RefusesWhatTheMfcRefusesAndNamesTheCommandAsIssued) {
  ProxyBench bench({Schedule::kEager, 0});
  const std::optional<Fault> misaligned = bench.issue(MfcOpcode::gets, 8, 8, 128, 0);
  ASSERT_TRUE(misaligned);
  EXPECT_EQ(misaligned->rule, Rule::kLsaAlignment);
  EXPECT_NE(misaligned->message().find("gets tag 0"), std::string::npos);
  const std::optional<Fault> unmapped = bench.issue(MfcOpcode::put, 0, 1 << 20, 128, 0);
  ASSERT_TRUE(unmapped);
  EXPECT_EQ(unmapped->rule, Rule::kEaNotMapped);

  bench.fill_buffer(0, 128, 1);
  EXPECT_FALSE(bench.issue(MfcOpcode::get, 0, 0, 128, 0));
  EXPECT_TRUE(bench.starts.empty()) << "the refused start belongs to no other command";
}

TEST(ProxyQueue, WaitingForNoTagReturnsAtOnce) {
  ProxyBench bench({Schedule::kLazy, 0});
  EXPECT_FALSE(bench.issue(MfcOpcode::get, 0, 0, 128, 0));
  EXPECT_EQ(bench.queue.wait_all(0), 0u);
  EXPECT_EQ(bench.queue.wait_any(0), 0u);
  EXPECT_EQ(bench.queue.free_slots(), ProxyQueue::kSlots - 1);
}

}  // namespace
}  // namespace softcell::dma
