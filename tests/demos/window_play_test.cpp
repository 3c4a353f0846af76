// A window whose display is none (SDL's driver "dummy"): steps go on however slow drawing is, and a game controller that SDL itself
// pretends is heard.

#include <SDL.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "demo/scene_demo.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "view/scene_view_2d.h"
#include "window/play.h"

namespace softcell::demos {
namespace {

std::chrono::milliseconds drawing_takes{0};

class SlowView : public SceneView2d {
 public:
  using SceneView2d::draw;
  using SceneView2d::SceneView2d;
  void draw(const Shown2d& shown, const Look& look) {
    std::this_thread::sleep_for(drawing_takes);
    SceneView2d::draw(shown, look);
  }
};

struct SlowTypes {
  static constexpr int kDimension = 2;
  using Scene = Scene2d;
  using Simulation = Simulation2d;
  using Shown = Shown2d;
  using SceneView = SlowView;
  using View = View2d;
  static constexpr int kViews = kViews2d;
};

class SlowDemo final : public SceneDemo<SlowTypes> {
 public:
  SlowDemo(const Scene2d& scene, const SimulationOptions& how)
      : SceneDemo(
            scene, Log(RecordingFiles{}), how, View2d::kFilled,
            {MouseHand(
                scene.camera, [this](const Eigen::Vector2f& point) { return simulation().touch(point); }, 320,
                240)}) {}
  Beginning<2> now() const { return simulation().moment(); }
  DemoCounts counts() const override { return {}; }
  ppu::ContactMethod contacts() const override { return ppu::ContactMethod::kSpheres; }
  std::filesystem::path save_scene(const std::optional<std::filesystem::path>&) const override { return {}; }
  std::span<const std::string_view> shapes() const override { return {}; }
  std::unique_ptr<Demo> changed(const SceneChange&, const SimulationOptions&) const override {
    throw std::runtime_error("not in this test");
  }
  std::vector<OwnScene> own_scenes() const override { return {}; }
  std::unique_ptr<Demo> opened(const std::filesystem::path&, const SimulationOptions&) const override {
    throw std::runtime_error("not in this test");
  }
};

std::unique_ptr<SlowDemo> make_man(const SimulationOptions& how) {
  return std::make_unique<SlowDemo>(load_scene_2d("man"), how);
}

void use_no_display() {
  setenv("SDL_VIDEODRIVER", "dummy", 1);
  setenv("SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", "1", 1);  // such a window never has the focus
}

struct WindowSize {
  int width = 320, height = 240;
};

/// What of the page and the menu does not fit into the window, or lies on something else. Empty: everything fits.
std::string overflow(const WindowSize& size) {
  std::string found;
  std::vector<ImRect> seen;
  for (const ImGuiWindow* const window : ImGui::GetCurrentContext()->Windows) {
    if (!window->WasActive || window->Hidden || window->ParentWindow != nullptr || window->IsFallbackWindow)
      continue;
    const ImRect at = window->Rect();
    const bool fits = at.Min.x >= 0 && at.Min.y >= 0 && at.Max.x <= static_cast<float>(size.width) &&
                      at.Max.y <= static_cast<float>(size.height);
    if (std::ranges::any_of(seen, [&](const ImRect& other) { return other.Overlaps(at); }))
      found += fmt::format("{} lies on something; ", window->Name);
    seen.push_back(at);
    const bool cut_off = window->ContentSize.x > window->InnerRect.GetWidth() + 1;
    if (!fits || cut_off)
      found += fmt::format("{} from ({}, {}) to ({}, {}), {} wide inside; ", window->Name, at.Min.x, at.Min.y,
                           at.Max.x, at.Max.y, window->ContentSize.x);
  }
  return found;
}

/// @param each_frame  called before each frame, with its number
Run play_man(
    int frames, const std::function<void(int)>& each_frame = [](int) {}) {
  use_no_display();
  const std::vector<NamedDemo> scenes{{"man", "", &make_man}};
  int frame = 0;
  return play({.title = "test", .width = 320, .height = 240, .frames = frames, .ui_scale = {}}, scenes,
              {.spes = 1}, [&] {
                each_frame(frame++);
                return false;
              });
}

TEST(Play, StepsGoOnHoweverSlowDrawingIs) {
  drawing_takes = std::chrono::milliseconds(250);
  constexpr int kFrames = 120;
  const auto begin = std::chrono::steady_clock::now();
  const auto run = play_man(kFrames);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  drawing_takes = {};
  ASSERT_EQ(run.record.frames, kFrames);
  const auto pictures = static_cast<double>(run.record.picture_ms.size());
  EXPECT_GE(pictures, 1);
  EXPECT_LE(pictures, 4 * seconds.count() + 1) << "a picture takes a quarter of a second";
  EXPECT_GT(kFrames, 3 * pictures) << "frames wait for pictures: " << seconds.count() << " s";
  EXPECT_GE(seconds.count(), 0.95 * kFrames / 60) << "no faster than sixty a second";
}

TEST(Play, AControllerIsHeardWhenItIsPluggedIn) {
  int device = -1;
  SDL_Joystick* joystick = nullptr;
  const auto press = [&](SDL_GameControllerButton button, bool down) {
    SDL_JoystickSetVirtualButton(joystick, button, down ? SDL_PRESSED : SDL_RELEASED);
  };
  const auto run = play_man(60, [&](int frame) {
    if (frame == 5) {
      device = SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
                                         SDL_CONTROLLER_BUTTON_MAX, 0);
      ASSERT_GE(device, 0) << SDL_GetError();
      joystick = SDL_JoystickOpen(device);
      ASSERT_NE(joystick, nullptr) << SDL_GetError();
    }
    if (frame == 15) press(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, true);
    if (frame == 17) press(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, false);
    if (frame == 20) press(SDL_CONTROLLER_BUTTON_DPAD_LEFT, true);
    if (frame == 22) press(SDL_CONTROLLER_BUTTON_DPAD_LEFT, false);
    if (frame == 50) {  // it is pulled out again
      SDL_JoystickClose(joystick);
      SDL_JoystickDetachVirtual(device);
    }
  });
  ASSERT_EQ(run.record.frames, 60);
  const auto& demo = dynamic_cast<const SlowDemo&>(*run.demo);
  EXPECT_NEAR(run.demo->settings().gravity, 10.81f, 1e-4f) << "the right shoulder is more gravity";
  const Beginning<2> moment = demo.now();
  EXPECT_NEAR(moment.gravity->x(), -10.81f, 1e-4f) << "the directional pad turns it";
}

TEST(Play, AControllersTwoHandsLiftTheMan) {
  int device = -1;
  SDL_Joystick* joystick = nullptr;
  std::array<bool, 2> shown{}, hold{};
  const auto turn = [&](const std::array<SDL_GameControllerAxis, 2>& axes, Sint16 to) {
    for (const auto axis : axes) SDL_JoystickSetVirtualAxis(joystick, axis, to);
  };
  constexpr std::array kTriggers{SDL_CONTROLLER_AXIS_TRIGGERLEFT, SDL_CONTROLLER_AXIS_TRIGGERRIGHT};
  constexpr std::array kSticks{SDL_CONTROLLER_AXIS_LEFTY, SDL_CONTROLLER_AXIS_RIGHTY};
  use_no_display();
  SlowDemo* seen = nullptr;
  const std::vector<NamedDemo> scenes{{"man", "", [&](const SimulationOptions& how) {
                                         auto made = make_man(how);
                                         seen = made.get();
                                         return made;
                                       }}};
  int frame = 0;
  const auto run = play(
      {.title = "test", .width = 320, .height = 240, .frames = 90, .ui_scale = {}}, scenes, {.spes = 1}, [&] {
        ++frame;
        if (frame == 5) {
          device = SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
                                             SDL_CONTROLLER_BUTTON_MAX, 0);
          joystick = SDL_JoystickOpen(device);
        }
        if (frame == 7) turn(kTriggers, -32768);
        if (frame == 9) turn(kTriggers, -20000);  // touched
        if (frame == 11) turn(kTriggers, 32767);
        if (frame == 13) turn(kSticks, -32768);  // up
        if (frame == 21) turn(kSticks, 0);
        if (frame == 10 || frame == 80) {
          for (std::size_t side = 0; side < 2; ++side) {
            const auto& hand = seen->input().look().hands[side];
            shown[side] = hand.has_value();
            hold[side] = hand && hand->holds;
          }
          if (frame == 10) {
            EXPECT_TRUE(shown[0] && shown[1]);
            EXPECT_FALSE(hold[0] || hold[1]);
          }
        }
        return false;
      });
  SDL_JoystickClose(joystick);
  SDL_JoystickDetachVirtual(device);
  EXPECT_TRUE(hold[0] && hold[1]);
  const Beginning<2> moment = dynamic_cast<const SlowDemo&>(*run.demo).now();
  float height = 0;
  for (const auto& at : moment.soft_bodies.at(0).positions)
    height += at.y() / static_cast<float>(moment.soft_bodies[0].positions.size());
  EXPECT_GT(height, 0.3f) << "who falls lies at -1.4";
}

