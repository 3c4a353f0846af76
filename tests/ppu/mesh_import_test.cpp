#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "ppu/mesh_checks.h"
#include "softcell/mesh_import/mesh_import.h"
#include "softcell/soft_bodies/shapes.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

namespace fs = std::filesystem;

class MeshImport : public testing::Test {
 protected:
  MeshImport() : folder_(fs::temp_directory_path() / ("softcell_mesh_import_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~MeshImport() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    fs::remove(folder_ / name);  // some file systems make overwriting wait for the disk
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  TriangleMesh import(const std::string& name, const std::string& bytes) const {
    return import_mesh(write(name, bytes));
  }

  /// The file is refused with one sentence that names it and contains `reason`; nothing is printed.
  void expect_refused(const std::string& name, const std::string& bytes, const std::string& reason) const {
    expect_path_refused(write(name, bytes), reason);
  }
  static void expect_path_refused(const fs::path& path, const std::string& reason) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    std::string message = "(imported)";
    try {
      import_mesh(path);
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << reason;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << reason;
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << "wanted: " << reason << "\n   got: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  fs::path folder_;
};

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string as_obj(const TriangleMesh& mesh, bool normals) {
  std::string text = "# a comment\nmtllib /etc/hostname\no thing\n";
  char line[128];
  for (const Eigen::Vector3f& p : mesh.positions) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", static_cast<double>(p.x()),
                  static_cast<double>(p.y()), static_cast<double>(p.z()));
    text += line;
  }
  for (const Eigen::Vector3f& n : mesh.normals) {
    std::snprintf(line, sizeof line, "vn %.9g %.9g %.9g\n", static_cast<double>(n.x()),
                  static_cast<double>(n.y()), static_cast<double>(n.z()));
    if (normals) text += line;
  }
  for (const auto& t : mesh.triangles) {
    const unsigned a = t[0] + 1, b = t[1] + 1, c = t[2] + 1;
    std::snprintf(line, sizeof line, normals ? "f %u//%u %u//%u %u//%u\n" : "f %u %u %u\n", a,
                  normals ? a : b, normals ? b : c, b, c, c);
    text += line;
  }
  return text;
}

std::string as_binary_ply(const TriangleMesh& mesh) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment made by a test\nelement vertex " +
      std::to_string(mesh.positions.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
      "property float nz\nelement face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (int d = 0; d < 3; ++d) append(bytes, mesh.positions[v][d]);
    for (int d = 0; d < 3; ++d) append(bytes, mesh.normals[v][d]);
  }
  for (const auto& t : mesh.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t index : t) append(bytes, index);
  }
  return bytes;
}

