// What a user adds to a scene that runs, takes away, or makes heavier: all else goes on from where it was, and the changed scene can be
// saved.

#include "scene_file/change_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "ppu/gltf_builder.h"
#include "scene_file/scene_library.h"
#include "simulation/picked.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"
#include "simulation_runs.h"
#include "softcell/render/png_io.h"
#include "support/scratch_folder.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
namespace fs = std::filesystem;

template <class Simulation>
std::vector<std::remove_cvref_t<decltype(std::declval<Simulation>().soft_body(0).position(0))>> positions(
    const Simulation& simulation, std::size_t body) {
  const auto all = simulation.soft_body(body).positions();
  return {all.begin(), all.end()};
}

class ChangeScene : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string picture(bool transparent = false) const {
    render::Image image(40, 40);
    for (int y = 5; y < 35; ++y)
      for (int x = 5; x < 35; ++x)
        if (!transparent) std::fill_n(image.pixel(x, y), 4, std::uint8_t{255});
    render::write_png(folder_ / "cat.png", image);
    return folder_ / "cat.png";
  }
  std::string model() const {
    ppu::GltfBuilder file;
    file.add_floats({0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4}, "VEC3", 3);
    file.add<std::uint8_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", 5121, 1);
    return write(
        "m.glb",
        file.glb(
            R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"));
  }
  template <class Do>
  static std::string refusal(const Do& act) {
    try {
      act();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "(accepted)";
  }

  tests::ScratchFolder folder_;
};

TEST_F(ChangeScene, AddsAModelWhereItIsAskedFor) {
  const Scene scene = load_scene_3d("bridge");
  Simulation3d run(scene, {.spes = 2});
  step(run, 30);
  Scene more = scene_now(scene, present(run));
  const NewBody<3> body{.middle = {0.2f, 3, -0.4f}, .longest_side = 0.8f};
  add_file(more, model(), body);
  add_file(more, model(), {.middle = {0.2f, 5, -0.4f}, .longest_side = 0.4f});
  ASSERT_EQ(more.soft_bodies.size(), scene.soft_bodies.size() + 2);
  EXPECT_EQ(more.soft_bodies[scene.soft_bodies.size()].name, "m");
  EXPECT_EQ(more.soft_bodies.back().name, "m 2");
  Simulation3d again(more, {.spes = 2});
  for (std::size_t b = 0; b < scene.soft_bodies.size(); ++b)
    EXPECT_EQ(positions(again, b), positions(run, b)) << b;
  const std::size_t added = scene.soft_bodies.size();
  const ppu::Bounds<3> box = ppu::bounds(more.soft_bodies[added].mesh);
  EXPECT_NEAR((box.high - box.low).maxCoeff(), 0.8f, 1e-5f);
  EXPECT_LT((more.soft_bodies[added].position + 0.5f * (box.low + box.high) - body.middle).norm(), 1e-5f);
  EXPECT_FLOAT_EQ(more.soft_bodies[added].settings.cell_size, 0.1f) << "eight cells along, as with --mesh";
  const float before = again.soft_body(added).centre_of_mass().y();
  step(again, 15);
  EXPECT_LT(again.soft_body(added).centre_of_mass().y(), before - 0.1f) << "it falls";
}

TEST_F(ChangeScene, AddsAPictureWhereItIsAskedFor) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d run(scene);
  step(run, 20);
  Scene2d more = scene_now(scene, present(run));
  add_file(more, picture(), {.middle = {1.5f, 1}, .longest_side = 0.75f});
  Simulation2d again(more);
  EXPECT_EQ(positions(again, 0), positions(run, 0));
  ASSERT_EQ(again.soft_bodies(), 2u);
  EXPECT_LT((again.soft_body(1).centre_of_mass() - Vector2f(1.5f, 1)).norm(), 1e-4f);
  EXPECT_EQ(more.soft_bodies[1].cells.size(), 400u) << "20 cells along, as with --image";
  ASSERT_TRUE(more.soft_bodies[1].picture);
}

TEST_F(ChangeScene, RefusesWhatIsNoModelAndChangesNothing) {
  const Scene scene = load_scene_3d("drop");
  const Simulation3d run(scene, {.spes = 1});
  Scene now = scene_now(scene, present(run));
  const std::shared_ptr<const SceneDocument> document = now.document;
  EXPECT_NE(refusal([&] { add_file(now, folder_ / "none.glb", {}); }).find("there is no mesh file"),
            std::string::npos);
  std::filesystem::create_directory(folder_ / "models");
  EXPECT_NE(
      refusal([&] { add_file(now, folder_ / "models", {}); }).find("is a folder; expected is a mesh file"),
      std::string::npos);
  EXPECT_NE(refusal([&] { add_file(now, write("bad.ply", "ply\nrubbish"), {}); }), "(accepted)");
  EXPECT_NE(refusal([&] { add_file(now, picture(), {}); }), "(accepted)") << "a picture is no model";
  EXPECT_EQ(now.soft_bodies.size(), scene.soft_bodies.size());
  EXPECT_EQ(now.document, document);
  const Scene2d scene_2d = load_scene_2d("man");
  const Simulation2d run_2d(scene_2d);
  Scene2d now_2d = scene_now(scene_2d, present(run_2d));
  EXPECT_NE(refusal([&] { add_file(now_2d, model(), {}); }), "(accepted)");
  EXPECT_NE(refusal([&] { add_file(now_2d, picture(true), {}); }).find("transparent"), std::string::npos);
  EXPECT_EQ(now_2d.soft_bodies.size(), scene_2d.soft_bodies.size());
}

TEST_F(ChangeScene, AddsEachShapeThatThereIs) {
  for (const std::string_view shape : spawned_shapes(3)) {
    const Scene scene = load_scene_3d(write("empty.toml", "[framework]\n"));
    const Simulation3d run(scene, {.spes = 1});
    Scene more = scene_now(scene, present(run));
    add_shape(more, shape, {.middle = {0, 1.5f, 0}, .longest_side = 1.2f, .alpha = 0.3f});
    const ppu::Bounds<3> box = ppu::bounds(more.soft_bodies.at(0).mesh);
    EXPECT_NEAR((box.high - box.low).maxCoeff(), 1.2f, 0.02f) << shape;
    EXPECT_EQ(more.soft_bodies[0].settings.alpha, 0.3f);
    Simulation3d again(more, {.spes = 1});
    step(again, 30);
    EXPECT_LT(again.soft_body(0).centre_of_mass().y(), 1.5f) << shape;
  }
  for (const std::string_view shape : spawned_shapes(2)) {
    const Scene2d scene = load_scene_2d("man");
    const Simulation2d run(scene);
    Scene2d more = scene_now(scene, present(run));
    add_shape(more, shape, {.middle = {-2, 1}, .longest_side = 1, .alpha = 0.3f});
    const ppu::Bounds<2> box = Simulation2d(more).soft_body(1).bounds();
    EXPECT_NEAR((box.high - box.low).maxCoeff(), 1, 1e-5f) << shape;
    EXPECT_LT((0.5f * (box.high + box.low) - Vector2f(-2, 1)).norm(), 1e-5f) << shape;
  }
}

TEST_F(ChangeScene, RemovesABodyWithWhatIsAttachedToIt) {
  const Scene scene = load_scene_3d("bridge");
  Simulation3d run(scene, {.spes = 2});
  step(run, 140);
  const InputEvent<3> hold{
      .action = Action::kHold, .hand = kUsersHand, .body = 2, .value = positions(run, 2)[0]};
  run.step(std::vector<InputEvent<3>>{
      hold, {.action = Action::kPin, .hand = kUsersHand}, {.action = Action::kRelease, .hand = kUsersHand}});
  const Beginning<3> broken = run.moment();
  ASSERT_EQ(broken.pins.size(), 1u);
  EXPECT_EQ(broken.pins[0].body, 2u);
  ASSERT_FALSE(broken.ended_attachments.empty());
  constexpr std::size_t kSecond = 1;
  Scene less = scene_now(scene, present(run));
  remove_body(less, kSecond);
  ASSERT_EQ(less.soft_bodies.size(), scene.soft_bodies.size() - 1);
  std::size_t kept = 0, kept_broken = 0;
  for (std::uint32_t i = 0; i < scene.attachments.size(); ++i) {
    const AttachmentPlacement<3>& attachment = scene.attachments[i];
    if (attachment.body == kSecond || attachment.other == kSecond) continue;
    const AttachmentPlacement<3>& same = less.attachments.at(kept++);
    EXPECT_EQ(less.soft_bodies[same.body].name, scene.soft_bodies[attachment.body].name);
    ASSERT_EQ(same.other.has_value(), attachment.other.has_value());
    if (attachment.other) {
      EXPECT_EQ(less.soft_bodies[*same.other].name, scene.soft_bodies[*attachment.other].name);
    }
    kept_broken += std::ranges::count(broken.ended_attachments, i);
  }
  EXPECT_EQ(kept, less.attachments.size());
  EXPECT_LT(kept, scene.attachments.size());
  EXPECT_EQ(less.begin->ended_attachments.size(), kept_broken);
  ASSERT_EQ(less.begin->pins.size(), 1u);
  EXPECT_EQ(less.begin->pins[0].body, 1u);
  EXPECT_EQ(less.begin->pins[0].particles, broken.pins[0].particles);
  Simulation3d again(less, {.spes = 2});
  EXPECT_EQ(positions(again, 0), positions(run, 0));
  EXPECT_EQ(positions(again, 1), positions(run, 2));
  step(again, 10);
  EXPECT_EQ(again.moment().pins.size(), 1u);
  remove_body(less, 1);
  EXPECT_TRUE(less.begin->pins.empty());
}

TEST_F(ChangeScene, RemovesWhatTheScriptDoesToABody) {
  const Scene scene = load_scene_3d(
      write("s.toml",
            "[[soft_body]]\ncell_size = 0.5\nshape = { kind = \"box\" }\n[[soft_body]]\ncell_size = 0.5\n"
            "shape = { kind = \"box\" }\nposition = [3, 0, 0]\n"
            "[[impulse]]\ntime = 9\nbody = \"body 1\"\nvelocity = [1, 0, 0]\n"
            "[[impulse]]\ntime = 1\nbody = \"body 2\"\nvelocity = [0, 0, 2]\n"
            "[[drag]]\nbegin = 1\nend = 2\nbody = \"body 1\"\nfrom = [0, 0, 0]\nto = [1, 1, 1]\n"
            "[[cut]]\ntime = 1\nbody = \"body 1\"\npoint = [0, 0, 0]\nnormal = [1, 0, 0]\n"
            "[[cut]]\ntime = 8\nbody = \"body 2\"\npoint = [3, 0, 0]\nnormal = [1, 0, 0]\n"));
  const Simulation3d run(scene, {.spes = 1});
  Scene less = scene_now(scene, present(run));
  remove_body(less, 0);
  ASSERT_EQ(less.script.impulses.size(), 1u);
  EXPECT_EQ(less.script.impulses[0].body, 0u);
  EXPECT_TRUE(less.script.drags.empty());
  ASSERT_EQ(less.cuts.size(), 1u);
  EXPECT_EQ(less.cuts[0].body, 0u);
  EXPECT_EQ(less.soft_bodies[0].name, "body 2");
  const Simulation3d again(less, {.spes = 1});
  write_scene_files(saved_scene(less, present(again), less.camera, again.contacts(), folder_ / "saved.toml"));
  const Scene loaded = load_scene_3d(folder_ / "saved.toml");
  EXPECT_EQ(loaded.soft_bodies.at(0).name, "body 2");
  EXPECT_EQ(loaded.script.impulses.size(), 1u);
  EXPECT_EQ(loaded.cuts.size(), 1u);
}

TEST_F(ChangeScene, CanBeSaved) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d run(scene, {.spes = 2});
  step(run, 10);
  Scene changed = scene_now(scene, present(run));
  add_file(changed, model(), {.middle = {0, 4, 0}, .longest_side = 0.6f});
  add_shape(changed, "torus", {.middle = {0, 6, 0}, .longest_side = 0.6f});
  set_density(changed, 0, 321);
  Simulation3d again(changed, {.spes = 2});
  step(again, 10);
  write_scene_files(
      saved_scene(changed, present(again), changed.camera, again.contacts(), folder_ / "saved.toml"));
  const Scene loaded = load_scene_3d(folder_ / "saved.toml");
  const Simulation3d third(loaded, {.spes = 2});
  EXPECT_EQ(third.state_hash(), again.state_hash());
  EXPECT_EQ(loaded.soft_bodies[0].settings.density, 321);
  EXPECT_NE(refusal([&] {
              saved_scene(changed, present(again), changed.camera, again.contacts(),
                          "/usr/elsewhere/saved.toml");
            }).find("m.glb"),
            std::string::npos)
      << "the model is not below that folder";
}

