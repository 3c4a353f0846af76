// What keys, mouse and controllers mean, told to the input as SDL tells it; no window.

#include "input/user_input.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/look.h"
#include "window/controllers.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

SDL_Event key(Uint32 type, SDL_Keycode code, bool repeat = false) {
  SDL_Event event{};
  event.key.type = type;
  event.key.repeat = repeat;
  event.key.keysym.sym = code;
  return event;
}
SDL_Event press(SDL_Keycode code) { return key(SDL_KEYDOWN, code); }

SDL_Event mouse_button(Uint32 type, int x, int y, Uint8 button = SDL_BUTTON_LEFT) {
  SDL_Event event{};
  event.button.type = type;
  event.button.button = button;
  event.button.x = x;
  event.button.y = y;
  return event;
}

SDL_Event mouse_to(int x, int y) {
  SDL_Event event{};
  event.motion.type = SDL_MOUSEMOTION;
  event.motion.x = x;
  event.motion.y = y;
  return event;
}

SDL_Event accelerometer(float x, float y, float z) {
  SDL_Event event{};
  event.csensor.type = SDL_CONTROLLERSENSORUPDATE;
  event.csensor.sensor = SDL_SENSOR_ACCEL;
  event.csensor.data[0] = x;
  event.csensor.data[1] = y;
  event.csensor.data[2] = z;
  return event;
}

/// A rigid body stands left of x = -2; everything else is particles.
std::optional<InputEvent<2>> pick_2d(const Vector2f& point) {
  if (point.x() < -2) return InputEvent<2>{.action = Action::kHoldRigid, .body = 4, .value = point};
  return InputEvent<2>{.action = Action::kGrab, .body = kEveryBody, .value = point};
}

/// The input of a picture of 800 x 600 that shows 8 m x 6 m about (1, 2).
UserInput<2> input_2d() {
  UserInput<2> input(kViews2d, {MouseHand({.centre = {1, 2}, .height = 6}, &pick_2d, 800, 600)});
  input.follow({0, -10}, false);
  return input;
}

template <int Dimension>
std::vector<InputEvent<Dimension>> frame_of(UserInput<Dimension>& input,
                                            const std::vector<SDL_Event>& events) {
  for (const SDL_Event& event : events) input.handle(event);
  const auto frame = input.next_frame();
  return {frame.begin(), frame.end()};
}

using Events2d = std::vector<InputEvent<2>>;
using Events3d = std::vector<InputEvent<3>>;

TEST(UserInput, TheMouseTakesAParticleDragsItAndLetsGo) {
  UserInput<2> input = input_2d();
  const auto grab = frame_of(input, {mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300)});
  EXPECT_EQ(grab,
            (Events2d{{.action = Action::kGrab, .hand = kUsersHand, .body = kEveryBody, .value = {1, 2}}}));
  const auto moves = frame_of(input, {mouse_to(400, 400), mouse_to(0, 0)});
  EXPECT_EQ(moves, (Events2d{{.action = Action::kMoveHand, .hand = kUsersHand, .value = {-3, 5}}}))
      << "only where the mouse is at last counts";
  const auto release = frame_of(input, {mouse_to(800, 600), mouse_button(SDL_MOUSEBUTTONUP, 800, 600)});
  EXPECT_EQ(release, (Events2d{{.action = Action::kMoveHand, .hand = kUsersHand, .value = {5, -1}},
                               {.action = Action::kRelease, .hand = kUsersHand}}));
  EXPECT_TRUE(frame_of(input, {mouse_to(1, 1)}).empty()) << "a hand that holds nothing";
}

TEST(UserInput, TheMouseTakesARigidBodyWhereOneIs) {
  UserInput<2> input = input_2d();
  const auto hold = frame_of(input, {mouse_button(SDL_MOUSEBUTTONDOWN, 0, 300)});
  EXPECT_EQ(hold,
            (Events2d{{.action = Action::kHoldRigid, .hand = kUsersHand, .body = 4, .value = {-3, 2}}}));
  EXPECT_EQ(frame_of(input, {mouse_to(400, 300)}),
            (Events2d{{.action = Action::kMoveHand, .hand = kUsersHand, .value = {1, 2}}}));
}

TEST(UserInput, OnlyTheLeftButtonTakes) {
  UserInput<2> input = input_2d();
  EXPECT_TRUE(frame_of(input, {mouse_button(SDL_MOUSEBUTTONDOWN, 1, 1, SDL_BUTTON_RIGHT), mouse_to(2, 2),
                               mouse_button(SDL_MOUSEBUTTONUP, 1, 1)})
                  .empty());
}

TEST(UserInput, TheMouseFollowsTheWindowsSize) {
  UserInput<2> input = input_2d();
  SDL_Event resized{};
  resized.window.type = SDL_WINDOWEVENT;
  resized.window.event = SDL_WINDOWEVENT_SIZE_CHANGED;
  resized.window.data1 = 300;
  resized.window.data2 = 100;
  const auto grab = frame_of(input, {resized, mouse_button(SDL_MOUSEBUTTONDOWN, 150, 0)});
  ASSERT_EQ(grab.size(), 1u);
  EXPECT_LT((grab[0].value - Vector2f(1, 5)).norm(), 1e-5f);
}

