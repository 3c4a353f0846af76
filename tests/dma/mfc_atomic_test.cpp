// The line commands: getllar, putllc, putlluc at once, putqlluc in its turn, and their status.
#include "mfc_fixture.h"

#include <cstring>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace softcell::dma {
namespace {

class LossCounter final : public ReservationListener {
 public:
  void on_reservation_lost() override { ++losses; }
  int losses = 0;
};

/// A second SPE on the same memory.
struct Neighbour {
  explicit Neighbour(MfcBench& bench)
      : store(kLocalStoreBytes), mfc(store, bench.space, kEager, 1, &listener) {}
  LossCounter listener;
  std::vector<std::byte> store;
  Mfc mfc;
};

std::uint32_t atomic_status(Mfc& mfc) {
  const auto status = mfc.read_atomic_status();
  EXPECT_TRUE(std::holds_alternative<std::uint32_t>(status));
  return std::holds_alternative<std::uint32_t>(status) ? std::get<std::uint32_t>(status) : ~0u;
}

class MfcAtomic : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcAtomic, testing::ValuesIn(all_schedules()), schedule_test_name);

TEST_P(MfcAtomic, GetllarAndPutllcMoveALineAtOnce) {
  MfcBench bench(GetParam());
  bench.fill_buffer(256, 128, 7);
  bench.issue(MfcOpcode::getllar, 0x1000, 256, 0, 99);
  EXPECT_EQ(bench.count_in_store(0x1000, 128, 7), 128);
  EXPECT_EQ(atomic_status(bench.mfc), 4u);
  bench.fill_store(0x1000, 128, 8);
  bench.issue(MfcOpcode::putllc, 0x1000, 256, 0, 99);
  EXPECT_EQ(atomic_status(bench.mfc), 0u);
  EXPECT_EQ(std::count(bench.buffer.data(), bench.buffer.data() + 1024, std::byte{8}), 128);
  EXPECT_EQ(bench.buffer_at(256), 8);
}

TEST_P(MfcAtomic, PutllcFailsWithoutAReservationOfThatLine) {
  MfcBench bench(GetParam());
  bench.fill_store(0, 128, 8);
  bench.issue(MfcOpcode::putllc, 0, 256, 0, 0);
  EXPECT_EQ(atomic_status(bench.mfc), 1u);
  bench.issue(MfcOpcode::getllar, 0x1000, 128, 0, 0);
  bench.issue(MfcOpcode::putllc, 0, 256, 0, 0);
  EXPECT_EQ(atomic_status(bench.mfc), 1u);
  EXPECT_EQ(bench.buffer_at(256), 0);
}

TEST_P(MfcAtomic, ASecondPutllcFailsBecauseTheFirstGaveTheReservationUp) {
  MfcBench bench(GetParam());
  bench.issue(MfcOpcode::getllar, 0, 256, 0, 0);
  bench.issue(MfcOpcode::putllc, 0, 256, 0, 0);
  EXPECT_EQ(atomic_status(bench.mfc), 0u);
  bench.issue(MfcOpcode::putllc, 0, 256, 0, 0);
  EXPECT_EQ(atomic_status(bench.mfc), 1u);
}

TEST_P(MfcAtomic, AnybodysWriteToTheLineLosesTheReservation) {
  for (const MfcOpcode opcode : {MfcOpcode::put, MfcOpcode::putlluc, MfcOpcode::putqlluc, MfcOpcode::sdcrz}) {
    MfcBench bench(GetParam());
    Neighbour other(bench);
    ASSERT_FALSE(other.mfc.issue(command(MfcOpcode::getllar, 0, bench.buffer.ea() + 256, 0, 0)));
    bench.issue(opcode, 0x2000, 256, 16, 1);
    bench.wait_all(1u << 1);
    EXPECT_EQ(other.listener.losses, 1) << name(opcode);
    ASSERT_FALSE(other.mfc.issue(command(MfcOpcode::putllc, 0, bench.buffer.ea() + 256, 0, 0)));
    EXPECT_EQ(atomic_status(other.mfc), 1u) << name(opcode);
  }
}

