// glTF files, written by hand.

#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "gltf_builder.h"
#include "ppu/mesh_import/parse_mesh.h"
#include "ppu/mesh_import/picture.h"
#include "softcell/mesh_import/mesh_import.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

/// A square in the plane z = 0, of two triangles with normals along z.
struct Square : GltfBuilder {
  std::uint32_t position = add_floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
  std::uint32_t normal = add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  std::uint32_t texture = add_floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
  std::uint32_t indices = add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 5123, 1);

  static std::string primitive(const std::string& more = "") {
    return R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3)" + more + "}";
  }
  /// One node with one mesh of one such primitive.
  static std::string alone(const std::string& more = "", const std::string& rest = "") {
    return R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[)" + primitive(more) + "]}]" + rest;
  }
};

TriangleMesh parse(const std::string& file, std::vector<std::string>* not_read = nullptr) {
  return parse_mesh(file, MeshFormat::kGltf, nullptr, not_read);
}

std::string refusal(const std::string& file) {
  try {
    parse(file);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "(imported)";
}

std::string png_of(int width, int height, const std::vector<std::uint8_t>& rgba) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width);
  png.height = static_cast<png_uint_32>(height);
  png.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = 0;
  png_image_write_get_memory_size(png, size, 0, rgba.data(), 0, nullptr);
  std::string bytes(size, '\0');
  png_image_write_to_memory(&png, bytes.data(), &size, 0, rgba.data(), 0, nullptr);
  bytes.resize(size);
  return bytes;
}

std::string jpeg_of(int width, int height, const std::vector<std::uint8_t>& rgba) {
  const tjhandle jpeg = tjInitCompress();
  unsigned char* data = nullptr;
  unsigned long size = 0;
  tjCompress2(jpeg, rgba.data(), width, 0, height, TJPF_RGBA, &data, &size, TJSAMP_444, 95, 0);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  tjFree(data);
  tjDestroy(jpeg);
  return bytes;
}

const std::vector<std::uint8_t> kTwoPixels{255, 0, 0, 255, 0, 0, 255, 128};

TEST(GltfImport, AFileHasTheSameMeshAsTextAndAsBytes) {
  const Square square;
  const TriangleMesh mesh = parse(square.gltf(Square::alone()));
  EXPECT_EQ(mesh.positions,
            (std::vector{Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(1, 1, 0), Vector3f(0, 1, 0)}));
  EXPECT_EQ(mesh.normals, std::vector(4, Vector3f(0, 0, 1)));
  // v grows downwards in the file and upwards here.
  EXPECT_EQ(mesh.texture_coordinates,
            (std::vector{Vector2f(0, 0), Vector2f(1, 0), Vector2f(1, 1), Vector2f(0, 1)}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(mesh.materials.empty());
  validate(mesh);
  EXPECT_EQ(parse(square.glb(Square::alone())), mesh);
  EXPECT_EQ(parse("\xEF\xBB\xBF" + square.gltf(Square::alone())), mesh);
}

TEST(GltfImport, NodesMoveTurnAndScaleWhatIsBelowThem) {
  const Square square;
  // Turned by 90 degrees about z, then doubled along y, then moved: as matrix and as parts.
  const float r = std::sqrt(0.5f);
  const std::string parts =
      R"("nodes":[{"name":"far","children":[1],"translation":[10,0,0],"scale":[1,2,1]},{"name":"turned","mesh":0,"rotation":[0,0,)" +
      std::to_string(r) + "," + std::to_string(r) + R"(]}],"meshes":[{"primitives":[)" + Square::primitive() +
      "]}]";
  const TriangleMesh mesh = parse(square.gltf(parts));
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_LT((mesh.positions[1] - Vector3f(10, 2, 0)).norm(), 1e-5f);  // was x
  EXPECT_LT((mesh.positions[3] - Vector3f(9, 0, 0)).norm(), 1e-5f);   // was y
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0].object, "turned");
  const std::string matrix =
      R"("nodes":[{"mesh":0,"matrix":[0,2,0,0,-1,0,0,0,0,0,1,0,10,0,0,1]}],"meshes":[{"primitives":[)" +
      Square::primitive() + "]}]";
  const TriangleMesh same = parse(square.gltf(matrix));
  for (std::size_t v = 0; v < 4; ++v) EXPECT_LT((same.positions[v] - mesh.positions[v]).norm(), 1e-5f) << v;
}

