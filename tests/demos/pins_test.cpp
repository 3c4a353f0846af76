// Soft bodies that a hand pins where they are, in both dimensions: they hang after it lets go, and fall when the pin is taken off.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "input/recording.h"
#include "scene/beginning.h"
#include "scene_file/scene_library.h"
#include "scene_file/state_file.h"
#include "simulation/pins.h"
#include "simulation_runs.h"

namespace softcell::demos {
namespace {

template <int Dimension>
using Vector = Eigen::Vector<float, Dimension>;

template <int Dimension>
InputEvent<Dimension> hold_at(const Vector<Dimension>& at, std::uint32_t hand = kUsersHand,
                              Action action = Action::kHold) {
  return {.action = action, .hand = hand, .body = 0, .value = at};
}

template <int Dimension>
struct Pinned;
template <>
struct Pinned<2> {
  using Simulation = Simulation2d;
  static constexpr const char* kScene = "man";
  static auto scene() { return load_scene_2d(kScene); }
  static void fill(Shown2d& shown, const Simulation2d& run) { run.show(shown); }
  using Shown = Shown2d;
};
template <>
struct Pinned<3> {
  using Simulation = Simulation3d;
  static constexpr const char* kScene = "drop";
  static auto scene() { return load_scene_3d(kScene); }
  static void fill(Shown3d& shown, Simulation3d& run) { run.finish(), run.show(shown); }
  using Shown = Shown3d;
};

template <class Dimension>
class Pin : public testing::Test {
 public:
  static constexpr int kDimension = Dimension::value;
  using P = Pinned<kDimension>;
  using Event = InputEvent<kDimension>;
  using Events = std::vector<Event>;

  void step_with(const Events& events) { run.step(events); }
  /// The top of the body is taken, pinned and let go.
  void pin_top(std::uint32_t hand = kUsersHand) {
    step_with({hold_at<kDimension>(top(), hand), {.action = Action::kPin, .hand = hand}});
    step_with({{.action = Action::kRelease, .hand = hand}});
  }
  Vector<kDimension> place_of(std::size_t particle) const { return run.soft_body(0).position(particle); }
  std::size_t highest() const {
    const auto positions = run.soft_body(0).positions();
    std::size_t found = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (positions[i].y() > positions[found].y()) found = i;
    return found;
  }
  Vector<kDimension> top() const { return place_of(highest()); }
  float height(std::size_t body = 0) const { return run.soft_body(body).centre_of_mass().y(); }
  /// How far the body falls in so many frames.
  float falls(int frames) {
    const float before = height();
    step(run, frames);
    return before - height();
  }
  std::size_t heads() {
    typename P::Shown shown;
    P::fill(shown, run);
    return shown.ropes.size();
  }

