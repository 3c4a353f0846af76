#include "channels/spu_channels.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "channels/spe_monitor.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/channel_name.h"

namespace softcell::ls_sim {
namespace {

constexpr std::uint32_t number(Channel channel) { return static_cast<std::uint32_t>(channel); }

/// Runs nothing: the tests act as the kernel.
class NoEngine final : public Engine {
 public:
  void load(const KernelImage&) override {}
  RunResult run(const EntryArguments&, ChannelPort&, AccessObserver*, JobObserver*) override { return {}; }
  dma::LocalStoreAddress position() const override { return {0x1234}; }
  dma::LocalStoreAddress stack_pointer() const override { return {0x1234}; }
  void interrupt() override {}
  std::uint32_t stack_high_water() const override { return 0; }
};

/// A thread of the PPU side that only waits, while this object lives.
class WaitingPpu {
 public:
  explicit WaitingPpu(SpeMonitor& monitor) : monitor_(monitor), thread_([this] { wait(); }) {
    waits_.wait(false);
  }
  ~WaitingPpu() {
    const SpeMonitor::Lock lock = monitor_.lock();
    over_ = true;
    monitor_.wake_ppu();
  }
  WaitingPpu(const WaitingPpu&) = delete;
  WaitingPpu& operator=(const WaitingPpu&) = delete;

 private:
  void wait() {
    SpeMonitor::Lock lock = monitor_.lock();
    monitor_.ppu_wait(lock, [this] {
      waits_ = true;
      waits_.notify_one();
      return over_;
    });
  }

  SpeMonitor& monitor_;
  std::atomic<bool> waits_ = false;
  bool over_ = false;  // guarded by the monitor's lock
  std::jthread thread_;
};

/// One SPE to which nobody else writes, so that every sleep is a deadlock at once.
class SpuChannelsTest : public testing::Test {
 protected:
  explicit SpuChannelsTest(dma::Schedule schedule = {})
      : options_{.schedule = schedule, .clock = Clock::kSimulated} {
    const SpeMonitor::Lock lock = monitor_.lock();
    monitor_.start(0, image_, std::chrono::steady_clock::now());
  }

  std::uint32_t read(Channel channel) { return value_of(channels_.read(number(channel))); }
  std::uint32_t count(Channel channel) { return value_of(channels_.count(number(channel))); }
  void write(Channel channel, std::uint32_t value) { value_of(channels_.write(number(channel), value)); }

  dma::Rule rule_of(const ChannelReply& reply) {
    EXPECT_TRUE(reply.fault);
    return reply.fault ? reply.fault->rule : dma::Rule{};
  }

  /// Issues a command by six channel writes, as a kernel does.
  void command(std::uint32_t opcode, std::uint32_t lsa, dma::EffectiveAddress ea, std::uint32_t size,
               std::uint32_t tag) {
    write(Channel::kMfcLsa, lsa);
    write(Channel::kMfcEah, static_cast<std::uint32_t>(ea.value >> 32));
    write(Channel::kMfcEal, static_cast<std::uint32_t>(ea.value));
    write(Channel::kMfcSize, size);
    write(Channel::kMfcTagId, tag);
    write(Channel::kMfcCmd, opcode);
  }

  /// MFC_EAH and MFC_EAL of a list command: the high half that its elements share, and the list's local-store address.
  dma::EffectiveAddress list_at(std::uint32_t lsa) const { return {(lines_.ea().value >> 32 << 32) | lsa}; }

  /// Puts the event into the mask and waits for it.
  std::uint32_t wait_for(std::uint32_t event) {
    write(Channel::kSpuWrEventMask, event);
    return read(Channel::kSpuRdEventStat);
  }

  const KernelImage image_{};
  SpeOptions options_;
  dma::AddressSpace memory_;
  dma::Buffer<std::array<std::uint32_t, 32>> lines_{memory_, "lines", 17};
  alignas(128) std::array<std::byte, dma::kLocalStoreBytes> local_store_{};
  dma::Mfc mfc_{local_store_, memory_, options_.schedule};
  SpeMonitor monitor_{options_};
  WaitingPpu ppu_{monitor_};
  SpeRegisters registers_;
  NoEngine engine_;
  SpeStatistics statistics_;
  SpuChannels channels_{{.spe = 0,
                         .options = options_,
                         .monitor = monitor_,
                         .registers = registers_,
                         .mfc = mfc_,
                         .engine = engine_,
                         .statistics = statistics_,
                         .trace = nullptr}};