void push_key(Uint32 type, SDL_Keycode code) {
  SDL_Event event{};
  event.key.type = type;
  event.key.keysym.sym = code;
  event.key.keysym.scancode = SDL_GetScancodeFromKey(code);
  ASSERT_EQ(SDL_PushEvent(&event), 1) << SDL_GetError();
}
void press_key(SDL_Keycode code) {
  push_key(SDL_KEYDOWN, code);
  push_key(SDL_KEYUP, code);
}

/// On displays of every density, in windows of every size: statistics, help, menu, and what the window says.
TEST(Play, PagesAndMenuFitIntoTheWindow) {
  use_no_display();
  for (const WindowSize size : {WindowSize{1280, 720}, WindowSize{640, 360}, WindowSize{400, 600}}) {
    for (const float scale : {1.0f, 1.5f, 2.0f}) {
      const auto check = [&](const char* what) {
        EXPECT_EQ(overflow(size), "")
            << what << " in " << size.width << " x " << size.height << " at scale " << scale;
      };
      int frame = 0;
      play({.title = "test", .width = size.width, .height = size.height, .frames = 60, .ui_scale = scale},
           {{"man", "", &make_man}}, {.spes = 1}, [&] {
             ++frame;
             if (frame == 10) check("statistics"), press_key(SDLK_F1);
             if (frame == 20) check("help"), press_key(SDLK_F1), press_key(SDLK_m);
             if (frame == 30) check("menu"), press_key(SDLK_m);
             if (frame == 35) press_key(SDLK_DELETE);  // of nothing: the window says so
             if (frame == 45 && static_cast<float>(size.height) / scale > 300) check("statistics and notice");
             if (frame == 45) press_key(SDLK_m);
             if (frame == 55 && size.width > 1000) check("menu and notice");
             return false;
           });
    }
  }
}