TEST_P(MfcAtomic, AWriteToAnotherLineLosesNothing) {
  MfcBench bench(GetParam());
  Neighbour other(bench);
  ASSERT_FALSE(other.mfc.issue(command(MfcOpcode::getllar, 0, bench.buffer.ea() + 256, 0, 0)));
  bench.issue(MfcOpcode::put, 0x2000, 128, 128, 1);
  bench.issue(MfcOpcode::put, 0x2000, 384, 128, 1);
  bench.issue(MfcOpcode::get, 0x4000, 0, 1024, 1);
  bench.wait_all(1u << 1);
  EXPECT_EQ(other.listener.losses, 0);
  ASSERT_FALSE(other.mfc.issue(command(MfcOpcode::putllc, 0, bench.buffer.ea() + 256, 0, 0)));
  EXPECT_EQ(atomic_status(other.mfc), 0u);
}

TEST_P(MfcAtomic, PutllucStoresWithoutAReservation) {
  MfcBench bench(GetParam());
  bench.fill_store(0, 128, 8);
  bench.issue(MfcOpcode::putlluc, 0, 256, 0, 0);
  EXPECT_EQ(bench.buffer_at(256), 8);
  EXPECT_EQ(bench.buffer_at(256 + 127), 8);
  EXPECT_EQ(atomic_status(bench.mfc), 2u);
}

TEST_P(MfcAtomic, PutqllucWaitsItsTurnAndHasNoAtomicStatus) {
  MfcBench bench(GetParam());
  bench.fill_store(0, 128, 8);
  bench.fill_store(0x1000, 128, 9);
  bench.issue(MfcOpcode::put, 0x1000, 256, 128, 1);
  bench.issue(MfcOpcode::barrier, 0, 0, 0, 2);
  bench.issue(MfcOpcode::putqlluc, 0, 256, 0, 1);
  EXPECT_EQ(bench.mfc.atomic_status_count(), 0);
  bench.wait_all(1u << 1);
  EXPECT_EQ(bench.buffer_at(256), 8);
  EXPECT_EQ(bench.buffer_at(256 + 127), 8);
}

// A flag line told by putqlluc is the usual way to say that the data before it are there.
TEST_P(MfcAtomic, PutqllucDoesNotOvertakeAnEarlierPutOfItsTag) {
  MfcBench bench(GetParam());
  bench.fill_store(0, 4096, 8);
  bench.issue(MfcOpcode::put, 0, 1024, 4096, 1);
  bench.issue(MfcOpcode::putqlluc, 0, 256, 0, 1);
  do {
    if (bench.buffer_at(256) != 8) continue;
    ASSERT_EQ(std::count(&bench.buffer[1024], &bench.buffer[1024] + 4096, std::byte{8}), 4096);
  } while (bench.mfc.advance());
  EXPECT_EQ(bench.buffer_at(256), 8);
}

// A buffer owns its last line whole, so that a counter alone may be used by line commands.
TEST_P(MfcAtomic, ReachTheLineOfASmallBuffer) {
  MfcBench bench(GetParam());
  Buffer<std::uint32_t> counter(bench.space, "counter", 1);
  for (int i = 0; i < 3; ++i) {
    ASSERT_FALSE(bench.mfc.issue(command(MfcOpcode::getllar, 0, counter.ea(), 0, 0)));
    std::uint32_t value;
    std::memcpy(&value, bench.store.data(), sizeof value);
    ++value;
    std::memcpy(bench.store.data(), &value, sizeof value);
    ASSERT_FALSE(bench.mfc.issue(command(MfcOpcode::putllc, 0, counter.ea(), 0, 0)));
    EXPECT_EQ(atomic_status(bench.mfc), 0u);
  }
  EXPECT_EQ(counter[0], 3u);
}