 private:
  static std::uint32_t value_of(const ChannelReply& reply) {
    EXPECT_FALSE(reply.fault) << reply.fault->message();
    return reply.value;
  }
};

class LazySpuChannels : public SpuChannelsTest {
 protected:
  LazySpuChannels() : SpuChannelsTest({dma::Schedule::kLazy}) {}
};

// ---- the table

TEST_F(SpuChannelsTest, CountsAtResetAreTheManuals) {
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> counts{
      {0, 0},  {1, 1},  {2, 1},  {3, 0},  {4, 0},  {7, 1},  {8, 1},  {9, 1},   {11, 1}, {12, 1}, {13, 1},
      {14, 1}, {15, 1}, {16, 1}, {17, 1}, {18, 1}, {19, 1}, {20, 1}, {21, 16}, {22, 1}, {23, 1}, {24, 0},
      {25, 0}, {26, 1}, {27, 0}, {28, 1}, {29, 0}, {30, 1}, {69, 1}, {70, 1},  {71, 1}};
  std::size_t channels = 0;
  for (std::uint32_t channel = 0; channel < 128; ++channel) {
    if (!channel_name(channel).empty()) ++channels;
  }
  EXPECT_EQ(channels, counts.size());
  for (const auto& [channel, expected] : counts) {
    const ChannelReply reply = channels_.count(channel);
    ASSERT_FALSE(reply.fault) << channel;
    EXPECT_EQ(reply.value, expected) << channel_name(channel);
  }
}

TEST_F(SpuChannelsTest, AChannelGoesOneWayOnly) {
  for (std::uint32_t channel = 0; channel < 128; ++channel) {
    const ChannelAccess access = channel_access(channel);
    if (access != ChannelAccess::kRead) {
      const ChannelReply reply = channels_.read(channel);
      EXPECT_EQ(rule_of(reply), dma::Rule::kIllegalChannel);
      EXPECT_NE(reply.fault->message().find(channel_name(channel)), std::string::npos);
    }
    if (access != ChannelAccess::kWrite) {
      EXPECT_EQ(rule_of(channels_.write(channel, 0)), dma::Rule::kIllegalChannel);
    }
    if (access == ChannelAccess::kNone) {
      EXPECT_EQ(rule_of(channels_.count(channel)), dma::Rule::kIllegalChannel);
    }
  }
}

TEST_F(SpuChannelsTest, AFaultSaysHowItWasUsed) {
  EXPECT_NE(channels_.read(21).fault->message().find("read of channel 21, MFC_Cmd, which is only written"),
            std::string::npos);
  EXPECT_NE(channels_.write(24, 0).fault->message().find("MFC_RdTagStat, which is only read"),
            std::string::npos);
  EXPECT_NE(channels_.count(5).fault->message().find("channel 5, which does not exist"), std::string::npos);
}

// ---- mailboxes, signals, registers

TEST_F(SpuChannelsTest, MailboxesCountWhatGoesWithoutWaiting) {
  for (std::uint32_t i = 1; i <= 4; ++i) {
    registers_.write_in_mbox(10 * i);
    EXPECT_EQ(count(Channel::kSpuRdInMbox), i);
  }
  for (std::uint32_t i = 1; i <= 4; ++i) EXPECT_EQ(read(Channel::kSpuRdInMbox), 10 * i);
  EXPECT_EQ(count(Channel::kSpuRdInMbox), 0u);
  for (const Channel channel : {Channel::kSpuWrOutMbox, Channel::kSpuWrOutIntrMbox}) {
    write(channel, 7);
    EXPECT_EQ(count(channel), 0u);
  }
  EXPECT_EQ(registers_.read_out_mbox(), 7u);
  EXPECT_EQ(registers_.read_out_intr_mbox(), 7u);
  EXPECT_EQ(count(Channel::kSpuWrOutMbox), 1u);
}

TEST_F(SpuChannelsTest, SignalsAreReadOnce) {
  registers_.write_signal(1, 5);
  registers_.write_signal(2, 6);
  EXPECT_EQ(count(Channel::kSpuRdSigNotify1), 1u);
  EXPECT_EQ(read(Channel::kSpuRdSigNotify1), 5u);
  EXPECT_EQ(count(Channel::kSpuRdSigNotify1), 0u);
  EXPECT_EQ(read(Channel::kSpuRdSigNotify2), 6u);
}

TEST_F(SpuChannelsTest, ASleepThatNobodyCanEndIsADeadlockAndAWait) {
  const std::vector<Channel> empty{Channel::kSpuRdInMbox, Channel::kSpuRdSigNotify1,
                                   Channel::kSpuRdSigNotify2, Channel::kSpuRdEventStat};
  for (const Channel channel : empty) {
    EXPECT_EQ(rule_of(channels_.read(number(channel))), dma::Rule::kDeadlock);
    EXPECT_EQ(statistics_.waits[number(channel)].count, 1u);
  }
  for (const Channel channel : {Channel::kSpuWrOutMbox, Channel::kSpuWrOutIntrMbox}) {
    write(channel, 1);
    EXPECT_EQ(rule_of(channels_.write(number(channel), 2)), dma::Rule::kDeadlock);
  }
  EXPECT_EQ(statistics_.channel_waits, 6u);
  EXPECT_EQ(registers_.read_out_mbox(), 1u) << "what could not be written is not there";
}

TEST_F(SpuChannelsTest, KeepsMasksAndTheInterruptReturnAddress) {
  write(Channel::kSpuWrEventMask, 0x1FFB);
  EXPECT_EQ(read(Channel::kSpuRdEventMask), 0x1FFBu);
  write(Channel::kMfcWrTagMask, 0x8000'0001);
  EXPECT_EQ(read(Channel::kMfcRdTagMask), 0x8000'0001u);
  write(Channel::kSpuWrSrr0, 0x100);
  EXPECT_EQ(read(Channel::kSpuRdSrr0), 0x100u);
  EXPECT_EQ(read(Channel::kSpuRdMachStat), 0u) << "interrupts are never on";
  channels_.begin_run(false);
  EXPECT_EQ(read(Channel::kSpuRdSrr0), 0u);
}

// ---- where code may arrive, which decides how gets are copied (dma/local_store_bytes.h)

class SyncOfA : public SpuChannelsTest {
 protected:
  SyncOfA() { mfc_.confine_code({0x1000}); }

  std::uint32_t code_end_after_a_sync() {
    channels_.sync();
    return mfc_.code_end().value;
  }
};

TEST_F(SyncOfA, ProgramMeansCodeAnywhere) {
  channels_.announce_jobs();
  channels_.begin_run(false);
  EXPECT_EQ(code_end_after_a_sync(), dma::kLocalStoreBytes);
}

TEST_F(SyncOfA, KernelThatCallsAnnouncedJobsMeansTheirImages) {
  channels_.announce_jobs();
  channels_.begin_run(true);
  EXPECT_EQ(code_end_after_a_sync(), 0x1000u);
}

TEST_F(SyncOfA, KernelThatCallsUnannouncedJobsMeansCodeAnywhere) {
  channels_.begin_run(true);
  EXPECT_EQ(code_end_after_a_sync(), dma::kLocalStoreBytes);
}

TEST_F(SyncOfA, JobMeansCodeAnywhereAndOfItsCallerAfterwardsAnnouncedImages) {
  channels_.announce_jobs();
  channels_.begin_run(true);
  channels_.begin_job();
  channels_.end_job();
  EXPECT_EQ(code_end_after_a_sync(), 0x1000u);
  channels_.begin_job();
  EXPECT_EQ(code_end_after_a_sync(), dma::kLocalStoreBytes);
}

// ---- the decrementer, in simulated time: a tick for each operation

TEST_F(SpuChannelsTest, TheDecrementerCountsOperations) {
  EXPECT_EQ(read(Channel::kSpuRdDec), 0u);
  write(Channel::kSpuWrDec, 1000);
  for (std::uint32_t i = 1; i <= 5; ++i) EXPECT_EQ(read(Channel::kSpuRdDec), 1000 - i);
}

TEST_F(SpuChannelsTest, TheDecrementerEndsASleep) {
  write(Channel::kSpuWrDec, 1'000'000);
  EXPECT_EQ(wait_for(event::kDecrementer), event::kDecrementer);
  EXPECT_EQ(read(Channel::kSpuRdDec), 0xFFFF'FFFEu) << "it has counted on";
}

TEST_F(SpuChannelsTest, AcknowledgedWhileMaskedTheDecrementerStops) {
  write(Channel::kSpuWrDec, 1000);
  write(Channel::kSpuWrEventMask, event::kDecrementer);
  write(Channel::kSpuWrEventAck, event::kDecrementer);
  const std::uint32_t runs = read(Channel::kSpuRdDec);
  EXPECT_LT(read(Channel::kSpuRdDec), runs) << "in the mask, it goes on";
  write(Channel::kSpuWrEventMask, 0);
  write(Channel::kSpuWrEventAck, event::kDecrementer);
  const std::uint32_t stopped = read(Channel::kSpuRdDec);
  EXPECT_EQ(read(Channel::kSpuRdDec), stopped);
}

// ---- events

TEST_F(SpuChannelsTest, EveryEventOfTheRegistersHasItsBit) {
  struct Case {
    std::uint32_t event;
    std::function<void()> cause;
  };
  const std::vector<Case> cases{{event::kInMbox, [&] { registers_.write_in_mbox(1); }},
                                {event::kSignal1, [&] { registers_.write_signal(1, 1); }},
                                {event::kSignal2, [&] { registers_.write_signal(2, 1); }},
                                {event::kOutMboxFree,
                                 [&] {
                                   write(Channel::kSpuWrOutMbox, 1);
                                   registers_.read_out_mbox();
                                 }},
                                {event::kOutIntrMboxFree,
                                 [&] {
                                   write(Channel::kSpuWrOutIntrMbox, 1);
                                   registers_.read_out_intr_mbox();
                                 }},
                                {event::kMultisourceSync, [&] { write(Channel::kMfcWrMsSyncReq, 0); }}};
  for (const auto& [event, cause] : cases) {
    EXPECT_EQ(count(Channel::kSpuRdEventStat), 0u);
    cause();
    EXPECT_EQ(count(Channel::kSpuRdEventStat), 0u) << "not in the mask";
    EXPECT_EQ(wait_for(event), event);
    write(Channel::kSpuWrEventAck, event);
    write(Channel::kSpuWrEventMask, 0);
  }
}

TEST_F(SpuChannelsTest, OnlyTheFirstWordIntoAMailboxIsAnEdge) {
  registers_.write_in_mbox(1);
  EXPECT_EQ(wait_for(event::kInMbox), event::kInMbox);
  write(Channel::kSpuWrEventAck, event::kInMbox);
  registers_.write_in_mbox(2);
  EXPECT_EQ(count(Channel::kSpuRdEventStat), 0u);
  read(Channel::kSpuRdInMbox);
  read(Channel::kSpuRdInMbox);
  registers_.write_in_mbox(3);
  EXPECT_EQ(count(Channel::kSpuRdEventStat), 1u);
}

TEST_F(LazySpuChannels, TheMfcRaisesTagStatusListStallAndQueueSlot) {
  const std::uint32_t ea_low = static_cast<std::uint32_t>(lines_.ea().value);

  command(0x40, 0x1000, lines_.ea(), 128, 3);
  write(Channel::kMfcWrTagMask, 1u << 3);
  write(Channel::kMfcWrTagUpdate, 2);
  EXPECT_EQ(wait_for(event::kTagStatus), event::kTagStatus);
  write(Channel::kSpuWrEventAck, event::kTagStatus);
  EXPECT_EQ(count(Channel::kMfcRdTagStat), 1u);
  EXPECT_EQ(read(Channel::kMfcRdTagStat), 1u << 3);

  const std::array<std::uint32_t, 4> list{0x8000'0080, ea_low, 0x0000'0080, ea_low};
  std::memcpy(&local_store_[0x2000], list.data(), sizeof list);
  command(0x44, 0x1000, list_at(0x2000), sizeof list, 5);
  EXPECT_EQ(wait_for(event::kListStall), event::kListStall);
  write(Channel::kSpuWrEventAck, event::kListStall);
  EXPECT_EQ(count(Channel::kMfcRdListStallStat), 1u);
  EXPECT_EQ(read(Channel::kMfcRdListStallStat), 1u << 5);
  write(Channel::kMfcWrListStallAck, 5);

  for (int i = 0; i < 16; ++i) command(0x40, 0x1000, lines_.ea(), 128, 1);
  EXPECT_EQ(wait_for(event::kQueueSlot), event::kQueueSlot);
}

// ---- commands

TEST_F(SpuChannelsTest, SixWritesAreACommand) {
  lines_.span()[1].fill(0xC0FFEE);
  command(0x40, 0x1000, lines_.ea(1), 128, 3);
  std::uint32_t word = 0;
  std::memcpy(&word, &local_store_[0x1000], sizeof word);
  EXPECT_EQ(word, 0xC0FFEEu);
  EXPECT_EQ(rule_of(channels_.issue({.word = 0x40, .lsa = {8}, .ea = lines_.ea(), .size = 16})),
            dma::Rule::kLsaAlignment);
}

TEST_F(SpuChannelsTest, LineCommandsAnswerAtTheirChannel) {
  command(0xD0, 0x1000, lines_.ea(), 128, 0);
  EXPECT_EQ(count(Channel::kMfcRdAtomicStat), 1u);
  EXPECT_EQ(read(Channel::kMfcRdAtomicStat), 4u);
  EXPECT_EQ(count(Channel::kMfcRdAtomicStat), 0u);
  command(0xB4, 0x1000, lines_.ea(), 128, 0);
  EXPECT_EQ(read(Channel::kMfcRdAtomicStat), 0u);
}

TEST_F(LazySpuChannels, WhatCanMoveHasMovedBeforeTheSpuSleeps) {
  lines_.span()[0].fill(0xC0FFEE);
  command(0x40, 0x1000, lines_.ea(), 128, 3);
  std::uint32_t word = 0;
  std::memcpy(&word, &local_store_[0x1000], sizeof word);
  ASSERT_EQ(word, 0u);
  EXPECT_EQ(rule_of(channels_.read(number(Channel::kSpuRdInMbox))), dma::Rule::kDeadlock);
  std::memcpy(&word, &local_store_[0x1000], sizeof word);
  EXPECT_EQ(word, 0xC0FFEEu);
}

TEST_F(LazySpuChannels, ATransferOfItsOwnMayEndTheWait) {
  // An element of the list faults. The SPU, which would sleep, gets the fault instead.
  const std::array<std::uint32_t, 2> list{0x0000'0080, 0x0000'0000};
  std::memcpy(&local_store_[0x2000], list.data(), sizeof list);
  command(0x44, 0x1000, list_at(0x2000), sizeof list, 5);
  EXPECT_EQ(rule_of(channels_.read(number(Channel::kSpuRdInMbox))), dma::Rule::kEaNotMapped);
}

TEST_F(LazySpuChannels, ACountThatIsPolledTellsOfAFaultOfAnElement) {
  const std::array<std::uint32_t, 2> list{0x0000'0080, 0x0000'0000};
  for (const Channel channel : {Channel::kMfcCmd, Channel::kMfcRdTagStat, Channel::kMfcRdListStallStat,
                                Channel::kMfcRdAtomicStat, Channel::kSpuRdInMbox}) {
    mfc_.begin_job(0);
    std::memcpy(&local_store_[0x2000], list.data(), sizeof list);
    command(0x44, 0x1000, list_at(0x2000), sizeof list, 5);
    write(Channel::kMfcWrTagMask, 1u << 5);
    write(Channel::kMfcWrTagUpdate, 2);
    ChannelReply reply;
    for (std::uint64_t i = 0; i <= dma::Mfc::kMostVisits && !reply.fault; ++i)
      reply = channels_.count(number(channel));
    EXPECT_EQ(rule_of(reply), dma::Rule::kEaNotMapped) << channel_name(number(channel));
  }
}

TEST_F(LazySpuChannels, ATagWaitIsAWaitWhenSomethingIsQueued) {
  write(Channel::kMfcWrTagMask, 1);
  for (const std::uint64_t waits : {0u, 1u}) {
    if (waits == 1) command(0x40, 0x1000, lines_.ea(), 128, 0);
    write(Channel::kMfcWrTagUpdate, 2);
    read(Channel::kMfcRdTagStat);
    EXPECT_EQ(statistics_.waits[number(Channel::kMfcRdTagStat)].count, waits);
  }
  EXPECT_GT(statistics_.channel_waiting.count(), 0);
}

}  // namespace
}  // namespace softcell::ls_sim