TEST(UserInput, AWindowThatHasShrunkToNothingTakesTheMouse) {
  UserInput<2> input = input_2d();
  SDL_Event resized{};
  resized.window.type = SDL_WINDOWEVENT;
  resized.window.event = SDL_WINDOWEVENT_SIZE_CHANGED;
  const auto grab = frame_of(input, {resized, mouse_button(SDL_MOUSEBUTTONDOWN, 0, 0)});
  ASSERT_EQ(grab.size(), 1u);
  EXPECT_TRUE(grab[0].value.allFinite());
}

TEST(UserInput, GravityHasFourDirectionsAnyStrengthAndOff) {
  UserInput<2> input = input_2d();
  const auto gravity_after = [&](SDL_Keycode code) -> Vector2f {
    const auto events = frame_of(input, {press(code)});
    if (events.size() != 1 || events[0].action != Action::kGravity) {
      ADD_FAILURE() << "no change of gravity";
      return {0, 0};
    }
    input.follow(events[0].value, false);
    return events[0].value;
  };
  EXPECT_EQ(gravity_after(SDLK_UP), Vector2f(0, 10));
  EXPECT_EQ(gravity_after(SDLK_LEFT), Vector2f(-10, 0));
  EXPECT_EQ(gravity_after(SDLK_RIGHT), Vector2f(10, 0));
  EXPECT_EQ(gravity_after(SDLK_PLUS), Vector2f(11, 0));
  EXPECT_EQ(gravity_after(SDLK_EQUALS), Vector2f(12, 0)) << "plus without shift";
  EXPECT_EQ(gravity_after(SDLK_KP_MINUS), Vector2f(11, 0));
  EXPECT_EQ(gravity_after(SDLK_g), Vector2f(0, 0));
  EXPECT_EQ(gravity_after(SDLK_g), Vector2f(11, 0)) << "on again, as it was";
  EXPECT_EQ(gravity_after(SDLK_g), Vector2f(0, 0));
  EXPECT_EQ(gravity_after(SDLK_DOWN), Vector2f(0, -11)) << "on again, downwards";
}

TEST(UserInput, GravityNeverPullsTheOtherWayNorGrowsWithoutBound) {
  UserInput<2> input = input_2d();
  for (int i = 0; i < 30; ++i) input.handle(press(SDLK_MINUS));
  EXPECT_EQ(input.next_frame().back().value, Vector2f(0, 0));
  for (int i = 0; i < 2000; ++i) input.handle(key(SDL_KEYDOWN, SDLK_PLUS, true));
  EXPECT_EQ(input.next_frame().back().value, Vector2f(0, -UserInput<2>::kMostGravity));
}

TEST(UserInput, PausesAndGoesOn) {
  UserInput<2> input = input_2d();
  EXPECT_EQ(frame_of(input, {press(SDLK_p)}), (Events2d{{.action = Action::kPause}}));
  EXPECT_EQ(frame_of(input, {press(SDLK_PERIOD)}), (Events2d{{.action = Action::kSingleStep}}));
  EXPECT_EQ(frame_of(input, {press(SDLK_p)}), (Events2d{{.action = Action::kResume}}));
  input.follow({0, -10}, true);
  EXPECT_EQ(frame_of(input, {press(SDLK_p)}), (Events2d{{.action = Action::kResume}})) << "a script paused";
}

TEST(UserInput, AHeldKeyActsOnceExceptWhereItHelps) {
  UserInput<2> input = input_2d();
  for (const KeyBinding& binding : key_bindings()) {
    if (binding.command == Command::kQuit) continue;
    const int dimension = binding.only_in_3d ? 3 : 2;
    const auto repeated = command_of(key(SDL_KEYDOWN, binding.key, true), dimension);
    EXPECT_EQ(repeated.has_value(), binding.repeats) << binding.key_name;
    EXPECT_EQ(command_of(press(binding.key), dimension), binding.command) << binding.key_name;
    EXPECT_EQ(command_of(key(SDL_KEYUP, binding.key), dimension), std::nullopt) << binding.key_name;
  }
}

TEST(UserInput, WhatTheWindowDoesIsNoEvent) {
  UserInput<2> input = input_2d();
  EXPECT_TRUE(frame_of(input, {press(SDLK_v), press(SDLK_s), press(SDLK_F1)}).empty());
  EXPECT_EQ(input.look().view, 1);
  EXPECT_FALSE(input.look().statistics);
  EXPECT_TRUE(input.look().help);
  input.handle(press(SDLK_v));
  input.handle(press(SDLK_v));
  EXPECT_EQ(input.look().view, 0) << "after the last view comes the first";
  EXPECT_FALSE(input.wants_next_scene());
  input.handle(press(SDLK_n));
  EXPECT_TRUE(input.wants_next_scene());
  EXPECT_FALSE(input.wants_to_quit());
  input.handle(press(SDLK_ESCAPE));
  EXPECT_TRUE(input.wants_to_quit());
  UserInput<2> closed = input_2d();
  SDL_Event quit{};
  quit.type = SDL_QUIT;
  closed.handle(quit);
  EXPECT_TRUE(closed.wants_to_quit());
}

