// Signals and the data-cache commands: the queue's commands that are no plain transfers.
#include "fake_spe.h"

#include <cstring>
#include <optional>
#include <string>
#include <vector>
#include "mfc_fixture.h"

namespace softcell::dma {
namespace {

using Writes = std::vector<std::pair<SpeRegister, std::uint32_t>>;

/// A bench with SPE 1 beside it in the address space.
class SignalBench : public MfcBench {
 public:
  explicit SignalBench(Schedule schedule) : MfcBench(schedule) { space.map_local_store(1, other); }
  ~SignalBench() { space.unmap_local_store(1); }

  void set_word(std::uint32_t lsa, std::uint32_t value) { std::memcpy(&store[lsa], &value, sizeof value); }
  std::optional<Fault> signal(MfcOpcode opcode, std::uint32_t lsa, SpeRegister which, std::uint32_t tag) {
    return mfc.issue(command(opcode, lsa, local_store_ea(1) + static_cast<std::uint32_t>(which), 4, tag));
  }

  FakeSpe other;
};

class MfcSignal : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, MfcSignal, testing::ValuesIn(all_schedules()), schedule_test_name);

TEST_P(MfcSignal, WritesFourBytesToTheRegisterOnce) {
  SignalBench bench(GetParam());
  bench.set_word(0x100C, 0x12345678);
  ASSERT_FALSE(bench.signal(MfcOpcode::sndsig, 0x100C, SpeRegister::kSignal2, 3));
  bench.wait_all(1u << 3);
  EXPECT_EQ(bench.other.registers, (Writes{{SpeRegister::kSignal2, 0x12345678}}));
  EXPECT_EQ(bench.mfc.statistics().signals, 1u);
  EXPECT_EQ(bench.mfc.statistics().bytes(), 4u);
}

// How a producer tells that its data are there.
TEST_P(MfcSignal, AFencedSignalComesAfterThePutsOfItsTag) {
  SignalBench bench(GetParam());
  for (std::uint32_t i = 0; i < 5; ++i) bench.set_word(16 * i + 12, i);
  bench.fill_store(0x1000, 1024, 9);
  ASSERT_FALSE(bench.mfc.issue(command(MfcOpcode::put, 0x1000, local_store_ea(1) + 0x2000, 1024, 3)));
  ASSERT_FALSE(bench.signal(MfcOpcode::sndsigb, 0x0C, SpeRegister::kSignal1, 3));
  ASSERT_FALSE(bench.signal(MfcOpcode::sndsigf, 0x1C, SpeRegister::kSignal1, 3));
  ASSERT_FALSE(bench.signal(MfcOpcode::sndsigf, 0x2C, SpeRegister::kSignal1, 3));
  while (bench.other.registers.empty() && bench.mfc.advance()) {
  }
  EXPECT_EQ(std::count(bench.other.store.begin(), bench.other.store.end(), std::byte{9}), 1024);
  bench.wait_all(1u << 3);
  EXPECT_EQ(bench.other.registers,
            (Writes{{SpeRegister::kSignal1, 0}, {SpeRegister::kSignal1, 1}, {SpeRegister::kSignal1, 2}}));
}

TEST_P(MfcSignal, APlainPutOfFourBytesReachesTheMailboxAsWell) {
  SignalBench bench(GetParam());
  bench.set_word(0x100C, 77);
  ASSERT_FALSE(bench.signal(MfcOpcode::put, 0x100C, SpeRegister::kInMbox, 3));
  bench.wait_all(1u << 3);
  EXPECT_EQ(bench.other.registers, (Writes{{SpeRegister::kInMbox, 77}}));
}

TEST(MfcSignals, NeedAnSpeThatIsThere) {
  SignalBench bench(kEager);
  EXPECT_FALSE(bench.signal(MfcOpcode::sndsig, 12, SpeRegister::kSignal1, 3));
  const std::optional<Fault> fault =
      bench.mfc.issue(command(MfcOpcode::sndsig, 12, local_store_ea(2) + 0x5400C, 4, 3));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->rule, Rule::kEaNotMapped);
  EXPECT_EQ(fault->command->opcode(), MfcOpcode::sndsig);
}

