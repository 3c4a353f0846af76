#pragma once
// A pointer, mostly the mouse, as the user's hand in three dimensions: it moves what it has taken in the plane that faces the
// eye.

#include <SDL.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "input_event.h"
#include "scene/look.h"
#include "scene/scene_camera.h"

namespace softcell::demos {

/// The left button takes what is under the mouse, which then follows it; letting go throws it. The wheel moves what is held
/// nearer and farther. Where there is nothing to take, the mouse is left to others.
class MouseReach {
 public:
  /// From where the scene is seen now.
  using Eye = std::function<render::Camera(const Look&)>;
  /// How a hand takes what one sees along a ray, all but the hand. None: nothing that can be taken.
  using Pick = std::function<std::optional<InputEvent<3>>(const Ray&)>;

  /// Reaches nothing.
  MouseReach() = default;
  /// @param width, height  of the window, in the units in which SDL gives the mouse
  MouseReach(Eye eye, Pick pick, int width, int height);

  /// Appends what the event means. Of moves that follow one another, the last counts.
  /// @return true: the event was the hand's
  bool handle(const SDL_Event& event, const Look& look, std::vector<InputEvent<3>>& events);

  // For pointers other than the mouse, at (x, y) of the window.

  /// The same for another hand of the user, which holds nothing.
  MouseReach for_hand(std::uint32_t hand) const;
  Eigen::Vector2i window_size() const { return {width_, height_}; }
  bool holds() const { return depth_.has_value(); }
  /// @return whether there is something to take
  bool take(int x, int y, const Look& look, std::vector<InputEvent<3>>& events);
  /// @pre holds()
  void move_to(int x, int y, const Look& look, std::vector<InputEvent<3>>& events);
  /// @param notches  of the wheel; below 0: nearer  @pre holds()
  void move_away(float notches, const Look& look, std::vector<InputEvent<3>>& events);
  /// What it holds stays where it is. @pre holds()
  void pin(std::vector<InputEvent<3>>& events) const;
  /// @pre holds()
  void let_go(std::vector<InputEvent<3>>& events);

 private:
  void move(const Look& look, std::vector<InputEvent<3>>& events) const;

  Eye eye_;
  Pick pick_;
  int width_ = 1, height_ = 1;
  std::uint32_t hand_ = kUsersHand;
  int x_ = 0, y_ = 0;           // of the pointer while it holds something
  std::optional<float> depth_;  // of what it holds, along the camera's axis, metres; none: it holds nothing
};

}  // namespace softcell::demos
