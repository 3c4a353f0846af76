// What the views in three dimensions show beside meshes, and what lies under the mouse.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>
#include <vector>

#include "scene/scene_camera.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/soft_bodies/shapes.h"
#include "view/rotation_axes.h"
#include "view/scene_view.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

TEST(RayThrough, PassesThroughWhatThePixelShows) {
  const render::Camera camera{.eye = {3, 4, 5}, .target = {0.5f, 1, -1}, .tan_half_fov_y = 0.4f};
  constexpr int kWidth = 640, kHeight = 360;
  for (const auto& [x, y] : {std::pair(0, 0), {320, 180}, {639, 20}, {100, 300}}) {
    const Ray ray = ray_through(camera, x, y, kWidth, kHeight);
    EXPECT_NEAR(ray.along.norm(), 1, 1e-6f);
    const Vector3f point = ray.from + 4 * ray.along;
    const Eigen::Vector4f clip = view_projection(camera, float{kWidth} / kHeight) * point.homogeneous();
    EXPECT_NEAR(0.5f * kWidth * (1 + clip.x() / clip.w()), static_cast<float>(x), 0.01f);
    EXPECT_NEAR(0.5f * kHeight * (1 - clip.y() / clip.w()), static_cast<float>(y), 0.01f);
  }
}

TEST(SeenFrom, TheGroundTiltsForAnObserverWhoStands) {
  const Scene scene = load_scene_3d("drop");
  const Eigen::Matrix3f tilt = Eigen::AngleAxisf(0.3f, Vector3f::UnitX()).toRotationMatrix();
  const render::Camera straight = seen_from(scene, {}, Eigen::Matrix3f::Identity());
  const render::Camera tilted = seen_from(scene, {}, tilt);
  EXPECT_LT((straight.eye - scene.camera.eye).norm(), 1e-6f);
  EXPECT_LT((tilt * tilted.eye - scene.camera.eye).norm(), 1e-5f);
  EXPECT_LT((tilt * tilted.up - scene.camera.up).norm(), 1e-6f);
}

TEST(RotationAxes, AreThoseOfTheBodyThatWasTurned) {
  const auto model = ppu::make_soft_body_model(ppu::make_box({1, 0.6f, 0.4f}, 1), {.cell_size = 0.2f});
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.7f, Vector3f(1, 2, -1).normalized()).toRotationMatrix();
  std::vector<Shown3d::Body> bodies(1);
  for (std::size_t i = 0; i < model->particles(); ++i) {
    const Vector3f x = turn * model->lattice().rest_position(i) + Vector3f(3, 1, 2);
    bodies[0].particles.push_back({x.x(), x.y(), x.z(), 0});
  }
  RotationAxes rotations;
  rotations.add_body(model->plan());
  for (int again = 0; again < 2; ++again) {  // the second time instead of the first, not after it
    rotations.update(bodies);
    for (int axis = 0; axis < 3; ++axis) {
      const Lines& lines = rotations.axes()[static_cast<std::size_t>(axis)];
      ASSERT_EQ(lines.links.size(), model->particles());
      for (const auto& [from, to] : lines.links) {
        const Vector3f drawn = lines.ends[to] - lines.ends[from];
        EXPECT_LT((drawn - 0.45f * 0.2f * turn.col(axis)).norm(), 1e-4f);
      }
    }
  }
}

TEST(ShownContacts, AreNotedWhenAskedFor) {
  const Scene scene = load_scene_3d("torus_on_spike");
  Simulation3d simulation(scene, {});
  for (int frame = 0; frame < 120; ++frame) simulation.step();
  EXPECT_TRUE(simulation.shown_contacts().empty());
  simulation.record_contacts(true);
  simulation.step();
  simulation.finish();
  ASSERT_FALSE(simulation.shown_contacts().empty());
  Shown3d shown;
  simulation.show(shown);
  EXPECT_EQ(shown.contacts.size(), simulation.shown_contacts().size());
  const float spacing = simulation.model(0).lattice().spacing;
  for (const ppu::Contact& contact : shown.contacts) {
    EXPECT_NEAR(contact.normal.norm(), 1, 1e-4f);
    float nearest = 1e9f;  // somebody's particle is there
    for (const auto& body : shown.bodies) {
      for (const Eigen::Vector4f& p : body.particles)
        nearest = std::min(nearest, (p.head<3>() - contact.position).norm());
    }
    EXPECT_LT(nearest, spacing);
  }

  simulation.record_contacts(false);
  simulation.step();
  simulation.finish();
  EXPECT_TRUE(simulation.shown_contacts().empty());
  // In a pause they are those of the world as it stands.
  simulation.record_contacts(true);
  simulation.step(std::vector<InputEvent<3>>{{.action = Action::kPause}});
  EXPECT_FALSE(simulation.shown_contacts().empty());
  // Of what a body touches where it is put then, nobody knows before time goes on.
  simulation.step(std::vector<InputEvent<3>>{{.action = Action::kHome, .body = kEveryBody}});
  EXPECT_TRUE(simulation.shown_contacts().empty());
  simulation.step();
  EXPECT_TRUE(simulation.shown_contacts().empty());
  simulation.step(std::vector<InputEvent<3>>{{.action = Action::kResume}});
  for (int frame = 0; frame < 120; ++frame) simulation.step();
  EXPECT_FALSE(simulation.shown_contacts().empty());
}

TEST(Contacts, OfABoxOnTheFloorPointUpwards) {
  ppu::BulletWorld world;
  world.add_box({10, 1, 10}, 0, {0, -0.5f, 0}, 0.6f);
  world.add_box({1, 1, 1}, 5, {0, 3, 0}, 0.6f);
  std::vector<ppu::Contact> contacts;
  world.step(1.0f / 60, 1);
  world.contacts(contacts);
  EXPECT_TRUE(contacts.empty()) << "it falls";
  for (int frame = 0; frame < 120; ++frame) world.step(1.0f / 60, 1);
  world.contacts(contacts);
  ASSERT_GE(contacts.size(), 3u);
  for (const ppu::Contact& contact : contacts) {
    EXPECT_NEAR(std::abs(contact.normal.y()), 1, 1e-3f);
    EXPECT_NEAR(contact.position.y(), 0, 0.1f);
    EXPECT_LT(std::max(std::abs(contact.position.x()), std::abs(contact.position.z())), 0.6f);
  }
}

}  // namespace
}  // namespace softcell::demos
