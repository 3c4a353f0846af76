// softcell demo 3d: soft bodies in a Bullet world.

#include <optional>

#include "demo.h"
#include "scene_file/scene_library.h"
#include "scene_view.h"
#include "simulation_3d.h"
#include "verbs.h"

namespace softcell::demos {
namespace {

constexpr double kDefaultCellsAlongModel = 8;

std::optional<OwnModel> load_model(const Demo3dOptions& options) {
  if (!options.mesh) return std::nullopt;
  OwnModel model{.mesh = ppu::import_mesh(*options.mesh)};
  const ppu::Bounds box = ppu::bounds(model.mesh);
  const double longest = (box.high - box.low).maxCoeff();
  model.cell_size = static_cast<float>(options.cell.value_or(longest / kDefaultCellsAlongModel));
  ppu::fit(model.mesh, static_cast<float>(longest));  // centred, its size unchanged
  // Refused here, in the model's own units, before the scene scales both: the sentence has the user's
  // numbers.
  ppu::voxelize(model.mesh, model.cell_size);
  return model;
}

/// A scene, its simulation and its view.
class Demo3d : public Demo {
 public:
  Demo3d(Scene scene, const SimulationOptions& options, View view)
      : scene_(std::move(scene)), simulation_(scene_, options), kind_(view) {}

  const std::string& scene_name() const override { return scene_.name; }
  int frames() const override { return scene_.frames; }
  DemoCounts counts() const override {
    return {.soft_bodies = simulation_.soft_bodies(),
            .rigid_bodies = simulation_.rigid_bodies(),
            .particles = simulation_.particles(),
            .vertices = simulation_.vertices()};
  }
  FrameTimes step() override { return simulation_.step(); }
  void stop() override { simulation_.stop(); }
  std::uint64_t state_hash() const override { return simulation_.state_hash(); }
  std::vector<ls_sim::SpeStatistics> spe_statistics() const override { return simulation_.spe_statistics(); }
  std::uint64_t late_frames() const override { return simulation_.late_frames(); }
  void make_view(render::Renderer& renderer) override { view_.emplace(scene_, simulation_, renderer, kind_); }
  const render::Image& draw() override { return view_->draw(); }

 private:
  Scene scene_;
  Simulation3d simulation_;
  View kind_;
  std::optional<SceneView> view_;
};

}  // namespace

int run_demo_3d(const Demo3dOptions& options) {
  return run_demo(options, "demo 3d", [&](const SimulationOptions& how) {
    const std::optional<OwnModel> model = load_model(options);
    return std::make_unique<Demo3d>(load_scene_3d(options.scene.value_or(model ? "drop" : "arena"), model),
                                    how, options.lattice ? View::kLattice : View::kMesh);
  });
}

}  // namespace softcell::demos
