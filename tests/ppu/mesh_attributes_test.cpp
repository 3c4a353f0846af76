// What a mesh file says beside its geometry: texture coordinates, colours, objects, materials.

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/mesh_import/material_library.h"
#include "ppu/mesh_import/parse_mesh.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

/// Two triangles in one plane, which share an edge.
const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TriangleMesh obj(const std::string& text, const std::string& library = "") {
  return parse_mesh(text, MeshFormat::kObj,
                    [&](const std::string& name, std::uint64_t) -> std::optional<std::string> {
                      if (name != "paint.mtl") return std::nullopt;
                      return library;
                    });
}

std::string refusal(const std::string& text, const std::string& library) {
  try {
    obj(text, library);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "(imported)";
}

TEST(MeshAttributes, ObjTextureCoordinatesComeWithTheirCorners) {
  const TriangleMesh mesh = obj(kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.texture_coordinates.size(), 4u);
  for (std::size_t v = 0; v < 4; ++v)
    EXPECT_EQ(mesh.texture_coordinates[v], mesh.positions[v].head<2>()) << v;
  EXPECT_TRUE(mesh.colours.empty());
  EXPECT_TRUE(mesh.parts.empty());
  validate(mesh);
}

TEST(MeshAttributes, ASeamOfTheTextureSplitsVerticesAndNotTheirNormals) {
  // The second triangle has texture coordinates of its own.
  const TriangleMesh mesh =
      obj(kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.5\nf 1/1 2/2 3/3\nf 1/4 3/4 4/4\n");
  ASSERT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{3, 4, 5}));
  EXPECT_EQ(mesh.positions[3], mesh.positions[0]);
  EXPECT_EQ(mesh.normals[3], mesh.normals[0]);
  EXPECT_EQ(mesh.texture_coordinates[3], Vector2f(0.5f, 0.5f));
  EXPECT_EQ(mesh.texture_coordinates[0], Vector2f(0, 0));
}

TEST(MeshAttributes, WithoutASeamTheVerticesAreThoseOfTheMeshWithoutAttributes) {
  std::string plain, textured;
  const TriangleMesh shape = make_car(1);
  for (const Vector3f& p : shape.positions) {
    char line[128];
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", static_cast<double>(p.x()),
                  static_cast<double>(p.y()), static_cast<double>(p.z()));
    plain += line;
  }
  textured = plain;
  textured += "vt 0.25 0.75\n";
  for (const auto& t : shape.triangles) {
    char line[128];
    const unsigned a = t[0] + 1, b = t[1] + 1, c = t[2] + 1;
    std::snprintf(line, sizeof line, "f %u %u %u\n", a, b, c);
    plain += line;
    std::snprintf(line, sizeof line, "f %u/1 %u/1 %u/1\n", a, b, c);
    textured += line;
  }
  const TriangleMesh without = obj(plain);
  TriangleMesh with = obj(textured);
  EXPECT_EQ(with.texture_coordinates, std::vector(with.positions.size(), Vector2f(0.25f, 0.75f)));
  with.texture_coordinates.clear();
  EXPECT_EQ(with, without);
}

TEST(MeshAttributes, ObjColoursOfVerticesAreKept) {
  const TriangleMesh mesh = obj("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 0.5\nf 1 2 3\n");
  EXPECT_EQ(mesh.colours, (std::vector{Vector4f(1, 0, 0, 1), Vector4f(0, 1, 0, 1), Vector4f(0, 0, 0.5f, 1)}));
}

TEST(MeshAttributes, PlyHasColoursAndTextureCoordinates) {
  const TriangleMesh mesh = parse_mesh(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 255 0 0 255\n1 0 0 1 0 0 255 0 255\n0 1 0 0 1 0 0 255 0\n3 0 1 2\n",
      MeshFormat::kPly);
  EXPECT_EQ(mesh.texture_coordinates, (std::vector{Vector2f(0, 0), Vector2f(1, 0), Vector2f(0, 1)}));
  EXPECT_EQ(mesh.colours, (std::vector{Vector4f(1, 0, 0, 1), Vector4f(0, 1, 0, 1), Vector4f(0, 0, 1, 0)}));
}

