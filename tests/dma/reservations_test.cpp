#include "softcell/dma/reservations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

namespace softcell::dma {
namespace {

using Line = std::array<std::byte, kLineBytes>;

Line line_of(int value) {
  Line line;
  line.fill(static_cast<std::byte>(value));
  return line;
}

struct LossCounter : ReservationListener {
  void on_reservation_lost() override { ++losses; }
  int losses = 0;
};

// Two holders and four lines of storage.
class ReservationsTest : public testing::Test {
 protected:
  static constexpr EffectiveAddress kBase{0x5EA0'1000'0000};
  static constexpr std::uint32_t kBytes = 4 * kLineBytes;

  EffectiveAddress ea(std::uint32_t offset) const { return kBase + offset; }
  std::byte* host(std::uint32_t offset) { return storage_.data() + offset; }

  Line reserve(ReservationHolder& holder, std::uint32_t offset) {
    Line line;
    reservations_.load_and_reserve(holder, ea(offset), host(offset), line.data());
    return line;
  }
  bool store_conditional(ReservationHolder& holder, std::uint32_t offset, int value) {
    return reservations_.store_conditional(holder, ea(offset), host(offset), line_of(value).data());
  }
  void store_line(ReservationHolder& holder, std::uint32_t offset, int value) {
    reservations_.store_line(holder, ea(offset), host(offset), line_of(value).data());
  }
  void write(ReservationHolder& holder, std::uint32_t offset, std::uint32_t bytes, int value) {
    const std::vector<std::byte> from(bytes, static_cast<std::byte>(value));
    reservations_.write(holder, ea(offset), host(offset), from.data(), bytes);
  }
  // True when exactly [offset, offset + bytes) of the storage holds `value`.
  bool holds_only(std::uint32_t offset, std::uint32_t bytes, int value) {
    for (std::uint32_t at = 0; at < kBytes; ++at) {
      const bool inside = at >= offset && at < offset + bytes;
      if ((*host(at) == static_cast<std::byte>(value)) != inside) return false;
    }
    return true;
  }