std::string as_binary_stl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) append(bytes, 0.0f);
    for (const std::uint32_t index : t) {
      for (int d = 0; d < 3; ++d) append(bytes, mesh.positions[index][d]);
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string as_text_stl(const TriangleMesh& mesh) {
  std::string text = "solid thing with a name\n";
  for (const auto& t : mesh.triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const std::uint32_t index : t) {
      char line[128];
      const Eigen::Vector3d p = mesh.positions[index].cast<double>();
      std::snprintf(line, sizeof line, "      vertex %.9g %.9g %.9g\n", p.x(), p.y(), p.z());
      text += line;
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid thing with a name\n";
}

/// The imported triangles are those of `original`, in order, to within `tolerance` metres (text formats
/// round).
void expect_same_triangles(const TriangleMesh& imported, const TriangleMesh& original, float tolerance) {
  ASSERT_EQ(imported.triangles.size(), original.triangles.size());
  ASSERT_EQ(imported.normals.size(), imported.positions.size());
  for (std::size_t t = 0; t < original.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& a = imported.positions[imported.triangles[t][k]];
      const Eigen::Vector3f& b = original.positions[original.triangles[t][k]];
      ASSERT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << "triangle " << t << ", corner " << k;
    }
  }
}

void expect_same_normals(const TriangleMesh& imported, const TriangleMesh& original, float tolerance) {
  for (std::size_t t = 0; t < original.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& a = imported.normals[imported.triangles[t][k]];
      const Eigen::Vector3f& b = original.normals[original.triangles[t][k]];
      ASSERT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << "triangle " << t << ", corner " << k;
    }
  }
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

std::string ply(const std::string& vertices, const std::string& faces, const std::string& body) {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

// --- what is read
// ---------------------------------------------------------------------------------------------------------

TEST_F(MeshImport, ReadsObj) {
  const TriangleMesh sphere = make_sphere(1, 6);
  const TriangleMesh with = import("sphere.obj", as_obj(sphere, true));
  expect_same_triangles(with, sphere, 1e-6f);
  expect_same_normals(with, sphere, 1e-6f);
  EXPECT_EQ(with.positions.size(), sphere.positions.size());
  expect_same_triangles(import("bare.obj", as_obj(sphere, false)), sphere, 1e-6f);
}

TEST_F(MeshImport, ReadsPlyAndItsNormals) {
  const TriangleMesh torus = make_torus(1, 0.25f, 16, 8);
  const TriangleMesh mesh = import("torus.ply", as_binary_ply(torus));
  expect_same_triangles(mesh, torus, 0);
  expect_same_normals(mesh, torus, 1e-6f);
  EXPECT_EQ(open_edges(mesh), 0u);
}

TEST_F(MeshImport, ReadsBothKindsOfStl) {
  const TriangleMesh torus = make_torus(1, 0.25f, 32, 16);
  const TriangleMesh binary = import("torus.stl", as_binary_stl(torus)),
                     text = import("text.STL", as_text_stl(torus));
  expect_same_triangles(binary, torus, 0);
  expect_same_triangles(text, torus, 1e-6f);
  EXPECT_EQ(binary.positions.size(), torus.positions.size());  // the corners are joined again
  expect_same_normals(binary, torus, 0.02f);  // and the normals made, close to the torus's own
}

TEST_F(MeshImport, ReadsPlyAsText) {
  const TriangleMesh mesh = import("a.ply", ply("4", "1", "0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n"));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.positions.size(), 4u);
  for (const Eigen::Vector3f& n : mesh.normals) EXPECT_EQ(n, Eigen::Vector3f(0, 0, 1));
}

/// The quadrilateral of ReadsPlyAsText, with a line more in its header.
std::string ply_with(const std::string& line, std::size_t before = 2) {
  std::string text = ply("4", "1", "0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n");
  std::size_t at = 0;
  for (std::size_t i = 0; i < before; ++i) at = text.find('\n', at) + 1;
  return text.insert(at, line);
}

// Blender 2.47 wrote a sentence without 'comment', which PLY readers skip. The importing library would take a
// comment that begins with an element's name for that element.
TEST_F(MeshImport, SkipsCommentsAndFreeTextInAPlyHeader) {
  for (const std::string line :
       {"Created by Blender3D 247 - www.blender.org, source file: \n", "Created by\ncomment\nsomebody\r\n",
        "comment\n", "comment \n", "comment\r\n", "obj_info\n", "comment TextureFile cube.png\n",
        "comment vertex 9\n", "comment face 9\n", "comment end_header\n", "\n", "vertex 9\n", "-1\n",
        "\x80\xff\x01 \n"}) {
    SCOPED_TRACE("with '" + line + "'");
    TriangleMesh mesh;
    ASSERT_NO_THROW(mesh = import("a.ply", ply_with(line)));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.positions.size(), 4u);
  }
  for (std::size_t before = 2; before < 9; ++before) {
    SCOPED_TRACE("a comment is line " + std::to_string(before + 1));
    for (const std::string line : {"comment\n", "comment face 9\n", "obj_info element face 9\n"}) {
      TriangleMesh mesh;
      ASSERT_NO_THROW(mesh = import("a.ply", ply_with(line, before))) << line;
      EXPECT_EQ(mesh.triangles.size(), 2u) << line;
      EXPECT_EQ(mesh.positions.size(), 4u) << line;
    }
  }
  const TriangleMesh torus = make_torus(1, 0.25f, 16, 8);
  std::string binary = as_binary_ply(torus);
  binary.insert(binary.find("comment"), "Written by hand\n");
  expect_same_triangles(import("torus.ply", binary), torus, 0);
}