TEST_F(ChangeScene, MakesBodiesHeavier) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d run(scene);
  step(run, 10);
  Scene2d heavy = scene_now(scene, present(run));
  set_density(heavy, 0, 2 * scene.soft_bodies[0].settings.density);
  const Simulation2d again(heavy);
  EXPECT_NEAR(again.soft_body(0).model().mass(), 2 * run.soft_body(0).model().mass(), 1e-3f);
  EXPECT_EQ(positions(again, 0), positions(run, 0));
}

TEST_F(ChangeScene, IsTheSameOnAnyNumberOfSpes) {
  const Scene scene = load_scene_3d("drop");
  std::vector<std::uint64_t> hashes;
  for (const int spes : {1, 3, 6}) {
    Simulation3d run(scene, {.spes = spes});
    step(run, 20);
    Scene more = scene_now(scene, present(run));
    add_shape(more, "sphere", {.middle = {0, 3, 0}, .longest_side = 0.7f});
    Simulation3d again(more, {.spes = spes});
    step(again, 20);
    hashes.push_back(again.state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

/// Particle (1, 1, 1) of 4 x 4 x 4 with half-width 1: it and its 26 neighbours.
TEST_F(ChangeScene, PicksAParticleWithItsRegion) {
  const Scene scene = load_scene_3d(write(
      "s.toml",
      "[[soft_body]]\ncell_size = 0.5\nhalf_width = 1\nshape = { kind = \"box\", size = [1.4, 1.4, 1.4] }\n"
      "position = [0, 2, 0]\n"));
  Simulation3d run(scene, {.spes = 1});
  const ppu::SoftBody<3>& body = run.soft_body(0);
  ASSERT_EQ(body.positions().size(), 64u);
  step(run, 30);
  const PickedParticle picked = picked_particle(body, 0, 21);
  EXPECT_EQ(picked.region, 27u);
  EXPECT_EQ(picked.position, body.position(21));
  EXPECT_EQ(picked.velocity, body.velocities()[21]);
  EXPECT_EQ(picked.mass, body.model().masses()[21]);
  EXPECT_GT(picked.region_mass, 20 * picked.mass * 0.3f);
  EXPECT_LT((picked.region_velocity - Vector3f(0, -9.81f / 2, 0)).norm(), 0.1f)
      << "it falls for half a second";
  EXPECT_EQ(picked_particle(body, 0, 0).region, 8u) << "a corner";
}

}  // namespace
}  // namespace softcell::demos
