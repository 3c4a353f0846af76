// Mailboxes, signal registers, events, decrementer and time base, each by itself.

#include <chrono>
#include <optional>

#include <gtest/gtest.h>

#include "channels/decrementer.h"
#include "channels/event_facility.h"
#include "channels/mailbox.h"
#include "channels/signal_register.h"
#include "channels/spu_clock.h"

namespace softcell::ls_sim {
namespace {

TEST(MailboxTest, GivesWordsInTheOrderInWhichTheyCame) {
  Mailbox<4> mailbox;
  EXPECT_EQ(mailbox.read(), std::nullopt);
  for (std::uint32_t round = 0; round < 3; ++round) {  // beyond the end of its ring of words
    for (std::uint32_t i = 0; i < 3; ++i) mailbox.write(10 * round + i);
    EXPECT_EQ(mailbox.count(), 3u);
    EXPECT_EQ(mailbox.free_slots(), 1u);
    for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(mailbox.read(), 10 * round + i);
    EXPECT_TRUE(mailbox.empty());
  }
}

TEST(MailboxTest, AWordIntoAFullOneReplacesTheNewest) {
  Mailbox<4> mailbox;
  for (std::uint32_t i = 1; i <= 6; ++i) mailbox.write(i);
  EXPECT_TRUE(mailbox.full());
  for (const std::uint32_t expected : {1u, 2u, 3u, 6u}) EXPECT_EQ(mailbox.read(), expected);
  EXPECT_EQ(mailbox.read(), std::nullopt);
}

TEST(SignalRegisterTest, OverwriteModeKeepsTheLast) {
  SignalRegister signal;
  EXPECT_EQ(signal.count(), 0u);
  signal.write(0x5);
  signal.write(0x2);
  EXPECT_EQ(signal.count(), 1u);
  EXPECT_EQ(signal.read(), 0x2u);
  EXPECT_EQ(signal.count(), 0u);
  EXPECT_EQ(signal.read(), std::nullopt);
}

TEST(SignalRegisterTest, OrModeCollectsUntilItIsRead) {
  SignalRegister signal;
  signal.set_mode(SignalMode::kOr);
  signal.write(0x5);
  signal.write(0x2);
  EXPECT_EQ(signal.read(), 0x7u);
  signal.write(0x8);
  EXPECT_EQ(signal.read(), 0x8u) << "bits that were read before came back";
}

TEST(SignalRegisterTest, AZeroIsAValueToo) {
  SignalRegister signal;
  signal.write(0);
  EXPECT_EQ(signal.count(), 1u);
  EXPECT_EQ(signal.read(), 0u);
}

TEST(EventFacilityTest, AnEventOutsideTheMaskWaitsForTheMask) {
  EventFacility events;
  events.raise(event::kSignal1);
  EXPECT_EQ(events.count(), 0u);
  events.write_mask(event::kSignal1 | event::kInMbox);
  EXPECT_EQ(events.count(), 1u);
  EXPECT_EQ(events.read(), event::kSignal1);
}

TEST(EventFacilityTest, ReadingTakesTheCountAndNotTheEvent) {
  EventFacility events;
  events.write_mask(event::kInMbox);
  events.raise(event::kInMbox);
  EXPECT_EQ(events.read(), event::kInMbox);
  EXPECT_EQ(events.count(), 0u);
  EXPECT_EQ(events.read(), std::nullopt);
  events.raise(event::kInMbox);  // the next edge is a new event
  EXPECT_EQ(events.read(), event::kInMbox);
}

TEST(EventFacilityTest, AcknowledgingOneLeavesTheOthersNews) {
  EventFacility events;
  events.write_mask(event::kSignal1 | event::kSignal2);
  events.raise(event::kSignal1 | event::kSignal2);
  EXPECT_EQ(events.read(), event::kSignal1 | event::kSignal2);
  events.acknowledge(event::kSignal1);
  EXPECT_EQ(events.count(), 1u);
  EXPECT_EQ(events.read(), event::kSignal2);
  events.acknowledge(event::kSignal2);
  EXPECT_EQ(events.count(), 0u);
}

TEST(EventFacilityTest, OneAcknowledgedBeforeItIsReadIsAPhantom) {
  EventFacility events;
  events.write_mask(event::kDecrementer);
  events.raise(event::kDecrementer);
  events.acknowledge(event::kDecrementer);
  EXPECT_EQ(events.count(), 1u);
  EXPECT_EQ(events.read(), 0u);
}

TEST(EventFacilityTest, ShowsOnlyWhatTheMaskHas) {
  EventFacility events;
  events.write_mask(event::kSignal1);
  events.raise(event::kSignal1 | event::kLostReservation);
  EXPECT_EQ(events.read(), event::kSignal1);
  EXPECT_EQ(events.mask(), event::kSignal1);
}

TEST(DecrementerTest, CountsDownWithTheTimeBase) {
  Decrementer decrementer;
  EXPECT_EQ(decrementer.read(1000), 0u) << "it starts when it is written";
  decrementer.write(100, 1000);
  EXPECT_EQ(decrementer.read(1000), 100u);
  EXPECT_EQ(decrementer.read(1040), 60u);
  EXPECT_EQ(decrementer.read(1101), 0xFFFF'FFFFu);
}

TEST(DecrementerTest, RaisesItsEventWhereItPassesZero) {
  Decrementer decrementer;
  EXPECT_FALSE(decrementer.take_event(~std::uint64_t{0} / 2));
  decrementer.write(100, 1000);
  EXPECT_EQ(decrementer.next_event(), 1101u);
  EXPECT_FALSE(decrementer.take_event(1100));
  EXPECT_TRUE(decrementer.take_event(1101));
  EXPECT_FALSE(decrementer.take_event(1102)) << "one event for one passage";
  EXPECT_EQ(decrementer.next_event(), 1101u + (std::uint64_t{1} << 32));
  EXPECT_TRUE(decrementer.take_event(1101 + 5 * (std::uint64_t{1} << 32)));
  EXPECT_EQ(decrementer.next_event(), 1101u + 6 * (std::uint64_t{1} << 32));
}

TEST(DecrementerTest, KeepsItsValueWhenStopped) {
  Decrementer decrementer;
  decrementer.write(100, 0);
  decrementer.stop(30);
  EXPECT_EQ(decrementer.read(1'000'000), 70u);
  EXPECT_FALSE(decrementer.take_event(1'000'000));
  EXPECT_EQ(decrementer.next_event(), std::nullopt);
}

TEST(SpuClockTest, SimulatedTimeGoesByOperationsAndWhatIsSkipped) {
  SpuClock clock(Clock::kSimulated);
  EXPECT_EQ(clock.ticks(), 0u);
  for (int i = 0; i < 10; ++i) clock.on_operation();
  clock.skip(90);
  EXPECT_EQ(clock.ticks(), 10 * SpuClock::kTicksPerOperation + 90);
}

TEST(SpuClockTest, HostTimeIsCountedAtTheFrequencyOfTheTimeBase) {
  EXPECT_EQ(SpuClock::to_ticks(std::chrono::seconds(1)), 79'800'000u);
  EXPECT_EQ(SpuClock::to_ticks(std::chrono::nanoseconds(1000)), 79u);
  EXPECT_EQ(SpuClock::to_ticks(std::chrono::hours(24 * 365)), 79'800'000ull * 3600 * 24 * 365);
  const SpuClock clock(Clock::kHost);
  const std::uint64_t before = clock.ticks();
  const auto later = clock.host_time_of(before + 79'800);  // 1 ms
  while (SpuClock::Host::now() < later) {
  }
  EXPECT_GE(clock.ticks(), before + 79'800);
}

}  // namespace
}  // namespace softcell::ls_sim