  decltype(P::scene()) scene = P::scene();
  typename P::Simulation run{scene, {}};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Pin, Dimensions);

const InputEvent<3> kGoHome3d{.action = Action::kHome, .body = kEveryBody};

TYPED_TEST(Pin, HoldsTheBodyWhenTheHandLetsGo) {
  const std::size_t held = this->highest();
  const auto before = this->place_of(held);
  this->pin_top();
  step(this->run, 30);  // it stretches
  EXPECT_LT(this->falls(60), 0.1f);
  EXPECT_LT((this->place_of(held) - before).norm(), 0.02f) << "the pinned part stays where it was";
  EXPECT_EQ(this->heads(), 1u);
  this->step_with({{.action = Action::kUnpin, .body = kEveryBody}});
  EXPECT_GT(this->falls(40), 0.5f);
  EXPECT_EQ(this->heads(), 0u);
}

TYPED_TEST(Pin, HoldsWhatAScriptsHandHoldsByAParticle) {
  this->step_with({hold_at<TestFixture::kDimension>(this->top(), 3, Action::kGrab),
                   {.action = Action::kPin, .hand = 3},
                   {.action = Action::kRelease, .hand = 3}});
  step(this->run, 30);
  EXPECT_LT(this->falls(60), 0.1f);
}

TYPED_TEST(Pin, OfAHandThatHoldsNothingOrOfABodyThatIsNoneHasNoEffect) {
  this->step_with({{.action = Action::kPin, .hand = kUsersHand},
                   {.action = Action::kUnpin, .body = 99},
                   {.action = Action::kUnpin, .body = 0}});
  EXPECT_GT(this->falls(40), 0.5f);
  this->pin_top();
  this->step_with({{.action = Action::kUnpin, .body = 99}});
  step(this->run, 30);
  EXPECT_EQ(this->heads(), 1u) << "the pins of another body were taken off";
}

TYPED_TEST(Pin, IsOnePerHand) {
  this->step_with({hold_at<TestFixture::kDimension>(this->run.soft_body(0).bounds().high, kUsersLeftHand),
                   hold_at<TestFixture::kDimension>(this->run.soft_body(0).bounds().low, kUsersRightHand),
                   {.action = Action::kPin, .hand = kUsersLeftHand},
                   {.action = Action::kPin, .hand = kUsersRightHand}});
  EXPECT_EQ(this->heads(), 2u);
}

TYPED_TEST(Pin, IsTakenOffWhenTheBodyGoesHomeAndByAReset) {
  for (const Action action : {Action::kHome, Action::kReset}) {
    this->pin_top();
    EXPECT_EQ(this->heads(), 1u);
    this->step_with({{.action = action, .body = action == Action::kHome ? kEveryBody : 0}});
    EXPECT_EQ(this->heads(), 0u);
    EXPECT_GT(this->falls(40), 0.5f);
  }
}

/// A hundred and more in a pause, as a wild user might: no number of attachments grows without end.
TYPED_TEST(Pin, TakesThePlaceOfTheOldestWhereThereAreMany) {
  const std::size_t held = this->highest();
  const auto before = this->place_of(held);
  this->step_with({hold_at<TestFixture::kDimension>(this->top()), {.action = Action::kPause}});
  for (std::size_t i = 0; i < kMostPins + 3; ++i)
    this->step_with({{.action = Action::kPin, .hand = kUsersHand}});
  this->step_with({{.action = Action::kResume}, {.action = Action::kRelease, .hand = kUsersHand}});
  EXPECT_EQ(this->heads(), kMostPins);
  step(this->run, 60);
  EXPECT_LT((this->place_of(held) - before).norm(), 0.02f);
}

/// The moment goes through the text of its state.
TYPED_TEST(Pin, HoldsInTheSceneThatASavedMomentBegins) {
  constexpr int kOf = TestFixture::kDimension;
  this->pin_top();
  step(this->run, 30);
  auto begun = this->scene;
  begun.begin = std::make_shared<const Beginning<kOf>>(parse_state<kOf>(state_to_text(this->run.moment())));
  ASSERT_EQ(begun.begin->pins.size(), 1u);
  const std::vector<std::uint32_t>& pinned = begun.begin->pins[0].particles;
  ASSERT_FALSE(pinned.empty());
  typename TestFixture::P::Simulation again(begun, {});
  const auto stays = [&] {
    std::vector<Vector<kOf>> before;
    for (const std::uint32_t i : pinned) before.push_back(again.soft_body(0).position(i));
    step(again, 60);
    float farthest = 0;
    for (std::size_t k = 0; k < pinned.size(); ++k)
      farthest = std::max(farthest, (again.soft_body(0).position(pinned[k]) - before[k]).norm());
    return farthest < 0.01f;
  };
  EXPECT_TRUE(stays());
  EXPECT_EQ(again.moment().pins.size(), 1u);
  const typename TestFixture::Events reset{{.action = Action::kReset}},
      off{{.action = Action::kUnpin, .body = kEveryBody}};
  again.step(reset);
  EXPECT_TRUE(stays()) << "the scene begins with the pin again";
  again.step(off);
  EXPECT_FALSE(stays());
  EXPECT_TRUE(again.moment().pins.empty());
}

/// The recording goes through its text.
TYPED_TEST(Pin, IsReplayedToTheSameBitsOnAnyNumberOfSpes) {
  constexpr int kOf = TestFixture::kDimension;
  Vector<kOf> aside = this->top();
  aside.x() += 0.7f;
  Recording<kOf> recording{.scene = TestFixture::P::kScene, .frames = 70};
  recording.events = {{2, hold_at<kOf>(this->top())},
                      {4, {.action = Action::kMoveHand, .hand = kUsersHand, .value = aside}},
                      {15, {.action = Action::kPin, .hand = kUsersHand}},
                      {16, {.action = Action::kRelease, .hand = kUsersHand}},
                      {50, {.action = Action::kUnpin, .body = 0}}};
  const Recording<kOf> again = parse_recording<kOf>(to_text(recording));
  EXPECT_EQ(again, recording);
  std::set<std::uint64_t> hashes;
  for (const int spes : {1, 5}) {
    typename TestFixture::P::Simulation replay(this->scene, {.spes = spes});
    std::size_t next = 0;
    for (int frame = 0; frame < recording.frames; ++frame) {
      typename TestFixture::Events events;
      while (next < again.events.size() && again.events[next].frame == frame)
        events.push_back(again.events[next++].event);
      replay.step(events);
    }
    hashes.insert(replay.state_hash());
  }
  EXPECT_EQ(hashes.size(), 1u);
}

TEST(Pins, HoldThePieceThatHasThemWhenTheirBodyIsCut) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {});
  const ppu::Bounds<3> box = run.soft_body(0).bounds();
  const Eigen::Vector3f middle = 0.5f * (box.low + box.high);
  const std::vector<InputEvent<3>> events{
      hold_at<3>({box.low.x(), middle.y(), middle.z()}),
      {.action = Action::kPin, .hand = kUsersHand},
      {.action = Action::kRelease, .hand = kUsersHand},
      {.action = Action::kCut,
       .body = kEveryBody,
       .value = {middle.x() + 0.1f * (box.high - box.low).x(), middle.y(), 20},
       .edge = {0, 50, -100},
       .way = {0, -50, -100}}};
  run.step(events);
  step(run, 60);
  ASSERT_EQ(run.soft_bodies(), 2u);
  const auto low = [&](std::size_t body) { return run.soft_body(body).centre_of_mass().y(); };
  EXPECT_GT(std::abs(low(0) - low(1)), 1.0f) << "one hangs, one lies";
  // Backspace makes it whole, and takes the pin off.
  run.step({&kGoHome3d, 1});
  const float before = low(0);
  step(run, 40);
  EXPECT_LT(low(0), before - 0.5f);
}

