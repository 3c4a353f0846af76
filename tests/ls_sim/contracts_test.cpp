// The preconditions of functions inside ls_sim and of its public headers: an assertion reports a caller that breaks one,
// with the values.

#include <chrono>
#include <memory>

#include "../support/contract.h"
#include "channels/decrementer.h"
#include "channels/spe_monitor.h"
#include "channels/spe_registers.h"
#include "checker/commands_in_flight.h"
#include "checker/unsynced_bytes.h"
#include "image/local_store_map.h"
#include "image/object_map.h"
#include "softcell/dma/address_space.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::ls_sim {
namespace {

KernelImage image_named(const char* name) {
  KernelImage image;
  image.name = name;
  return image;
}

TEST(LsSimContractsDeathTest, TimeDoesNotGoBack) {
  Decrementer decrementer;
  decrementer.write(100, 50);
  SC_EXPECT_VIOLATES(
      decrementer.read(49),
      "decrementer\\.h:[0-9]+: .*read.*: SC_ASSERT\\(now >= since_\\).*: tick 49 after tick 50\n");
}

TEST(LsSimContractsDeathTest, AnSpeHasTwoSignalRegisters) {
  SpeRegisters registers;
  SC_EXPECT_VIOLATES(registers.write_signal(3, 1), "signal register 3\n");
}

TEST(LsSimContractsDeathTest, AnSpeRunsOneImageAtATime) {
  SpeMonitor monitor{SpeOptions{}};
  const KernelImage image = image_named("saxpy");
  const SpeMonitor::Lock lock = monitor.lock();
  monitor.start(2, image, std::chrono::steady_clock::now());
  SC_EXPECT_VIOLATES(monitor.start(2, image, std::chrono::steady_clock::now()),
                     "start.*: SPE 2 is started while it runs saxpy\n");
}

TEST(LsSimContractsDeathTest, ThereAreSixSpes) {
  SpeMonitor monitor{SpeOptions{}};
  const SpeMonitor::Lock lock = monitor.lock();
  SC_EXPECT_VIOLATES(static_cast<void>(monitor.runs(6)), "SPE 6 of 6\n");
}

TEST(LsSimContractsDeathTest, OnlyUnsyncedBytesHaveAWriter) {
  const auto unsynced = std::make_unique<UnsyncedBytes>();
  unsynced->mark(0x100, 16, 0x80);
  EXPECT_EQ(unsynced->writer_of(0x10F), 0x80u);
  SC_EXPECT_VIOLATES(unsynced->writer_of(0x110), "writer_of.*: byte 272 is in no unsynced range\n");
}

TEST(LsSimContracts, ASyncClearsUnsyncedBytesWhereverTheyAre) {
  const auto unsynced = std::make_unique<UnsyncedBytes>();
  for (int round = 0; round < 2; ++round) {
    for (std::uint32_t lsa = 0; lsa < dma::kLocalStoreBytes; lsa += 1008) unsynced->mark(lsa + 8, 16, 0x80);
    for (std::uint32_t lsa = 0; lsa < dma::kLocalStoreBytes; lsa += 1008) {
      EXPECT_TRUE(unsynced->contains(lsa + 8) && unsynced->contains(lsa + 23)) << lsa;
      EXPECT_FALSE(unsynced->contains(lsa + 7) || unsynced->contains(lsa + 24)) << lsa;
    }
    unsynced->clear();
    EXPECT_EQ(unsynced->first_in(0, dma::kLocalStoreBytes), dma::kLocalStoreBytes);
  }
}

TEST(LsSimContractsDeathTest, OnlyCommandsThatWereIssuedComplete) {
  CommandsInFlight in_flight;
  SC_EXPECT_VIOLATES(in_flight.complete(1, 7), "complete.*: commands up to 7 of 0 are complete\n");
}

TEST(LsSimContractsDeathTest, AStackDoesNotEndBeforeItBegins) {
  const KernelImage image = image_named("saxpy");
  SC_EXPECT_VIOLATES(ObjectMap(image, {.begin = 512, .end = 256}), "the stack of saxpy is 512 to 256\n");
}

TEST(LsSimContractsDeathTest, AnImageEndsInTheLocalStore) {
  KernelImage image = image_named("saxpy");
  image.sizes.end = dma::kLocalStoreBytes + 16;
  SC_EXPECT_VIOLATES(local_store_map(image), "saxpy ends at 262160 with 0 bytes of bss\n");
}

TEST(LsSimContractsDeathTest, ATraceHasAsManySpesAsItWasMadeFor) {
  Trace trace(2);
  SC_EXPECT_VIOLATES(trace.spe(2), "Trace::spe.*: SPE 2 in a trace of 2\n");
}

TEST(LsSimContractsDeathTest, WhatATraceRecordsEndsAfterItsBegin) {
  Trace trace(1);
  const KernelImage image = image_named("saxpy");
  SC_EXPECT_VIOLATES(trace.spe(0).on_job(image, 3, 20, 10, false),
                     "on_job.*: job 3 of saxpy begins at 20 and ends at 10\n");
  SC_EXPECT_VIOLATES(trace.spe(0).on_wait(28, 20, 10),
                     "on_wait.*: a wait at channel 28 begins at 20 and ends at 10\n");
  SC_EXPECT_VIOLATES(trace.spe(0).on_stack_used(image, dma::kLocalStoreBytes + 1),
                     "on_stack_used.*: saxpy has used 262145 bytes of stack\n");
}

TEST(LsSimContractsDeathTest, JobsBeginAndEndInsideARun) {
  SpeMonitor monitor{SpeOptions{}};
  const SpeMonitor::Lock lock = monitor.lock();
  SC_EXPECT_VIOLATES(monitor.begin_job(1, std::chrono::steady_clock::now()),
                     "begin_job.*: a job begins in SPE 1, which does not run\n");
  SC_EXPECT_VIOLATES(monitor.end_job(1), "end_job.*: a job ends in SPE 1, and none has begun\n");
}

TEST(LsSimContractsDeathTest, ThePpuWaitsForSomething) {
  SpeMonitor monitor{SpeOptions{}};
  SpeMonitor::Lock lock = monitor.lock();
  SC_EXPECT_VIOLATES(monitor.ppu_wait(lock, nullptr),
                     "ppu_wait.*: the PPU side.s wait has no condition; 0 others wait");
}

TEST(LsSimContractsDeathTest, CommandsInFlightHaveTags) {
  CommandsInFlight in_flight;
  CommandInFlight command;
  command.command.tag = 32;
  SC_EXPECT_VIOLATES(in_flight.add(command), "add.*: a command of tag 32 is in flight\n");
}

TEST(LsSimContractsDeathTest, PartsOfAnImageEndAfterTheirBegin) {
  KernelImage image = image_named("saxpy");
  image.text_begin = 256;
  image.text_end = 128;
  SC_EXPECT_VIOLATES(local_store_map(image), "saxpy has text from 256 to 128, constants from 0 to 0");
}

TEST(LsSimContractsDeathTest, AListenerIsThereBeforeTheFirstRun) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a group has threads
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  KernelImage image = image_named("stop");
  image.machine = Machine::kSpu;
  image.bytes.resize(16);
  image.sizes.end = image.begin + 16;
  group.prepare(0, image, {});
  SC_EXPECT_VIOLATES(group.on_end([](int, const RunResult&) {}), "on_end\\(\\) after 1 runs were prepared\n");
}

TEST(LsSimContractsDeathTest, AnEngineRunsWhatWasLoaded) {
  class NoChannels final : public ChannelPort {
    ChannelReply read(std::uint32_t) override { return {}; }
    ChannelReply write(std::uint32_t, std::uint32_t) override { return {}; }
    ChannelReply count(std::uint32_t) override { return {}; }
    ChannelReply issue(const dma::MfcCommand&) override { return {}; }
    void sync() override {}
  } channels;
  LocalStore local_store;
  const std::unique_ptr<Engine> engine = make_native_engine(local_store);
  SC_EXPECT_VIOLATES(engine->run({.spe_id = 4}, channels), "run\\(4\\) before load\\(\\)\n");
}

TEST(LsSimContractsDeathTest, AJobImageLiesInMainStorage) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a group has threads
  dma::AddressSpace memory;
  SpeGroup group(memory, {.spes = 1});
  KernelImage image = image_named("saxpy");
  image.main = 4;
  SC_EXPECT_VIOLATES(group.register_job_image({0x1234}, image),
                     "register_job_image.*: the job image saxpy lies at 0x1234, which no DMA can fetch\n");
}

}  // namespace
}  // namespace softcell::ls_sim