TEST(GltfImport, AMirroredNodeKeepsItsOutsideOutside) {
  const Square square;
  const TriangleMesh mesh = parse(square.gltf(
      R"("nodes":[{"mesh":0,"scale":[-1,1,1]}],"meshes":[{"primitives":[)" + Square::primitive() + "]}]"));
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3f across =
        (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    EXPECT_GT(across.z(), 0);
    EXPECT_EQ(mesh.normals[a], Vector3f(0, 0, 1));
  }
}

TEST(GltfImport, AMeshThatTwoNodesShareIsThereTwice) {
  const Square square;
  const std::string two =
      R"("nodes":[{"mesh":0},{"mesh":0,"translation":[0,0,3]}],"meshes":[{"name":"s","primitives":[)" +
      Square::primitive() + "]}]";
  EXPECT_EQ(parse(square.gltf(two)).triangles.size(), 4u);
  EXPECT_EQ(parse(square.gltf(two)).parts[1], (MeshPart{"s", std::nullopt, 2, 2}));
  // Only what is in the scene.
  EXPECT_EQ(
      parse(square.gltf(two + R"(,"scene":1,"scenes":[{"nodes":[0,1]},{"nodes":[1]}])")).triangles.size(),
      2u);
}

TEST(GltfImport, StripsFansAndCornersInARow) {
  GltfBuilder file;
  file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3);
  file.add_floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
  const auto mesh_of_mode = [&](const std::string& primitive) {
    return parse(file.gltf(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[)" + primitive + "]}]"));
  };
  for (const char* const primitive :
       {R"({"attributes":{"POSITION":0},"mode":5})", R"({"attributes":{"POSITION":1},"mode":6})"}) {
    const TriangleMesh mesh = mesh_of_mode(primitive);
    ASSERT_EQ(mesh.triangles.size(), 2u) << primitive;
    for (const Vector3f& normal : mesh.normals) EXPECT_EQ(normal, Vector3f(0, 0, 1)) << primitive;
  }
}

TEST(GltfImport, NumbersOfAllTypesAndSparseOnes) {
  GltfBuilder file;
  file.add<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 127, 127, 0, 0}, "VEC3", 5120, 3, R"(,"normalized":true)");
  file.add<std::uint8_t>({0, 1, 2}, "SCALAR", 5121, 1);
  file.add<std::uint16_t>({0, 65535, 0, 65535, 0, 0, 0, 65535, 0, 65535, 0, 0, 0, 0, 0, 0}, "VEC4", 5123, 4,
                          R"(,"normalized":true)");
  file.add_floats({0, 0, 5}, "VEC3", 3);
  // The first accessor has elements of three bytes; the last vertex of the fifth accessor is a sparse one.
  std::string text = file.gltf(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":4,"COLOR_0":2},"indices":1}]}])");
  const std::string more =
      R"(,{"bufferView":4,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,"byteOffset":2,"componentType":5121},"values":{"bufferView":3}}}])";
  // A view for it, close behind the others: three corners and one that the sparse element replaces.
  file.add_floats({0, 0, 0, 1, 0, 0, 9, 9, 9, 0, 0, 0}, "VEC3", 3);
  text = file.gltf(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":5,"COLOR_0":2},"indices":1}]}])");
  const std::size_t end = text.find("],\"nodes\"");
  ASSERT_NE(end, std::string::npos);
  text.replace(end, 1, more);
  const TriangleMesh mesh = parse(text);
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[2], Vector3f(0, 0, 5));
  EXPECT_EQ(mesh.colours[0], Vector4f(0, 1, 0, 1));
  EXPECT_EQ(mesh.colours[2], Vector4f(0, 1, 0, 0));
  EXPECT_EQ(mesh.colours[1], Vector4f(0, 0, 0, 1));
}

