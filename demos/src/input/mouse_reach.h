#pragma once
// A pointer, usually the mouse, as the user's hand in three dimensions: it moves what it has taken in a plane parallel to the picture.

#include <SDL.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "input_event.h"
#include "scene/look.h"
#include "scene/scene_camera.h"
#include "window_size.h"

namespace softcell::demos {

/// Pressing the left button takes what is under the mouse, which then follows it; letting the button go throws it. The wheel moves the held
/// thing nearer and farther. Where there is nothing to take, it leaves the mouse events to others.
class MouseReach {
 public:
  /// Gives the camera from which the scene is seen now.
  using Eye = std::function<render::Camera(const Look&)>;
  /// Makes the event by which a hand takes what one sees along a ray; all of it but the hand. None: there is nothing that can be taken.
  using Pick = std::function<std::optional<InputEvent<3>>(const Ray&)>;

  /// A hand that reaches nothing.
  MouseReach() = default;
  /// @param width, height  of the window, in the units in which SDL gives the mouse
  MouseReach(Eye eye, Pick pick, int width, int height);

  /// Appends the events that it makes of this one. Of moves that follow one another, only the last counts.
  /// @return true: the hand has used the event
  bool handle(const SDL_Event& event, const Look& look, std::vector<InputEvent<3>>& events);

  // For pointers other than the mouse, at (x, y) of the window.

  /// The same for another hand of the user, which holds nothing yet.
  MouseReach for_hand(std::uint32_t hand) const;
  Eigen::Vector2i window_size() const { return {window_.width, window_.height}; }
  bool holds() const { return depth_.has_value(); }
  /// @return whether there is something to grab
  bool grab(int x, int y, const Look& look, std::vector<InputEvent<3>>& events);
  /// @pre holds()
  void move_to(int x, int y, const Look& look, std::vector<InputEvent<3>>& events);
  /// @param notches  of the wheel; below 0: nearer  @pre holds()
  void move_away(float notches, const Look& look, std::vector<InputEvent<3>>& events);
  /// Pins what it holds where it is. @pre holds()
  void pin(std::vector<InputEvent<3>>& events) const;
  /// @pre holds()
  void let_go(std::vector<InputEvent<3>>& events);

 private:
  void move(const Look& look, std::vector<InputEvent<3>>& events) const;

  Eye eye_;
  Pick pick_;
  WindowSize window_;
  std::uint32_t hand_ = kUsersHand;
  int x_ = 0, y_ = 0;           // of the pointer while it holds something
  std::optional<float> depth_;  // of what it holds, along the camera's axis, metres; none: it holds nothing
};

}  // namespace softcell::demos
