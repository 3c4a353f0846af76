// softcell demo 2d: runs soft bodies in a Box2D world.

#include <filesystem>
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
#include "scene_file/change_scene.h"
#include "scene_file/picture_cells.h"
#include "scene_file/save_scene.h"
#include "simulation/simulation_2d.h"
#include "verb/exit_status.h"
#include "view/scene_view_2d.h"

namespace softcell::tool {
namespace {

struct Types2d {
  static constexpr int kDimension = 2;
  using Scene = demos::Scene2d;
  using Simulation = demos::Simulation2d;
  using Shown = demos::Shown2d;
  using SceneView = demos::SceneView2d;
  using View = demos::View2d;
  static constexpr int kViews = demos::kViews2d;
};

class Demo2d final : public demos::SceneDemo<Types2d> {
 public:
  Demo2d(const demos::Scene2d& scene, const Log& log, const demos::SimulationOptions& how,
         const Demo2dOptions& options)
      : SceneDemo(
            scene, log, how, options.view,
            {.hand = demos::MouseHand(
                 scene.camera, [this](const Eigen::Vector2f& point) { return simulation().touch(point); },
                 options.size.width, options.size.height),
             .knife = demos::knife_2d(scene.camera, options.size.width, options.size.height)}),
        options_(options) {}

  demos::DemoCounts counts() const override {
    return {.soft_bodies = simulation().soft_bodies(),
            .rigid_bodies = simulation().rigid_bodies(),
            .particles = simulation().particles(),
            .vertices = simulation().particles(),
            .bodies_on_ppu = simulation().bodies_on_ppu()};
  }
  ppu::ContactMethod contacts() const override { return simulation().contacts(); }
  std::filesystem::path save_scene(const std::optional<std::filesystem::path>& file) const override {
    return write_scene(scene(), file, [&](const std::filesystem::path& path) {
      return demos::saved_scene(scene(), present(), simulation().contacts(), path);
    });
  }

  std::span<const std::string_view> shapes() const override { return demos::spawned_shapes(2); }
  std::unique_ptr<demos::Demo> changed(const demos::SceneChange& change,
                                       const demos::SimulationOptions& how) const override {
    require_changeable();
    return made(changed_scene<2>(scene(), present(), change, [&] { return new_body(change); }), how);
  }
  std::vector<demos::OwnScene> own_scenes() const override { return scene_files_here(2); }
  std::unique_ptr<demos::Demo> opened(const std::filesystem::path& scene_file,
                                      const demos::SimulationOptions& how) const override {
    require_changeable();
    refuse_lua(scene_file);
    return made(demos::load_scene_2d(scene_file.string()), how);
  }

 private:
  std::unique_ptr<demos::Demo> made(demos::Scene2d scene, const demos::SimulationOptions& how) const {
    Log log{demos::RecordingFiles{}};
    log.begin(scene);
    return std::make_unique<Demo2d>(scene, log, how, options_);
  }
  demos::PresentScene<2> present() const {
    return {simulation().moment(), settings_of_bodies(), simulation().substeps()};
  }

  /// Places the body at the point of the window, with a quarter of the picture's height. If that is in a wall or another body, takes the
  /// first free place on the way to the picture's middle.
  demos::NewBody<2> new_body(const demos::SceneChange& change) const {
    constexpr float kShareOfHeight = 0.25f;
    demos::NewBody<2> body;
    const Eigen::Vector2f at = scene().camera.point_at(change.x, change.y, change.width, change.height);
    body.middle = at;
    body.longest_side = kShareOfHeight * scene().camera.height;
    constexpr int kTries = 24;
    for (int i = 0; i <= kTries; ++i) {
      const float share = static_cast<float>(i) / kTries;
      const Eigen::Vector2f middle = at + share * (scene().camera.centre - at);
      if (!simulation().is_free(middle, 1.15f * body.longest_side)) continue;
      body.middle = middle;
      break;
    }
    if (change.kind == demos::SceneChange::Kind::kShape) body.alpha = change.number;
    return body;
  }

  const Demo2dOptions& options_;
};

demos::Scene2d load_with_picture(const std::string& name, const std::optional<demos::OwnPicture>& picture) {
  try {
    return demos::load_scene_2d(name, picture);
  } catch (const demos::NoPlaceForModel& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

int run_demo_2d(const Demo2dOptions& options) {
  check_kept({{"--image", options.image}}, written_files(options));
  return run_demo(options, "demo 2d", [&](bool all) {
    std::optional<demos::OwnPicture> picture;
    if (options.image)
      picture = {
          .image = demos::load_picture(*options.image), .cells = options.cells, .file = *options.image};
    demos::InputLog<2> log(options);
    const std::string usual = picture ? "picture" : "man";
    demos::Scene2d scene = load_with_picture(scene_to_load(options, 2, log.scene_name(), usual), picture);
    check_scene_kept(scene.files, options);
    log.begin(scene, options.contacts);
    return demos_of<Demo2d>(options, log, scene, all,
                            [](std::string_view name) { return demos::load_scene_2d(name); });
  });
}

}  // namespace softcell::tool