TEST(Pins, HoldNothingWhereBodiesTouchWithSpheres) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {.contacts = ppu::ContactMethod::kSpheres}),
      free(scene, {.contacts = ppu::ContactMethod::kSpheres});
  const InputEvent<3> hold = hold_at<3>(run.soft_body(0).bounds().high),
                      pin{.action = Action::kPin, .hand = kUsersHand};
  const std::vector<InputEvent<3>> both{hold, pin};
  run.step(both);
  free.step({&hold, 1});
  step(run, 20), step(free, 20);
  EXPECT_EQ(run.state_hash(), free.state_hash());
}

TEST(Pins, OfASavedMomentAreRefusedWhereBodiesTouchWithSpheres) {
  Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {});
  run.step(std::vector{hold_at<3>(run.soft_body(0).bounds().high),
                       InputEvent<3>{.action = Action::kPin, .hand = kUsersHand}});
  scene.begin = std::make_shared<const Beginning<3>>(run.moment());
  try {
    Simulation3d(scene, {.contacts = ppu::ContactMethod::kSpheres});
    FAIL() << "it was not refused";
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(
        std::string(error.what()).starts_with("pin 1 of the saved state: the soft body to be attached"))
        << error.what();
  }
}

TEST(Pins, HoldBodiesThatTouchWithCirclesInTwoDimensions) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d run(scene, {.contacts = ppu::ContactMethod::kSpheres});
  const std::vector<InputEvent<2>> events{hold_at<2>(run.soft_body(0).bounds().high),
                                          {.action = Action::kPin, .hand = kUsersHand},
                                          {.action = Action::kRelease, .hand = kUsersHand}};
  run.step(events);
  step(run, 30);
  const float before = run.soft_body(0).bounds().high.y();
  step(run, 60);
  EXPECT_GT(run.soft_body(0).bounds().high.y(), before - 0.2f);
}

}  // namespace
}  // namespace softcell::demos
