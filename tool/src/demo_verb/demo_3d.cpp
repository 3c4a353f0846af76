// softcell demo 3d: runs soft bodies in a Bullet world.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "changed_scene.h"
#include "demo/scene_demo.h"
#include "demo_verbs.h"
#include "run_demo.h"
#include "scene/scene_camera.h"
#include "scene_file/change_scene.h"
#include "scene_file/own_model.h"
#include "scene_file/save_scene.h"
#include "simulation/simulation_3d.h"
#include "softcell/base/text.h"
#include "verb/exit_status.h"
#include "view/scene_view.h"

namespace softcell::tool {
namespace {

struct Types3d {
  static constexpr int kDimension = 3;
  using Scene = demos::Scene;
  using Simulation = demos::Simulation3d;
  using Shown = demos::Shown3d;
  using SceneView = demos::SceneView;
  using View = demos::View;
  static constexpr int kViews = demos::kViews;
};

demos::SimulationOptions skinned_by(demos::Skin skin, demos::SimulationOptions how) {
  how.skin = skin;
  return how;
}

class Demo3d final : public demos::SceneDemo<Types3d> {
 public:
  Demo3d(const demos::Scene& scene, const Log& log, const demos::SimulationOptions& how,
         const Demo3dOptions& options)
      : SceneDemo(scene, log, skinned_by(options.skin, how), options.view,
                  {.tilt = {},
                   .knife = demos::knife_3d([this](const demos::Look& look) { return eye(look); },
                                            options.size.width, options.size.height),
                   .hand = demos::MouseReach([this](const demos::Look& look) { return eye(look); },
                                             [this](const demos::Ray& ray) { return grab(ray); },
                                             options.size.width, options.size.height),
                   .camera = demos::CameraControl(scene.camera, options.size.height)}),
        options_(options) {}

  demos::FrameTimes step() override {
    simulation().record_contacts(shows_contacts());
    const demos::FrameTimes times = SceneDemo::step();
    follow_body();
    follow_contact();
    return times;
  }
  std::optional<demos::PickedContact> picked_contact() const override {
    if (!contact_ || !shows_contacts()) return std::nullopt;
    return demos::PickedContact{.first = simulation().name_of(contact_->first),
                                .second = simulation().name_of(contact_->second),
                                .position = contact_->position,
                                .normal = contact_->normal,
                                .impulse = contact_->impulse,
                                .force = contact_->impulse / settings().substep};
  }
  demos::DemoCounts counts() const override {
    return {.soft_bodies = simulation().soft_bodies(),
            .rigid_bodies = simulation().rigid_bodies(),
            .particles = simulation().particles(),
            .vertices = simulation().vertices(),
            .bodies_on_ppu = simulation().bodies_on_ppu()};
  }
  ppu::ContactMethod contacts() const override { return simulation().contacts(); }
  std::filesystem::path save_scene(const std::optional<std::filesystem::path>& file) const override {
    return write_scene(scene(), file, [&](const std::filesystem::path& path) {
      return demos::saved_scene(scene(), present(), demos::moved_by(scene().camera, look()),
                                simulation().contacts(), path);
    });
  }

  std::span<const std::string_view> shapes() const override { return demos::spawned_shapes(3); }
  std::unique_ptr<demos::Demo> changed(const demos::SceneChange& change,
                                       const demos::SimulationOptions& how) const override {
    require_changeable();
    return made(changed_scene<3>(scene(), present(), change, [&] { return new_body(change); }), how);
  }
  std::vector<demos::OwnScene> own_scenes() const override { return scene_files_here(3); }
  std::unique_ptr<demos::Demo> opened(const std::filesystem::path& scene_file,
                                      const demos::SimulationOptions& how) const override {
    require_changeable();
    refuse_lua(scene_file);
    return made(demos::load_scene_3d(scene_file.string()), how);
  }

