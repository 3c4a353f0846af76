// Models as their makers painted them, turned the right way up: the fields up, scale and rotation, and what a body is
// drawn with.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/gltf_builder.h"
#include "scene/scene_hash.h"
#include "scene_file/own_model.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/soft_bodies/mesh.h"
#include "support/scratch_folder.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

/// A tetrahedron of 2 by 3 by 4 units, with one material.
std::string tetrahedron(const std::string& more = "") {
  ppu::GltfBuilder file;
  file.add_floats({0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4}, "VEC3", 3);
  file.add<std::uint8_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", 5121, 1);
  return file.glb(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}])" +
      more);
}

class OwnLooks : public testing::Test {
 protected:
  OwnLooks() { write("model.glb", tetrahedron()); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Scene scene(const std::string& fields, const std::string& kind = "soft_body") const {
    const std::string body = kind == "soft_body" ? "cell_size = 0.5\n" : "";
    return load_scene_3d(write("s.toml", "[[" + kind + "]]\nmesh = \"model.glb\"\n" + body + fields));
  }
  std::string refusal(const std::string& fields) const {
    try {
      scene(fields);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "(loaded)";
  }
  static Vector3f size(const Scene& scene) {
    const ppu::Bounds<3> box = ppu::bounds(scene.soft_bodies.at(0).mesh);
    return box.high - box.low;
  }
  tests::ScratchFolder folder_;
};

TEST_F(OwnLooks, UpAndScaleAndLongestSideChangeTheMesh) {
  EXPECT_EQ(size(scene("")), Vector3f(2, 3, 4));
  EXPECT_EQ(size(scene("up = \"y\"")), Vector3f(2, 3, 4));
  const Scene turned = scene("up = \"z\"");
  EXPECT_EQ(size(turned), Vector3f(2, 4, 3));
  EXPECT_EQ(ppu::bounds(turned.soft_bodies[0].mesh).high, Vector3f(2, 4, 0)) << "y has become -z";
  EXPECT_EQ(size(scene("scale = 0.5\nup = \"z\"")), Vector3f(1, 2, 1.5f));
  EXPECT_EQ(size(scene("longest_side = 2")), Vector3f(1, 1.5f, 2));
}

TEST_F(OwnLooks, ARotationTurnsTheMeshAndKeepsItsSize) {
  const Scene turned = scene("longest_side = 4\nrotation = { axis = [0, 0, 2], degrees = 90 }\nabove = 1");
  EXPECT_LT((size(turned) - Vector3f(3, 2, 4)).norm(), 1e-5f);
  EXPECT_NEAR(turned.soft_bodies[0].position.y() + ppu::bounds(turned.soft_bodies[0].mesh).low.y(), 1, 1e-6);
  const ppu::TriangleMesh& mesh = turned.soft_bodies[0].mesh;
  EXPECT_NO_THROW(ppu::validate(mesh));
  const ppu::TriangleMesh straight = scene("longest_side = 4").soft_bodies[0].mesh;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vector3f &was = straight.positions[v], &normal = straight.normals[v];
    EXPECT_LT((mesh.positions[v] - Vector3f(-was.y(), was.x(), was.z())).norm(), 1e-5f) << v;
    EXPECT_LT((mesh.normals[v] - Vector3f(-normal.y(), normal.x(), normal.z())).norm(), 1e-5f) << v;
  }
}

TEST_F(OwnLooks, ABoxThatIsTurnedStandsSoAndAgainAfterAReset) {
  const Scene turned = load_scene_3d(
      write("b.toml",
            "[[box]]\nsize = [1, 2, 3]\nposition = [0, 5, 0]\nmass = 1\nrotation = { axis = [1, 0, 0], "
            "degrees = 90 }\n"
            "[[soft_body]]\nshape = { kind = \"box\" }\ncell_size = 0.5\n[[reset]]\ntime = 0.5\n"));
  Simulation3d simulation(turned, {});
  Eigen::Matrix3f expected;
  expected << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const auto is_as_at_the_beginning = [&] {
    const Eigen::Matrix4f pose = simulation.shown_box_poses()[0];
    return (pose.topLeftCorner<3, 3>() - expected).norm() < 1e-5f && std::abs(pose(1, 3) - 5) < 0.01f;
  };
  EXPECT_TRUE(is_as_at_the_beginning());
  for (int frame = 0; frame < 30; ++frame) simulation.step();
  simulation.finish();
  EXPECT_FALSE(is_as_at_the_beginning()) << "it falls";
  simulation.step();  // after the reset
  simulation.finish();
  EXPECT_TRUE(is_as_at_the_beginning());
}

TEST_F(OwnLooks, FieldsAtTheirDefaultsLeaveTheSceneAsItWas) {
  const std::string body = "[[soft_body]]\nmesh = \"model.glb\"\ncell_size = 0.5\n";
  const std::string box = "[[box]]\nsize = [1, 1, 1]\n";
  const auto hash = [&](const std::string& text) { return scene_hash(load_scene_3d(write("h.toml", text))); };
  const std::uint64_t plain = hash(body + box);
  EXPECT_EQ(hash(body + "up = \"y\"\nscale = 1\nrotation = { degrees = 0 }\n" + box +
                 "rotation = { degrees = 0 }\n"),
            plain);
  EXPECT_EQ(hash(body + "colour = \"#102030\"\n" + box), plain) << "looks are no part of it";
  EXPECT_NE(hash(body + "up = \"z\"\n" + box), plain);
  EXPECT_NE(hash(body + "rotation = { degrees = 1 }\n" + box), plain);
  EXPECT_NE(hash(body + box + "rotation = { degrees = 1 }\n"), plain);
}

TEST_F(OwnLooks, ABodyKeepsTheColourThatItGivesAndHasItsOwnMaterialsOtherwise) {
  EXPECT_TRUE(scene("").soft_bodies[0].own_materials);
  EXPECT_FALSE(scene("colour = \"#102030\"").soft_bodies[0].own_materials);
  EXPECT_TRUE(scene("", "obstacle").obstacles[0].own_materials);
  EXPECT_FALSE(scene("colour = \"#102030\"", "obstacle").obstacles[0].own_materials);
  EXPECT_EQ(scene("").soft_bodies[0].mesh.materials.at(0).base_colour, Eigen::Vector4f(1, 0, 0, 1));
}

TEST_F(OwnLooks, TheUsersModelHasItsOwnMaterialsWhateverColourTheSceneGives) {
  const auto model = load_own_model({.mesh = folder_ / "model.glb", .z_up = true, .cell = std::nullopt});
  const Scene with = load_scene_3d("drop", model);
  EXPECT_TRUE(with.soft_bodies[0].own_materials);
  const Vector3f side = size(with);
  EXPECT_LT((side - Vector3f(0.8f, 1.6f, 1.2f)).norm(), 1e-5f) << side.transpose();
  EXPECT_FALSE(load_scene_3d("drop").soft_bodies[0].own_materials);
}

TEST_F(OwnLooks, WhatIsNotReadIsSaidOnceForEachFile) {
  write("model.glb", tetrahedron(R"(,"animations":[{}])"));
  const Scene two =
      load_scene_3d(write("two.toml",
                          "[[soft_body]]\nmesh = \"model.glb\"\ncell_size = 0.5\n"
                          "[[soft_body]]\nmesh = \"model.glb\"\ncell_size = 0.5\nposition = [9, 0, 0]\n"));
  EXPECT_EQ(two.notes, std::vector<std::string>{"model.glb: not read: animations"});
  const auto model = load_own_model({.mesh = folder_ / "model.glb", .cell = std::nullopt});
  EXPECT_EQ(model->notes, std::vector<std::string>{folder_ / "model.glb" + ": not read: animations"});
}

TEST_F(OwnLooks, WrongFieldsAreRefused) {
  EXPECT_NE(refusal("up = \"x\"").find("up of soft body 1 is 'x'; it must be one of y, z"), std::string::npos)
      << refusal("up = \"x\"");
  EXPECT_NE(refusal("scale = 0").find("scale of soft body 1 is 0; it must be a number above 0"),
            std::string::npos);
  EXPECT_NE(refusal("scale = 1\nlongest_side = 1")
                .find("soft body 1 has both scale and longest_side; give one of them"),
            std::string::npos);
  EXPECT_NE(refusal("scale = 9999").find("scale of soft body 1 is 9999, which makes it larger than 10000 m"),
            std::string::npos);
  EXPECT_NE(refusal("rotation = 90").find("the rotation of soft body 1 must be a table"), std::string::npos);
  EXPECT_NE(refusal("rotation = { axis = [0, 0, 0], degrees = 1 }")
                .find("axis of the rotation of soft body 1 must not be 0"),
            std::string::npos);
  EXPECT_NE(refusal("rotation = { axis = [0, 0, 1] }").find("degrees"), std::string::npos);
  const std::string shape = [&] {
    try {
      load_scene_3d(
          write("s.toml", "[[soft_body]]\nshape = { kind = \"box\" }\ncell_size = 0.5\nup = \"z\"\n"));
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("(loaded)");
  }();
  EXPECT_NE(shape.find("up of soft body 1 is for a mesh from a file, not for a shape"), std::string::npos)
      << shape;
}

TEST_F(OwnLooks, FilesThatAMeshNamesBelongToTheScene) {
  ppu::GltfBuilder file;
  file.add_floats({0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4}, "VEC3", 3);
  file.add<std::uint8_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", 5121, 1);
  write("data.bin", file.bytes());
  write("beside.gltf",
        file.gltf_beside(
            "data.bin",
            R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"));
  const Scene scene =
      load_scene_3d(write("f.toml", "[[soft_body]]\nmesh = \"beside.gltf\"\ncell_size = 0.5\n"));
  const auto& files = scene.files;
  EXPECT_NE(std::ranges::find(files, std::filesystem::weakly_canonical(folder_ / "data.bin")), files.end());
}

}  // namespace
}  // namespace softcell::demos