TEST(UserInput, JumpsResetsAndGoesHomeIn3d) {
  UserInput<3> input(2, {});
  EXPECT_EQ(
      frame_of(input, {press(SDLK_SPACE), press(SDLK_BACKSPACE), press(SDLK_r)}),
      (Events3d{{.action = Action::kPush, .body = kEveryBody, .value = {0, UserInput<3>::kJumpSpeed, 0}},
                {.action = Action::kHome, .body = kEveryBody},
                {.action = Action::kReset}}));
}

/// What the ground is tilted by after so many frames that begin with `tilt`.
Vector3f tilt_after(UserInput<3>& input, int frames, Vector3f tilt = {0, 0, 0}) {
  for (int i = 0; i < frames; ++i) {
    for (const InputEvent<3>& event : input.next_frame()) {
      if (event.action != Action::kTilt) continue;
      EXPECT_LE((event.value - tilt).cwiseAbs().maxCoeff(), GroundTilt::kMostInAFrame + 1e-6f);
      tilt = event.value;
    }
  }
  EXPECT_TRUE(input.next_frame().empty()) << "what does not change is no event";
  return tilt;
}

TEST(UserInput, ArrowsTiltTheGroundWhileTheyAreHeld) {
  UserInput<3> input(2, {});
  EXPECT_TRUE(input.next_frame().empty()) << "until then the ground is as the scene has it";
  input.handle(press(SDLK_RIGHT));
  EXPECT_EQ(tilt_after(input, 20), Vector3f(0, 0, -GroundTilt::kMost)) << "the right side is lower";
  input.handle(press(SDLK_UP));
  EXPECT_EQ(tilt_after(input, 20, {0, 0, -GroundTilt::kMost}),
            Vector3f(-GroundTilt::kMost, 0, -GroundTilt::kMost));
  input.handle(key(SDL_KEYUP, SDLK_RIGHT));
  input.handle(key(SDL_KEYUP, SDLK_UP));
  EXPECT_EQ(tilt_after(input, 20, {-GroundTilt::kMost, 0, -GroundTilt::kMost}), Vector3f(0, 0, 0));
}

TEST(UserInput, TheMotionSensorTiltsTheGroundAsItIsHeld) {
  UserInput<3> input(2, {});
  const float angle = 0.2f, g = SDL_STANDARD_GRAVITY;
  // Rolled to the right, its right side lower: what holds it up comes from the left.
  input.handle(accelerometer(-g * std::sin(angle), g * std::cos(angle), 0));
  const Vector3f rolled = tilt_after(input, 20);
  EXPECT_LT((rolled - Vector3f(0, 0, -angle)).norm(), 0.01f);
  // Its far side lower: it comes from the player's side.
  input.handle(accelerometer(0, g * std::cos(angle), g * std::sin(angle)));
  const Vector3f pitched = tilt_after(input, 20, rolled);
  EXPECT_LT((pitched - Vector3f(-angle, 0, 0)).norm(), 0.01f);
  input.handle(accelerometer(0, -g, 0.1f));
  const Vector3f over = tilt_after(input, 40, pitched);
  EXPECT_FLOAT_EQ(over.x(), -GroundTilt::kMost) << "upside down: no further";
  input.handle(accelerometer(0, std::numeric_limits<float>::quiet_NaN(), 0));
  EXPECT_EQ(tilt_after(input, 40, over), over) << "no sense: ignored";
}

TEST(UserInput, TheMouseMovesTheCameraIn3d) {
  UserInput<3> input(2, {});
  SDL_Event drag = mouse_to(0, 0);
  drag.motion.state = SDL_BUTTON_LMASK;
  drag.motion.xrel = 100;
  drag.motion.yrel = 10'000;
  SDL_Event wheel{};
  wheel.wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.preciseY = 2;
  EXPECT_TRUE(frame_of(input, {drag, wheel}).empty()) << "the simulation does not notice";
  EXPECT_LT(input.look().turn, -0.1f);
  EXPECT_EQ(input.look().rise, 1.5f) << "not over the top";
  EXPECT_LT(input.look().distance, 0.9f);
  const Look before = input.look();
  frame_of(input, {mouse_to(50, 50)});
  EXPECT_EQ(input.look().turn, before.turn) << "no button is held";
}

/// The input of a picture of 800 x 600 that looks from (0, 0, 10) at the origin.
UserInput<3> input_3d() {
  const auto eye = [](const Look&) {
    return render::Camera{.eye = {0, 0, 10}, .target = {0, 0, 0}, .tan_half_fov_y = 0.5f, .far_plane = 100};
  };
  const auto pick = [](const Ray&) -> std::optional<InputEvent<3>> {
    return InputEvent<3>{.action = Action::kHold, .value = {0, 0, 0}};
  };
  return {kViews,
          {.tilt = {},
           .knife = knife_3d(eye, 800, 600),
           .hand = MouseReach(eye, pick, 800, 600),
           .camera = CameraControl(eye({}), 600)}};
}