TEST(GltfImport, MaterialsHaveFactorsTexturesAndModes) {
  Square square;
  const std::string png = png_of(2, 1, kTwoPixels);
  const std::uint32_t view = square.add_bytes(png);
  const std::string rest =
      R"(,"materials":[{"name":"unused"},{"name":"paint","emissiveFactor":[0,0.21404114,1],"emissiveTexture":{"index":0},"doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
      "pbrMetallicRoughness":{"baseColorFactor":[1,0.21404114,0,0.5],"baseColorTexture":{"index":0},"metallicFactor":0.25,
      "roughnessFactor":0.75,"metallicRoughnessTexture":{"index":1}},"normalTexture":{"index":0,"scale":0.5}}],
      "textures":[{"source":0,"sampler":0},{"source":1}],"samplers":[{"wrapS":33071,"wrapT":33648}],
      "images":[{"bufferView":)" +
      std::to_string(view) + R"(,"mimeType":"image/png"},{"uri":"data:image/jpeg;base64,)" +
      base64(jpeg_of(2, 1, kTwoPixels)) + R"("}])";
  std::vector<std::string> not_read;
  const TriangleMesh mesh = parse(square.glb(Square::alone(R"(,"material":1)", rest)), &not_read);
  EXPECT_TRUE(not_read.empty());
  ASSERT_EQ(mesh.materials.size(), 1u);
  const MeshMaterial& material = mesh.materials[0];
  EXPECT_EQ(mesh.parts[0].material, 0u);
  EXPECT_EQ(material.name, "paint");
  ASSERT_TRUE(material.base_colour);
  // 0.214 in linear light is the middle of the sRGB range.
  EXPECT_LT((*material.base_colour - Vector4f(1, 0.5f, 0, 0.5f)).norm(), 1e-5f);
  ASSERT_TRUE(material.base_texture.picture);
  EXPECT_EQ(*material.base_texture.picture, (MeshPicture{2, 1, kTwoPixels}));
  EXPECT_EQ(material.base_texture.picture, material.normal_texture.picture);
  EXPECT_EQ(material.base_texture.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(material.base_texture.wrap_v, TextureWrap::kMirror);
  EXPECT_EQ(material.metallic, 0.25f);
  EXPECT_EQ(material.roughness, 0.75f);
  ASSERT_TRUE(material.metallic_roughness_texture.picture);
  EXPECT_NEAR(material.metallic_roughness_texture.picture->rgba[0], 255, 3);
  EXPECT_EQ(material.normal_scale, 0.5f);
  EXPECT_LT((material.emission - Vector3f(0, 0.5f, 1)).norm(), 1e-5f);
  EXPECT_EQ(material.emission_texture.picture, material.base_texture.picture);
  EXPECT_EQ(material.alpha, MeshAlpha::kMask);
  EXPECT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_TRUE(material.two_sided);
  EXPECT_TRUE(material.has_looks());
  EXPECT_EQ(parse(square.glb(Square::alone(R"(,"material":1)", rest))), mesh) << "equal by content";
}

TEST(GltfImport, TextureCoordinatesAreTransformed) {
  Square square;
  const std::string view = std::to_string(square.add_bytes(png_of(2, 1, kTwoPixels)));
  const auto coordinates = [&](const std::string& transform) {
    return parse(
               square.glb(Square::alone(
                   R"(,"material":0)",
                   R"(,"extensionsRequired":["KHR_texture_transform"],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,
                     "extensions":{"KHR_texture_transform":)" +
                       transform + R"(}}}}],"textures":[{"source":0}],"images":[{"bufferView":)" + view +
                       "}]")))
        .texture_coordinates;
  };
  // The corners of the square in glTF's own coordinates, v downwards: (0, 1), (1, 1), (1, 0), (0, 0).
  EXPECT_EQ(coordinates(R"({"offset":[0.5,0.25],"scale":[2,4]})"),
            (std::vector{Vector2f(0.5f, -3.25f), Vector2f(2.5f, -3.25f), Vector2f(2.5f, 0.75f),
                         Vector2f(0.5f, 0.75f)}));
  // A quarter counter-clockwise as one sees the picture: u goes to where v was smaller.
  const auto turned = coordinates(R"({"rotation":1.5707963267948966})");
  EXPECT_LT((turned[0] - Vector2f(1, 1)).norm(), 1e-6f) << turned[0].transpose();
  EXPECT_LT((turned[2] - Vector2f(0, 2)).norm(), 1e-6f) << turned[2].transpose();
}

TEST(GltfImport, WhatIsNotReadIsSaid) {
  Square square;
  const std::uint32_t webp = square.add_bytes("RIFF....WEBP");
  std::vector<std::string> not_read;
  const std::string rest =
      R"(,"animations":[{}],"skins":[{}],"materials":[{"emissiveFactor":[0,0,0],"occlusionTexture":{"index":0},
    "pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"extensions":{"KHR_materials_sheen":{}}}],
    "textures":[{"source":0}],"images":[{"bufferView":)" +
      std::to_string(webp) + "}]";
  parse(square.glb(Square::alone(R"(,"material":0,"targets":[{"POSITION":0}])", rest)), &not_read);
  EXPECT_EQ(not_read,
            (std::vector<std::string>{"animations", "skins", "morph targets",
                                      "the picture images[0], which is neither PNG nor JPEG",
                                      "the extension 'KHR_materials_sheen'", "occlusion textures"}));
}

TEST(GltfImport, TheModelBeforeMetallicRoughnessGivesItsColours) {
  const Square square;
  const TriangleMesh mesh = parse(square.gltf(Square::alone(
      R"(,"material":0)",
      R"(,"materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0,1,0,1],"glossinessFactor":0.25}}}])")));
  EXPECT_EQ(mesh.materials.at(0).base_colour, Vector4f(0, 1, 0, 1));
  EXPECT_EQ(mesh.materials.at(0).metallic, 0);
  EXPECT_EQ(mesh.materials.at(0).roughness, 0.75f);
}