  alignas(kLineBytes) std::array<std::byte, kBytes> storage_{};
  Reservations reservations_;
  LossCounter losses_;
  ReservationHolder one_{reservations_, &losses_};
  ReservationHolder two_{reservations_};
};

TEST_F(ReservationsTest, APutllcAfterItsGetllarStores) {
  *host(kLineBytes + 5) = std::byte{7};
  EXPECT_EQ(reserve(one_, kLineBytes)[5], std::byte{7});
  EXPECT_TRUE(reservations_.holds(one_));
  EXPECT_TRUE(store_conditional(one_, kLineBytes, 1));
  EXPECT_TRUE(holds_only(kLineBytes, kLineBytes, 1));
  EXPECT_FALSE(reservations_.holds(one_));
  EXPECT_EQ(losses_.losses, 0) << "its own putllc is no loss";
}

TEST_F(ReservationsTest, APutllcWithoutReservationFails) {
  EXPECT_FALSE(store_conditional(one_, 0, 1));
  EXPECT_TRUE(holds_only(0, 0, 1));
}

TEST_F(ReservationsTest, AReservationServesOnePutllc) {
  reserve(one_, 0);
  EXPECT_TRUE(store_conditional(one_, 0, 1));
  EXPECT_FALSE(store_conditional(one_, 0, 2));
  EXPECT_TRUE(holds_only(0, kLineBytes, 1));
}

TEST_F(ReservationsTest, APutllcOfAnotherLineFailsAndGivesUpTheReservation) {
  reserve(one_, 0);
  EXPECT_FALSE(store_conditional(one_, kLineBytes, 1));
  EXPECT_FALSE(reservations_.holds(one_));
  EXPECT_FALSE(store_conditional(one_, 0, 1));
}

TEST_F(ReservationsTest, ASecondGetllarReplacesTheFirst) {
  reserve(one_, 0);
  reserve(one_, kLineBytes);
  write(two_, 0, 16, 9);
  EXPECT_EQ(losses_.losses, 0);
  EXPECT_TRUE(store_conditional(one_, kLineBytes, 1));
}

TEST_F(ReservationsTest, TheFirstOfTwoPutllcsWins) {
  reserve(one_, 0);
  reserve(two_, 0);
  EXPECT_TRUE(store_conditional(two_, 0, 2));
  EXPECT_EQ(losses_.losses, 1);
  EXPECT_FALSE(store_conditional(one_, 0, 1));
  EXPECT_TRUE(holds_only(0, kLineBytes, 2));
}

TEST_F(ReservationsTest, AFailedPutllcTakesNobodysReservation) {
  reserve(one_, 0);
  EXPECT_FALSE(store_conditional(two_, 0, 2));
  EXPECT_EQ(losses_.losses, 0);
  EXPECT_TRUE(store_conditional(one_, 0, 1));
}

TEST_F(ReservationsTest, EveryKindOfWriteByOthersLosesItOnce) {
  const auto lost_after = [&](auto&& foreign_write) {
    losses_.losses = 0;
    reserve(one_, kLineBytes);
    foreign_write();
    return losses_.losses == 1 && !reservations_.holds(one_) && !store_conditional(one_, kLineBytes, 1);
  };
  EXPECT_TRUE(lost_after([&] { store_line(two_, kLineBytes, 2); }));
  EXPECT_TRUE(lost_after([&] { write(two_, kLineBytes, 1, 2); }));
  EXPECT_TRUE(lost_after([&] { write(two_, 2 * kLineBytes - 4, 4, 2); }));
  EXPECT_TRUE(lost_after([&] { write(two_, kLineBytes - 16, 32, 2); }));
  EXPECT_TRUE(lost_after([&] { write(two_, 0, kBytes, 2); }));
  EXPECT_TRUE(lost_after([&] {
    write(two_, kLineBytes, kLineBytes, 2);
    write(two_, kLineBytes, kLineBytes, 3);
  }));
}

TEST_F(ReservationsTest, WritesBesideTheLineLoseNothing) {
  reserve(one_, kLineBytes);
  write(two_, 0, kLineBytes, 2);
  write(two_, 2 * kLineBytes, 2 * kLineBytes, 2);
  store_line(two_, 0, 3);
  EXPECT_TRUE(reservations_.holds(one_));
  EXPECT_EQ(losses_.losses, 0);
}

TEST_F(ReservationsTest, ReadsLoseNothing) {
  std::vector<std::byte> to(kBytes);
  reserve(one_, kLineBytes);
  reservations_.read(two_, ea(0), host(0), to.data(), kBytes);
  reservations_.read(two_, ea(kLineBytes), host(kLineBytes), to.data(), 16);
  reserve(two_, kLineBytes);
  EXPECT_TRUE(store_conditional(one_, kLineBytes, 1));
}

// A plain put of the holder itself: as in RPCS3, unconfirmed on the hardware.
TEST_F(ReservationsTest, AnOwnWriteLosesTheReservationWithoutAnEvent) {
  for (const std::uint32_t bytes : {16u, 2 * kLineBytes}) {
    reserve(one_, kLineBytes);
    write(one_, kLineBytes, bytes, 5);
    EXPECT_FALSE(reservations_.holds(one_));
    EXPECT_FALSE(store_conditional(one_, kLineBytes, 1));
  }
  EXPECT_EQ(losses_.losses, 0);
}

TEST_F(ReservationsTest, AnOwnPutllucGivesTheReservationOfItsLineUp) {
  reserve(one_, 0);
  store_line(one_, 0, 1);
  EXPECT_FALSE(store_conditional(one_, 0, 2));
  reserve(one_, 0);
  store_line(one_, kLineBytes, 1);
  EXPECT_TRUE(store_conditional(one_, 0, 2));
}

// Every place and size in four lines, with and without a reservation in the way, which is another path.
TEST_F(ReservationsTest, CopiesMoveTheirBytesAndNoOthers) {
  std::vector<std::byte> to(kBytes);
  for (const bool reserved : {false, true}) {
    for (std::uint32_t offset = 0; offset < kBytes; offset += 16) {
      for (std::uint32_t bytes = 16; bytes <= kBytes - offset; bytes += 16) {
        storage_.fill(std::byte{0});
        if (reserved) reserve(two_, kLineBytes);
        write(one_, offset, bytes, 3);
        ASSERT_TRUE(holds_only(offset, bytes, 3)) << offset << ' ' << bytes;
        if (reserved) reserve(two_, kLineBytes);
        std::fill(to.begin(), to.end(), std::byte{0});
        reservations_.read(one_, ea(offset), host(offset), to.data() + offset, bytes);
        ASSERT_TRUE(std::equal(to.begin(), to.end(), storage_.begin())) << offset << ' ' << bytes;
      }
    }
  }
}

TEST_F(ReservationsTest, SmallCopiesMoveTheirBytesAndNoOthers) {
  for (const std::uint32_t bytes : {1u, 2u, 4u, 8u}) {
    for (std::uint32_t offset = 0; offset < 2 * kLineBytes; offset += bytes) {
      storage_.fill(std::byte{0});
      write(one_, offset, bytes, 3);
      ASSERT_TRUE(holds_only(offset, bytes, 3)) << offset << ' ' << bytes;
    }
  }
}

TEST_F(ReservationsTest, HasRoomForAsManyHoldersAsStated) {
  std::vector<std::unique_ptr<ReservationHolder>> more;
  for (int i = 2; i < Reservations::kMaxHolders; ++i) {
    more.push_back(std::make_unique<ReservationHolder>(reservations_));
  }
  EXPECT_THROW(ReservationHolder(reservations_, nullptr), std::runtime_error);
  reserve(*more.back(), 0);
  write(one_, 0, 16, 1);
  EXPECT_FALSE(reservations_.holds(*more.back()));
  more.pop_back();
  EXPECT_NO_THROW(ReservationHolder(reservations_, nullptr));
}

TEST_F(ReservationsTest, AHolderThatLeavesTakesItsReservationAlong) {
  LossCounter losses;
  {
    ReservationHolder brief(reservations_, &losses);
    reserve(brief, 0);
  }
  write(one_, 0, 16, 1);
  EXPECT_EQ(losses.losses, 0);
  const ReservationHolder next(reservations_);
  EXPECT_FALSE(reservations_.holds(next));
}

}  // namespace
}  // namespace softcell::dma
