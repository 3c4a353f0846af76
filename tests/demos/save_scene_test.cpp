// A saved scene has what there was: parameters, positions and velocities, and it goes on from there.

#include "scene_file/save_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "document/documents.h"
#include "document/write_toml.h"
#include "ppu/gltf_builder.h"
#include "scene/scene_hash.h"
#include "scene_file/own_model.h"
#include "scene_file/picture_cells.h"
#include "scene_file/scene_library.h"
#include "scene_file/state_file.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"
#include "simulation_runs.h"
#include "softcell/render/png_io.h"
#include "support/scratch_folder.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;
namespace fs = std::filesystem;

/// Without what has no effect: alpha beside a frequency, damping beside a damping time.
std::vector<ppu::SoftBodySettings> in_effect(std::vector<ppu::SoftBodySettings> all) {
  for (ppu::SoftBodySettings& settings : all) {
    if (settings.frequency) settings.alpha = 0;
    if (settings.damping_time) settings.damping = 0;
  }
  return all;
}

std::vector<SceneFile> files_of(const Scene& scene, const Simulation3d& simulation, const fs::path& file) {
  return saved_scene(scene, present(simulation), scene.camera, simulation.contacts(), file);
}
std::vector<SceneFile> files_of(const Scene2d& scene, const Simulation2d& simulation, const fs::path& file) {
  return saved_scene(scene, present(simulation), simulation.contacts(), file);
}

template <class SceneOf, class Simulation>
SceneOf saved_and_loaded(const SceneOf& scene, const Simulation& simulation, const fs::path& file) {
  write_scene_files(files_of(scene, simulation, file));
  return std::get<SceneOf>(load_scene(file.string()));
}

template <int Dimension>
void expect_same_moment(const Beginning<Dimension>& a, const Beginning<Dimension>& b) {
  EXPECT_EQ(*a.gravity, *b.gravity);
  EXPECT_EQ(a.tilt, b.tilt);
  EXPECT_EQ(a.time_scale, b.time_scale);
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_NEAR(a.seconds, b.seconds, 1e-6);
  EXPECT_EQ(a.ended_attachments, b.ended_attachments);
  ASSERT_EQ(a.soft_bodies.size(), b.soft_bodies.size());
  for (std::size_t i = 0; i < a.soft_bodies.size(); ++i) {
    EXPECT_EQ(a.soft_bodies[i].positions, b.soft_bodies[i].positions) << i;
    EXPECT_EQ(a.soft_bodies[i].velocities, b.soft_bodies[i].velocities) << i;
    EXPECT_EQ(a.soft_bodies[i].rest, b.soft_bodies[i].rest) << i;
  }
  ASSERT_EQ(a.rigid_bodies.size(), b.rigid_bodies.size());
  for (std::size_t i = 0; i < a.rigid_bodies.size(); ++i) {
    EXPECT_EQ(a.rigid_bodies[i].body, b.rigid_bodies[i].body);
    EXPECT_EQ(a.rigid_bodies[i].position, b.rigid_bodies[i].position);
    EXPECT_EQ(a.rigid_bodies[i].velocity, b.rigid_bodies[i].velocity);
    EXPECT_EQ(a.rigid_bodies[i].angular_velocity, b.rigid_bodies[i].angular_velocity);
    if constexpr (Dimension == 3) {
      EXPECT_LT(a.rigid_bodies[i].rotation.angularDistance(b.rigid_bodies[i].rotation), 2e-3f);
    } else {
      EXPECT_EQ(a.rigid_bodies[i].rotation, b.rigid_bodies[i].rotation);
    }
  }
}

bool same(const Value& a, const Value& b) {
  if (const auto* items = std::get_if<Array>(&a.data)) {
    const auto* others = std::get_if<Array>(&b.data);
    return others != nullptr && std::ranges::equal(*items, *others, same);
  }
  if (const auto* fields = std::get_if<Table>(&a.data)) {
    const auto* others = std::get_if<Table>(&b.data);
    return others != nullptr && fields->size() == others->size() &&
           std::ranges::all_of(*fields, [&](const Field& field) {
             const auto found = std::ranges::find(*others, field.name, &Field::name);
             return found != others->end() && same(field.value, found->value);
           });
  }
  const auto number = [](const Value& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value.data)) return static_cast<double>(*whole);
    const auto* real = std::get_if<double>(&value.data);
    return real != nullptr ? *real : std::numeric_limits<double>::quiet_NaN();
  };
  if (!std::isnan(number(a))) return number(a) == number(b);
  if (const auto* text = std::get_if<std::string>(&a.data))
    return std::holds_alternative<std::string>(b.data) && *text == std::get<std::string>(b.data);
  return std::get<bool>(a.data) == std::get<bool>(b.data);
}