 private:
  std::unique_ptr<demos::Demo> made(demos::Scene scene, const demos::SimulationOptions& how) const {
    Log log{demos::RecordingFiles{}};
    log.begin(scene);
    return std::make_unique<Demo3d>(scene, log, how, options_);
  }
  demos::PresentScene<3> present() const {
    return {simulation().moment(), settings_of_bodies(), simulation().substeps()};
  }

  /// Places the body in front of what one sees at the point of the window, and above it, with a quarter of the picture's height.
  demos::NewBody<3> new_body(const demos::SceneChange& change) const {
    constexpr float kShareOfHeight = 0.25f, kLeastSide = 0.02f;
    const render::Camera camera = eye(look());
    const demos::Ray ray = demos::ray_through(camera, change.x, change.y, change.width, change.height);
    const auto seen = simulation().seen_along(ray);
    const Eigen::Vector3f forward = (camera.target - camera.eye).normalized();
    const Eigen::Vector3f at = seen ? *seen
                                    : Eigen::Vector3f(ray.from + (camera.target - camera.eye).norm() /
                                                                     ray.along.dot(forward) * ray.along);
    const float depth = std::max((at - camera.eye).dot(forward), camera.near_plane);
    demos::NewBody<3> body;
    body.longest_side = std::max(kShareOfHeight * 2 * camera.tan_half_fov_y * depth, kLeastSide);
    body.middle = at;
    if (seen) {
      body.middle -= 0.5f * body.longest_side * ray.along;
      body.middle.y() = std::max(body.middle.y(), at.y() + 0.6f * body.longest_side);
    }
    rise_to_room(body);
    if (change.kind == demos::SceneChange::Kind::kShape) body.alpha = change.number;
    return body;
  }

  /// Moves the body upwards to a free place; leaves it where it is if there is none.
  void rise_to_room(demos::NewBody<3>& body) const {
    constexpr int kTries = 64;
    constexpr float kStep = 0.25f;  // of the body's side
    const Eigen::Vector3f half = Eigen::Vector3f::Constant(0.5f * body.longest_side);
    Eigen::Vector3f middle = body.middle;
    for (int i = 0; i < kTries; ++i, middle.y() += kStep * body.longest_side) {
      if (!simulation().is_free({middle - half, middle + half})) continue;
      body.middle = middle;
      return;
    }
  }

  bool shows_contacts() const { return static_cast<demos::View>(look().view) == demos::View::kContacts; }

  /// What the mouse grabs along a ray. A click on the point of a contact, while contacts are shown, selects the contact and grabs nothing.
  std::optional<demos::InputEvent<3>> grab(const demos::Ray& ray) {
    contact_ = shows_contacts() ? contact_at(ray) : std::nullopt;
    return contact_ ? std::nullopt : simulation().touch(ray);
  }
  std::optional<ppu::Contact> contact_at(const demos::Ray& ray) const {
    constexpr float kShareOfHeight = 0.012f;  // of the picture: the mouse must be this near to the point
    float least = kShareOfHeight * 2 * scene().camera.tan_half_fov_y;
    std::optional<ppu::Contact> nearest;
    for (const ppu::Contact& contact : simulation().shown_contacts()) {
      const Eigen::Vector3f way = contact.position - ray.from;
      const float depth = way.dot(ray.along), beside = (way - depth * ray.along).norm();
      if (depth > 0 && beside < least * depth) nearest = contact, least = beside / depth;
    }
    return nearest;
  }
  /// Finds the contact of the same two bodies that is nearest to its old place; if there is none, its impulse is 0.
  void follow_contact() {
    if (contact_) {
      const ppu::Contact before = *contact_;
      contact_->impulse = 0;
      float least = std::numeric_limits<float>::infinity();
      for (const ppu::Contact& contact : simulation().shown_contacts()) {
        if (contact.first != before.first || contact.second != before.second) continue;
        const float distance = (contact.position - before.position).norm();
        if (distance < least) contact_ = contact, least = distance;
      }
    }
    demos::Look look = input().look();
    look.marked = contact_ ? std::optional(contact_->position) : std::nullopt;
    input().set_look(look);
  }