TEST_F(MeshImport, ReadsPlyAsBlender247WroteIt) {
  const TriangleMesh torus = make_torus(1, 0.25f, 16, 8);
  std::ostringstream file;
  file.precision(9);
  file << "ply\nformat ascii 1.0\nCreated by Blender3D 247 - www.blender.org, source file: \n"
       << "element vertex " << torus.positions.size();
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "s", "t"}) file << "\nproperty float " << name;
  file << "\nelement face " << torus.triangles.size()
       << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < torus.positions.size(); ++i) {
    file << torus.positions[i].transpose() << ' ' << torus.normals[i].transpose() << " 0.681180 0.275678 \n";
  }
  for (const auto& [a, b, c] : torus.triangles) file << "3 " << a << ' ' << b << ' ' << c << " \n";
  const TriangleMesh mesh = import("torus.ply", file.str());
  expect_same_triangles(mesh, torus, 1e-6f);
  expect_same_normals(mesh, torus, 1e-5f);
}

TEST_F(MeshImport, ReadsPlyInBigEndianOrder) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "element face 1\nproperty list uchar short vertex_index\nend_header\n";
  for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
    std::string raw;
    append(raw, value);
    bytes.append(raw.rbegin(), raw.rend());
  }
  bytes += std::string("\3\0\0\0\1\0\2", 7);
  EXPECT_EQ(import("big.ply", bytes).positions[1], Eigen::Vector3f(1, 0, 0));
}

