// A window whose display is none (SDL's driver "dummy"): steps go on however slow drawing is, and a game controller that SDL itself
// pretends is heard.

#include <SDL.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
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
      : SceneDemo(scene, Log(RecordingFiles{}), how, View2d::kFilled,
                  {MouseHand(
                      scene.camera, [](const Eigen::Vector2f&) { return std::nullopt; }, 320, 240)}) {}
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

/// @param each_frame  called before each frame, with its number
Run play_man(
    int frames, const std::function<void(int)>& each_frame = [](int) {}) {
  setenv("SDL_VIDEODRIVER", "dummy", 1);
  setenv("SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", "1", 1);  // such a window never has the focus
  const std::vector<NamedDemo> scenes{{"man", "", [](const SimulationOptions& how) -> std::unique_ptr<Demo> {
                                         return std::make_unique<SlowDemo>(load_scene_2d("man"), how);
                                       }}};
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

}  // namespace
}  // namespace softcell::demos