TEST(UserInput, TheMouseCutsAlongALineWhileItIsAKnife) {
  UserInput<3> input = input_3d();
  EXPECT_TRUE(frame_of(input, {press(SDLK_k), mouse_button(SDL_MOUSEBUTTONDOWN, 400, 0), mouse_to(400, 200)})
                  .empty());
  ASSERT_TRUE(input.look().stroke);
  EXPECT_LT(((*input.look().stroke)[0] - Vector2f(0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT(((*input.look().stroke)[1] - Vector2f(0.5f, 1.0f / 3)).norm(), 1e-6f);
  const auto cut = frame_of(input, {mouse_button(SDL_MOUSEBUTTONUP, 400, 600)});
  EXPECT_FALSE(input.look().stroke);
  ASSERT_EQ(cut.size(), 1u) << "no hand takes anything";
  EXPECT_EQ(cut[0].action, Action::kCut);
  EXPECT_EQ(cut[0].body, kEveryBody);
  EXPECT_EQ(cut[0].value, Vector3f(0, 0, 10));
  // From the upper to the lower edge of the picture, as far as one sees: half as high as the way is long.
  const Vector3f upper = Vector3f(0, 0.5f, -1).normalized() * 100,
                 lower = Vector3f(0, -0.5f, -1).normalized() * 100;
  EXPECT_LT((cut[0].edge - upper).norm(), 1e-3f) << cut[0].edge.transpose();
  EXPECT_LT((cut[0].way - lower).norm(), 1e-3f) << cut[0].way.transpose();
  EXPECT_EQ(input.look().turn, 0) << "the camera stays";
}

TEST(UserInput, TheMouseIsAKnifeInTwoDimensionsToo) {
  const Camera2d camera{.centre = {1, 2}, .height = 6};
  const auto pick = [](const Vector2f& at) -> std::optional<InputEvent<2>> {
    return InputEvent<2>{.action = Action::kHold, .value = at};
  };
  UserInput<2> input(kViews,
                     {.hand = MouseHand(camera, pick, 800, 600), .knife = knife_2d(camera, 800, 600)});
  const auto cut = frame_of(input, {press(SDLK_k), mouse_button(SDL_MOUSEBUTTONDOWN, 400, 0),
                                    mouse_to(400, 200), mouse_button(SDL_MOUSEBUTTONUP, 500, 600)});
  ASSERT_EQ(cut.size(), 1u) << "no hand takes anything";
  EXPECT_EQ(cut[0].action, Action::kCut);
  EXPECT_EQ(cut[0].body, kEveryBody);
  EXPECT_LT((cut[0].value - Vector2f(1, 5)).norm(), 1e-5f) << cut[0].value.transpose();
  EXPECT_LT((cut[0].way - Vector2f(1, -6)).norm(), 1e-5f) << cut[0].way.transpose();
  EXPECT_EQ(frame_of(input, {press(SDLK_k), mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300)}).size(), 1u);
}

TEST(UserInput, AKnifeThatIsClickedOrPutAwayCutsNothing) {
  UserInput<3> input = input_3d();
  EXPECT_TRUE(frame_of(input, {press(SDLK_k), mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300), mouse_to(402, 302),
                               mouse_button(SDL_MOUSEBUTTONUP, 402, 302)})
                  .empty());
  EXPECT_TRUE(frame_of(input, {mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300), mouse_to(100, 100), press(SDLK_k),
                               mouse_button(SDL_MOUSEBUTTONUP, 100, 100)})
                  .empty());
  EXPECT_FALSE(input.look().stroke);
  EXPECT_FALSE(input.look().knife);
  const auto hold = frame_of(input, {mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300)});
  ASSERT_EQ(hold.size(), 1u) << "a hand again";
  EXPECT_EQ(hold[0].action, Action::kHold);
}

TEST(UserInput, AKeyPinsWhatHandsHoldAndElseTakesAllPinsOff) {
  UserInput<2> input = input_2d();
  const Events2d all_off{{.action = Action::kUnpin, .body = kEveryBody}};
  EXPECT_EQ(frame_of(input, {press(SDLK_h)}), all_off);
  EXPECT_FALSE(input.poll_pinned());
  const auto pin = frame_of(input, {mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300), press(SDLK_h)});
  ASSERT_EQ(pin.size(), 2u);
  EXPECT_EQ(pin[1], (InputEvent<2>{.action = Action::kPin, .hand = kUsersHand}));
  EXPECT_TRUE(input.poll_pinned());
  EXPECT_FALSE(input.poll_pinned()) << "asking forgets it";
  EXPECT_EQ(frame_of(input, {mouse_button(SDL_MOUSEBUTTONUP, 400, 300), press(SDLK_h)})[1], all_off[0]);

  UserInput<3> solid = input_3d();
  EXPECT_EQ(frame_of(solid, {press(SDLK_h)}), (Events3d{{.action = Action::kUnpin, .body = kEveryBody}}));
  EXPECT_EQ(frame_of(solid, {mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300), press(SDLK_h)}).back(),
            (InputEvent<3>{.action = Action::kPin, .hand = kUsersHand}));
}

