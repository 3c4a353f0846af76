#pragma once
// A pointer, usually the mouse, as the user's hand in a scene in two dimensions.

#include <SDL.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "input_event.h"
#include "scene/look.h"
#include "scene/scene_2d.h"
#include "softcell/base/assert.h"
#include "window_size.h"

namespace softcell::demos {

/// Pressing the left button takes what is under the mouse, which then follows it; letting the button go throws it.
class MouseHand {
 public:
  /// Makes the event by which a hand takes what is at a point of the scene; all of it but the hand. None: there is nothing.
  using Pick = std::function<std::optional<InputEvent<2>>(const Eigen::Vector2f&)>;

  /// @param width, height  of the window, in the units in which SDL gives the mouse
  MouseHand(const Camera2d& camera, Pick pick, int width, int height)
      : camera_(camera), pick_(std::move(pick)), window_{width, height} {
    SC_ASSERT(pick_ && width > 0 && height > 0, "a picture of {} by {} pixels", width, height);
  }

  /// Appends the events that it makes of this one. Of moves that follow one another, only the last counts.
  void handle(const SDL_Event& event, const Look& look, std::vector<InputEvent<2>>& events);

  // For pointers other than the mouse, at (x, y) of the window.

  /// The same for another hand of the user, which holds nothing yet.
  MouseHand for_hand(std::uint32_t hand) const;
  Eigen::Vector2i window_size() const { return {window_.width, window_.height}; }
  bool holds() const { return holds_; }
  /// @return whether there is something to grab
  bool grab(int x, int y, const Look& look, std::vector<InputEvent<2>>& events);
  /// @pre holds()
  void move_to(int x, int y, const Look& look, std::vector<InputEvent<2>>& events);
  /// Pins what it holds where it is. @pre holds()
  void pin(std::vector<InputEvent<2>>& events) const;
  /// @pre holds()
  void let_go(std::vector<InputEvent<2>>& events);

 private:
  Camera2d camera_;
  Pick pick_;
  WindowSize window_;
  std::uint32_t hand_ = kUsersHand;
  bool holds_ = false;
};

}  // namespace softcell::demos