TEST_F(MeshImport, ReadsObjWithRelativeIndicesPolygonsColoursAndContinuedLines) {
  const TriangleMesh mesh =
      import("odd.obj",
             "v 0 0 0 1 0 0\r\nv +1 0 0\r\nv 1 1e0 0\nv 0 1 0\nvt 0 0\n\ng a b\nusemtl red\ns off\n"
             "f -4/1 -3/1 \\\n -2/1 -1/1\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(bounds(mesh).high, Eigen::Vector3f(1, 1, 0));
}

TEST_F(MeshImport, ReadsObjWithCommentsBehindStatementsAndNumbersThatBeginOrEndWithAPoint) {
  const TriangleMesh mesh =
      import("odd.obj",
             "\xEF\xBB\xBFv -.5 0 0 # left\nv .5 0. 0 #right\nv +.5 1. -0.25\nv -.5e1 .25 1.e0\n"
             "vt .5 .25 # a comment\nf 1/1 2/1 3/1 # 4/1\nf 1/1 3/1 4/1\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(bounds(mesh).low, Eigen::Vector3f(-5, 0, -0.25f));
  EXPECT_EQ(bounds(mesh).high, Eigen::Vector3f(0.5f, 1, 1));
  ASSERT_FALSE(mesh.texture_coordinates.empty());
  EXPECT_EQ(mesh.texture_coordinates[0], Eigen::Vector2f(0.5f, 0.25f));
}

TEST_F(MeshImport, KeepsABoxSharpAndASphereSmooth) {
  const TriangleMesh box = import("box.obj", as_obj(make_box({1, 1, 1}, 0.5f), false));
  EXPECT_GT(worst_normal_cosine(box), 0.9999);
  EXPECT_EQ(box.positions.size(), 6u * 9u);
  const TriangleMesh sphere = import("sphere.obj", as_obj(make_sphere(1, 8), false));
  EXPECT_EQ(sphere.positions.size(), make_sphere(1, 8).positions.size());
  for (std::size_t v = 0; v < sphere.positions.size(); ++v) {
    ASSERT_GT(sphere.normals[v].dot(sphere.positions[v].normalized()), 0.9999f);
  }
}

TEST_F(MeshImport, MakesNormalsWhereTheFileHasUselessOnes) {
  const TriangleMesh mesh = import("zero.obj", kTriangle + "vn 0 0 0\nf 1//1 2//1 3//1\n");
  for (const Eigen::Vector3f& n : mesh.normals) EXPECT_EQ(n, Eigen::Vector3f(0, 0, 1));
}

TEST_F(MeshImport, MakesUnitNormalsOfTheLongestAndThinnestTriangle) {
  const TriangleMesh mesh = import("needle.obj", "v 0 0 0\nv 3e38 0 0\nv 3e38 1.4e-45 0\nf 1 2 3\n");
  ASSERT_EQ(mesh.normals.size(), 3u);
  for (const Eigen::Vector3f& normal : mesh.normals) EXPECT_EQ(normal, Eigen::Vector3f::UnitZ());
}

TEST_F(MeshImport, DropsTrianglesWithoutArea) {
  EXPECT_EQ(import("a.obj", kTriangle + "v 2 0 0\nf 1 2 3\nf 1 2 2\nf 1 2 4\n").triangles.size(), 1u);
}

TEST_F(MeshImport, LooksForNoMaterialsWhateverTheirNames) {
  // The library clears such names of their detours, and wrote before the beginning of this one.
  const std::string no_name =
      "mtllib a:::::::::::://////////:::://////////:::://////////////////a::::/1///////:/::::"
      "::::::::::::::::::///////////////////$clr.zmbi3 4\n";
  const std::string groups = "g a\nusemtl b\nl 1 2\np 1\n";
  EXPECT_EQ(hash(import("a.obj", kTriangle + no_name + groups + "f 1 2 3\n" + no_name)),
            hash(import("b.obj", kTriangle + "f 1 2 3\n")));
}

TEST_F(MeshImport, GivesTheSameBitsAgain) {
  const std::string text = as_obj(make_car(1), false);
  EXPECT_EQ(hash(import("a.obj", text)), hash(import("b.obj", text)));
}

TEST_F(MeshImport, ReadsAMeshThatNobodyHereModelled) {
  const fs::path bunny = "/usr/share/glmark2/models/bunny.obj";  // Debian package glmark2-data, GPL-3+
  if (!fs::exists(bunny)) GTEST_SKIP() << "install glmark2-data for " << bunny;
  const auto start = std::chrono::steady_clock::now();
  const TriangleMesh mesh = import_mesh(bunny);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(seconds.count()));
  EXPECT_EQ(mesh.triangles.size(), 69666u);
  EXPECT_GE(mesh.positions.size(), 34835u);
  EXPECT_LT(mesh.positions.size(), 37000u);  // creases
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_GT(volume(mesh), 0);
}

// --- what is refused
// --------------------------------------------------------------------------------------------------------

TEST_F(MeshImport, RefusesWhatIsNoMeshFile) {
  expect_path_refused(folder_ / "none.obj", "there is no such file");
  fs::create_directories(folder_ / "folder.obj");
  expect_path_refused(folder_ / "folder.obj", "it is a directory");
  expect_path_refused("/dev/null.obj", "there is no such file");
  for (const char* name : {"a.obj", "a.ply", "a.stl"}) expect_refused(name, "", "it is empty");
  expect_refused("a.fbx", "x", "its extension '.fbx' is not one of .gltf, .glb, .obj, .ply, .stl");
  expect_refused("noextension", "x", "its extension '' is not one of");
}

TEST_F(MeshImport, RefusesAFormatUnderAnotherName) {
  const TriangleMesh sphere = make_sphere(1, 2);
  expect_refused("stl.obj", as_text_stl(sphere), "'solid' is not a statement");
  expect_refused("ply.obj", as_binary_ply(sphere), "it holds binary data");
  expect_refused("obj.ply", as_obj(sphere, false), "its first line is not 'ply'");
  expect_refused("obj.stl", "v 0 0 0\n", "it is neither");
  expect_refused("off.obj", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "'OFF' is not a statement");
}

TEST_F(MeshImport, RefusesBinaryGarbage) {
  std::string garbage;
  std::uint32_t state = 1;
  for (int i = 0; i < 5000; ++i) garbage += static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
  expect_refused("garbage.obj", garbage, "it holds binary data");
  expect_refused("garbage.ply", garbage, "its first line is not 'ply'");
  expect_refused("garbage.stl", garbage, "its header promises");
}

TEST_F(MeshImport, RefusesBrokenObj) {
  expect_refused("a.obj", kTriangle + "f 1 2 4\n", "a face names vertex 4, but the file has 3");
  expect_refused("a.obj", kTriangle + "f 1 2 99999999999\n", "a face names vertex 99999999999");
  expect_refused("a.obj", kTriangle + "f 1 2 99999999999999999999\n",
                 "line 4: '99999999999999999999' is not a whole number");
  expect_refused("a.obj", kTriangle + "f 0 1 2\n", "line 4: a face has index 0");
  expect_refused("a.obj", kTriangle + "f -1 -2 -4\n", "line 4: index -4 points before the first of 3");
  expect_refused("a.obj", kTriangle + "f 1//1 2//1 3//1\n", "a face names normal 1, but the file has 0");
  expect_refused("a.obj", kTriangle + "f 1 2\n", "line 4: a face has 2 corners");
  expect_refused("a.obj", kTriangle + "f\n", "line 4: a face has 0 corners");
  expect_refused("a.obj", kTriangle + "f 1 2 3/\n", "'' is not a whole number");
  expect_refused("a.obj", kTriangle + "f 1 2 x\n", "'x' is not a whole number");
  expect_refused("a.obj", "v 0 0\n", "line 1: 'v' is followed by 2 numbers");
  expect_refused("a.obj", kTriangle + "v 0 0 nan\nf 1 2 3\n", "line 4: 'nan' is not a finite number");
  expect_refused("a.obj", kTriangle + "v 0 -inf 0\nf 1 2 3\n", "'-inf' is not a finite number");
  expect_refused("a.obj", kTriangle + "v 0 1e39 0\nf 1 2 3\n", "'1e39' is not a finite number");
  expect_refused("a.obj", kTriangle + "v 0 1,5 0\nf 1 2 3\n", "'1,5' is not a number");
  expect_refused("a.obj", kTriangle, "it has no faces");
  expect_refused("a.obj", kTriangle + "l 1 2 3\np 1\n", "it has no faces");
  expect_refused("a.obj", kTriangle + "f 1 1 2\nf 3 3 3\n", "all its triangles have area zero");
  expect_refused("a.obj", kTriangle + "cstype bezier\n", "line 4: 'cstype' is not a statement");
  std::string polygon = kTriangle + "f";
  for (int i = 0; i < 100; ++i) polygon += " 1 2 3";
  expect_refused("a.obj", polygon, "line 4: a face has more than 255 corners");
}

// An OBJ file promises no count, so only a cut inside a line, or before the faces, can be seen.
TEST_F(MeshImport, RefusesACutOffObj) {
  expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1", "line 3: 'v' is followed by 2 numbers");
  expect_refused("a.obj", "v 0 0 0\nv 1 0 0\n", "it has no faces");
  expect_refused("a.obj", kTriangle + "f 1 2 3\nf 1 3", "line 5: a face has 2 corners");
}

TEST_F(MeshImport, RefusesEveryCutOfTheFormatsThatPromiseCounts) {
  const TriangleMesh cube = make_sphere(1, 1);
  const std::string binary_ply = as_binary_ply(cube), binary_stl = as_binary_stl(cube),
                    text_stl = as_text_stl(cube);
  constexpr std::size_t kNext = kSlowBuild ? 7 : 1;
  for (std::size_t size = 1; size < binary_ply.size(); size += kNext) {
    EXPECT_THROW(import("cut.ply", binary_ply.substr(0, size)), std::runtime_error) << size;
  }
  for (std::size_t size = 1; size < binary_stl.size(); size += kNext) {
    EXPECT_THROW(import("cut.stl", binary_stl.substr(0, size)), std::runtime_error) << size;
  }
  for (std::size_t size = 1; size < text_stl.rfind("endsolid") + 8; size += kNext) {
    EXPECT_THROW(import("cut.stl", text_stl.substr(0, size)), std::runtime_error) << size;
  }
}

TEST_F(MeshImport, RefusesBrokenTextPly) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  expect_refused("a.ply", ply("3", "1", points + "3 0 1 3\n"), "face 0: index 3 is outside the 3 vertices");
  expect_refused("a.ply", ply("3", "1", points + "3 0 1 -1\n"), "face 0: index -1 is outside");
  expect_refused("a.ply", ply("3", "1", points + "2 0 1\n"), "face 0: a face has 2 corners");
  expect_refused("a.ply", ply("3", "1", points + "300 0 1\n"), "'300' is out of its type's range");
  expect_refused("a.ply", ply("3", "1", points + "3 0 1\n"), "there are fewer values than properties");
  expect_refused("a.ply", ply("3", "1", points + "3 0 1 2 0\n"), "there are more values than properties");
  expect_refused("a.ply", ply("4", "1", points + "3 0 1 2\n"), "there are more values than properties");
  expect_refused("a.ply", ply("3", "2", points + "3 0 1 2\n"), "it ends before all the elements");
  expect_refused("a.ply", ply("3", "1", points + "3 0 1 2\n3 0 1 2\n"), "there is more after the elements");
  expect_refused("a.ply", ply("3", "1", "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n"), "'nan' is not a finite number");
  expect_refused("a.ply", ply("3", "1", "0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n"), "'inf' is not a finite number");
  expect_refused("a.ply", ply("3", "0", points), "it has no faces");
  expect_refused("a.ply", ply("4000000000", "1", points), "more than the file has bytes for");
  expect_refused("a.ply", ply("-3", "1", points), "an element's count is negative");
}