  render::Camera eye(const demos::Look& look) const {
    std::vector<demos::SolidBox> boxes;
    for (std::size_t b = 0; b < simulation().soft_bodies(); ++b)
      boxes.push_back({.bounds = simulation().soft_body(b).bounds()});
    demos::append_rigid(scene(), simulation().shown_box_poses(), boxes);
    return demos::kept_outside(demos::seen_from(scene(), look, simulation().shown_tilt()), boxes);
  }

  /// Moves the camera as far as the body that was held last, or else the first body, has moved since the beginning.
  void follow_body() {
    for (const demos::InputEvent<3>& event : simulation().last_events())
      if (event.action == demos::Action::kHold && event.body < simulation().soft_bodies())
        followed_ = event.body;
    if (!input().look().follows || simulation().soft_bodies() == 0) return;
    if (followed_ >= simulation().soft_bodies()) followed_ = 0;  // it was a piece that a reset has removed
    const auto& body = simulation().soft_body(followed_);
    const demos::SoftBodyPlacement& placement = scene().soft_bodies[simulation().source(followed_)];
    const ppu::Bounds<3> rest = ppu::bounds(placement.mesh), now = body.bounds();
    const Eigen::Vector3f begin = placement.position + 0.5f * (rest.low + rest.high);
    input().follow_body(simulation().shown_tilt() * (0.5f * (now.low + now.high) - begin));
  }

  const Demo3dOptions& options_;
  std::size_t followed_ = 0;             // number of a soft body
  std::optional<ppu::Contact> contact_;  // the contact that the user has clicked
};

/// Prints which parts of the models are not shown; the demo runs all the same.
void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "softcell: {}\n", base::one_line(note));
}

demos::Scene load_with_model(const std::string& name, const std::optional<demos::OwnModel>& model) {
  try {
    return demos::load_scene_3d(name, model);
  } catch (const demos::NoPlaceForModel& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

int run_demo_3d(const Demo3dOptions& options) {
  check_kept({{"--mesh", options.model.mesh}}, written_files(options));
  if (const auto cell = options.model.cell;
      options.model.mesh && cell && !(*cell > 0 && std::isfinite(*cell)))
    throw UsageError(fmt::format("--cell {}: give a length above 0, in the model's units", *cell));
  if (const auto unit = options.model.unit; unit && !(*unit > 0 && std::isfinite(*unit)))
    throw UsageError(
        fmt::format("--unit {}: give what one of the model's units is in metres, above 0", *unit));
  if (const auto tessellation = options.model.tessellation;
      tessellation &&
      !(*tessellation >= demos::kLeastTessellation && *tessellation <= demos::kMostTessellation))
    throw UsageError(fmt::format("--tessellate {}: give a number of cells from {} to {}", *tessellation,
                                 demos::kLeastTessellation, demos::kMostTessellation));
  if (options.turntable && !(*options.turntable > 0 && std::isfinite(*options.turntable)))
    throw UsageError(
        fmt::format("--turntable {}: give the seconds of one turn, above 0", *options.turntable));
  if (options.turntable && !options.headless)
    throw UsageError("--turntable is for pictures without a window: give --headless too");
  return run_demo(options, "demo 3d", [&](bool all) {
    const std::optional<demos::OwnModel> model = demos::load_own_model(options.model);
    demos::InputLog<3> log(options);
    const std::string usual = model ? "drop" : "arena";
    demos::Scene scene = load_with_model(scene_to_load(options, 3, log.scene_name(), usual), model);
    if (model) scene.files.insert(scene.files.end(), model->files.begin(), model->files.end());
    check_scene_kept(scene.files, options);
    if (model && !options.quiet) print_notes(model->notes);
    if (!options.quiet) print_notes(scene.notes);
    log.begin(scene, options.contacts);
    return demos_of<Demo3d>(options, log, scene, all,
                            [](std::string_view name) { return demos::load_scene_3d(name); });
  });
}

}  // namespace softcell::tool