TEST(Play, EscapesThatArePressedWhileAChosenSceneLoadsAreHeard) {
  use_no_display();
  int made = 0;
  const MakeDemo make = [&](const SimulationOptions& how) -> std::unique_ptr<Demo> {
    if (++made == 2) {  // what the user does meanwhile: one press for the menu, one for the window
      push_key(SDL_KEYUP, SDLK_SPACE);
      press_key(SDLK_ESCAPE);
      press_key(SDLK_ESCAPE);
    }
    return make_man(how);
  };
  int frame = 0;
  const auto run = play({.title = "test", .width = 320, .height = 240, .frames = 300, .ui_scale = {}},
                        {{"man", "", make}, {"stack", "", make}}, {.spes = 1}, [&] {
                          ++frame;
                          if (frame == 10) press_key(SDLK_m);
                          if (frame == 20) press_key(SDLK_DOWN);
                          if (frame == 30) press_key(SDLK_DOWN);
                          if (frame == 40) push_key(SDL_KEYDOWN, SDLK_SPACE);
                          if (frame == 45 && made < 2) push_key(SDL_KEYUP, SDLK_SPACE);
                          return false;
                        });
  ASSERT_EQ(made, 2) << "the keys choose no scene";
  EXPECT_LT(run.record.frames, 10) << "an Escape was lost";
}

TEST(Play, EscapeEndsTheChangeOfASliderBeforeItClosesTheMenu) {
  use_no_display();
  Demo* demo = nullptr;
  const MakeDemo make = [&](const SimulationOptions& how) -> std::unique_ptr<Demo> {
    auto man = make_man(how);
    demo = man.get();
    return man;
  };
  int frame = 0;
  std::vector<bool> open;
  const auto run = play({.title = "test", .width = 320, .height = 240, .frames = 300, .ui_scale = {}},
                        {{"man", "", make}}, {.spes = 1}, [&] {
                          ++frame;
                          if (frame == 10) press_key(SDLK_m);
                          if (frame == 20 || frame == 30)
                            press_key(SDLK_DOWN);  // from the heading to the first slider
                          if (frame == 40) push_key(SDL_KEYDOWN, SDLK_SPACE);
                          if (frame == 42) push_key(SDL_KEYUP, SDLK_SPACE);
                          if (frame == 50 || frame == 60 || frame == 70) press_key(SDLK_ESCAPE);
                          if (frame == 49 || frame == 59 || frame == 69)
                            open.push_back(demo->input().look().menu);
                          return false;
                        });
  EXPECT_EQ(open, (std::vector{true, true, false}));
  EXPECT_LT(run.record.frames, 80);
}

}  // namespace
}  // namespace softcell::demos