TEST_F(MeshImport, RefusesBrokenPlyHeaders) {
  expect_refused("a.ply", "ply\n", "its header has no end");
  expect_refused("a.ply", "ply\nformat ascii 2.0\nend_header\n", "line 2: 'format ascii 1.0'");
  expect_refused("a.ply", "ply\nformat middle_endian 1.0\nend_header\n", "'middle_endian' is not a format");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nend_header\n", "it declares no element 'vertex'");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n", "'element NAME COUNT'");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty half y\n",
                 "'half' is not a type");
  expect_refused("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n",
                 "no property 'z'");
  expect_refused(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n0 0 0\n",
      "it declares no element 'face'");
  expect_refused(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty int vertex_indices\nend_header\n0 0 0\n3\n",
      "no list of whole numbers 'vertex_indices'");
  // The library takes the last of both, and stops the program at a face without corners.
  const std::string vertices =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string list = "property list uchar int ", points = "0 0 0\n1 0 0\n0 1 0\n";
  expect_refused("a.ply",
                 vertices + "element face 1\n" + list + "vertex_indices\n" + list +
                     "vertex_index\nend_header\n" + points + "3 0 1 2 0\n",
                 "both 'vertex_indices' and 'vertex_index'");
  expect_refused("a.ply",
                 vertices + "element face 1\n" + list + "vertex_indices\nelement tristrips 1\n" + list +
                     "vertex_indices\nend_header\n" + points + "3 0 1 2\n3 0 1 2\n",
                 "triangle strips");
}

