// What the views in three dimensions show beside meshes, and what lies under the mouse.

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "input/camera_control.h"
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

render::Camera a_camera() { return {.eye = {1, 3, 4}, .target = {0, 1, 0}, .tan_half_fov_y = 0.4f}; }

TEST(MovedCamera, IsTheScenesOwnUntilTheUserMovesIt) {
  const render::Camera camera = a_camera(), same = moved_by(camera, {});
  EXPECT_EQ(same.eye, camera.eye);
  EXPECT_EQ(same.target, camera.target);
}

TEST(MovedCamera, GoesAboutItsTargetAndNeverOverTheTop) {
  const render::Camera camera = a_camera();
  for (const float turn : {0.4f, -2.0f, 3.1f}) {
    Look look;
    look.turn = turn;
    const Vector3f expected = Eigen::AngleAxisf(turn, Vector3f::UnitY()) * (camera.eye - camera.target);
    EXPECT_LT((moved_by(camera, look).eye - camera.target - expected).norm(), 1e-5f);
  }
  const float distance = (camera.eye - camera.target).norm();
  for (const float rise : {-1.5f, -0.3f, 0.2f, 1.5f}) {
    for (const bool looks_around : {false, true}) {
      Look look;
      look.rise = rise;
      look.distance = 2;
      look.looks_around = looks_around;
      const Vector3f from_target = moved_by(camera, look).eye - camera.target;
      EXPECT_NEAR(from_target.norm(), 2 * distance, 1e-4f);
      EXPECT_GT(from_target.dot(Vector3f(1, 0, 4)), 0) << "on the same side";
      const float angle = std::asin(from_target.normalized().y());
      const float whole = std::asin(2 / distance) + rise;
      EXPECT_NEAR(angle, std::clamp(whole, looks_around ? -1.5f : 0.03f, 1.5f), 1e-3f);
    }
  }
}

SDL_Event drag(Uint32 buttons, int x, int y) {
  SDL_Event event{};
  event.motion.type = SDL_MOUSEMOTION;
  event.motion.state = buttons;
  event.motion.xrel = x;
  event.motion.yrel = y;
  return event;
}

TEST(CameraControl, TheMiddleButtonDragsThePictureWithTheMouse) {
  constexpr int kWidth = 640, kHeight = 360;
  const render::Camera camera = a_camera();
  CameraControl control(camera, kHeight);
  Look look;
  look.turn = 0.7f;
  look.distance = 1.4f;
  const Vector3f seen = moved_by(camera, look).target;  // in the middle
  EXPECT_TRUE(control.handle(drag(SDL_BUTTON_MMASK, 100, -40), look));
  const Ray ray = ray_through(moved_by(camera, look), kWidth / 2 + 100, kHeight / 2 - 40, kWidth, kHeight);
  EXPECT_LT((seen - ray.from).cross(ray.along).norm(), 1e-3f) << "what was under the mouse still is";
}

TEST(CameraControl, TheRightButtonLooksAroundAndFlies) {
  const render::Camera camera = a_camera();
  CameraControl control(camera, 360);
  Look look;
  SDL_Event button{};
  button.button.type = SDL_MOUSEBUTTONDOWN;
  button.button.button = SDL_BUTTON_RIGHT;
  SDL_Event key{};
  key.key.type = SDL_KEYDOWN;
  key.key.keysym.sym = SDLK_w;
  EXPECT_FALSE(control.handle(key, look)) << "without the button a key has another use";
  control.handle(button, look);
  control.handle(drag(SDL_BUTTON_RMASK, 200, -300), look);
  const render::Camera turned = moved_by(camera, look);
  EXPECT_LT((turned.eye - camera.eye).norm(), 1e-4f) << "the eye stays";
  EXPECT_GT((turned.target - camera.target).norm(), 1);
  EXPECT_GT(turned.target.y(), turned.eye.y()) << "it looks upwards";
  EXPECT_TRUE(control.handle(key, look));
  for (int frame = 0; frame < 60; ++frame) control.next_frame(look);
  const Vector3f way = moved_by(camera, look).eye - turned.eye;
  EXPECT_GT(way.norm(), 0.5f);
  EXPECT_GT(way.normalized().dot((turned.target - turned.eye).normalized()), 0.999f) << "forwards";
  button.button.type = SDL_MOUSEBUTTONUP;
  control.handle(button, look);
  const Vector3f there = look.moved;
  control.next_frame(look);
  EXPECT_EQ(look.moved, there) << "it has landed";
}