TEST(UserInput, AControllerThatIsPulledOutTiltsNoMore) {
  SDL_Event stick{};
  stick.caxis.type = SDL_CONTROLLERAXISMOTION;
  stick.caxis.axis = SDL_CONTROLLER_AXIS_LEFTX;
  stick.caxis.value = 32767;
  SDL_Event removed{};
  removed.type = SDL_CONTROLLERDEVICEREMOVED;
  for (const SDL_Event& last : {stick, accelerometer(-SDL_STANDARD_GRAVITY, SDL_STANDARD_GRAVITY, 0)}) {
    const std::string what = last.type == stick.type ? "its stick" : "its motion sensor";
    UserInput<3> input(2, {});
    input.handle(last);
    const Vector3f tilted = tilt_after(input, 20);
    ASSERT_EQ(tilted, Vector3f(0, 0, -GroundTilt::kMost)) << what;
    input.handle(removed);
    EXPECT_EQ(tilt_after(input, 20, tilted), Vector3f(0, 0, 0)) << what << " counts for ever";
  }
}

}  // namespace
}  // namespace softcell::demos

namespace {
/// Whose accelerometer has been switched on, and not off again.
std::set<SDL_JoystickID> g_accelerometers_on;
}  // namespace

/// SDL 2 has no virtual sensors. In place of SDL's function: every controller has an accelerometer, which is
/// off when the controller is opened.
extern "C" int SDL_GameControllerSetSensorEnabled(SDL_GameController* controller, SDL_SensorType sensor,
                                                  SDL_bool on) {
  if (sensor != SDL_SENSOR_ACCEL) return -1;
  const SDL_JoystickID id = SDL_JoystickInstanceID(SDL_GameControllerGetJoystick(controller));
  if (on == SDL_TRUE)
    g_accelerometers_on.insert(id);
  else
    g_accelerometers_on.erase(id);
  return 0;
}

namespace softcell::demos {
namespace {

/// A controller that SDL believes in: events go through SDL's own mapping of buttons and axes.
class VirtualController : public testing::Test {
 protected:
  void SetUp() override {
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    SDL_SetMainReady();
    ASSERT_EQ(SDL_Init(SDL_INIT_GAMECONTROLLER), 0) << SDL_GetError();
    SDL_VirtualJoystickDesc description{};
    description.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
    description.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
    description.naxes = SDL_CONTROLLER_AXIS_MAX;
    description.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
    index_ = SDL_JoystickAttachVirtualEx(&description);
    ASSERT_GE(index_, 0) << SDL_GetError();
    pump();
    joystick_ = SDL_JoystickOpen(index_);
    ASSERT_NE(joystick_, nullptr) << SDL_GetError();
  }
  void TearDown() override {
    if (joystick_ != nullptr) SDL_JoystickClose(joystick_);
    controllers_ = {};
    g_accelerometers_on.clear();
    SDL_Quit();
  }

  void pump() {
    SDL_Event event;
    SDL_PumpEvents();
    while (SDL_PollEvent(&event) != 0) {
      controllers_.handle(event);
      input_.handle(event);
    }
  }
  void press_button(SDL_GameControllerButton button) {
    ASSERT_EQ(SDL_JoystickSetVirtualButton(joystick_, button, SDL_PRESSED), 0);
    pump();
    ASSERT_EQ(SDL_JoystickSetVirtualButton(joystick_, button, SDL_RELEASED), 0);
    pump();
  }

  /// Holds the controller so that its accelerometer shows this: an event, if the sensor is switched on.
  void hold(float x, float y, float z) {
    const SDL_JoystickID id = SDL_JoystickInstanceID(joystick_);
    if (!g_accelerometers_on.contains(id)) return;
    SDL_Event event = accelerometer(x, y, z);
    event.csensor.which = id;
    ASSERT_EQ(SDL_PushEvent(&event), 1) << SDL_GetError();
    pump();
  }