// Skipped, such lines would make a file mean something else.
TEST_F(MeshImport, RefusesFreeTextInAPlyHeaderThatCouldBeADeclaration) {
  const std::string expected = "'element NAME COUNT', 'property TYPE NAME' or";
  for (std::size_t before = 3; before < 9; ++before) {
    expect_refused("a.ply", ply_with("propety float red\n", before),
                   "line " + std::to_string(before + 1) + ": " + expected);
  }
  expect_refused("a.ply", ply_with("format binary_little_endian 1.0\n"), "line 3: " + expected);
  expect_refused("a.ply", ply_with("ply\n"), "line 3: " + expected);
  expect_refused("a.ply", ply_with("element of surprise\n"), "line 3: 'surprise' is not a whole number");
  expect_refused("a.ply", ply_with("property of somebody else\n"), "line 3: " + expected);
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelemnt vertex 3\nproperty float x\n",
                 "line 4: " + expected);
  expect_refused("a.ply", "ply\nformat ascii 1.0\n" + std::string(100'000, 'x'), "its header has no end");
}

TEST_F(MeshImport, RefusesBrokenBinaryPly) {
  const std::string whole = as_binary_ply(make_sphere(1, 2));
  for (const std::size_t missing : {1u, 13u, 100u}) {
    expect_refused("a.ply", whole.substr(0, whole.size() - missing), "it ends before all the elements");
  }
  expect_refused("a.ply", whole + "x", "it has 1 bytes more than its header promises");
  std::string nan = whole;
  const float value = NAN;
  std::memcpy(nan.data() + whole.find("end_header\n") + 11, &value, sizeof value);
  expect_refused("a.ply", nan, "vertex 0: x is not a finite number");
  std::string index = whole;
  index[index.size() - 1] = 0x7f;
  expect_refused("a.ply", index, "is outside the 26 vertices");
}

TEST_F(MeshImport, RefusesBrokenBinaryStl) {
  const std::string whole = as_binary_stl(make_sphere(1, 2));
  expect_refused("a.stl", whole.substr(0, whole.size() - 50),
                 "its header promises 48 triangles in 2484 bytes, but the file has 2434");
  expect_refused("a.stl", whole.substr(0, 60), "it is neither");
  std::string many = whole;
  many[83] = 0x7f;
  expect_refused("a.stl", many, "its header promises 2130706480 triangles");
  std::string nan = whole;
  const float value = INFINITY;
  std::memcpy(nan.data() + 84 + 50 + 12, &value, sizeof value);
  expect_refused("a.stl", nan, "triangle 1 has a coordinate that is not finite");
  std::string none(84, '\0');
  expect_refused("a.stl", none, "it has no faces");
}

TEST_F(MeshImport, RefusesBrokenTextStl) {
  const std::string whole = as_text_stl(make_sphere(1, 2));
  const std::size_t end = whole.rfind("endsolid");
  expect_refused("a.stl", whole.substr(0, end), "it ends in the middle of a solid");
  expect_refused("a.stl", "solid a\nendsolid a\n", "it has no faces");
  expect_refused(
      "a.stl",
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
      "line 6: 'vertex' was expected");
  expect_refused("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n",
                 "line 4: three coordinates were expected");
  expect_refused("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n",
                 "line 4: 'nan' is not a finite number");
}

TEST(Fit, CentresAndScales) {
  TriangleMesh mesh = make_box({2, 4, 8}, 2);
  for (Eigen::Vector3f& p : mesh.positions) p += Eigen::Vector3f(10, -20, 30);
  fit(mesh, 2);
  EXPECT_EQ(bounds(mesh).low, Eigen::Vector3f(-0.25f, -0.5f, -1));
  EXPECT_EQ(bounds(mesh).high, Eigen::Vector3f(0.25f, 0.5f, 1));
}

}  // namespace
}  // namespace softcell::ppu
