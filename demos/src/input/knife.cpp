#include "knife.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {

Knife::Knife(Eye eye, int width, int height) : eye_(std::move(eye)), width_(width), height_(height) {
  SC_ASSERT(eye_ && width > 0 && height > 0, "a picture of {} by {} pixels, {} an eye", width, height,
            eye_ ? "with" : "without");
}

bool Knife::handle(const SDL_Event& event, Look& look, std::vector<InputEvent<3>>& events) {
  if (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) {
    width_ = std::max(event.window.data1, 1);  // a window may shrink to nothing
    height_ = std::max(event.window.data2, 1);
    return false;
  }
  if (!eye_) return false;
  if (!look.knife) {  // put away, perhaps in the middle of a stroke
    from_.reset();
    look.stroke.reset();
    return false;
  }
  switch (event.type) {
    case SDL_MOUSEBUTTONDOWN:
      if (event.button.button != SDL_BUTTON_LEFT) return false;
      from_ = to_ = {event.button.x, event.button.y};
      show(look);
      return true;
    case SDL_MOUSEMOTION:
      if (!from_) return false;
      to_ = {event.motion.x, event.motion.y};
      show(look);
      return true;
    case SDL_MOUSEBUTTONUP:
      if (event.button.button != SDL_BUTTON_LEFT || !from_) return false;
      to_ = {event.button.x, event.button.y};
      cut(look, events);
      from_.reset();
      look.stroke.reset();
      return true;
    default:
      return false;
  }
}

void Knife::show(Look& look) const {
  const auto share = [this](const Point& at) {
    return Eigen::Vector2f(static_cast<float>(at.x) / static_cast<float>(width_),
                           static_cast<float>(at.y) / static_cast<float>(height_));
  };
  look.stroke = std::array{share(*from_), share(to_)};
}

void Knife::cut(const Look& look, std::vector<InputEvent<3>>& events) const {
  if (std::max(std::abs(to_.x - from_->x), std::abs(to_.y - from_->y)) < kShortest) return;
  // The parallelogram between both rays lies in the plane that one sees as a line; it is longer than all that is drawn.
  const render::Camera camera = eye_(look);
  const Ray first = ray_through(camera, from_->x, from_->y, width_, height_);
  const Ray last = ray_through(camera, to_.x, to_.y, width_, height_);
  events.push_back({.action = Action::kCut,
                    .body = kEveryBody,
                    .value = camera.eye,
                    .edge = camera.far_plane * first.along,
                    .way = camera.far_plane * last.along});
}

}  // namespace softcell::demos
