// Plates thinner than what one substep presses a body into them: its points go back by the side on which the body is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "contact_world.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kOfThrown = 0.1f;

/// A box of the world, and how deep points of its faces are in what is drawn of a body.
struct Plate {
  btRigidBody* body;
  Vector3f half;

  float depth_in(const tests::DrawnBody& drawn) const {
    constexpr float kApart = 0.07f;
    const Eigen::Vector3i last = (2 / kApart * half).array().ceil().cast<int>().max(1);
    float deepest = 0;
    for (int i = 0; i <= last.x(); ++i)
      for (int j = 0; j <= last.y(); ++j)
        for (int k = 0; k <= last.z(); ++k) {
          const Vector3f share = Eigen::Array3f(float(i), float(j), float(k)) / last.cast<float>().array();
          const Vector3f own = (2 * share.array() - 1) * half.array();
          const Vector3f point = to_eigen(body->getWorldTransform() * to_bullet(own));
          if (drawn.box().contains(point)) deepest = std::max(deepest, drawn.depth(point));
        }
    return deepest;
  }
};

/// Plates as convex shapes, or as the triangles of their faces.
class Plates {
 public:
  explicit Plates(bool of_triangles) : of_triangles_(of_triangles) {}

  /// @pre the world is gone before this
  Plate add(ContactWorld& w, const Vector3f& half, const Vector3f& position) {
    return {&w.add(shape(half), 0, position, 0.6f), half};
  }

 private:
  std::unique_ptr<btCollisionShape> shape(const Vector3f& half) {
    constexpr float kEdge = 0.3f;
    if (!of_triangles_) return std::make_unique<btBoxShape>(to_bullet(half));
    const TriangleMesh box = make_box(2 * half, kEdge);
    meshes_.push_back(std::make_unique<btTriangleMesh>());
    for (const auto& [i, j, k] : box.triangles)
      meshes_.back()->addTriangle(to_bullet(box.positions[i]), to_bullet(box.positions[j]),
                                  to_bullet(box.positions[k]));
    return std::make_unique<btBvhTriangleMeshShape>(meshes_.back().get(), true);
  }

  bool of_triangles_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
};

class ThinThings : public testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(As, ThinThings, testing::Values(false, true),
                         [](const auto& kind) { return kind.param ? "Triangles" : "ConvexShapes"; });

/// Throws boxes and balls into the corners of a room that is 1.8 m wide.
/// @param beyond  metres: so far do walls reach beyond the corners  @param most  metres: how deep they are in what is drawn in the end
void throw_in_room(bool of_triangles, float thickness, float beyond, float alpha, float most) {
  constexpr float kInner = 0.9f;
  const std::vector<Vector3f> directions{{1, -0.9f, 1}, {1, 0.3f, 0.2f}, {-0.5f, -1, 0.9f}, {0.7f, 0.8f, -1}};
  for (const TriangleMesh& mesh : {make_box({0.5f, 0.6f, 0.4f}, 0.05f), make_sphere(0.3f, 10)}) {
    const auto model = make_soft_body_model(mesh, settings_of(kOfThrown, alpha));
    for (const Vector3f& direction : directions) {
      Plates plates(of_triangles);
      ContactWorld w;
      std::vector<Plate> walls;
      for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
          Vector3f half = Vector3f::Constant(kInner + beyond), at = Vector3f::Zero();
          half[axis] = thickness / 2, at[axis] = side * (kInner + thickness / 2);
          walls.push_back(plates.add(w, half, at));
        }
      }
      SoftBody<3>& body = w.bodies.add(model, Vector3f(0, 0, 0));
      body.add_velocity(20 * direction.normalized());
      w.run(60);
      const tests::DrawnBody drawn(body);
      for (const Plate& wall : walls)
        EXPECT_LT(wall.depth_in(drawn), most) << "alpha " << alpha << ", walls of " << thickness
                                              << " m, thrown along " << direction.transpose();
    }
  }
}

/// What had been pressed past the middle of a plate was pushed out on its far side, and hung there.
TEST_P(ThinThings, NothingHangsInTheCornerOfARoomWithThinWalls) {
  for (const float alpha : {0.15f, 0.5f, 0.85f})
    for (const float thickness : {0.03f, 0.1f})
      throw_in_room(GetParam(), thickness, thickness, alpha, 0.1f * kOfThrown);
}

/// What was pressed in near the end of a wall was pushed out there.
TEST_P(ThinThings, NothingHangsBetweenWallsThatTouchAtTheirEdges) {
  for (const float thickness : {0.03f, 0.1f})
    throw_in_room(GetParam(), thickness, 0, 0.85f, 0.15f * kOfThrown);
}

/// The bar acts as a flipper does: it ends up in the body's way, in one step farther than it is thick.
TEST_P(ThinThings, ABodyFliesOffTheBarThatHitsIt) {
  for (const float alpha : {0.2f, 0.5f, 0.8f}) {
    for (const float turn : {5.0f, 8.0f, 15.0f}) {  // rad/s
      Plates plates(GetParam());
      ContactWorld w;
      const Vector3f half(0.6f, 0.06f, 0.3f), hinge(-0.6f, 0.3f, 0);
      const Plate bar = plates.add(w, half, {0, 0.3f, 0});
      bar.body->setCollisionFlags(bar.body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      bar.body->setActivationState(DISABLE_DEACTIVATION);
      SoftBody<3>& body = w.add(make_sphere(0.3f, 10), settings_of(kOfThrown, alpha), {0.25f, 0.75f, 0});
      for (int frame = 0; frame < 150; ++frame) {
        const float angle = std::clamp(turn * float(frame - 60) / 60, 0.0f, 1.2f);
        btTransform pose(btQuaternion(btVector3(0, 0, 1), angle), to_bullet(hinge));
        pose.setOrigin(pose * btVector3(half.x(), 0, 0));
        bar.body->setWorldTransform(pose);
        w.world.updateSingleAabb(bar.body);
        w.world.stepSimulation(1.0f / 60, 2, 1.0f / 120);
      }
      EXPECT_LT(bar.depth_in(tests::DrawnBody(body)), 0.1f * kOfThrown)
          << "alpha " << alpha << ", " << turn << " rad/s";
    }
  }
}

}  // namespace
}  // namespace softcell::ppu