TEST(WriteToml, IsReadAsTheSame) {
  const auto name = std::make_shared<const std::string>("t.toml");
  for (const SceneListing& listing : list_scenes()) {
    const auto scene = load_scene(listing.name);
    std::visit(
        [&](const auto& s) {
          ASSERT_TRUE(s.document) << listing.name;
          EXPECT_TRUE(same(parse_toml(write_toml(s.document->root), name), s.document->root)) << listing.name;
        },
        scene);
  }
  const Value strange = parse_toml(
      "'a b' = [[1, -2], [true, 3.5e-7]]\n\"\" = \"q\\\"b\\\\ \\u0001 \\t \u00e4\"\nc = {d = {}, e = []}\nf "
      "= 1e30\n"
      "[[g]]\n[[g]]\nh = { i = [{j = 1}, 2] }\n[k.l]\n[k.m]\nn = ['x', 'y']\n",
      name);
  EXPECT_TRUE(same(parse_toml(write_toml(strange), name), strange)) << write_toml(strange);
}

TEST(WriteToml, RefusesWhatIsNotUtf8) {
  const Value value{.data = Table{{"title", {.data = std::string("a\xff"), .location = {}}}}, .location = {}};
  EXPECT_THROW(write_toml(value), std::runtime_error);
}

TEST(WriteToml, WritesTheDigitsOfFloats) {
  for (const float number : {0.1f, 1.0f / 3, 9.81f, 1e-45f, -3e38f, 123456.789f})
    EXPECT_EQ(static_cast<float>(std::get<double>(number_value(number).data)), number);
  EXPECT_EQ(std::get<double>(number_value(0.1f).data), 0.1);
}

