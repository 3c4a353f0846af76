// What callers of dma must keep to: who does not is told by an assertion, with the values.

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "../support/contract.h"
#include "softcell/dma/address_space.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/mfc_queue.h"
#include "softcell/dma/random_stream.h"
#include "softcell/dma/reservations.h"
#include "softcell/dma/transfer.h"

namespace softcell::dma {
namespace {

constexpr MfcCommand get(std::uint32_t tag) {
  return {.word = static_cast<std::uint32_t>(MfcOpcode::get), .size = 16, .tag = tag};
}

TEST(DmaContractsDeathTest, AFullQueueTakesNoCommand) {
  MfcQueue queue;
  for (int slot = 0; slot < MfcQueue::kSlots; ++slot) queue.push(get(0));
  SC_EXPECT_VIOLATES(queue.push(get(1)),
                     "mfc_queue\\.h:[0-9]+: .*push.*: SC_ASSERT\\(!full\\(\\)\\).* 16 slots");
}

TEST(DmaContractsDeathTest, ATagIsBelow32) {
  MfcQueue queue;
  SC_EXPECT_VIOLATES(queue.push(get(32)), "push.*: tag 32; the highest is 31");
}

TEST(DmaContractsDeathTest, ACommandThatWaitsForOthersCannotComplete) {
  MfcQueue queue;
  queue.push(get(3));
  MfcCommand fenced = get(3);
  fenced.word = static_cast<std::uint32_t>(MfcOpcode::getf);
  const int slot = queue.push(fenced);
  SC_EXPECT_VIOLATES(queue.complete(slot), "complete.*: slot 1 still waits for slots 1\n");
}

TEST(DmaContractsDeathTest, ARandomNumberHasABound) {
  RandomStream random(1, 2);
  SC_EXPECT_VIOLATES(random.below(0), "below.*: a random number below 0\n");
}

TEST(DmaContractsDeathTest, ABufferHasNoElementPastItsEnd) {
  AddressSpace space;
  const Buffer<float> buffer(space, "four", 4);
  EXPECT_EQ(buffer.ea(4).value, buffer.ea().value + 16) << "where the elements end may be asked";
  SC_EXPECT_VIOLATES(buffer.ea(5), "element 5 of a buffer of 4\n");
}

TEST(DmaContractsDeathTest, ABufferIsNotReadBehindItsEnd) {
  AddressSpace space;
  Buffer<float> buffer(space, "four", 4);
  buffer[3] = 1;
  SC_EXPECT_VIOLATES(buffer[4] = 1, "element 4 of a buffer of 4\n");
  SC_EXPECT_VIOLATES(static_cast<void>(std::as_const(buffer)[4]), "element 4 of a buffer of 4\n");
  SC_EXPECT_VIOLATES(Buffer<float>()[0] = 1, "element 0 of a buffer of 0\n");
}

TEST(DmaContractsDeathTest, AnAccessHasBytes) {
  AddressSpace space;
  const Buffer<float> buffer(space, "four", 4);
  SC_EXPECT_VIOLATES(space.resolve(buffer.ea(), 0, SpeAccess::kRead),
                     "resolve.*: an access of 0 bytes at 0x5ea01");
}

TEST(DmaContractsDeathTest, AReservationIsOfAnAlignedWordOrLine) {
  Reservations reservations;
  ReservationHolder holder(reservations);
  alignas(kLineBytes) std::array<std::byte, kLineBytes> line{}, to{};
  SC_EXPECT_VIOLATES(reservations.load_and_reserve(holder, kMainMemoryBase + 64, line.data(), to.data()),
                     "load_and_reserve.*: 128 bytes at 0x5ea010000040\n");
}

TEST(DmaContractsDeathTest, AHolderBelongsToOneAddressSpace) {
  Reservations mine, others;
  ReservationHolder holder(mine);
  alignas(kLineBytes) std::array<std::byte, kLineBytes> line{}, to{};
  SC_EXPECT_VIOLATES(others.read(holder, kMainMemoryBase, line.data(), to.data(), kLineBytes),
                     "read.*: holder 0 belongs to another AddressSpace\n");
}

TEST(DmaContractsDeathTest, AHolderDoesNotOutliveItsReservations) {
  auto reservations = std::make_unique<Reservations>();
  const ReservationHolder holder(*reservations);
  SC_EXPECT_VIOLATES(reservations.reset(), "places_taken.none.*: 1 holders outlive their Reservations\n");
}

TEST(DmaContractsDeathTest, AGetArrivesInTheLocalStoreOfItsMfc) {
  AddressSpace space;
  const Buffer<float> source(space, "source", 32);
  const auto store = std::make_unique<std::array<std::byte, kLocalStoreBytes + 128>>();
  StoragePort port(store->data(), space, nullptr);
  const auto place = std::get<StoragePlace>(port.resolve(source.ea(), 128, SpeAccess::kRead));
  Transfer transfer = Transfer::get(place, store->data() + kLocalStoreBytes - 64, 128);
  SC_EXPECT_VIOLATES(transfer.move_rest(port),
                     "read.*: 128 bytes from 0x5ea0.* leave the local store: 262080 ");
}

}  // namespace
}  // namespace softcell::dma