TEST(GltfImport, WrongFilesAreRefusedInOneSentence) {
  const Square square;
  const auto with = [&](const std::string& rest) { return refusal(square.gltf(rest)); };
  const auto primitive = [&](const std::string& fields) {
    return with(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[)" + fields + "]}]");
  };
  EXPECT_EQ(
      refusal("{"),
      "its JSON cannot be read: parse error at line 1, column 2: syntax error while parsing object key - "
      "unexpected end of input; expected string literal");
  EXPECT_EQ(refusal("[]"), "its JSON is not an object");
  EXPECT_EQ(refusal("{}"), "it has no 'asset'");
  EXPECT_EQ(refusal(R"({"asset":{"version":"1.0"}})"), "it is of version '1.0' of glTF; 2.0 was expected");
  EXPECT_EQ(refusal(std::string(100, '[') + std::string(100, ']')), "its JSON is nested more than 32 deep");
  EXPECT_EQ(with(R"("nodes":[])"), "it has no triangles in its scene; a mesh of triangles was expected");
  EXPECT_EQ(with(R"("nodes":[{"mesh":0}])"), "nodes[0].mesh is 0, but the file has 0 meshes");
  EXPECT_EQ(with(R"("nodes":[{"children":[1]},{"children":[0]}],"scenes":[{"nodes":[0]}])"),
            "nodes[0]: it is the child of two nodes, or of itself");
  EXPECT_EQ(with(R"("nodes":[{"rotation":[0,0,0,0],"mesh":0}],"meshes":[{}])"),
            "nodes[0]: its rotation is not a quaternion of length 1");
  EXPECT_EQ(with(R"("nodes":[{"matrix":[1]}])"), "nodes[0].matrix does not have 16 finite numbers");
  EXPECT_EQ(with(R"("extensionsRequired":["KHR_draco_mesh_compression"])"),
            "it requires the extension 'KHR_draco_mesh_compression', which softcell does not read; export "
            "it without "
            "compression and the like");
  EXPECT_EQ(primitive("{}"), "meshes[0].primitives[0]: it has no 'attributes'");
  EXPECT_EQ(primitive(R"({"attributes":{"POSITION":9}})"),
            "meshes[0].primitives[0].attributes.POSITION is 9, but the file has 4 accessors");
  EXPECT_EQ(primitive(R"({"attributes":{"POSITION":2}})"),
            "meshes[0].primitives[0].attributes: its POSITION has 2 numbers an element");
  EXPECT_EQ(primitive(R"({"attributes":{"POSITION":0},"indices":1})"),
            "meshes[0].primitives[0]: its indices, accessors[1], are not whole numbers of 0 or more");
  EXPECT_EQ(primitive(R"({"attributes":{"POSITION":0},"mode":7})"),
            "meshes[0].primitives[0].mode is 7; it may be at most 6");
  EXPECT_EQ(primitive(R"({"attributes":{"POSITION":0}})"),
            "meshes[0].primitives[0]: its 4 corners make no whole number of triangles");
  EXPECT_EQ(with(Square::alone(R"(,"material":0)", R"(,"materials":[{"alphaMode":"GLASS"}])")),
            "materials[0]: its alphaMode is 'GLASS'; OPAQUE, MASK or BLEND was expected");
  EXPECT_EQ(with(Square::alone(R"(,"material":0)",
                               R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":2}}])")),
            "materials[0].pbrMetallicRoughness.metallicFactor is 2; a number from 0.0 to 1.0 was expected");
}

