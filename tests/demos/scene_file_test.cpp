// Scene files: what they become, and how bad ones are refused.

#include "scene_file/scene_library.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "demo/scene_pictures.h"
#include "document/documents.h"
#include "document/value.h"
#include "softcell/base/nearest_name.h"
#include "softcell/soft_bodies/tessellate.h"
#include "support/scratch_folder.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

/// The processor time of this process and of those that ran its scripts: what others do on the machine says nothing of a test.
double processor_seconds() {
  double seconds = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return seconds;
}

/// A folder with scene files, and what loading them says.
class SceneFile : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// The sentence with which the scene is refused, without the folder's name; "" when it is not refused.
  std::string refusal(const std::string& name, const std::string& text) {
    const std::string file = write(name, text);
    const double begin = processor_seconds();
    std::string sentence;
    try {
      load_scene(file);
    } catch (const std::runtime_error& error) {
      sentence = error.what();
    }
    EXPECT_LT(processor_seconds() - begin, kSlowBuild ? 10 : 2) << sentence;
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    const std::string prefix = folder_.path().string() + "/";
    return sentence.starts_with(prefix) ? sentence.substr(prefix.size()) : sentence;
  }

  tests::ScratchFolder folder_;
};

#define EXPECT_BEGINS(sentence, expected)                                    \
  do {                                                                       \
    const std::string said = sentence;                                       \
    EXPECT_TRUE(said.starts_with(expected)) << "it says: \"" << said << '"'; \
  } while (false)

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(SceneFile, BodiesOfBothDimensionsMaySleep) {
  const std::string body2 =
      "[[soft_body]]\nshape = { kind = \"rectangle\", width = 4, height = 2 }\ncell_size = 0.2\n";
  const std::string body3 = "[[soft_body]]\nshape = { kind = \"sphere\" }\ncell_size = 0.2\n";
  for (const bool sleep : {false, true}) {
    const std::string world = sleep ? "[world]\nsleep = true\n" : "";
    EXPECT_EQ(std::get<Scene2d>(load_scene(write("s.toml", "dimension = 2\n" + world + body2))).sleep, sleep);
    EXPECT_EQ(std::get<Scene>(load_scene(write("t.toml", world + body3))).sleep, sleep);
  }
}

TEST_F(SceneFile, AMeshOfLongTrianglesIsTessellatedOnRequest) {
  const auto mesh_of = [&](const std::string& more) {
    return load_scene_3d(write("s.toml",
                               "[[soft_body]]\ncell_size = 0.2\n"
                               "shape = { kind = \"box\", size = [2, 0.4, 0.4], step = 10 }\n" +
                                   more))
        .soft_bodies.at(0)
        .mesh;
  };
  const ppu::TriangleMesh coarse = mesh_of(""), finer = mesh_of("tessellate = 1.5\n");
  EXPECT_EQ(coarse.triangles.size(), 12u);
  EXPECT_EQ(finer, ppu::tessellate(coarse, 1.5f * 0.2f));
  EXPECT_GT(finer.triangles.size(), 100u);
  EXPECT_BEGINS(
      refusal("s.toml", "[[soft_body]]\ncell_size = 0.2\ntessellate = 0\nshape = { kind = \"box\" }\n"),
      "s.toml:3:");
  const std::string too_many =
      refusal("s.toml", "[[soft_body]]\ncell_size = 0.004\ntessellate = 0.125\nshape = { kind = \"box\" }\n");
  EXPECT_BEGINS(too_many, "s.toml:1:");
  EXPECT_NE(too_many.find("more than 2000000 triangles"), std::string::npos) << too_many;
}