TEST(KeptOutside, TheEyeGoesBackUntilItIsInNoBody) {
  render::Camera camera{.eye = {0, 1, 2}, .target = {0, 0, 0}, .near_plane = 0.1f};
  const std::vector<SolidBox> far{{.bounds = {{5, 0, 0}, {6, 1, 1}}}};
  EXPECT_EQ(kept_outside(camera, far).eye, camera.eye);
  const std::vector<SolidBox> around{{.bounds = {{-1, -1, -1}, {1, 2, 3}}},
                                     {.bounds = {{-1, 0, 2.5f}, {1, 4, 5}}}};
  const render::Camera outside = kept_outside(camera, around);
  for (const auto& [body, pose] : around)
    EXPECT_TRUE((outside.eye.array() < body.low.array()).any() ||
                (outside.eye.array() > body.high.array()).any());
  EXPECT_LT((outside.eye - outside.target).cross(camera.eye - camera.target).norm(), 1e-4f)
      << "the same view";
}

TEST(KeptOutside, ABoxMayBeTurned) {
  // Thin, and turned by 45 degrees about y: the eye is in the box around it, and not in it, until it goes nearer.
  SolidBox plate{.bounds = {{-2, -1, -0.1f}, {2, 1, 0.1f}}};
  plate.pose.topLeftCorner<3, 3>() =
      Eigen::AngleAxisf(0.25f * 3.14159265f, Vector3f::UnitY()).toRotationMatrix();
  plate.pose.topRightCorner<3, 1>() = Vector3f(0, 0, 1);
  render::Camera camera{.eye = {0, 0, 2}, .target = {0, 0, -5}, .near_plane = 0.01f};
  EXPECT_EQ(kept_outside(camera, std::vector{plate}).eye, camera.eye);
  camera.eye.z() = 1.05f;
  EXPECT_NEAR(kept_outside(camera, std::vector{plate}).eye.z(), 1 + 0.12f * std::sqrt(2.0f), 1e-4f);
}

TEST(KeptOutside, RigidBodiesAreBodiesToo) {
  Scene scene = load_scene_3d("rollers");
  Simulation3d simulation(scene, {.spes = 1});
  for (int frame = 0; frame < 30; ++frame) simulation.step();
  std::vector<SolidBox> boxes;
  append_rigid(scene, simulation.shown_box_poses(), boxes);
  const Eigen::Matrix4f& pose = simulation.shown_box_poses()[scene.boxes.size()];
  const Vector3f middle = pose.topRightCorner<3, 1>();  // of a body
  const render::Camera inside{.eye = middle, .target = middle - Vector3f(0, 0.2f, 1), .near_plane = 0.05f};
  EXPECT_GT((kept_outside(inside, boxes).eye - middle).norm(), 0.1f);
}

// Whoever opens a window sees what pictures show.
TEST(KeptOutside, TheCamerasOfTheScenesAreOutsideOfRigidBodies) {
  for (const SceneListing& listing : list_scenes()) {
    if (listing.dimension != 3) continue;
    const Scene scene = load_scene_3d(listing.name);
    std::vector<SolidBox> boxes;
    std::vector<Eigen::Matrix4f> poses;
    const auto add = [&](const Vector3f& position, const Eigen::Matrix3f& rotation) {
      Eigen::Matrix4f& pose = poses.emplace_back(Eigen::Matrix4f::Identity());
      pose.topLeftCorner<3, 3>() = rotation;
      pose.topRightCorner<3, 1>() = position;
    };
    for (const RigidBox& box : scene.boxes) add(box.position, box.rotation.toRotationMatrix());
    for (const RigidBody& body : scene.rigid_bodies) add(body.position, body.rotation.toRotationMatrix());
    append_rigid(scene, poses, boxes);
    EXPECT_EQ(kept_outside(scene.camera, boxes).eye, scene.camera.eye) << listing.name;
  }
}

TEST(FramedBodies, AreInThePictureFromTheBeginningToTheGround) {
  constexpr float kAspect = 16.0f / 9;
  for (const ppu::TriangleMesh& mesh :
       {ppu::make_penguin(30), ppu::make_torus(0.02f, 0.005f, 24, 12), ppu::make_car(2)}) {
    const ppu::Bounds<3> box = ppu::bounds(mesh);
    const Scene scene =
        load_scene_3d("drop", OwnModel{.mesh = mesh, .cell_size = (box.high - box.low).maxCoeff() / 8});
    Simulation3d simulation(scene, {.spes = 2});
    float widest = 0;
    for (int frame = 0; frame < 60; ++frame) {
      for (const Vector3f& particle : simulation.soft_body(0).positions()) {
        const Eigen::Vector4f clip = view_projection(scene.camera, kAspect) * particle.homogeneous();
        ASSERT_GT(clip.w(), 0);
        const float y = std::abs(clip.y() / clip.w()), x = std::abs(clip.x() / clip.w());
        ASSERT_LT(std::max(x, y), 1) << "frame " << frame;
        widest = std::max({widest, y, x * kAspect});
      }
      simulation.step();
    }
    EXPECT_GT(widest, 0.5f) << "and it is not far away";
  }
}