  int index_ = -1;
  SDL_Joystick* joystick_ = nullptr;
  Controllers controllers_;
  UserInput<3> input_{2, {}};
};

TEST_F(VirtualController, ItsButtonsDoWhatTheHelpSays) {
  press_button(SDL_CONTROLLER_BUTTON_X);
  press_button(SDL_CONTROLLER_BUTTON_BACK);
  press_button(SDL_CONTROLLER_BUTTON_START);
  const auto frame = input_.next_frame();
  ASSERT_EQ(frame.size(), 3u);
  EXPECT_EQ(frame[0].action, Action::kPush) << "the square: jump";
  EXPECT_EQ(frame[1].action, Action::kHome);
  EXPECT_EQ(frame[2].action, Action::kReset);
  press_button(SDL_CONTROLLER_BUTTON_A);
  EXPECT_EQ(input_.look().view, 1);
  press_button(SDL_CONTROLLER_BUTTON_B);
  EXPECT_TRUE(input_.wants_next_scene());
}

TEST_F(VirtualController, ItsLeftStickTiltsTheGround) {
  ASSERT_EQ(SDL_JoystickSetVirtualAxis(joystick_, SDL_CONTROLLER_AXIS_LEFTX, 3000), 0);
  pump();
  EXPECT_EQ(tilt_after(input_, 20), Vector3f(0, 0, 0)) << "a stick that nobody touches";
  ASSERT_EQ(SDL_JoystickSetVirtualAxis(joystick_, SDL_CONTROLLER_AXIS_LEFTX, 32767), 0);
  ASSERT_EQ(SDL_JoystickSetVirtualAxis(joystick_, SDL_CONTROLLER_AXIS_LEFTY, -32768), 0);
  pump();
  EXPECT_EQ(tilt_after(input_, 20), Vector3f(-GroundTilt::kMost, 0, -GroundTilt::kMost)) << "right and away";
}

TEST_F(VirtualController, ItsMotionSensorIsSwitchedOnAndTiltsTheGround) {
  EXPECT_TRUE(g_accelerometers_on.contains(SDL_JoystickInstanceID(joystick_)))
      << "nobody has switched the accelerometer on: SDL would send none of its events";
  hold(SDL_STANDARD_GRAVITY, SDL_STANDARD_GRAVITY, 0);
  EXPECT_FLOAT_EQ(tilt_after(input_, 20).z(), GroundTilt::kMost);
}

TEST_F(VirtualController, ThatIsPulledOutWhileItIsHeldAslantLetsTheGroundGoBack) {
  hold(SDL_STANDARD_GRAVITY, SDL_STANDARD_GRAVITY, 0);
  const Vector3f tilted = tilt_after(input_, 20);
  EXPECT_FLOAT_EQ(tilted.z(), GroundTilt::kMost);
  ASSERT_EQ(SDL_JoystickDetachVirtual(index_), 0);
  pump();
  EXPECT_EQ(tilt_after(input_, 20, tilted), Vector3f(0, 0, 0));
}

TEST_F(VirtualController, ThatIsPulledOutLetsTheGroundGoBack) {
  ASSERT_EQ(SDL_JoystickSetVirtualAxis(joystick_, SDL_CONTROLLER_AXIS_LEFTX, 32767), 0);
  pump();
  const Vector3f tilted = tilt_after(input_, 20);
  EXPECT_FLOAT_EQ(tilted.z(), -GroundTilt::kMost);
  ASSERT_EQ(SDL_JoystickDetachVirtual(index_), 0);
  pump();
  EXPECT_EQ(tilt_after(input_, 20, tilted), Vector3f(0, 0, 0));
}

/// A hand that sees from 10 m above the origin, 8 m x 6 m of the ground in a window of 800 x 600, and reaches
/// what is within a metre of (1, 0, 1).
MouseReach reach_from_above() {
  const auto eye = [](const Look&) {
    return render::Camera{.eye = {0, 10, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}, .tan_half_fov_y = 0.3f};
  };
  const auto pick = [](const Ray& ray) -> std::optional<InputEvent<3>> {
    const Vector3f ground = ray.from - ray.from.y() / ray.along.y() * ray.along;
    if ((ground - Vector3f(1, 0, 1)).norm() > 1) return std::nullopt;
    return InputEvent<3>{.action = Action::kHold, .body = 2, .value = {1, 0.5f, 1}};
  };
  return {eye, pick, 800, 600};
}

TEST(UserInput3d, TheMouseTakesABodyAndMovesItInThePlaneThatFacesTheEye) {
  UserInput<3> input(kViews, {.tilt = {}, .knife = {}, .hand = reach_from_above(), .camera = {}});
  input.handle(mouse_button(SDL_MOUSEBUTTONDOWN, 510, 390));
  auto events = input.next_frame();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].action, Action::kHold);
  EXPECT_EQ(events[0].hand, kUsersHand);
  EXPECT_EQ(events[0].body, 2u);
  EXPECT_EQ(events[0].value, Vector3f(1, 0.5f, 1));

  SDL_Event motion = mouse_to(100, 100);
  motion.motion.state = SDL_BUTTON_LMASK;
  motion.motion.xrel = -400;
  input.handle(motion);
  motion.motion.x = 600;
  motion.motion.y = 300;
  input.handle(motion);
  events = input.next_frame();
  ASSERT_EQ(events.size(), 1u) << "the last place counts";
  EXPECT_EQ(events[0].action, Action::kMoveHand);
  // 200 pixels are 2 m on the ground, and 0.95 of that half a metre above it.
  EXPECT_LT((events[0].value - Vector3f(1.9f, 0.5f, 0)).norm(), 1e-4f);
  EXPECT_EQ(input.look().turn, 0) << "the camera stays";

  input.handle(mouse_button(SDL_MOUSEBUTTONUP, 600, 300));
  events = input.next_frame();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].action, Action::kRelease);
}