TEST(GltfImport, BytesThatAreNotThereAreRefused) {
  Square square;
  std::string glb = square.glb(Square::alone());
  EXPECT_EQ(refusal(glb.substr(0, 11)), "it ends within its header");
  EXPECT_EQ(refusal(glb.substr(0, glb.size() - 1)).substr(0, 12), "it is to hav");
  std::string older = glb;
  older[4] = 1;
  EXPECT_EQ(refusal(older), "it is of version 1 of glTF; 2 was expected");
  std::string text = square.gltf(Square::alone());
  const auto replaced = [&](const std::string& what, const std::string& by) {
    std::string changed = text;
    changed.replace(changed.find(what), what.size(), by);
    return refusal(changed);
  };
  EXPECT_EQ(replaced(R"("byteOffset":0,"byteLength":48)", R"("byteOffset":200,"byteLength":48)"),
            "bufferViews[0] reaches from byte 200 to 248 of 140");
  EXPECT_EQ(replaced(R"("count":4,"type":"VEC3")", R"("count":5,"type":"VEC3")"),
            "accessors[0] reaches from byte 0 to 60 of 48");
  EXPECT_EQ(replaced(R"("count":4,"type":"VEC3")", R"("count":1000000000000,"type":"VEC3")").substr(0, 41),
            "accessors[0] reaches from byte 0 to 12000");
  EXPECT_EQ(replaced(R"("componentType":5126)", R"("componentType":5130)"),
            "accessors[0].componentType is 5130, which glTF does not have");
  EXPECT_EQ(replaced("base64,", "base64,!"), "buffers[0] holds data that are not base64");
  EXPECT_EQ(replaced("\"count\":6", "\"count\":-6"), "accessors[3].count is not a whole number of 0 or more");
}

TEST(GltfImport, AnIndexBeyondTheVerticesIsRefused) {
  GltfBuilder file;
  file.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  file.add<std::uint32_t>({0, 1, 3}, "SCALAR", 5125, 1);
  EXPECT_EQ(
      refusal(file.gltf(
          R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])")),
      "meshes[0].primitives[0]: its index 2 is 3, but it has 3 vertices");
}

TEST(GltfImport, CoordinatesThatAreNotFiniteAreRefused) {
  GltfBuilder file;
  file.add_floats({0, 0, 0, 1, 0, 0, 0, INFINITY, 0}, "VEC3", 3);
  EXPECT_EQ(
      refusal(file.gltf(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])")),
      "it has coordinates that are not finite");
}

