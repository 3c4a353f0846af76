#include "knife.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {

template <int Dimension>
Knife<Dimension>::Knife(Blade blade, int width, int height)
    : blade_(std::move(blade)), window_{width, height} {
  SC_ASSERT(blade_ && width > 0 && height > 0, "a picture of {} by {} pixels, {} a blade", width, height,
            blade_ ? "with" : "without");
}

template <int Dimension>
bool Knife<Dimension>::handle(const SDL_Event& event, Look& look,
                              std::vector<InputEvent<Dimension>>& events) {
  if (window_.follow(event)) return false;
  if (!blade_) return false;
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

template <int Dimension>
void Knife<Dimension>::show(Look& look) const {
  const auto share = [this](const Point& at) {
    return Eigen::Vector2f(static_cast<float>(at.x) / static_cast<float>(window_.width),
                           static_cast<float>(at.y) / static_cast<float>(window_.height));
  };
  look.stroke = std::array{share(*from_), share(to_)};
}

template <int Dimension>
void Knife<Dimension>::cut(const Look& look, std::vector<InputEvent<Dimension>>& events) const {
  if (std::max(std::abs(to_.x - from_->x), std::abs(to_.y - from_->y)) < kShortest) return;
  InputEvent<Dimension> event = blade_(look, {*from_, to_, window_.width, window_.height});
  event.action = Action::kCut;
  event.body = kEveryBody;
  events.push_back(event);
}

template class Knife<2>;
template class Knife<3>;

/// The parallelogram between both rays is in the plane that the user sees as a line; it is longer than everything that is drawn.
Knife<3> knife_3d(std::function<render::Camera(const Look&)> eye, int width, int height) {
  return {[eye = std::move(eye)](const Look& look, const Knife<3>::Stroke& stroke) {
            const render::Camera camera = eye(look);
            const Ray first = ray_through(camera, stroke.from.x, stroke.from.y, stroke.width, stroke.height);
            const Ray last = ray_through(camera, stroke.to.x, stroke.to.y, stroke.width, stroke.height);
            InputEvent<3> event;
            event.value = camera.eye;
            event.edge = camera.far_plane * first.along;
            event.way = camera.far_plane * last.along;
            return event;
          },
          width, height};
}

Knife<2> knife_2d(const Camera2d& camera, int width, int height) {
  return {[camera](const Look&, const Knife<2>::Stroke& stroke) {
            InputEvent<2> event;
            event.value = camera.point_at(stroke.from.x, stroke.from.y, stroke.width, stroke.height);
            event.way = camera.point_at(stroke.to.x, stroke.to.y, stroke.width, stroke.height) - event.value;
            return event;
          },
          width, height};
}

}  // namespace softcell::demos
