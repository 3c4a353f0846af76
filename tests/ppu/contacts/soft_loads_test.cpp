// Soft bodies that carry each other: what is stretched and pressed returns to its shape within a substep, which ends deep in the other body
// unless contacts hold it.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "../soft_body_2d_scenes.h"
#include "contact_world.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// On the thread that steps the world, and on the SPEs.
class SoftLoads : public testing::TestWithParam<bool> {
 protected:
  SoftLoads() : spes_(GetParam() ? std::make_unique<SpeRuntime>() : nullptr) {}
  SolverFactory* solvers() { return spes_.get(); }

 private:
  std::unique_ptr<SpeRuntime> spes_;
};

INSTANTIATE_TEST_SUITE_P(Solver, SoftLoads, testing::Bool(),
                         [](const auto& spes) { return std::string(spes.param ? "Spes" : "Ppu"); });

/// Each ring passes through the one before; the first is held.
TEST_P(SoftLoads, RingsOfAChainStayLinked) {
  constexpr float kMajor = 0.4f, kMinor = 0.1f, kSize = 0.1f;
  ContactWorld w({0, -9.81f, 0}, solvers());
  SoftBodySettings settings = settings_of(kSize, 1);
  settings.half_width = 3;
  std::vector<SoftBody<3>*> rings;
  for (int i = 0; i < 3; ++i) {
    TriangleMesh mesh = make_torus(kMajor, kMinor, 36, 14);
    Eigen::Quaternionf turn(Eigen::AngleAxisf(0.5f * 3.14159265f, Vector3f::UnitX()));
    if (i % 2 != 0)
      turn = Eigen::Quaternionf(Eigen::AngleAxisf(0.5f * 3.14159265f, Vector3f::UnitY())) * turn;
    for (Vector3f& p : mesh.positions) p = turn * p;
    for (Vector3f& n : mesh.normals) n = turn * n;
    rings.push_back(
        &w.add(mesh, settings, {0, -(2 * kMajor - 2 * kMinor - 0.02f) * static_cast<float>(i), 0}));
  }
  w.bodies.attach(*rings[0], Patch<3>::of_surface({0, kMajor, 0}, 2 * kSize));
  w.run(100);
  for (std::size_t i = 1; i < rings.size(); ++i)
    EXPECT_LT(rings[i - 1]->centre_of_mass().y() - rings[i]->centre_of_mass().y(), 3 * kMajor)
        << "ring " << i;
}

/// A beam of one layer of cells, held at both ends, and a block that falls on it.
struct Load {
  float alpha;
  Eigen::Vector2i cells;
  float height;  ///< metres
};

TEST_P(SoftLoads, ABeamOfOneLayerCarriesBlocks) {
  constexpr float kSize = 0.1f;
  for (const Load& load : {Load{0.1f, {3, 8}, 0.1f}, Load{0.1f, {6, 3}, 1.5f}, Load{0.3f, {3, 8}, 1.5f}}) {
    const auto w = solvers() != nullptr
                       ? std::make_unique<World2d>(9.81f, ContactMethod::kSurface, *solvers())
                       : std::make_unique<World2d>(9.81f, ContactMethod::kSurface);
    const SoftBodySettings settings{.cell_size = kSize, .alpha = load.alpha, .damping = 0.1f};
    SoftBody<2>& beam = w->soft.add(rectangle_model({16, 1}, settings), {0, -0.5f * kSize});
    for (const float x : {-0.8f, 0.8f}) w->soft.attach(beam, Patch<2>::of_surface({x, 0}, 3 * kSize));
    SoftBody<2>& block =
        w->soft.add(rectangle_model(load.cells, settings), {0.05f, 1.7f * kSize + load.height});
    w->run(3);
    EXPECT_GT(block.centre_of_mass().y(), -1.5f) << "alpha " << load.alpha << ", " << load.cells.x() << " x "
                                                 << load.cells.y() << " cells from " << load.height;
  }
}

}  // namespace
}  // namespace softcell::ppu
