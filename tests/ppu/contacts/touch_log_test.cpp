// What contact events say of who touches whom from call to call.
#include "ppu/contacts/touch_log.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Kind = ContactEvent::Kind;

class TouchLogTest : public ::testing::Test {
 protected:
  const SoftBody<3> body_{make_soft_body_model(make_box({1, 1, 1}, 0.5f), {.cell_size = 0.5f}), {0, 0, 0}};
  TouchLog<ContactEvent> log_;

  /// A substep in which the body touches something at two points, whose mean is (2, 0, 0).
  void touch(std::uint64_t other = 7) {
    log_.begin_step();
    auto& touch = log_[{0, TouchedKind::kRigid, other}];
    touch.event.body = &body_;
    touch.add(3, 3, {1, 0, 0}, {0, 1, 0});
    touch.add(1, 1, {5, 0, 0}, {0, 1, 0});
  }
  static void expect_mean(const ContactEvent& event) {
    EXPECT_EQ(event.position, Vector3f(2, 0, 0));
    EXPECT_EQ(event.normal, Vector3f(0, 1, 0));
  }
};

TEST_F(TouchLogTest, ATouchBeginsGoesOnAndEnds) {
  touch();
  auto events = log_.poll();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kBegin);
  EXPECT_EQ(events[0].impulse, 4);
  expect_mean(events[0]);
  touch();
  touch();
  events = log_.poll();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kPersist);
  EXPECT_EQ(events[0].impulse, 8);
  log_.begin_step();
  events = log_.poll();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kEnd);
  EXPECT_EQ(events[0].impulse, 0);
  expect_mean(events[0]);
  log_.begin_step();
  EXPECT_TRUE(log_.poll().empty());
}

TEST_F(TouchLogTest, WithoutASubstepATouchGoesOn) {
  touch();
  log_.poll();
  for (int frame = 0; frame < 2; ++frame) {
    const auto events = log_.poll();
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, Kind::kPersist);
    EXPECT_EQ(events[0].impulse, 0);
    expect_mean(events[0]);
  }
  touch();
  EXPECT_EQ(log_.poll().at(0).kind, Kind::kPersist);
}

TEST_F(TouchLogTest, ARemovedBodyEndsWhatHasBegunWithTheMeanOfItsPoints) {
  touch();
  log_.poll();
  touch();
  log_.forget(body_);
  const auto events = log_.poll();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kEnd);
  expect_mean(events[0]);
  EXPECT_TRUE(log_.poll().empty());
}

/// The address sanitizer sees if it is read.
TEST_F(TouchLogTest, ABodyThatIsGoneIsNotRead) {
  auto gone = std::make_unique<SoftBody<3>>(body_);
  touch();
  for (auto& event : log_.poll()) EXPECT_EQ(event.kind, Kind::kBegin);
  log_.begin_step();
  auto& touch = log_[{1, TouchedKind::kRigid, 7}];
  touch.event.body = gone.get();
  touch.add(1, 1, {5, 0, 0}, {0, 1, 0});
  ASSERT_EQ(log_.poll().size(), 2u);
  log_.forget(*gone);
  gone.reset();
  log_.begin_step();
  const auto events = log_.poll();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kEnd);
}

TEST_F(TouchLogTest, NobodyHearsTheEndOfWhatHasNotBegun) {
  touch();
  log_.forget(body_);
  EXPECT_TRUE(log_.poll().empty());
  EXPECT_TRUE(log_.poll().empty());
}

}  // namespace
}  // namespace softcell::ppu