TEST(MeshAttributes, BinaryStlHasColoursOfTriangles) {
  std::string bytes(84, ' ');
  bytes[80] = 1, bytes[81] = bytes[82] = bytes[83] = 0;
  const float numbers[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
  bytes += std::string("\x00\xFC", 2);  // a colour, and it is red
  const TriangleMesh mesh = parse_mesh(bytes, MeshFormat::kStl);
  EXPECT_EQ(mesh.colours, std::vector(3, Vector4f(1, 0, 0, 1)));
}

TEST(MeshAttributes, ObjectsAndMaterialsAreRangesOfTriangles) {
  const TriangleMesh mesh =
      obj("mtllib paint.mtl\no head of it\nusemtl skin\n" + kSquare +
              "f 1 2 3 4\nf 1 2 2\nusemtl hair\nf 1 2 3\no body\nusemtl skin\nf 2 3 4\n",
          "# made by hand\nnewmtl skin\nKd 0.9 0.6 0.5\nKs 1 1 1\nmap_Kd -s 2 2 2 skin.png\n"
          "newmtl hair\nKd 0.25\nmap_Kd my hair.png\nnewmtl other\nKd xyz 1 1 1\n");
  ASSERT_EQ(mesh.triangles.size(), 4u);  // the one without area is gone
  ASSERT_EQ(mesh.parts.size(), 3u);
  EXPECT_EQ(mesh.parts[0], (MeshPart{"head of it", 0, 0, 2}));
  EXPECT_EQ(mesh.parts[1], (MeshPart{"head of it", 1, 2, 1}));
  EXPECT_EQ(mesh.parts[2], (MeshPart{"body", 0, 3, 1}));
  ASSERT_EQ(mesh.materials.size(), 2u);
  EXPECT_EQ(mesh.materials[0], (MeshMaterial{.name = "skin",
                                             .base_colour = Vector4f(0.9f, 0.6f, 0.5f, 1),
                                             .base_texture = {.file = "skin.png", .picture = nullptr}}));
  EXPECT_EQ(mesh.materials[1], (MeshMaterial{.name = "hair",
                                             .base_colour = Vector4f(0.25f, 0.25f, 0.25f, 1),
                                             .base_texture = {.file = "my hair.png", .picture = nullptr}}));
  validate(mesh);
}

TEST(MeshAttributes, AMissingMaterialLibraryLeavesTheNames) {
  const TriangleMesh mesh = obj("mtllib elsewhere.mtl\nusemtl red\n" + kSquare + "f 1 2 3\n");
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0], (MeshPart{"", 0, 0, 1}));
  EXPECT_EQ(mesh.materials, std::vector{MeshMaterial{.name = "red"}});
  EXPECT_FALSE(mesh.materials[0].has_looks());
}

TEST(MeshAttributes, SolidsOfTextStlAreParts) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const TriangleMesh mesh =
      parse_mesh("solid lid\n" + facet + "endsolid lid\nsolid pot\n" + facet + facet + "endsolid pot\n",
                 MeshFormat::kStl);
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.parts[0], (MeshPart{"lid", std::nullopt, 0, 1}));
  EXPECT_EQ(mesh.parts[1], (MeshPart{"pot", std::nullopt, 1, 2}));
}

TEST(MeshAttributes, ABrokenMaterialLibraryIsRefused) {
  const std::string text = "mtllib paint.mtl\nusemtl red\n" + kSquare + "f 1 2 3\n";
  EXPECT_EQ(refusal(text, "newmtl red\nKd 1 0\n"),
            "its material library 'paint.mtl': line 2: 'Kd' is not followed by one number or three");
  EXPECT_EQ(refusal(text, "Kd 1 0 0\n"),
            "its material library 'paint.mtl': line 1: 'Kd' comes before the first 'newmtl'");
  EXPECT_EQ(refusal(text, "newmtl red\nKd nan 0 0\n"),
            "its material library 'paint.mtl': line 2: 'nan' is not a finite number (of at most 3.4e38)");
  EXPECT_EQ(refusal(text, std::string("newmtl red\n\0", 12)),
            "its material library 'paint.mtl': it holds binary data; a material library is text");
}

TEST(MeshAttributes, NamesAreCutAndTheirNumberIsLimited) {
  const TriangleMesh mesh = obj("o " + std::string(1000, 'a') + "\n" + kSquare + "f 1 2 3\n");
  EXPECT_EQ(mesh.parts[0].object, std::string(255, 'a'));
  std::string many = kSquare;
  for (int i = 0; i < 65'537; ++i) many += i % 2 == 0 ? "g a\nf 1 2 3\n" : "g b\nf 1 2 3\n";
  EXPECT_EQ(refusal(many, ""), "its objects and materials change more than 65536 times");
}

TEST(MeshAttributes, ArraysThatDoNotFitEachOtherAreNamed) {
  const TriangleMesh good = make_box({1, 1, 1}, 1);
  const auto problem = [](const TriangleMesh& mesh) -> std::string {
    try {
      validate(mesh);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem(good), "");
  TriangleMesh mesh = good;
  mesh.normals.pop_back();
  EXPECT_EQ(problem(mesh), "a mesh of 24 positions has 23 normals; one for each position was expected");
  for (const Eigen::Vector3f& bad :
       {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0, NAN, 1), Eigen::Vector3f(INFINITY, 0, 0)}) {
    mesh = good;
    mesh.normals[5] = bad;
    EXPECT_EQ(problem(mesh).find("normal 5 of a mesh is "), 0u) << problem(mesh);
  }
  mesh = good;
  mesh.texture_coordinates.resize(1);
  EXPECT_EQ(problem(mesh),
            "a mesh of 24 positions has 1 texture coordinates; one for each position was expected");
  mesh = good;
  mesh.triangles[3][1] = 24;
  EXPECT_EQ(problem(mesh), "triangle 3 of a mesh names vertex 24; the mesh has 24");
  mesh = good;
  mesh.parts = {{.object = "half", .material = std::nullopt, .first_triangle = 0, .triangle_count = 6}};
  EXPECT_EQ(problem(mesh), "the parts of a mesh have 6 triangles, the mesh has 12");
}

}  // namespace
}  // namespace softcell::ppu