TEST_P(MfcAtomic, CountsByKind) {
  MfcBench bench(GetParam());
  bench.issue(MfcOpcode::getllar, 0, 0, 0, 0);
  bench.issue(MfcOpcode::putllc, 0, 0, 0, 0);
  bench.issue(MfcOpcode::putllc, 0, 0, 0, 0);
  bench.issue(MfcOpcode::putlluc, 0, 0, 0, 0);
  bench.issue(MfcOpcode::putqlluc, 0, 0, 0, 0);
  const MfcStatistics& statistics = bench.mfc.statistics();
  EXPECT_EQ(statistics.getllar, 1u);
  EXPECT_EQ(statistics.putllc, 2u);
  EXPECT_EQ(statistics.putllc_failed, 1u);
  EXPECT_EQ(statistics.putlluc, 1u);
  EXPECT_EQ(statistics.putqlluc, 1u);
  EXPECT_EQ(statistics.atomics(), 5u);
  EXPECT_EQ(statistics.queued_commands, 1u);
  EXPECT_EQ(statistics.bytes(), 4u * 128);
}

TEST(MfcAtomicCommands, WaitForNothingThatIsQueued) {
  MfcBench bench(kLazy);
  bench.fill_store(0, 128, 8);
  bench.issue(MfcOpcode::put, 0, 256, 128, 1);
  bench.issue(MfcOpcode::barrier, 0, 0, 0, 1);
  bench.issue(MfcOpcode::getllar, 0x1000, 256, 0, 1);
  EXPECT_EQ(bench.count_in_store(0x1000, 128, 0), 128) << "the put has not left";
}

TEST(MfcAtomicCommands, NeedPermissionAndAMappedLine) {
  MfcBench bench(kEager);
  const Buffer<char> input(bench.space, "input", 128, {.spe_access = SpeAccess::kRead});
  const auto rule_of = [&](MfcOpcode opcode, EffectiveAddress ea) {
    const std::optional<Fault> fault = bench.mfc.issue(command(opcode, 0, ea, 0, 0));
    if (!fault) return std::string("none");
    EXPECT_EQ(fault->command->opcode(), opcode);
    return std::string(name(fault->rule));
  };
  EXPECT_EQ(rule_of(MfcOpcode::getllar, input.ea()), "none");
  for (const MfcOpcode opcode : {MfcOpcode::putllc, MfcOpcode::putlluc, MfcOpcode::putqlluc}) {
    EXPECT_EQ(rule_of(opcode, bench.buffer.ea()), "none");
    EXPECT_EQ(rule_of(opcode, input.ea()), "ea-not-writable");
  }
  EXPECT_EQ(rule_of(MfcOpcode::getllar, input.ea() + 128), "ea-not-mapped");
  EXPECT_EQ(bench.mfc.statistics().atomics(), 4u) << "refused commands are not counted";
}

TEST(MfcAtomicStatus, IsThatOfTheLastCommand) {
  MfcBench bench(kEager);
  EXPECT_EQ(bench.mfc.atomic_status_count(), 0);
  bench.issue(MfcOpcode::getllar, 0, 0, 0, 0);
  EXPECT_EQ(bench.mfc.atomic_status_count(), 1);
  bench.issue(MfcOpcode::putlluc, 0, 0, 0, 0);
  EXPECT_EQ(atomic_status(bench.mfc), 2u);
  EXPECT_EQ(bench.mfc.atomic_status_count(), 0);
}

TEST(MfcAtomicStatus, ReadingItWithoutACommandNeverEnds) {
  MfcBench bench(kEager);
  bench.issue(MfcOpcode::getllar, 0, 0, 0, 0);
  EXPECT_EQ(atomic_status(bench.mfc), 4u);
  const auto status = bench.mfc.read_atomic_status();
  ASSERT_TRUE(std::holds_alternative<Fault>(status));
  EXPECT_EQ(std::get<Fault>(status).rule, Rule::kAtomicStatusNotExpected);
  EXPECT_EQ(std::get<Fault>(status).detail,
            "MFC_RdAtomicStat was read, and no getllar, putllc or putlluc was issued since its last read");
}

TEST(MfcAtomicStatus, AJobStartsWithoutReservationAndStatus) {
  MfcBench bench(kEager);
  bench.issue(MfcOpcode::getllar, 0, 0, 0, 0);
  bench.mfc.begin_job(1);
  EXPECT_EQ(bench.mfc.atomic_status_count(), 0);
  bench.issue(MfcOpcode::putllc, 0, 0, 0, 0);
  EXPECT_EQ(atomic_status(bench.mfc), 1u);
}

}  // namespace
}  // namespace softcell::dma