TEST(Pictures, PngAndJpegAreDecoded) {
  const std::vector<std::uint8_t> grey{10, 20, 30, 255, 10, 20, 30, 255};
  EXPECT_EQ(*decode_picture(png_of(2, 1, kTwoPixels), 100), (MeshPicture{2, 1, kTwoPixels}));
  const auto jpeg = decode_picture(jpeg_of(2, 1, grey), 100);
  ASSERT_EQ(jpeg->rgba.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(jpeg->rgba[i], grey[i], 3) << i;
}

TEST(Pictures, DamagedAndLargeOnesAreRefused) {
  const auto problem = [](const std::string& bytes, std::size_t most) -> std::string {
    try {
      decode_picture(bytes, most);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "(decoded)";
  };
  const std::string png = png_of(2, 1, kTwoPixels), jpeg = jpeg_of(2, 1, kTwoPixels);
  EXPECT_EQ(problem("GIF89a", 100), "it is neither a PNG nor a JPEG file");
  EXPECT_EQ(problem(png.substr(0, png.size() - 20), 100).substr(0, 24), "it is a damaged PNG file");
  EXPECT_EQ(problem(jpeg.substr(0, jpeg.size() / 2), 100).substr(0, 25), "it is a damaged JPEG file");
  EXPECT_EQ(problem(jpeg.substr(0, 30), 100).substr(0, 25), "it is a damaged JPEG file");
  EXPECT_EQ(
      problem(png, 1),
      "it has 2 by 1 pixels; a side may have at most 16384, and a model's pictures together 64 million");
  EXPECT_EQ(problem(jpeg, 1).substr(0, 19), "it has 2 by 1 pixel");
}

class ModelFolder : public testing::Test {
 protected:
  ModelFolder()
      : home_(std::filesystem::temp_directory_path() /
              ("softcell_model_folder_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(home_ / "model" / "maps");
  }
  ~ModelFolder() override { std::filesystem::remove_all(home_); }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(home_ / name, std::ios::binary) << bytes;
    return home_ / name;
  }
  std::filesystem::path home_;
};

TEST_F(ModelFolder, BuffersAndPicturesLieBesideTheFileOrBelow) {
  const Square square;
  const auto bin = write("model/its data.bin", square.bytes());
  const auto png = write("model/maps/two.png", png_of(2, 1, kTwoPixels));
  const std::string rest = Square::alone(
      R"(,"material":0)", R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
    "textures":[{"source":0}],"images":[{"uri":"maps/two.png"}])");
  const auto model = write("model/square.gltf", square.gltf_beside("its%20data.bin", rest));
  ImportReport report;
  const TriangleMesh mesh = import_mesh(model, &report);
  EXPECT_EQ(mesh.materials.at(0).base_texture.file, "maps/two.png");
  ASSERT_TRUE(mesh.materials.at(0).base_texture.picture);
  EXPECT_TRUE(report.not_read.empty());
  EXPECT_EQ(report.files, (std::vector<std::filesystem::path>{model, png, bin}));
}

TEST_F(ModelFolder, NothingOutsideTheFolderIsOpened) {
  Square square;
  const std::string png = png_of(2, 1, kTwoPixels);
  const auto outside = write("outside.png", png);
  write("outside.bin", square.bytes());
  std::filesystem::create_symlink(outside, home_ / "model" / "link.png");
  const auto pictures = [&](const std::string& name) {
    ImportReport report;
    const auto model = write(
        "model/square.gltf",
        square.gltf(Square::alone(
            R"(,"material":0)",
            R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],"images":[{"uri":")" +
                name + R"("}])")));
    EXPECT_FALSE(import_mesh(model, &report).materials.at(0).base_texture.picture) << name;
    EXPECT_EQ(report.files, std::vector{model}) << name;
    return report.not_read.size();
  };
  for (const std::string& name :
       {std::string("../outside.png"), outside.string(), std::string("link.png"),
        std::string("maps/../../outside.png"), std::string("%2e%2e/outside.png"),
        std::string("https://example.org/a.png"), std::string("none.png"), std::string("maps")})
    EXPECT_EQ(pictures(name), 1u) << name;
  const auto model = write("model/square.gltf", square.gltf_beside("../outside.bin", Square::alone()));
  try {
    import_mesh(model);
    FAIL() << "imported";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "cannot import the mesh " + model.string() +
                                ": buffers[0]: '../outside.bin' is no file in the model's folder or below");
  }
}

TEST_F(ModelFolder, AnObjFileHasPicturesOfItsMaterialLibrary) {
  write("model/maps/two.png", png_of(2, 1, kTwoPixels));
  write("model/paint.mtl",
        "newmtl skin\nKd 0 0 0\nmap_Kd maps\\two.png\nd 0.5\nPr 0.25\nPm 1\nnewmtl gone\nmap_Kd gone.jpg\n");
  const auto model = write("model/square.obj",
                           "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nusemtl skin\nf 1/1 2/1 3/1\n"
                           "usemtl gone\nf 3/1 2/1 1/1\n");
  ImportReport report;
  const TriangleMesh mesh = import_mesh(model, &report);
  const MeshMaterial& skin = mesh.materials.at(0);
  ASSERT_TRUE(skin.base_texture.picture);
  EXPECT_EQ(skin.base_texture.picture->rgba, kTwoPixels);
  EXPECT_EQ(skin.base_colour, Vector4f(1, 1, 1, 0.5f)) << "a black colour beside a texture is not meant";
  EXPECT_EQ(skin.alpha, MeshAlpha::kBlend);
  EXPECT_EQ(skin.roughness, 0.25f);
  EXPECT_EQ(skin.metallic, 1);
  EXPECT_EQ(report.not_read,
            std::vector<std::string>{"the picture 'gone.jpg', which is not in the model's folder or below"});
}

TEST_F(ModelFolder, ADamagedPictureIsNamed) {
  write("model/two.png", png_of(2, 1, kTwoPixels).substr(0, 40));
  const auto model =
      write("model/square.obj", "mtllib paint.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  write("model/paint.mtl", "newmtl skin\nmap_Kd two.png\n");
  try {
    import_mesh(model);
    FAIL() << "imported";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("its picture 'two.png': it is a damaged PNG file ("),
              std::string::npos)
        << error.what();
  }
}

TEST(GltfImport, AFileInMemoryCanNameNoOthers) {
  const Square square;
  const std::string glb = square.glb(Square::alone());
  EXPECT_EQ(import_mesh(std::as_bytes(std::span(glb)), "square.glb"), parse(glb));
  const std::string beside = square.gltf_beside("a.bin", Square::alone());
  EXPECT_THROW(import_mesh(std::as_bytes(std::span(beside)), "square.gltf"), std::runtime_error);
}

}  // namespace
}  // namespace softcell::ppu