TEST(UserInput3d, TheWheelMovesWhatIsHeldAndElseTheCamera) {
  UserInput<3> input(kViews, {.tilt = {}, .knife = {}, .hand = reach_from_above(), .camera = {}});
  SDL_Event wheel{};
  wheel.wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.preciseY = 1;
  input.handle(mouse_button(SDL_MOUSEBUTTONDOWN, 400, 300));  // in the middle: straight below the eye
  EXPECT_TRUE(input.next_frame().empty()) << "nothing is there";
  input.handle(mouse_button(SDL_MOUSEBUTTONDOWN, 500, 400));
  input.next_frame();
  input.handle(wheel);
  auto events = input.next_frame();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].action, Action::kMoveHand);
  EXPECT_NEAR(events[0].value.y(), 10 - 9.5f * 1.05f, 1e-4f) << "a twentieth farther from the eye";
  EXPECT_EQ(input.look().distance, 1);
  for (int notch = 0; notch < 500; ++notch) {
    wheel.wheel.preciseY = -1;
    input.handle(wheel);
  }
  events = input.next_frame();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_LE(events[0].value.y(), 10 - 0.1f) << "not behind the eye, nor at it";
  input.handle(mouse_button(SDL_MOUSEBUTTONUP, 500, 400));
  input.handle(wheel);
  EXPECT_GT(input.look().distance, 1);
}

TEST(UserInput3d, WhereThereIsNothingToTakeTheMouseTurnsTheCamera) {
  UserInput<3> input(kViews, {.tilt = {}, .knife = {}, .hand = reach_from_above(), .camera = {}});
  input.handle(mouse_button(SDL_MOUSEBUTTONDOWN, 100, 100));
  SDL_Event motion = mouse_to(150, 100);
  motion.motion.state = SDL_BUTTON_LMASK;
  motion.motion.xrel = 50;
  input.handle(motion);
  input.handle(mouse_button(SDL_MOUSEBUTTONUP, 150, 100));
  // Nor does any other button take anything.
  input.handle(mouse_button(SDL_MOUSEBUTTONDOWN, 510, 390, SDL_BUTTON_RIGHT));
  EXPECT_TRUE(input.next_frame().empty());
  EXPECT_LT(input.look().turn, 0);
}

TEST(UserInput3d, TheMouseKnowsTheWindowsSize) {
  UserInput<3> input(kViews, {.tilt = {}, .knife = {}, .hand = reach_from_above(), .camera = {}});
  SDL_Event resized{};
  resized.type = SDL_WINDOWEVENT;
  resized.window.event = SDL_WINDOWEVENT_SIZE_CHANGED;
  resized.window.data1 = 400;
  resized.window.data2 = 300;
  input.handle(resized);
  input.handle(mouse_button(SDL_MOUSEBUTTONDOWN, 255, 195));
  ASSERT_EQ(input.next_frame().size(), 1u);
}

/// The event of a controller's axis at this share of its way.
SDL_Event axis_at(SDL_GameControllerAxis axis, float share) {
  SDL_Event event{};
  event.caxis.type = SDL_CONTROLLERAXISMOTION;
  event.caxis.axis = static_cast<Uint8>(axis);
  event.caxis.value = static_cast<Sint16>(share * 32767);
  return event;
}

std::vector<InputEvent<3>> frames_of(UserInput<3>& input, int frames) {
  std::vector<InputEvent<3>> events;
  for (int i = 0; i < frames; ++i) {
    const auto frame = input.next_frame();
    events.insert(events.end(), frame.begin(), frame.end());
  }
  return events;
}

TEST(ControllerHands, ATriggerThatIsTouchedShowsAHandThatItsStickMoves) {
  UserInput<3> input(kViews, {.tilt = {}, .knife = {}, .hand = reach_from_above(), .camera = {}});
  EXPECT_FALSE(input.look().hands[0] || input.look().hands[1]);
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 0.2f));
  EXPECT_TRUE(frames_of(input, 1).empty());
  EXPECT_FALSE(input.look().hands[0]) << "the left trigger is not touched";
  ASSERT_TRUE(input.look().hands[1]);
  EXPECT_EQ(input.look().hands[1]->at, Vector2f(0.6f, 0.5f));
  input.handle(axis_at(SDL_CONTROLLER_AXIS_RIGHTX, 1));
  input.handle(axis_at(SDL_CONTROLLER_AXIS_RIGHTY, -0.5f));
  EXPECT_TRUE(frames_of(input, 10).empty());
  // The window is 800 x 600: as far to the right in pixels as it would go upwards.
  EXPECT_NEAR(input.look().hands[1]->at.x(), 0.6f + 0.2f * 0.75f, 1e-4f);
  EXPECT_NEAR(input.look().hands[1]->at.y(), 0.5f - 0.1f, 1e-4f);
  EXPECT_TRUE(frames_of(input, 1000).empty());
  EXPECT_EQ(input.look().hands[1]->at, Vector2f(1, 0)) << "in the window";
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 0));
  EXPECT_TRUE(frames_of(input, 1).empty());
  EXPECT_FALSE(input.look().hands[1]);
}