TEST(FramedBodies, AreOfScenesWithoutACamera) {
  const std::string body =
      "[[soft_body]]\nshape = { kind = \"sphere\" }\ncell_size = 0.3\nposition = [40, 7, -3]\n";
  const Scene framed = std::get<Scene>(parse_scene(body, "s.toml"));
  EXPECT_LT((framed.camera.target - Vector3f(40, 7, -3)).norm(), 0.5f);
  const Scene given = std::get<Scene>(parse_scene("[camera]\neye = [0, 0, 9]\n" + body, "s.toml"));
  EXPECT_EQ(given.camera.eye, Vector3f(0, 0, 9));
  EXPECT_EQ(given.camera.target, Vector3f(0, 0, 0));
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
  rotations.set_bodies({model->plan()});
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
  float impulse = 0;
  for (const ppu::Contact& contact : contacts) {
    impulse += contact.impulse;
    EXPECT_EQ(std::minmax(contact.first.object, contact.second.object),
              (std::minmax<const btCollisionObject*>(&world.rigid_body(0), &world.rigid_body(1))));
    EXPECT_NEAR(std::abs(contact.normal.y()), 1, 1e-3f);
    EXPECT_NEAR(contact.position.y(), 0, 0.1f);
    EXPECT_LT(std::max(std::abs(contact.position.x()), std::abs(contact.position.z())), 0.6f);
  }
  EXPECT_NEAR(impulse, 5 * 9.81f / 60, 0.05f) << "they carry the box";
}

TEST(Contacts, OfASoftBodyAtRestCarryItAndNameWhatItLiesOn) {
  for (const ppu::ContactMethod method : {ppu::ContactMethod::kSurface, ppu::ContactMethod::kSpheres}) {
    const Scene scene = load_scene_3d("drop");
    Simulation3d run(scene, {.contacts = method, .spes = 2});
    run.record_contacts(true);
    float impulse = 0, weight = 0;
    constexpr int kFrames = 400, kCounted = 60;
    for (int frame = 0; frame < kFrames; ++frame) {
      run.step();
      run.finish();
      if (frame < kFrames - kCounted) continue;
      for (const ppu::Contact& contact : run.shown_contacts()) {
        impulse += contact.impulse * contact.normal.y() * (contact.first.soft != nullptr ? 1.0f : -1.0f);
        const std::set<std::string> names{run.name_of(contact.first), run.name_of(contact.second)};
        ASSERT_EQ(names, (std::set<std::string>{scene.soft_bodies[0].name, "box 1"}));
        ASSERT_GT(contact.impulse, 0);
      }
    }
    for (const float mass : run.model(0).masses()) weight += 9.81f * mass;
    const float per_substep = weight / 60 / static_cast<float>(scene.substeps);
    EXPECT_NEAR(impulse / kCounted / per_substep, 1, 0.1f) << "method " << static_cast<int>(method);
  }
}

TEST(RoomForABody, IsWhereNothingIs) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {.spes = 1});
  const auto cube = [](const Eigen::Vector3f& middle, float side) {
    const Eigen::Vector3f half = Eigen::Vector3f::Constant(side / 2);
    return ppu::Bounds<3>{middle - half, middle + half};
  };
  const ppu::Bounds<3> body = run.soft_body(0).bounds();
  const Eigen::Vector3f middle = 0.5f * (body.low + body.high);
  EXPECT_FALSE(run.is_free(cube(middle, 0.3f)));
  EXPECT_FALSE(run.is_free(cube({middle.x(), 0, middle.z()}, 0.3f))) << "in the floor";
  EXPECT_FALSE(run.is_free(cube({middle.x(), body.high.y() + 0.1f, middle.z()}, 0.3f)))
      << "partly in the body";
  EXPECT_TRUE(run.is_free(cube({middle.x(), body.high.y() + 1, middle.z()}, 0.5f)));
}

}  // namespace
}  // namespace softcell::demos