TEST(MfcSignals, RegistersTakeFourBytesAndGiveNone) {
  SignalBench bench(kEager);
  const EffectiveAddress mailbox = local_store_ea(1) + static_cast<std::uint32_t>(SpeRegister::kInMbox);
  EXPECT_FALSE(bench.mfc.issue(command(MfcOpcode::put, 12, mailbox, 4, 3)));
  for (const MfcCommand& broken :
       {command(MfcOpcode::put, 14, mailbox + 2, 2, 3), command(MfcOpcode::get, 12, mailbox, 4, 3),
        command(MfcOpcode::put, 0, {mailbox.value - 12}, 16, 3)}) {
    const std::optional<Fault> fault = bench.mfc.issue(broken);
    ASSERT_TRUE(fault);
    EXPECT_EQ(name(fault->rule), name(Rule::kRegisterAccess));
    EXPECT_EQ(fault->command, broken);
  }
  EXPECT_EQ(bench.other.registers.size(), 1u);
}

TEST_P(MfcSignal, SdcrzZeroesTheLinesOfItsRange) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 4096, 5);
  bench.issue(MfcOpcode::sdcrz, 0, 300, 100, 3);  // in lines 2 and 3
  bench.wait_all(1u << 3);
  EXPECT_EQ(std::count(bench.buffer.data(), bench.buffer.data() + 4096, std::byte{0}), 256);
  EXPECT_EQ(bench.buffer_at(255), 5);
  EXPECT_EQ(bench.buffer_at(256), 0);
  EXPECT_EQ(bench.buffer_at(511), 0);

  bench.fill_buffer(0, 32768, 5);
  bench.issue(MfcOpcode::sdcrz, 0, 1, 16384, 3);  // the most lines a range can touch
  bench.wait_all(1u << 3);
  EXPECT_EQ(std::count(bench.buffer.data(), bench.buffer.data() + 32768, std::byte{0}), 129 * 128);
}

TEST_P(MfcSignal, TheOtherCacheCommandsMoveNothing) {
  MfcBench bench(GetParam());
  bench.fill_buffer(0, 4096, 5);
  for (const MfcOpcode opcode : {MfcOpcode::sdcrt, MfcOpcode::sdcrtst, MfcOpcode::sdcrst, MfcOpcode::sdcrf}) {
    bench.issue(opcode, 0, 300, 100, 3);
  }
  EXPECT_EQ(bench.wait_all(1u << 3), 1u << 3);
  EXPECT_EQ(std::count(bench.buffer.data(), bench.buffer.data() + 4096, std::byte{5}), 4096);
  EXPECT_EQ(bench.mfc.statistics().hints, 4u);
  EXPECT_EQ(bench.mfc.statistics().bytes(), 0u);
}

TEST(MfcCacheCommands, AskForTheMemoryThatTheyNeed) {
  MfcBench bench(kEager);
  const Buffer<char> input(bench.space, "input", 100, {.spe_access = SpeAccess::kRead});
  const auto rule_of = [&](MfcOpcode opcode, EffectiveAddress ea) {
    const std::optional<Fault> fault = bench.mfc.issue(command(opcode, 0, ea, 100, 0));
    return fault ? std::string(name(fault->rule)) : std::string("none");
  };
  EXPECT_EQ(rule_of(MfcOpcode::sdcrz, bench.buffer.ea()), "none");
  EXPECT_EQ(rule_of(MfcOpcode::sdcrz, input.ea()), "ea-not-writable");
  EXPECT_EQ(rule_of(MfcOpcode::sdcrst, input.ea()), "none");
  EXPECT_EQ(rule_of(MfcOpcode::sdcrf, input.ea() + 64), "ea-crosses-buffer");
  EXPECT_EQ(rule_of(MfcOpcode::sdcrst, input.ea() + 128), "ea-not-mapped");
  EXPECT_EQ(rule_of(MfcOpcode::sdcrt, input.ea() + 128), "none") << "a touch never faults";
  EXPECT_EQ(rule_of(MfcOpcode::sdcrtst, input.ea() + 128), "none");
}

}  // namespace
}  // namespace softcell::dma
