// The window's mouse and keys as Dear ImGui sees them; no window.

#include "window/panel_input.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <utility>
#include <vector>

#include "softcell/render/overlay.h"

namespace softcell::demos {
namespace {

SDL_Event mouse(Uint32 type, int x, int y) {
  SDL_Event event{};
  event.type = type;
  if (type == SDL_MOUSEMOTION) {
    event.motion.x = x;
    event.motion.y = y;
  } else {
    event.button.button = SDL_BUTTON_LEFT;
    event.button.x = x;
    event.button.y = y;
  }
  return event;
}

SDL_Event key(Uint32 type, SDL_Scancode code) {
  SDL_Event event{};
  event.key.type = type;
  event.key.keysym.scancode = code;
  return event;
}

/// A window of Dear ImGui with one button, at the picture's upper left corner.
class OneButton : public testing::Test {
 protected:
  void handle(const std::vector<SDL_Event>& events) {
    for (const SDL_Event& event : events) input_.handle(event, density_, panel_);
  }
  void frames(int count) {
    for (int frame = 0; frame < count; ++frame) {
      input_.begin_frame();
      overlay_.begin(400, 300, 1.0f / 60);
      ImGui::SetNextWindowPos({0, 0});
      ImGui::SetNextWindowSize({200, 200});
      ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration);
      if (ImGui::Button("button", {180, 180})) ++clicks_;
      ImGui::End();
      if (ImGui::IsKeyPressed(SDL_SCANCODE_A, false)) ++presses_;
      overlay_.end();
    }
  }

  render::Overlay overlay_;
  PanelInput input_;
  ScenePictures pictures_;
  Panel panel_{{}, pictures_};
  float density_ = 1;
  int clicks_ = 0, presses_ = 0;
};

TEST_F(OneButton, ClicksWithinAFrameAreNotLost) {
  frames(2);
  for (int click = 0; click < 3; ++click)
    handle({mouse(SDL_MOUSEMOTION, 90, 90), mouse(SDL_MOUSEBUTTONDOWN, 90, 90),
            mouse(SDL_MOUSEBUTTONUP, 90, 90), mouse(SDL_MOUSEMOTION, 300, 250)});
  frames(12);
  EXPECT_EQ(clicks_, 3);
}

TEST_F(OneButton, KeysWithinAFrameAreNotLost) {
  frames(2);
  for (int press = 0; press < 4; ++press)
    handle({key(SDL_KEYDOWN, SDL_SCANCODE_A), key(SDL_KEYUP, SDL_SCANCODE_A)});
  frames(10);
  EXPECT_EQ(presses_, 4);
}

TEST_F(OneButton, IsPressedByKeyboardAlone) {
  frames(2);
  handle({key(SDL_KEYDOWN, SDL_SCANCODE_DOWN), key(SDL_KEYUP, SDL_SCANCODE_DOWN)});
  frames(3);
  handle({key(SDL_KEYDOWN, SDL_SCANCODE_SPACE), key(SDL_KEYUP, SDL_SCANCODE_SPACE)});
  frames(3);
  EXPECT_EQ(clicks_, 1);
}

TEST_F(OneButton, OnADenseScreenAUnitOfTheMouseIsSeveralPixels) {
  density_ = 2;
  frames(2);
  handle({mouse(SDL_MOUSEBUTTONDOWN, 90, 90), mouse(SDL_MOUSEBUTTONUP, 90, 90)});
  frames(3);
  EXPECT_EQ(clicks_, 1) << "at pixel 180";
  handle({mouse(SDL_MOUSEBUTTONDOWN, 110, 90), mouse(SDL_MOUSEBUTTONUP, 110, 90)});
  frames(3);
  EXPECT_EQ(clicks_, 1) << "at pixel 220, beside it";
}

}  // namespace
}  // namespace softcell::demos