class SaveScene : public testing::Test {
 protected:
  fs::path file(const std::string& name = "saved.toml") const { return folder_ / name; }
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories(file(name).parent_path());
    std::ofstream(file(name), std::ios::binary) << text;
    return folder_ / name;
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      all.insert(entry.path().filename().string());
    return all;
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

/// Each built-in scene of moderate size: saved after half a second with everything changed that sliders change.
class SaveBuiltIn : public SaveScene, public testing::WithParamInterface<const char*> {};

template <int Dimension, class Simulation, class SceneOf>
void expect_saved_again(const SceneOf& scene, const fs::path& file) {
  Simulation run(scene, {.spes = 2});
  step(run, 30);
  InputEvent<Dimension> gravity{.action = Action::kGravity};
  gravity.value[0] = 1, gravity.value[1] = -7;
  const std::vector<InputEvent<Dimension>> events{
      change<Dimension>(Action::kSubsteps, 3),     change<Dimension>(Action::kFrequency, 3.3f, 0),
      change<Dimension>(Action::kDamping, 0.123f), change<Dimension>(Action::kFriction, 0.77f),
      change<Dimension>(Action::kTimeScale, 0.5f), gravity};
  run.step(events);
  const SceneOf loaded = saved_and_loaded(scene, run, file);
  EXPECT_EQ(loaded.substeps, 3);
  const Simulation again(loaded, {.spes = 2});
  EXPECT_EQ(again.state_hash(), run.state_hash());
  EXPECT_EQ(in_effect(settings_of(again)), in_effect(settings_of(run)));
  EXPECT_EQ(again.gravity(), run.gravity());
  EXPECT_EQ(again.time_scale(), run.time_scale());
  EXPECT_EQ(again.substeps(), run.substeps());
  expect_same_moment<Dimension>(again.moment(), run.moment());
  EXPECT_NE(scene_hash(loaded), scene_hash(scene)) << "a recording of one is none of the other";
}

TEST_P(SaveBuiltIn, HasWhatThereWas) {
  const auto scene = load_scene(GetParam());
  if (const auto* of_3d = std::get_if<Scene>(&scene)) {
    expect_saved_again<3, Simulation3d>(*of_3d, file());
  } else {
    expect_saved_again<2, Simulation2d>(std::get<Scene2d>(scene), file());
  }
}

// In Lua (pile, penguins, cell); with a model, a lattice or a painted body of their own; with attachments; with rigid bodies.
INSTANTIATE_TEST_SUITE_P(Scenes, SaveBuiltIn,
                         testing::Values("arena", "bridge", "bumper_car", "cell", "drop", "kneeling", "knot",
                                         "man", "painted", "penguins", "picture", "pile", "stack",
                                         "two_way"));

TEST_F(SaveScene, KeepsGravityDownwardsInTheWorldAndCopiesBuiltInFiles) {
  const Scene2d scene = load_scene_2d("man");
  Simulation2d run(scene);
  run.step(std::vector{InputEvent<2>{.action = Action::kGravity, .value = {0, -3.5f}}});
  const Scene2d loaded = saved_and_loaded(scene, run, file());
  EXPECT_EQ(loaded.gravity, 3.5f);
  EXPECT_FALSE(loaded.begin->gravity);
  EXPECT_EQ(names(), (std::set<std::string>{"saved.toml", "saved.state", "saved_man.lua"}));
}

TEST_F(SaveScene, IsTheSameWhenItIsSavedAgain) {
  const Scene scene = load_scene_3d("bridge");
  Simulation3d run(scene, {.spes = 2});
  step(run, 40);
  const Scene loaded = saved_and_loaded(scene, run, file());
  const Simulation3d again(loaded, {.spes = 2});
  auto first = files_of(scene, run, file()), second = files_of(loaded, again, file());
  for (auto* files : {&first, &second}) {  // but for the comment, which names the scene
    std::string& text = files->at(0).bytes;
    text = text.substr(text.find('\n'));
  }
  EXPECT_EQ(first.at(0).bytes, second.at(0).bytes);
}

/// Matching starts with rotations that it has to find anew, and contacts with none: the way is nearly the same.
TEST_F(SaveScene, GoesOnAsTheRunDoes) {
  const Scene scene = load_scene_3d("bridge");
  Simulation3d run(scene, {.spes = 2});
  step(run, 60);
  const Scene loaded = saved_and_loaded(scene, run, file());
  Simulation3d again(loaded, {.spes = 2});
  step(run, 20), step(again, 20);  // before the heavy box arrives, behind which nobody foresees anything
  for (std::size_t b = 0; b < run.soft_bodies(); ++b) {
    EXPECT_LT((run.soft_body(b).centre_of_mass() - again.soft_body(b).centre_of_mass()).norm(), 0.003f) << b;
    EXPECT_LT(again.soft_body(b).deformation(), run.soft_body(b).deformation() + 0.02f) << b;
  }
}

TEST_F(SaveScene, KeepsWhatHasBroken) {
  const Scene scene = load_scene_3d("bridge");
  Simulation3d run(scene, {.spes = 2});
  step(run, 220);  // the heavy box lies on the floor
  const Beginning<3> broken = run.moment();
  ASSERT_FALSE(broken.ended_attachments.empty());
  ASSERT_LT(broken.ended_attachments.size(), scene.attachments.size());
  const Scene loaded = saved_and_loaded(scene, run, file());
  Simulation3d again(loaded, {.spes = 2});
  EXPECT_EQ(again.moment().ended_attachments, broken.ended_attachments);
  step(run, 20), step(again, 20);
  for (std::size_t b = 0; b < run.soft_bodies(); ++b)
    EXPECT_LT((run.soft_body(b).centre_of_mass() - again.soft_body(b).centre_of_mass()).norm(), 0.05f) << b;
}

/// A car's dents are in its rest shape, and stay.
TEST_F(SaveScene, KeepsWhatIsBentForGood) {
  const Scene scene = load_scene_3d("car_crash");
  Simulation3d run(scene, {.spes = 2});
  step(run, 120);
  const Beginning<3> moment = run.moment();
  ASSERT_TRUE(std::ranges::any_of(moment.soft_bodies, [](const auto& body) { return !body.rest.empty(); }));
  ASSERT_TRUE(std::ranges::any_of(moment.soft_bodies, [](const auto& body) { return body.rest.empty(); }));
  const Scene loaded = saved_and_loaded(scene, run, file());
  Simulation3d again(loaded, {.spes = 2});
  const Beginning<3> read = again.moment();
  for (std::size_t b = 0; b < moment.soft_bodies.size(); ++b) {
    ASSERT_EQ(read.soft_bodies[b].rest.size(), moment.soft_bodies[b].rest.size());
    for (std::size_t i = 0; i < moment.soft_bodies[b].rest.size(); ++i)
      EXPECT_LT((read.soft_bodies[b].rest[i] - moment.soft_bodies[b].rest[i]).norm(), 1e-5f);
    EXPECT_NEAR(again.soft_body(b).deformation(), run.soft_body(b).deformation(), 1e-3f);
  }
  step(run, 20), step(again, 20);
  for (std::size_t b = 0; b < run.soft_bodies(); ++b)
    EXPECT_LT((run.soft_body(b).centre_of_mass() - again.soft_body(b).centre_of_mass()).norm(), 0.02f) << b;
}

/// Plasticity that a slider has given, changed or taken away, also where the body's material has it.
TEST_F(SaveScene, KeepsWhetherBodiesArePlastic) {
  const std::string text =
      "[framework]\n[materials.tin]\ncell_size = 0.25\nfrequency = 4\nfriction = 0.3\ndamping = 0.2\n"
      "plasticity = { yield = 0.05, limit = 0.5 }\n"
      "[[soft_body]]\nmaterial = \"tin\"\nalpha = 0.4\nshape = { kind = \"sphere\" }\nposition = [0, 1, 0]\n"
      "[[soft_body]]\nmaterial = \"tin\"\nshape = { kind = \"sphere\" }\nposition = [2, 1, 0]\n"
      "[[soft_body]]\ncell_size = 0.25\nshape = { kind = \"sphere\" }\nposition = [-2, 1, 0]\n";
  const Scene scene = load_scene_3d(write("tin.toml", text));
  Simulation3d run(scene, {.spes = 2});
  const std::vector<InputEvent<3>> events{change<3>(Action::kYield, 0, 0), change<3>(Action::kCreep, 25, 1),
                                          change<3>(Action::kYield, 0.2f, 2)};
  run.step(events);
  const Scene loaded = saved_and_loaded(scene, run, file());
  ASSERT_EQ(loaded.soft_bodies.size(), 3u);
  for (std::size_t b = 0; b < 3; ++b)
    EXPECT_EQ(loaded.soft_bodies[b].settings, run.soft_body(b).settings()) << b;
  EXPECT_FALSE(loaded.soft_bodies[0].settings.plasticity);
  EXPECT_EQ(loaded.soft_bodies[0].settings.alpha, 0.4f);
  EXPECT_EQ(loaded.soft_bodies[1].settings.plasticity,
            (ppu::Plasticity{.yield = 0.05f, .creep = 25, .limit = 0.5f}));
  EXPECT_EQ(loaded.soft_bodies[2].settings.plasticity, (ppu::Plasticity{.yield = 0.2f}));
}

/// The claw is where its motion has it at that time, and holds what it held.
TEST_F(SaveScene, KeepsRigidBodiesThatTheSceneMoves) {
  const Scene scene = load_scene_3d("claw");
  Simulation3d run(scene, {.spes = 2});
  step(run, kSlowBuild ? 100 : 300);
  const Scene loaded = saved_and_loaded(scene, run, file());
  Simulation3d again(loaded, {.spes = 2});
  Shown3d then, now;
  run.show(then), again.show(now);
  step(run, 2), step(again, 2);
  run.show(then), again.show(now);
  ASSERT_EQ(then.box_poses.size(), now.box_poses.size());
  for (std::size_t i = 0; i < then.box_poses.size(); ++i)
    EXPECT_LT((then.box_poses[i] - now.box_poses[i]).lpNorm<Eigen::Infinity>(), 1e-3f) << i;
  step(run, 20), step(again, 20);
  for (std::size_t b = 0; b < run.soft_bodies(); ++b)
    EXPECT_LT((run.soft_body(b).centre_of_mass() - again.soft_body(b).centre_of_mass()).norm(), 0.02f) << b;
}

TEST_F(SaveScene, KeepsAttachmentsOfTwoDimensions) {
  const Scene2d scene = load_scene_2d("rings");
  Simulation2d run(scene);
  step(run, 60);
  const Scene2d loaded = saved_and_loaded(scene, run, file());
  ASSERT_EQ(loaded.attachments.size(), scene.attachments.size());
  Simulation2d again(loaded);
  expect_same_moment(again.moment(), run.moment());
  step(run, 20), step(again, 20);
  for (std::size_t b = 0; b < run.soft_bodies(); ++b)
    EXPECT_LT((run.soft_body(b).centre_of_mass() - again.soft_body(b).centre_of_mass()).norm(), 0.02f) << b;
}

/// A body that lies upside down stays as it lies: its regions find their rotations from the identity.
TEST_F(SaveScene, KeepsBodiesThatAreTurned) {
  const Scene scene =
      load_scene_3d(write("t.toml",
                          "world = { gravity = 0 }\n[[soft_body]]\ncell_size = 0.2\nalpha = 0.9\n"
                          "shape = { kind = \"torus\" }\n"));
  Simulation3d run(scene, {.spes = 2});
  Beginning<3> moment = run.moment();
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(3.1f, Vector3f(1, 2, -1).normalized()).toRotationMatrix();
  for (Vector3f& x : moment.soft_bodies[0].positions) x = turn * x;
  write_scene_files(saved_scene(scene, {moment, settings_of(run), 2}, scene.camera, run.contacts(), file()));
  const Scene loaded = load_scene_3d(file().string());
  Simulation3d again(loaded, {.spes = 2});
  EXPECT_LT(again.soft_body(0).deformation(), 1e-3f);
  step(again, 20);
  EXPECT_LT(again.soft_body(0).deformation(), 2e-3f);
  for (std::size_t i = 0; i < moment.soft_bodies[0].positions.size(); ++i)
    ASSERT_LT((again.soft_body(0).position(i) - moment.soft_bodies[0].positions[i]).norm(), 5e-3f) << i;
}

template <int Dimension, class Simulation, class SceneOf>
void expect_reset(const SceneOf& scene, const fs::path& file) {
  Simulation run(scene, {.spes = 2});
  step(run, 30);
  run.step(
      std::vector{change<Dimension>(Action::kFriction, 0.9f), change<Dimension>(Action::kTimeScale, 0.7f)});
  const SceneOf loaded = saved_and_loaded(scene, run, file);
  Simulation again(loaded, {.spes = 2});
  const std::uint64_t begin = again.state_hash();
  step(again, 20);
  EXPECT_NE(again.state_hash(), begin);
  again.step(std::vector{change<Dimension>(Action::kPause, 0), change<Dimension>(Action::kReset, 0)});
  EXPECT_EQ(again.state_hash(), begin) << "a reset of a saved scene goes back to what was saved";
  EXPECT_FLOAT_EQ(again.time_scale(), 0.7f);
  again.step(std::vector{change<Dimension>(Action::kHome, 0)});
  EXPECT_LT(again.soft_body(0).deformation(), 1e-4f);
}

TEST_F(SaveScene, IsWhereAResetGoesBackTo) {
  expect_reset<3, Simulation3d>(load_scene_3d("bridge"), file("a.toml"));
  expect_reset<2, Simulation2d>(load_scene_2d("man"), file("b.toml"));
}

TEST_F(SaveScene, GoesOnWithScriptAndTilting) {
  const std::string name =
      write("s.toml",
            "tilt = { amplitude_x = 0.3, period_x = 2 }\n[[soft_body]]\nname = \"a\"\ncell_size = 0.5\n"
            "shape = { kind = \"box\" }\nposition = [0, 5, 0]\n"
            "[[impulse]]\ntime = 0.25\nbody = \"a\"\nvelocity = [1, 0, 0]\n"
            "[[impulse]]\ntime = 1\nbody = \"a\"\nvelocity = [0, 0, 2]\n");
  const Scene scene = load_scene_3d(name);
  Simulation3d run(scene, {.spes = 1});
  step(run, 30);
  const Scene loaded = saved_and_loaded(scene, run, file());
  Simulation3d again(loaded, {.spes = 1});
  step(run, 40), step(again, 40);
  const Vector3f of_run = run.soft_body(0).linear_momentum(), of_again = again.soft_body(0).linear_momentum();
  EXPECT_LT((of_run - of_again).norm(), 1e-3f * of_run.norm())
      << of_run.transpose() << " and " << of_again.transpose();
}

std::optional<OwnModel> own(const std::string& model, bool z_up, int cells,
                            std::optional<float> tessellation = {}, std::optional<double> unit = {}) {
  return load_own_model(
      {.mesh = model, .z_up = z_up, .unit = unit, .cells = cells, .cell = {}, .tessellation = tessellation});
}

TEST_F(SaveScene, HasTheModelOfTheCommandLine) {
  ppu::GltfBuilder builder;
  builder.add_floats({0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4}, "VEC3", 3);
  builder.add<std::uint8_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", 5121, 1);
  const std::string model = write(
      "models/m.glb",
      builder.glb(
          R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"));
  for (const bool z_up : {false, true}) {
    const Scene scene =
        load_scene_3d("drop", own(model, z_up, 7, z_up ? std::optional<float>(1.5f) : std::nullopt,
                                  z_up ? std::optional<double>(0.25) : std::nullopt));
    EXPECT_EQ(scene.soft_bodies[0].mesh.triangles.size() > 4, z_up);
    const ppu::Bounds<3> box = ppu::bounds(scene.soft_bodies[0].mesh);
    if (z_up) {  // four units long, of a quarter of a metre
      EXPECT_FLOAT_EQ((box.high - box.low).maxCoeff(), 1);
    }
    Simulation3d run(scene, {.spes = 2});
    step(run, 20);
    const Scene loaded = saved_and_loaded(scene, run, file());
    EXPECT_EQ(loaded.soft_bodies[0].settings, scene.soft_bodies[0].settings);
    ASSERT_EQ(loaded.soft_bodies[0].mesh.triangles, scene.soft_bodies[0].mesh.triangles);
    for (std::size_t i = 0; i < scene.soft_bodies[0].mesh.positions.size(); ++i)
      EXPECT_LT((loaded.soft_bodies[0].mesh.positions[i] - scene.soft_bodies[0].mesh.positions[i]).norm(),
                1e-5f);
    expect_same_moment<3>(Simulation3d(loaded, {.spes = 2}).moment(), run.moment());
  }
  const Scene scene = load_scene_3d("drop", own(model, false, 8));
  const Simulation3d run(scene, {.spes = 1});
  fs::create_directories(file("elsewhere"));
  const std::string sentence = refusal([&] { files_of(scene, run, file("elsewhere/s.toml")); });
  EXPECT_NE(sentence.find("names files below its own folder only"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("m.glb"), std::string::npos) << sentence;
}

TEST_F(SaveScene, HasThePictureOfTheCommandLine) {
  render::Image image(64, 48);
  for (int y = 8; y < 40; ++y)
    for (int x = 4; x < 60; ++x)
      if ((x - 32) * (x - 32) + (y - 24) * (y - 24) < 400)
        std::fill_n(image.pixel(x, y), 4, std::uint8_t{255});
  const std::string picture = folder_ / "p.png";
  render::write_png(picture, image);
  for (const int cells : {7, 13, 20, 24}) {
    const Scene2d scene =
        load_scene_2d("picture", OwnPicture{.image = load_picture(picture), .cells = cells, .file = picture});
    Simulation2d run(scene);
    step(run, 20);
    const Scene2d loaded = saved_and_loaded(scene, run, file());
    EXPECT_EQ(loaded.soft_bodies[0].cells, scene.soft_bodies[0].cells) << cells;
    EXPECT_EQ(loaded.soft_bodies[0].settings, scene.soft_bodies[0].settings) << cells;
    EXPECT_EQ(Simulation2d(loaded).state_hash(), run.state_hash()) << cells;
  }
}

TEST_F(SaveScene, RefusesWhatIsTooFarAwayAndLeavesNothing) {
  const Scene scene = load_scene_3d("drop");
  const Simulation3d run(scene, {.spes = 1});
  Beginning<3> moment = run.moment();
  moment.soft_bodies[0].positions[3].x() = 20000;
  const std::string sentence = refusal([&] {
    write_scene_files(
        saved_scene(scene, {moment, settings_of(run), 2}, scene.camera, run.contacts(), file()));
  });
  EXPECT_NE(sentence.find("soft body 1 cannot be saved: it has the value 20000 m"), std::string::npos)
      << sentence;
  EXPECT_TRUE(names().empty());
  EXPECT_NE(refusal([&] { write_scene_files(files_of(scene, run, file("missing/s.toml"))); }), "(accepted)");
  EXPECT_TRUE(names().empty());
}

TEST_F(SaveScene, RefusesASceneOfAProgram) {
  Scene scene = load_scene_3d("drop");
  scene.document.reset();
  const Simulation3d run(scene, {.spes = 1});
  EXPECT_EQ(refusal([&] { files_of(scene, run, file()); }),
            "the scene drop cannot be saved: a program has made it");
}

TEST_F(SaveScene, IsRefusedWithAnotherState) {
  const Scene scene = load_scene_3d("drop");
  const Simulation3d run(scene, {.spes = 1});
  write_scene_files(files_of(scene, run, file()));
  const auto changed = [&](const std::string& state) {
    write("saved.state", state);
    return refusal([&] { load_scene(file().string()); });
  };
  Beginning<3> other = run.moment();
  other.soft_bodies[0].positions.pop_back(), other.soft_bodies[0].velocities.pop_back();
  EXPECT_NE(changed(state_to_text(other)).find("particles of soft body"), std::string::npos)
      << changed(state_to_text(other));
  other.soft_bodies.clear();
  EXPECT_NE(changed(state_to_text(other)).find("has 0 soft bodies, and the scene has"), std::string::npos);
  EXPECT_NE(changed("softcell state 1\n").find("line 2"), std::string::npos) << changed("softcell state 1\n");
  Beginning<3> more = run.moment();
  more.rigid_bodies.push_back({.body = 0, .rotation = Eigen::Quaternionf::Identity()});
  write("saved.state", state_to_text(more));
  EXPECT_EQ(refusal([&] {
              const Scene loaded = load_scene_3d(file().string());
              const Simulation3d never(loaded, {.spes = 1});
            }),
            "the scene saved has 0 rigid bodies that move, and its saved state has 1");
  fs::remove(file("saved.state"));
  EXPECT_NE(refusal([&] { load_scene(file().string()); }).find("saved.state"), std::string::npos);
}

/// Whatever particles are, nothing becomes NaN by it.
TEST_F(SaveScene, BeginsWithAnyState) {
  const Scene scene = load_scene_3d(write(
      "t.toml",
      "[framework]\n[[soft_body]]\ncell_size = 0.25\nshape = { kind = \"sphere\" }\nposition = [0, 1, 0]\n"));
  const Simulation3d run(scene, {.spes = 2});
  const std::vector<Vector3f> rest = run.moment().soft_bodies[0].positions;
  for (int kind = 0; kind < 4; ++kind) {
    Beginning<3> moment = run.moment();
    for (std::size_t i = 0; i < rest.size(); ++i) {
      Vector3f& x = moment.soft_bodies[0].positions[i];
      if (kind == 0) x = {0, 1, 0};   // in a point
      if (kind == 1) x.z() = 0;       // in a plane
      if (kind == 2) x.x() = -x.x();  // inside out
      if (kind == 3) x = 1000 * Vector3f::Unit(static_cast<int>(i % 3)) * (i % 2 == 0 ? 1 : -1);  // far apart
    }
    write_scene_files(
        saved_scene(scene, {moment, settings_of(run), 2}, scene.camera, run.contacts(), file()));
    const Scene loaded = load_scene_3d(file().string());
    Simulation3d again(loaded, {.spes = 2});
    step(again, 20);
    for (const Vector3f& x : again.soft_body(0).positions()) ASSERT_TRUE(x.allFinite()) << kind;
  }
}

TEST(StateFile, ReadsBackWhatItWrote) {
  Beginning<3> moment;
  moment.soft_bodies = {{{{1, 2, 3}, {0.1f, -1e-45f, 1e4f}}, {{0, 0, 0}, {-1e5f, 0.3f, 7}}, {}},
                        {},
                        {{{1, 2, 3}}, {{0, 0, 0}}, {{4, 5, 0.1f}}}};
  moment.rigid_bodies = {{.body = 7,
                          .position = {1, 2, 3},
                          .rotation = Eigen::Quaternionf(0.6f, 0, -0.8f, 0),
                          .velocity = {4, 5, 6},
                          .angular_velocity = {7, 8, 9}}};
  moment.ended_attachments = {0, 5};
  const std::string text = state_to_text(moment);
  const Beginning<3> read = parse_state<3>(text);
  moment.gravity = Vector3f::Zero();
  Beginning<3> with_gravity = read;
  with_gravity.gravity = Vector3f::Zero();
  expect_same_moment(with_gravity, moment);
  EXPECT_EQ(state_to_text(read), text);
  EXPECT_THROW(parse_state<2>(text), std::runtime_error);
}

TEST(StateFile, RefusesWithTheLine) {
  const auto refused = [](const std::string& lines) -> std::string {
    try {
      parse_state<2>(lines + fmt::format("end {:016x}\n", state_checksum(lines)));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "(accepted)";
  };
  const std::string head = "softcell state 1\ndimension 2\n";
  EXPECT_EQ(refused(head), "(accepted)");
  EXPECT_EQ(refused(head + "soft_body 1\n1 2 3 4\nrigid_body 3 1 2 3 4 5 6\n"), "(accepted)");
  const std::string pin = "pin 0 1 2 0.5 0\n";
  std::string pins;
  for (std::size_t i = 0; i < kMostPins; ++i) pins += pin;
  EXPECT_EQ(refused(head + "soft_body 1\n1 2 3 4\n" + pins), "(accepted)");
  EXPECT_EQ(refused(head + "soft_body 1\n1 2 3 4\n" + pins + pin), "line 105: more than 100 pins");
  struct Case {
    std::string lines, expected;
  };
  for (const auto& [lines, expected] : std::vector<Case>{
           {"softcell state 2\n", "line 1: no saved state"},
           {"softcell state 1\ndimension 3\n", "line 2: expected 'dimension 2'"},
           {head + "soft_body 2\n1 2 3 4\n",
            "line 5: a particle's position is 'end'; it must be a number from -10000"},
           {head + "soft_body 1\n1 2 3\n",
            "line 4: a particle's velocity is ''; it must be a number from -100000"},
           {head + "soft_body 1\n1 2 3 4 5\n", "line 4: '5' was not expected here"},
           {head + "soft_body 1\n1 2 nan 4\n", "line 4: a particle's velocity is 'nan'; it must be a number"},
           {head + "soft_body 1\n20000 2 3 4\n",
            "line 4: a particle's position is '20000'; it must be a number from -10000 to 10000"},
           {head + "soft_body -1\n",
            "line 3: the number of particles is '-1'; it must be a whole number from 0 to 300000"},
           {head + "soft_body 4000000000\n",
            "line 3: the number of particles is '4000000000'; it must be a whole"},
           {head + "rigid_body 3 1 2 3 4 5 6\nrigid_body 3 1 2 3 4 5 6\n",
            "line 4: rigid bodies must be in ascending"},
           {head + "rest_shape\n1 2\n", "line 3: a rest shape must follow"},
           {head + "soft_body 1\n1 2 3 4\nrest_shape\n1 2\nrest_shape\n1 2\n",
            "line 7: a rest shape must follow"},
           {head + "soft_body 1\n1 2 3 4\nrest_shape\n1\n",
            "line 6: a position at rest is ''; it must be a number"},
           {head + "soft_body 1\n1 2 3 4\nrest_shape\n1 2 3\n", "line 6: '3' was not expected here"},
           {head + "ended_attachment 3\nended_attachment 2\n", "line 4: attachments must be in ascending"},
           {head + "pin 0 0 0 1 0\n", "line 3: a pin of soft body 0; there are 0"},
           {head + "soft_body 2\n1 2 3 4\n1 2 3 4\npin 0 0 0 0 1\n",
            "line 6: a pin's radius is 0; it must be above 0"},
           {head + "soft_body 2\n1 2 3 4\n1 2 3 4\npin 0 0 0 1\n", "line 6: a pin needs particles"},
           {head + "soft_body 2\n1 2 3 4\n1 2 3 4\npin 0 0 0 1 2\n",
            "line 6: a pin of particle 2; the soft body has 2"},
           {head + "soft_body 2\n1 2 3 4\n1 2 3 4\npin 0 0 0 1 1 0\n",
            "line 6: the particles of a pin must be in asc"},
           {head + "else\n", "line 3: expected soft_body, rest_shape, rigid_body"}}) {
    EXPECT_EQ(refused(lines).rfind(expected, 0), 0u) << refused(lines) << "\n" << expected;
  }
  const auto plain = [](const std::string& text) -> std::string {
    try {
      parse_state<2>(text);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "(accepted)";
  };
  EXPECT_EQ(plain(head), "line 3: the file ends here; expected 'end' and the checksum");
  EXPECT_EQ(plain(head + "end 0123456789abcdef\n"),
            "line 3: the checksum is wrong: the file was changed, or a part of it is missing");
}

TEST_F(SaveScene, FindsAFreeNameBesideTheScene) {
  const Scene scene = load_scene_3d(write("a/mine.toml", "[framework]\n"));
  EXPECT_EQ(fs::path(free_scene_file(scene.document.get(), scene.name)).filename(), "mine_1.toml");
  write("a/mine_1.toml", "");
  EXPECT_EQ(free_scene_file(scene.document.get(), scene.name),
            fs::weakly_canonical(file("a")) / "mine_2.toml");
  EXPECT_EQ(free_scene_file(nullptr, "x").parent_path(), "");
}

}  // namespace
}  // namespace softcell::demos