TEST(ControllerHands, BothTakeMoveAndLetGo) {
  UserInput<3> input(kViews, {.tilt = {}, .knife = {}, .hand = reach_from_above(), .camera = {}});
  for (const auto axis : {SDL_CONTROLLER_AXIS_TRIGGERLEFT, SDL_CONTROLLER_AXIS_TRIGGERRIGHT})
    input.handle(axis_at(axis, 0.3f));
  // To the right and down, from the middle to (1, 0, 1), where the body is; 100 pixels are a metre.
  for (const auto axis : {SDL_CONTROLLER_AXIS_LEFTX, SDL_CONTROLLER_AXIS_LEFTY, SDL_CONTROLLER_AXIS_RIGHTX,
                          SDL_CONTROLLER_AXIS_RIGHTY})
    input.handle(axis_at(axis, 0.5f));
  EXPECT_TRUE(frames_of(input, 16).empty()) << "nothing is held, and the left stick tilts nothing meanwhile";
  for (const auto axis : {SDL_CONTROLLER_AXIS_TRIGGERLEFT, SDL_CONTROLLER_AXIS_TRIGGERRIGHT})
    input.handle(axis_at(axis, 1));
  auto events = frames_of(input, 1);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].action, Action::kHold);
  EXPECT_EQ(events[0].hand, kUsersLeftHand);
  EXPECT_EQ(events[1].action, Action::kHold);
  EXPECT_EQ(events[1].hand, kUsersRightHand);
  EXPECT_EQ(events[1].body, 2u);
  EXPECT_TRUE(input.look().hands[0]->holds && input.look().hands[1]->holds);
  UserInput<3> pinning = input;
  const std::vector<InputEvent<3>> pins = frame_of(pinning, {press(SDLK_h)});
  EXPECT_EQ(pins[0], (InputEvent<3>{.action = Action::kPin, .hand = kUsersLeftHand}));
  EXPECT_EQ(pins[1], (InputEvent<3>{.action = Action::kPin, .hand = kUsersRightHand}));
  for (const auto axis : {SDL_CONTROLLER_AXIS_LEFTX, SDL_CONTROLLER_AXIS_LEFTY, SDL_CONTROLLER_AXIS_RIGHTY})
    input.handle(axis_at(axis, 0));
  events = frames_of(input, 2);
  ASSERT_EQ(events.size(), 4u);
  EXPECT_EQ(events[2].action, Action::kMoveHand);
  EXPECT_EQ(events[2].hand, kUsersLeftHand);
  EXPECT_EQ(events[3].hand, kUsersRightHand);
  EXPECT_EQ(events[2].value, events[0].value) << "its stick is in the middle";
  EXPECT_GT(events[3].value.x(), events[1].value.x() + 0.03f);
  // The pad takes both away from the eye.
  SDL_Event pad{};
  pad.cbutton.type = SDL_CONTROLLERBUTTONDOWN;
  pad.cbutton.button = SDL_CONTROLLER_BUTTON_DPAD_UP;
  input.handle(pad);
  const float before = events[2].value.y();
  events = frames_of(input, 5);
  EXPECT_LT(events.back().value.y(), before - 0.3f);
  EXPECT_EQ(events.size(), 10u) << "one event for each hand and frame";
  pad.cbutton.type = SDL_CONTROLLERBUTTONUP;
  input.handle(pad);
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERLEFT, 0.2f));
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 0));
  events = frames_of(input, 1);
  ASSERT_EQ(std::ranges::count(events, Action::kRelease, &InputEvent<3>::action), 2);
  EXPECT_TRUE(input.look().hands[0]) << "touched still, ready for the next time";
  EXPECT_FALSE(input.look().hands[1]);
}

TEST(ControllerHands, ThatFindNothingTakeNothingUntilTheyAreOpenedAgain) {
  UserInput<3> input(kViews, {.tilt = {}, .knife = {}, .hand = reach_from_above(), .camera = {}});
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 1));
  EXPECT_TRUE(frames_of(input, 1).empty()) << "nothing is there";
  for (const auto axis : {SDL_CONTROLLER_AXIS_RIGHTX, SDL_CONTROLLER_AXIS_RIGHTY})
    input.handle(axis_at(axis, 0.5f));
  EXPECT_TRUE(frames_of(input, 12).empty()) << "it goes over the body closed";
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 0.3f));
  EXPECT_TRUE(frames_of(input, 1).empty());
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 0.7f));
  EXPECT_EQ(frames_of(input, 1).size(), 1u);
  // A controller that is pulled out lets go.
  SDL_Event removed{};
  removed.cdevice.type = SDL_CONTROLLERDEVICEREMOVED;
  input.handle(removed);
  const auto events = frames_of(input, 1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].action, Action::kRelease);
}

TEST(ControllerHands, HoldInTwoDimensionsToo) {
  const auto pick = [](const Vector2f& at) -> std::optional<InputEvent<2>> {
    return InputEvent<2>{.action = Action::kHold, .body = 1, .value = at};
  };
  UserInput<2> input(kViews2d, {.hand = MouseHand({.centre = {1, 2}, .height = 6}, pick, 800, 600)});
  input.handle(axis_at(SDL_CONTROLLER_AXIS_TRIGGERLEFT, 1));
  const auto taken = input.next_frame();
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].hand, kUsersLeftHand);
  EXPECT_LT((taken[0].value - Vector2f(1 - 0.8f, 2)).norm(), 0.02f) << "a tenth of 8 m left of the middle";
  input.handle(axis_at(SDL_CONTROLLER_AXIS_LEFTY, -1));
  const auto moved = input.next_frame();
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_NEAR(moved[0].value.y(), 2 + 0.02f * 6, 0.011f);
}

}  // namespace
}  // namespace softcell::demos