TEST_F(SceneFile, EveryFieldOfA3dSceneArrives) {
  write("meshes/t.obj", kTetrahedron);
  const Scene scene = load_scene_3d(write("s.toml", R"(
title = "a title"
pictures = [30, 2]
[world]
gravity = 3.5
friction = 0.25
restitution = 0.75
substeps = 3
contacts = "surface"
frames = 40
[framework]
half_width = 2
height = 1
thickness = 0.5
front_opacity = 0.5
[materials.jelly]
cell_size = 0.25
half_width = 1
density = 100
frequency = 4
damping_time = 0.5
friction = 0.1
restitution = 0.5
self_contacts = false
plasticity = { yield = 0.25, limit = 2 }
fracture = { stretch = 0.5, least_cells = 4 }
[[box]]
size = [1, 2, 3]
mass = 4
position = [5, 6, 7]
opacity = 0.75
pattern = "tiles"
colour = "#FFFFFF"
[[obstacle]]
shape = { kind = "cone", radius = 0.25, height = 2, segments = 5 }
position = [1, 1, 1]
[[soft_body]]
name = "tetra"
mesh = "meshes/t.obj"
longest_side = 2
material = "jelly"
density = 50
above = 1.5
position = [3, 0, 4]
[[impulse]]
time = 0.5
body = "tetra"
velocity = [1, 2, 3]
[[drag]]
body = "tetra"
begin = 1
end = 2
from = [1, 0, 0]
to = [0, 1, 0]
[[gravity]]
time = 2
value = -5
[camera]
eye = [1, 2, 3]
target = [4, 5, 7]
up = [1, 0, 0]
tan_half_fov_y = 0.5
near = 0.25
far = 50
[light]
toward = [0, 1, 0]
shadow_centre = [1, 0, 1]
shadow_radius = 6
[tilt]
amplitude_x = 0.1
period_z = 3
begin = 2
)"));
  EXPECT_EQ(scene.name, "s");
  EXPECT_EQ(scene.title, "a title");
  EXPECT_EQ(scene.pictures, (std::vector<int>{2, 30}));
  EXPECT_EQ(scene.gravity, 3.5f);
  EXPECT_EQ(scene.friction, 0.25f);
  EXPECT_EQ(scene.restitution, 0.75f);
  EXPECT_EQ(scene.substeps, 3);
  EXPECT_EQ(scene.contacts, ppu::ContactMethod::kSurface);
  EXPECT_EQ(scene.frames, 40);
  ASSERT_EQ(scene.boxes.size(), 6u);  // floor, four walls, the box
  EXPECT_EQ(scene.boxes[0].size, Eigen::Vector3f(5, 1, 5));
  EXPECT_EQ(scene.boxes[4].opacity, 0.5f);
  const RigidBox& box = scene.boxes[5];
  EXPECT_EQ(box.size, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(box.mass, 4);
  EXPECT_EQ(box.position, Eigen::Vector3f(5, 6, 7));
  EXPECT_EQ(box.opacity, 0.75f);
  EXPECT_EQ(box.pattern, render::Pattern::kTiles);
  EXPECT_EQ(box.colour, render::srgb(0xFFFFFF));
  ASSERT_EQ(scene.obstacles.size(), 1u);
  EXPECT_EQ(ppu::bounds(scene.obstacles[0].mesh).high.y(), 1);
  ASSERT_EQ(scene.soft_bodies.size(), 1u);
  const SoftBodyPlacement& body = scene.soft_bodies[0];
  EXPECT_EQ(body.settings.cell_size, 0.25f);
  EXPECT_EQ(body.settings.half_width, 1);
  EXPECT_EQ(body.settings.density, 50);
  EXPECT_EQ(body.settings.frequency, 4.0f);
  EXPECT_EQ(body.settings.damping_time, 0.5f);
  EXPECT_EQ(body.settings.friction, 0.1f);
  EXPECT_EQ(body.settings.restitution, 0.5f);
  EXPECT_FALSE(body.settings.self_contacts);
  EXPECT_EQ(body.settings.plasticity, (ppu::Plasticity{.yield = 0.25f, .creep = 10, .limit = 2}));
  EXPECT_EQ(body.settings.fracture, (ppu::Fracture{.stretch = 0.5f, .turn = {}, .least_cells = 4}));
  EXPECT_EQ(body.position, Eigen::Vector3f(3, 2.5f, 4));
  ASSERT_EQ(scene.script.impulses.size(), 1u);
  EXPECT_EQ(scene.script.impulses[0].velocity, Eigen::Vector3f(1, 2, 3));
  ASSERT_EQ(scene.script.drags.size(), 1u);
  EXPECT_EQ(scene.script.drags[0].to, Eigen::Vector3f(0, 1, 0));
  ASSERT_EQ(scene.script.gravity.size(), 1u);
  EXPECT_EQ(scene.script.gravity[0].gravity, -5);
  EXPECT_EQ(scene.camera.target, Eigen::Vector3f(4, 5, 7));
  EXPECT_EQ(scene.camera.near_plane, 0.25f);
  EXPECT_EQ(scene.light.shadow_radius, 6);
  EXPECT_EQ(scene.tilt.amplitude_x, 0.1f);
  EXPECT_EQ(scene.tilt.period_z, 3);
}

TEST_F(SceneFile, EveryFieldOfA2dSceneArrives) {
  const Scene2d scene = load_scene_2d(write("s.toml", R"(
dimension = 2
[framework]
width = 4
height = 2
thickness = 0.5
[[box]]
size = [1, 2]
mass = 3
angle = 0.5
[[circle]]
radius = 0.75
position = [1, 1]
[[polygon]]
corners = [[0, 0], [1, 0], [0, 1]]
[[soft_body]]
name = "l"
cell_size = 0.5
alpha = 0.25
contact_radius = 0.25
position = [1, 2]
rows = ["#.", "##"]
[[soft_body]]
cell_size = 0.5
shape = { kind = "ring", diameter = 6, hole = 2 }
[[drag]]
body = "l"
begin = 0
end = 1
from = [0, 0]
to = [1, 1]
[camera]
centre = [1, 0]
height = 3
)"));
  ASSERT_EQ(scene.rigid_bodies.size(), 7u);
  EXPECT_EQ(scene.rigid_bodies[1].position, Eigen::Vector2f(2.25f, 0));
  EXPECT_EQ(std::get<Box2dShape>(scene.rigid_bodies[2].shape).size, Eigen::Vector2f(5, 0.5f));
  EXPECT_EQ(scene.rigid_bodies[4].mass, 3);
  EXPECT_EQ(std::get<CircleShape>(scene.rigid_bodies[5].shape).radius, 0.75f);
  EXPECT_EQ(std::get<PolygonShape>(scene.rigid_bodies[6].shape).corners.size(), 3u);
  ASSERT_EQ(scene.soft_bodies.size(), 2u);
  EXPECT_EQ(scene.soft_bodies[0].cells.size(), 3u);
  EXPECT_EQ(scene.soft_bodies[0].contact_radius, 0.25f);
  const ppu::Lattice<2> lattice = scene.soft_bodies[0].lattice();
  EXPECT_EQ(lattice.particles.size(), 8u);
  EXPECT_EQ(lattice.origin, Eigen::Vector2f(-0.5f, -0.5f)) << "the middle of the box is at 0";
  EXPECT_EQ(scene.soft_bodies[1].cells.size(), 28u) << "a disc of 32 cells without the four in its middle";
  EXPECT_EQ(scene.camera.height, 3);
  EXPECT_EQ(scene.script.drags.size(), 1u);
}

TEST_F(SceneFile, APolygonStandsAtItsCentroidAndWhereItsCornersAre) {
  const RigidBody2d body =
      load_scene_2d(write("s.toml",
                          "dimension = 2\n[[polygon]]\nposition = [1, 2]\nangle = 1.5707963\n"
                          "corners = [[6, 0], [9, 0], [6, 3]]\n"))
          .rigid_bodies.at(0);
  EXPECT_LT((body.position - Eigen::Vector2f(0, 9)).norm(), 1e-5f) << "(7, 1), turned, from (1, 2)";
  const auto& corners = std::get<PolygonShape>(body.shape).corners;
  EXPECT_EQ(corners, (std::vector<Eigen::Vector2f>{{-1, -1}, {2, -1}, {-1, 2}}));
}

TEST_F(SceneFile, ThoseOfAFolderAreListedByDimensionAndOthersLeftOut) {
  const std::string body = "[[soft_body]]\nshape = { kind = \"sphere\" }\n";
  write("b.toml", "title = \"second\"\n" + body);
  write("a.toml", "title = \"first\"\n[framework]\n");
  write("flat.toml", "title = \"flat\"\ndimension = 2\n" + body);
  write("untitled.toml", body);
  write("project.toml", "title = \"no scene\"\n[package]\nname = \"x\"\n");
  write("rubbish.toml", "][");
  write("wrong.toml", "dimension = \"three\"\n" + body);
  write("large.toml", body + "# " + std::string(1 << 20, 'x'));
  write("script.lua", "return { dimension = 3 }");
  write("folder.toml/c.toml", body);
  const auto listed = [&](int dimension) {
    std::string all;
    for (const SceneFileListing& scene : scene_files(folder_.path(), dimension))
      all += scene.file.filename().string() + ":" + scene.title + " ";
    return all;
  };
  EXPECT_EQ(listed(3), "a.toml:first b.toml:second untitled.toml: ");
  EXPECT_EQ(listed(2), "flat.toml:flat ");
  EXPECT_TRUE(scene_files(folder_ / "nowhere", 3).empty());
}

TEST(ScenePictures, EachSceneHasOneAndAllAreSmall) {
  const ScenePictures pictures;
  std::set<float> tops;
  for (const SceneListing& scene : list_scenes()) {
    const auto rectangle = pictures.rectangle(scene.name);
    ASSERT_TRUE(rectangle) << scene.name << " has no picture: ci/figures makes it";
    tops.insert((*rectangle)[1]);
    const auto row = static_cast<int>((*rectangle)[1] * static_cast<float>(pictures.sheet().height));
    std::set<std::array<std::uint8_t, 3>> colours;
    for (int x = 0; x < ScenePictures::kWidth; ++x) {
      const std::uint8_t* const p = pictures.sheet().pixel(x, row + ScenePictures::kHeight / 2);
      colours.insert({p[0], p[1], p[2]});
    }
    EXPECT_GT(colours.size(), 10u) << scene.name << " shows nothing";
  }
  EXPECT_EQ(tops.size(), list_scenes().size());
  EXPECT_EQ(pictures.sheet().height, ScenePictures::kHeight * static_cast<int>(list_scenes().size()))
      << "a picture of no scene";
  EXPECT_FALSE(pictures.rectangle("no such scene"));
}

TEST(Scenes, AreListedWithDimensionAndTitleAndAllLoad) {
  ASSERT_GE(list_scenes().size(), 3u);
  for (const SceneListing& listing : list_scenes()) {
    EXPECT_FALSE(listing.title.empty());
    const auto scene = load_scene(listing.name);
    EXPECT_EQ(std::holds_alternative<Scene>(scene) ? 3 : 2, listing.dimension) << listing.name;
    std::visit([&](const auto& s) { EXPECT_EQ(s.title, listing.title); }, scene);
  }
}

TEST(Scenes, TheManHas132Particles) {
  EXPECT_EQ(load_scene_2d("man").soft_bodies.at(0).lattice().particles.size(), 132u);
}

TEST(Scenes, OfTheOtherDimensionAreRefused) {
  EXPECT_THROW(load_scene_3d("man"), std::runtime_error);
  EXPECT_THROW(load_scene_2d("arena"), std::runtime_error);
}

TEST_F(SceneFile, LuaAndTomlBecomeTheSameScene) {
  const Scene lua = load_scene_3d(write("a.lua", R"(
local boxes = {}
for i = 1, 3 do table.insert(boxes, { size = { 1, i, 1 }, position = { 2 * i, 0.5, 0 } }) end
return { world = { gravity = 2 }, box = boxes })"));
  const Scene toml = load_scene_3d(write("a.toml",
                                         "world = { gravity = 2 }\n"
                                         "[[box]]\nsize = [1, 1, 1]\nposition = [2, 0.5, 0]\n"
                                         "[[box]]\nsize = [1, 2, 1]\nposition = [4, 0.5, 0]\n"
                                         "[[box]]\nsize = [1, 3, 1]\nposition = [6, 0.5, 0]\n"));
  EXPECT_EQ(lua.gravity, toml.gravity);
  ASSERT_EQ(lua.boxes.size(), toml.boxes.size());
  for (std::size_t i = 0; i < lua.boxes.size(); ++i) {
    EXPECT_EQ(lua.boxes[i].size, toml.boxes[i].size);
    EXPECT_EQ(lua.boxes[i].position, toml.boxes[i].position);
  }
}

TEST_F(SceneFile, LuaInsertsWhereItIsTold) {
  const std::string text =
      "local t = { 1, 2 }\ntable.insert(t, 1, 9)\ntable.insert(t, 3, 8)\ntable.insert(t, 5, 7)\n"
      "table.insert(t, 6)\nreturn { title = table.concat(t, ' ') }";
  EXPECT_EQ(load_scene_3d(write("s.lua", text)).title, "9 1 8 2 7 6");
}

// As `lua` itself: editors write a byte order mark, and a script may say which program runs it.
TEST_F(SceneFile, LuaMayBeginWithAByteOrderMarkAndALineForTheShell) {
  const std::string mark = "\xEF\xBB\xBF", shell = "#!/usr/bin/lua5.4\n", scene = "return { title = 'a' }";
  for (const std::string& beginning : {mark, shell, mark + shell})
    EXPECT_EQ(load_scene_3d(write("s.lua", beginning + scene)).title, "a");
  EXPECT_BEGINS(refusal("bad.lua", mark + shell + "x = = 1"), "bad.lua:2: unexpected symbol near '='");
  EXPECT_BEGINS(refusal("bad.lua", "#"), "bad.lua:1: what the script returns is nil");
  EXPECT_BEGINS(refusal("bad.lua", "\n" + shell + scene), "bad.lua:2: ");
}

TEST_F(SceneFile, RandomNumbersOfLuaAreTheSameInEveryRun) {
  const std::string file = write("r.lua", "return { world = { gravity = math.random() } }");
  EXPECT_EQ(load_scene_3d(file).gravity, load_scene_3d(file).gravity);
}

TEST_F(SceneFile, AttachmentsAreReadAndCheckedByName) {
  const std::string bodies =
      "[[box]]\nsize = [1, 1, 1]\n[[soft_body]]\nname = \"a\"\ncell_size = 0.3\nshape = { kind = \"box\" }\n"
      "[[soft_body]]\nname = \"b\"\ncell_size = 0.3\nshape = { kind = \"box\" }\nposition = [1.1, 0, "
      "0]\n[[attach]]\n";
  const Scene scene = load_scene_3d(write(
      "good.toml",
      bodies +
          "body = \"b\"\nto = \"a\"\nkind = \"hinge\"\nat = [0.5, 0, 0]\nradius = 0.4\nbreak_force = 9\n"));
  ASSERT_EQ(scene.attachments.size(), 1u);
  EXPECT_EQ(scene.attachments[0].body, 1u);
  EXPECT_EQ(scene.attachments[0].other, std::size_t{0});
  EXPECT_EQ(scene.attachments[0].other_radius, 0.4f);
  EXPECT_EQ(scene.attachments[0].settings.kind, ppu::AttachmentKind::kHinge);
  EXPECT_EQ(scene.attachments[0].settings.break_force, 9);
  const auto refusal = [&](const std::string& fields) -> std::string {
    try {
      load_scene_3d(write("bad.toml", bodies + "at = [0, 0, 0]\nradius = 1\n" + fields));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  const auto says = [&](const std::string& fields, const std::string& sentence) {
    const std::string said = refusal(fields);
    EXPECT_NE(said.find(sentence), std::string::npos) << "'" << said << "' in place of '" << sentence << "'";
  };
  says("body = \"c\"\n", "there is no soft body 'c'");
  says("body = \"a\"\nto = \"c\"\n", "there is no soft body 'c'");
  says("body = \"a\"\nto = \"a\"\n", "attach 1 attaches 'a' to itself");
  says("body = \"a\"\nto = \"b\"\nbox = 1\n", "attach 1 has to and box; give only one of to, box and rigid");
  says("body = \"a\"\nbox = 2\n", "box of attach 1 is 2; it must be a whole number from 1 to 1");
  says("body = \"a\"\nkind = \"glue\"\n", "it must be one of weld, hinge, rope");
  says("body = \"a\"\nkind = \"rope\"\n",
       "attach 1 is a rope to the world; it needs the point of its other end");
  says("body = \"a\"\nlength = 2\n", "attach 1: an attachment has a length and is no rope");
  says("body = \"a\"\naxis = [0, 0, 1]\n",
       "attach 1 is a weld and has the field 'axis'; only hinges have it");
  says("body = \"a\"\npoint = [0, 0, 1]\n", "has the field 'point'; only hinges and ropes have it");
  says("body = \"a\"\nkind = \"hinge\"\ncolour = \"#123456\"\n",
       "bad.toml:17:1: attach 1 is a hinge and has the field 'colour'; only ropes have it");
  says("body = \"a\"\nthickness = 1\n", "has the field 'thickness'; only ropes have it");
  says("body = \"a\"\nbreak_force = 0\n", "break_force of attach 1 is 0");
}

struct BadToml {
  const char* text;
  const char* sentence;
};
void PrintTo(const BadToml& bad, std::ostream* out) { *out << bad.sentence; }
class BadScene : public SceneFile, public testing::WithParamInterface<BadToml> {};

TEST_P(BadScene, IsRefusedWithLineAndColumn) {
  EXPECT_BEGINS(refusal("bad.toml", GetParam().text), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    Toml, BadScene,
    testing::Values(
        BadToml{"title = \n", "bad.toml:1:"},
        BadToml{"[world]\ngravitty = 3\n",
                "bad.toml:2:1: world has no field 'gravitty'; did you mean 'gravity'?"},
        BadToml{"[world]\nwheels = 3\n",
                "bad.toml:2:1: world has no field 'wheels'; it has gravity, friction,"},
        BadToml{"[[soft_bodies]]\n",
                "bad.toml:1:3: a scene has no field 'soft_bodies'; did you mean 'soft_body'?"},
        BadToml{"\n[world]\ngravity = \"down\"\n",
                "bad.toml:3:1: gravity of world is 'down'; it must be a number from -1000 to 1000"},
        BadToml{"[world]\ngravity = nan\n", "bad.toml:2:1: gravity of world is nan; it must be a number"},
        BadToml{"[world]\ngravity = inf\n", "bad.toml:2:1: gravity of world is inf; it must be a number"},
        BadToml{"[world]\nsubsteps = 1.5\n",
                "bad.toml:2:1: substeps of world is 1.5; it must be a whole number"},
        BadToml{"[world]\nsubsteps = 65\n",
                "bad.toml:2:1: substeps of world is 65; it must be a whole number from 1 to 64"},
        BadToml{"world = 3\n", "bad.toml:1:1: world must be a table, and is a number"},
        BadToml{"box = 3\n", "bad.toml:1:1: box of a scene is 3; it must be an array"},
        BadToml{"[[box]]\nmass = 1\n", "bad.toml:1:1: box 1 needs the field 'size'"},
        BadToml{"[[box]]\nsize = [1, 1]\n",
                "bad.toml:2:1: size of box 1 is an array of 2; it must be an array of 3 numbers"},
        BadToml{"[[box]]\nsize = [1, 0, 1]\n",
                "bad.toml:2:12: number 2 in size of box 1 is 0; it must be a number above 0"},
        BadToml{"[[box]]\nsize = [1, 1e-60, 1]\n", "bad.toml:2:12: number 2 in size of box 1 is 1e-60"},
        BadToml{"[[box]]\nsize = [1, 1, 1]\ncolour = \"red\"\n",
                "bad.toml:3:1: colour of box 1 is 'red'; it must be a colour"},
        BadToml{"[materials.tin]\nplasticity = { yield = 0 }\n",
                "bad.toml:2:16: yield of the plasticity of material 'tin' is 0; it must be a number above 0"},
        BadToml{"[materials.cup]\nfracture = { stretch = 0.1, least_cells = 0 }\n",
                "bad.toml:2:29: least_cells of the fracture of material 'cup' is 0; it must be a whole "
                "number from 1 to "
                "1000000"},
        BadToml{
            "[materials.tin]\nplasticity = { yeild = 0.1 }\n",
            "bad.toml:2:16: the plasticity of material 'tin' has no field 'yeild'; did you mean 'yield'?"},
        BadToml{"dimension = 4\n", "bad.toml:1:1: dimension of a scene is 4"},
        BadToml{"title = 1979-05-27\n", "bad.toml:1:9: a scene has no dates or times"},
        BadToml{"[materials.a]\nalpha = 1\nmodulus = 3\n",
                "bad.toml:3:1: material 'a' has both alpha and modulus; give one"},
        BadToml{"[materials.a]\ndensity = 1e-40\n",
                "bad.toml:2:1: density of material 'a' is 1e-40; it must be a number from 0.001 to"},
        BadToml{"[[soft_body]]\ndensity = 1e-9\ncell_size = 0.2\nshape = { kind = \"sphere\" }\n",
                "bad.toml:2:1: density of soft body 1 is 1e-09; it must be a number from 0.001 to"},
        BadToml{"dimension = 2\n[[soft_body]]\ncell_size = 1e-15\nrows = [\"#\"]\n",
                "bad.toml:3:1: cell_size of soft body 1 is 1e-15; it must be a number from 0.001 to"},
        BadToml{"dimension = 2\n[[soft_body]]\ncell_size = 1\nrows = [\"#\"]\ncontact_radius = 1e-9\n",
                "bad.toml:5:1: contact_radius of soft body 1 is 1e-09; it must be a number from 0.01 to 1"},
        BadToml{"[materials.rubber]\n[[soft_body]]\nmaterial = \"ruber\"\nshape = { kind = \"sphere\" }\n",
                "bad.toml:3:1: there is no material 'ruber'; did you mean 'rubber'?"},
        BadToml{"[[soft_body]]\nshape = { kind = \"sphere\" }\n",
                "bad.toml:1:1: soft body 1 needs the field 'cell_size'"},
        BadToml{
            "[materials.a]\nhalf_width = 1\n[[soft_body]]\nmaterial = \"a\"\nshape = { kind = \"sphere\" }\n",
            "bad.toml:3:1: soft body 1 needs the field 'cell_size'"},
        BadToml{"dimension = 2\n[[soft_body]]\nrows = [\"#\"]\n",
                "bad.toml:2:1: soft body 1 needs the field 'cell_size'"},
        BadToml{"[[soft_body]]\ncel_size = 0.2\nshape = { kind = \"sphere\" }\n",
                "bad.toml:2:1: soft body 1 has no field 'cel_size'; did you mean 'cell_size'?"},
        BadToml{"[[soft_body]]\ncell_size = 0.2\nshape = { kind = \"ball\" }\n",
                "bad.toml:3:11: kind of the shape of soft body 1 is 'ball'; it must be one of box, capsule, "
                "car,"},
        BadToml{"[[soft_body]]\ncell_size = 0.2\nmesh = \"none.obj\"\n",
                "bad.toml:3:1: there is no mesh file 'none.obj'"},
        BadToml{"[[soft_body]]\ncell_size = 0.004\nshape = { kind = \"box\", size = [1, 1, 1] }\n",
                "bad.toml:1:"},
        BadToml{"[[impulse]]\ntime = 0\nbody = \"x\"\nvelocity = [0, 0, 0]\n",
                "bad.toml:3:1: there is no soft body 'x'"},
        BadToml{
            "[materials.a]\ncell_size = 0.2\n"
            "[[soft_body]]\nname = \"x\"\nmaterial = \"a\"\nshape = { kind = \"sphere\" }\n"
            "[[soft_body]]\nname = \"x\"\nmaterial = \"a\"\nshape = { kind = \"sphere\" }\n",
            "bad.toml:8:1: soft body 1 and soft body 2 have the same name, 'x'; give one of them another"},
        BadToml{"dimension = 2\n[[soft_body]]\nname = \"body 2\"\ncell_size = 1\nrows = [\"#\"]\n"
                "[[soft_body]]\ncell_size = 1\nrows = [\"#\"]\n",
                "bad.toml:6:1: soft body 1 and soft body 2 have the same name, 'body 2'"},
        BadToml{"[camera]\neye = [0, 0, 0]\n", "bad.toml:"},
        BadToml{"dimension = 2\n[[polygon]]\ncorners = [[0, 0], [0, 1], [1, 0]]\n",
                "bad.toml:3:1: polygon 1 must be convex"},
        BadToml{"dimension = 2\n[[polygon]]\ncorners = [[0, 0], [1, 0], [1, 0.001]]\n",
                "bad.toml:3:1: polygon 1 must be convex"},
        BadToml{"dimension = 2\n[[polygon]]\ncorners = [[0, 0], [100, 0], [100, 0.05]]\n",
                "bad.toml:3:1: polygon 1 must be convex"},
        BadToml{
            "dimension = 2\n[[circle]]\nradius = 1\nmass = 1e-40\n",
            "bad.toml:4:1: mass of circle 1 is 1e-40; it must be 0, which does not move, or a number from "
            "1e-06"},
        BadToml{"[[box]]\nsize = [1, 1, 1]\nmass = 1e-9\n", "bad.toml:3:1: mass of box 1 is 1e-09; it must"},
        BadToml{"[[box]]\nsize = [1, 1, 1]\nmass = 1e-50\n", "bad.toml:3:1: mass of box 1 is 1e-45; it must"},
        BadToml{"[[soft_body]]\ncell_size = 0.1\nown_model_side = 1e-30\nshape = { kind = \"box\" }\n",
                "bad.toml:3:1: own_model_side of soft body 1 is 1e-30; it must be a number from 0.256"},
        BadToml{"dimension = 2\n[[box]]\nsize = [1, 1e-9]\n",
                "bad.toml:3:12: number 2 in size of box 1 is 1e-09; it must be a number from 0.01"},
        BadToml{"[[pause]]\nbegin = 2\nend = 1\n", "bad.toml:3:1: pause 1 ends at 1 s"},
        BadToml{"dimension = 2\n[[soft_body]]\ncell_size = 1\nrows = [\"#\", \"#o\"]\n", "bad.toml:4:"},
        BadToml{"dimension = 2\n[[soft_body]]\ncell_size = 1\n",
                "bad.toml:2:1: soft body 1 needs one of rows, shape, lattice and image"},
        BadToml{"dimension = 2\n[[soft_body]]\ncell_size = 1\nshape = { kind = \"rectangle\", width = 10000, "
                "height = 1000 }\n",
                "bad.toml:4:"},
        BadToml{"dimension = 2\n[[soft_body]]\ncell_size = 1\nshape = { kind = \"rectangle\", width = 256, "
                "height = 256 }\n",
                "bad.toml:2:1: a lattice may have at most 65536 particles"}));

TEST_F(SceneFile, MoreVerticesThanAnyPictureShowsAreRefusedWithinTwoSeconds) {
  EXPECT_BEGINS(
      refusal("fat.lua",
              "local tori = {}\nfor i = 1, 256 do\ntori[i] = { cell_size = 0.3, shape = { kind = "
              "'torus', ring_segments = 512, tube_segments = 512 } }\nend\nreturn { soft_body = tori }"),
      "fat.lua:5: the scene's meshes have 2097152 vertices or more; it may have at most 2000000");
  EXPECT_BEGINS(
      refusal("fat_obstacles.lua",
              "local tori = {}\nfor i = 1, 256 do\ntori[i] = { shape = { kind = 'torus', ring_segments "
              "= 512, tube_segments = 512 } }\nend\nreturn { obstacle = tori }"),
      "fat_obstacles.lua:5: the scene's meshes have 2097152 vertices or more; it may have at most 2000000");
}

class PathTrick : public SceneFile, public testing::WithParamInterface<const char*> {};

TEST_P(PathTrick, DoesNotLeaveTheFolder) {
  write("secret.obj", kTetrahedron);
  write("scenes/inside.obj", kTetrahedron);
  std::filesystem::create_symlink(folder_ / "secret.obj", folder_ / "scenes/link.obj");
  const std::string scene = "[[soft_body]]\ncell_size = 0.2\nmesh = \"" + std::string(GetParam()) + "\"\n";
  EXPECT_BEGINS(refusal("scenes/s.toml", scene), "scenes/s.toml:3:1: ");
}

INSTANTIATE_TEST_SUITE_P(Names, PathTrick,
                         testing::Values("../secret.obj", "x/../../secret.obj", "link.obj", "/etc/passwd", "",
                                         "/usr/share/../../etc/passwd", "inside.obj\\u0000", "a\\nb.obj",
                                         "/dev/zero", "."));

TEST_F(SceneFile, MeshesBelowTheFolderAreFoundThroughDots) {
  write("scenes/inside.obj", kTetrahedron);
  EXPECT_EQ(refusal("scenes/s.toml", "[[soft_body]]\ncell_size = 0.2\nmesh = \"./x/../inside.obj\"\n"), "");
}

TEST_F(SceneFile, FilesThatAreNoneAreRefusedAtOnce) {
  EXPECT_THROW(load_scene("nothing"), std::runtime_error);
  EXPECT_THROW(load_scene(folder_ / "nothing.toml"), std::runtime_error);
  const std::string pipe = folder_ / "pipe.toml";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(load_scene(pipe), std::runtime_error) << "reading a pipe would wait for ever";
}

TEST_F(SceneFile, DeepNestingIsRefusedBeforeItOverflowsTheStack) {
  const auto repeated = [](const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
  };
  constexpr int kTimes = 1'000'000;
  for (const std::string& line :
       {"a" + repeated(".a", kTimes) + " = 1", "[" + repeated("a.", kTimes) + "a]",
        "a = " + repeated("[", kTimes), "a = " + repeated("{a=", kTimes),
        repeated("\"#\".", kTimes) + "a = 1", R"(a = ["""x"""", { b)" + repeated(".a", kTimes) + "= 1}]"}) {
    EXPECT_EQ(refusal("bad.toml", "\n" + line + "\n"),
              "bad.toml:2: tables or arrays are nested more than 32 deep");
  }
}

TEST_F(SceneFile, DotsInTextsAndCommentsAreNoNesting) {
  const std::string dots(100, '.');
  EXPECT_EQ(refusal("s.toml", "title = '" + dots + "' # " + dots + "\n"), "");
  EXPECT_EQ(refusal("s.toml", "title = \"\\\"" + dots + "\"\n"), "");
  EXPECT_EQ(refusal("s.toml", "title = \"\"\"a\n" + dots + "\"\"\"\"\"\n"), "");
}

struct BadLua {
  const char* text;
  const char* sentence;
};
void PrintTo(const BadLua& bad, std::ostream* out) { *out << bad.sentence; }
class BadScript : public SceneFile, public testing::WithParamInterface<BadLua> {};

TEST_P(BadScript, IsRefusedWithinTwoSeconds) {
  EXPECT_BEGINS(refusal("bad.lua", GetParam().text), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    Lua, BadScript,
    testing::Values(
        BadLua{"\nx = = 1", "bad.lua:2: unexpected symbol near '='"},
        BadLua{"local x = 1\nwhile true do end", "bad.lua:2: the script ran for more than 1 second"},
        BadLua{"local t = {}\nwhile true do t[#t + 1] = { 1 } end",
               "bad.lua:2: the script needs more than 64 MB"},
        BadLua{"local s = 'x'\nwhile true do s = s .. s end", "bad.lua:2: the script needs more than 64 MB"},
        BadLua{"local function f() return 1 + f() end\nreturn f()", "bad.lua:"},
        BadLua{"local cells = {}\nfor i = 1, 1e7 do cells[i] = { i, i } end\nreturn { cells = cells }",
               "bad.lua:2: the script needs more than 64 MB"},
        BadLua{"local t = {}\nt[1] = t\nreturn t",
               "bad.lua:3: tables are nested more than 32 deep, or one contains itself"},
        BadLua{"local t = { 1 }\nfor i = 1, 30 do t = { t, t } end\nreturn t",
               "bad.lua:3: what the script returns is larger than 8 MB"},
        BadLua{"return { world = { gravity = 0 / 0 } }",
               "bad.lua:1: world.gravity is NaN; it must be a finite number"},
        BadLua{"return { world = { gravity = math.huge } }", "bad.lua:1: world.gravity is infinite"},
        BadLua{"return { title = math.sin }", "bad.lua:1: title is a function; a scene is made of"},
        BadLua{"return { box = { 1, nil, 3 } }", "bad.lua:1: box[2] is missing: an array has no holes"},
        BadLua{"return { box = { 1, x = 3 } }", "bad.lua:1: box has names as well as numbers for keys"},
        BadLua{"local x = 1", "bad.lua:1: what the script returns is nil"},
        BadLua{"return 3", "bad.lua:1: a scene must be a table, and is a number"},
        BadLua{"local t = { 1, 2 }\ntable.insert(t, 4, 9)\n",
               "bad.lua:2: bad argument #2 to 'insert' (position out of bounds)"},
        BadLua{"return { title = string.format('%-10p', {}) }",
               "bad.lua:1: bad argument #1 to 'format' (%p is an address, which differs from run to run)"},
        BadLua{"error(tostring({}) .. string.format(' %s %5s %d%%', math.sin, {}, 3))",
               "bad.lua:1: table function table 3%"},
        BadLua{"table.insert({}, 0, 9)", "bad.lua:1: bad argument #2 to 'insert' (position out of bounds)"},
        BadLua{"table.insert({}, math.mininteger, 9)",
               "bad.lua:1: bad argument #2 to 'insert' (position out"},
        BadLua{"table.insert({}, 1.5, 9)", "bad.lua:1: bad argument #2 to 'insert' (number has no integer"},
        BadLua{"table.insert({})", "bad.lua:1: wrong number of arguments to 'insert'"},
        BadLua{"table.insert({}, 1, 2, 3)", "bad.lua:1: wrong number of arguments to 'insert'"},
        BadLua{"table.insert(nil, 1)", "bad.lua:1: bad argument #1 to 'insert' (table expected, got nil)"},
        BadLua{"local t = {}\nfor i = 61, 0, -1 do t[1 << i] = 1 end\ntable.insert(t, 1, 9)",
               "bad.lua:3: the script ran for more than 1 second"},
        BadLua{"local t = {}\nwhile true do\ntable.insert(t, { 1 })\nend",
               "bad.lua:3: the script needs more than 64 MB"},
        BadLua{"local t = { 1 }\nfor k in pairs(t) do end",
               "bad.lua:2: pairs is not available in a scene; there are: assert, error, ipairs, select, "
               "tonumber, tostring, type, math, string, table"},
        BadLua{"\nio.write('x')", "bad.lua:2: io is not available in a scene; there are: assert, "},
        BadLua{"require('x')", "bad.lua:1: require is not available in a scene; there are: assert, "},
        BadLua{"print(1)", "bad.lua:1: print is not available in a scene; there are: assert, "},
        BadLua{"table.remove({ 1 })",
               "bad.lua:1: table.remove is not available in a scene; there are: concat, pack, sort, unpack, "
               "insert"},
        BadLua{"math.randomseed(3)",
               "bad.lua:1: math.randomseed is not available in a scene; there are: abs,"},
        BadLua{"\nreturn { title = ('x'):rep(3) }",
               "bad.lua:2: string.rep is not available in a scene; there are: byte, "},
        BadLua{"paris(1)", "bad.lua:1: attempt to call a nil value (global 'paris')"},
        BadLua{"table.inssert({}, 1)", "bad.lua:1: attempt to call a nil value (field 'inssert')"},
        BadLua{"error('by hand')", "bad.lua:1: by hand"},
        BadLua{"error({})", "bad.lua:1: the script ended with an error that is not a text"},
        BadLua{"return { world = { gravitty = 3 } }",
               "bad.lua:1: world has no field 'gravitty'; did you mean 'gravity'?"},
        BadLua{"\x1bLua", "bad.lua:1: "}));

/// Everything that a script must not have, by the name under which it would be found.
class LeftOut : public SceneFile, public testing::WithParamInterface<const char*> {};

TEST_P(LeftOut, IsRefusedByItsName) {
  const std::string expression = GetParam();
  const bool is_method = expression.starts_with("('').");
  const std::string name = is_method ? "string." + expression.substr(5) : expression;
  EXPECT_BEGINS(refusal("bad.lua", "return { title = tostring(" + expression + " == nil) }"),
                "bad.lua:1: " + name + " is not available in a scene; there are: ");
}

INSTANTIATE_TEST_SUITE_P(Functions, LeftOut,
                         testing::Values("load", "loadfile", "dofile", "require", "collectgarbage", "pcall",
                                         "xpcall", "setmetatable", "getmetatable", "rawset", "next", "pairs",
                                         "print", "io", "os", "debug", "package", "coroutine", "_G",
                                         "string.rep", "string.dump", "string.find", "string.match",
                                         "string.gmatch", "string.gsub", "('').rep", "('').find",
                                         "table.move", "table.remove", "math.randomseed"));

TEST_F(SceneFile, ALatticeMayBeAScript) {
  write("l.lua", "return { rows = { '##', '##' } }");
  const Scene2d scene =
      load_scene_2d(write("s.toml", "dimension = 2\n[[soft_body]]\ncell_size = 0.5\nlattice = \"l.lua\"\n"));
  EXPECT_EQ(scene.soft_bodies.at(0).cells.size(), 4u);
}

TEST_F(SceneFile, AnErrorInALatticeNamesTheLatticesFile) {
  write("l.lua", "return {\n cell = {} }");
  EXPECT_BEGINS(refusal("s.toml", "dimension = 2\n[[soft_body]]\ncell_size = 0.5\nlattice = \"l.lua\"\n"),
                "l.lua:2: a lattice has no field 'cell'; did you mean 'cells'?");
}

TEST_F(SceneFile, LatticesThatAreSlowTogetherAreRefused) {
  std::string scene = "dimension = 2\n";
  for (int i = 0; i < 40; ++i) {
    const std::string name = "slow" + std::to_string(i) + ".lua";
    write(name, "local x = 0\nfor i = 1, 4e6 do x = x + i end\nreturn { cells = { { 0, 0 } } }");
    scene += "[[soft_body]]\ncell_size = 1\nlattice = \"" + name + "\"\n";
  }
  const std::string file = write("slow.toml", scene);
  try {
    load_scene_2d(file);
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(
        std::string(error.what()).find("the scripts of the scene's lattices ran for more than 1 second"),
        std::string::npos)
        << error.what();
  }
}

TEST_F(SceneFile, ALatticeOfManyBodiesRunsOnce) {
  write("long.lua", "local x = 0\nfor i = 1, 2e6 do x = x + i end\nreturn { rows = { '##' } }");
  std::string scene = "dimension = 2\n";
  for (int i = 0; i < 200; ++i) scene += "[[soft_body]]\ncell_size = 1\nlattice = \"long.lua\"\n";
  EXPECT_EQ(load_scene_2d(write("many.toml", scene)).soft_bodies.size(), 200u);
}

TEST(NearestName, FindsSlipsAndNothingElse) {
  constexpr std::array<std::string_view, 3> known{"gravity", "friction", "up"};
  EXPECT_EQ(base::nearest_name("gravitty", known), "gravity");
  EXPECT_EQ(base::nearest_name("frction", known), "friction");
  EXPECT_EQ(base::nearest_name("ub", known), "up");
  EXPECT_EQ(base::nearest_name("grvty", known), "gravity");
  EXPECT_EQ(base::nearest_name("colour", known), "");
  EXPECT_EQ(base::nearest_name(std::string(100'000, 'x'), known), "");
}

}  // namespace
}  // namespace softcell::demos
