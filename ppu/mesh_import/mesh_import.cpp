#include "softcell/mesh_import/mesh_import.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <array>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ppu/mesh_import/gltf.h"
#include "ppu/mesh_import/material_library.h"
#include "ppu/mesh_import/mesh_file_text.h"
#include "ppu/mesh_import/mesh_soup.h"
#include "ppu/mesh_import/model_pictures.h"
#include "ppu/mesh_import/neighbours.h"
#include "ppu/mesh_import/parse_mesh.h"
#include "softcell/base/assert.h"
#include "softcell/base/read_file.h"

namespace softcell::ppu {
namespace {

/// 4 million triangles take a quarter of it as text.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxMaterialLibraryBytes = std::uint64_t{16} << 20;

/// The file extension of a format that the library reads.
const char* extension_of(MeshFormat format) {
  switch (format) {
    case MeshFormat::kGltf:
      break;
    case MeshFormat::kObj:
      return "obj";
    case MeshFormat::kPly:
      return "ply";
    case MeshFormat::kStl:
      return "stl";
  }
  return "";
}

/// The file system that the library sees: one file, in memory. Other files to which it refers (materials, pictures) do not exist there.
class SingleFile : public Assimp::IOSystem {
 public:
  SingleFile(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}
  bool Exists(const char* file) const override { return name_ == file; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char*) override {
    if (!Exists(file)) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string name_;
  std::string_view bytes_;
};

/// Leaves the importer with the one loader for `extension`, so that content cannot choose another.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  const Assimp::BaseImporter* wanted = importer.GetImporter(importer.GetImporterIndex(extension.c_str()));
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    std::unique_ptr<Assimp::BaseImporter> loader(importer.GetImporter(i));
    if (loader.get() == wanted) {
      loader.release();
    } else {
      importer.UnregisterLoader(loader.get());
    }
  }
}

/// The library's complaints may quote the rest of the file.
std::string one_line(std::string text) {
  constexpr std::size_t kLongest = 160;
  if (text.size() > kLongest) text.replace(kLongest, std::string::npos, "...");
  for (char& c : text) c = c >= ' ' && c <= '~' ? c : ' ';
  return text;
}

Eigen::Vector3f vector_of(const aiVector3D& v) {
  return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};  // + 0 turns -0 into 0, which is equal and must look equal
}

/// The texture coordinates and colours of one of the library's meshes, behind those of the ones before.
void gather_attributes(const aiMesh& mesh, const MeshFileContents& contents, MeshSoup& soup) {
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    if (contents.has_texture_coordinates) {
      const aiVector3D none(0, 0, 0);
      const aiVector3D& at = mesh.HasTextureCoords(0) ? mesh.mTextureCoords[0][v] : none;
      soup.texture_coordinates.emplace_back(at.x + 0.0f, at.y + 0.0f);
      if (!soup.texture_coordinates.back().allFinite())
        refuse("it has texture coordinates that are not finite");
    }
    if (contents.has_colours) {
      const aiColor4D white(1, 1, 1, 1);
      const aiColor4D& c = mesh.HasVertexColors(0) ? mesh.mColors[0][v] : white;
      const Eigen::Vector4f colour(c.r + 0.0f, c.g + 0.0f, c.b + 0.0f, c.a + 0.0f);
      if (!colour.allFinite()) refuse("it has colours that are not finite");
      soup.colours.push_back(colour.cwiseMax(0.0f).cwiseMin(1.0f));
    }
  }
}

MeshSoup gather(const aiScene& scene, const MeshFileContents& contents) {
  MeshSoup soup;
  bool normals = contents.has_normals;
  std::uint32_t delivered = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const auto base = static_cast<std::uint32_t>(soup.positions.size());
    normals = normals && mesh.HasNormals();
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      soup.positions.push_back(vector_of(mesh.mVertices[v]));
      if (!soup.positions.back().allFinite()) refuse("it has coordinates that are not finite");
      if (normals) soup.normals.push_back(vector_of(mesh.mNormals[v]));
    }
    gather_attributes(mesh, contents, soup);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<std::uint32_t, 3> triangle{};
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) refuse("a face's index is out of range");
        triangle[k] = base + face.mIndices[k];
      }
      add_triangle(soup, triangle, delivered);
      ++delivered;
    }
  }
  if (delivered != contents.triangles) {
    refuse("only " + std::to_string(delivered) + " of its " + std::to_string(contents.triangles) +
           " triangles could be read; some of its polygons may cross themselves");
  }
  if (soup.triangles.empty()) refuse("all its triangles have area zero");
  if (!normals) soup.normals.clear();
  return soup;
}

/// The parts that the file names, and the materials they have, which are numbered in the order of their first use.
void name_parts(const std::vector<NamedPart>& named, const MaterialLibrary& library,
                std::vector<MeshPart>& parts, std::vector<MeshMaterial>& materials) {
  std::map<std::string_view, std::uint32_t> numbers;
  for (const NamedPart& part : named) {
    std::optional<std::uint32_t> material;
    if (!part.material.empty()) {
      const auto [number, is_new] =
          numbers.try_emplace(part.material, static_cast<std::uint32_t>(materials.size()));
      material = number->second;
      if (is_new) {
        const auto found = library.find(part.material);
        materials.push_back(found == library.end() ? MeshMaterial() : found->second);
        materials.back().name = part.material;
      }
    }
    parts.push_back({part.object, material, part.first_triangle, part.triangle_count});
  }
}

MaterialLibrary read_material_library(const std::string& name, const ReadNeighbour& read_neighbour,
                                      std::vector<std::string>& not_read) {
  if (name.empty() || !read_neighbour) return {};
  const std::optional<std::string> text = read_neighbour(name, kMaxMaterialLibraryBytes);
  if (!text) {
    add_not_read(not_read,
                 "the material library " + in_quotes(name) + ", which is not in the model's folder or below");
    return {};
  }
  try {
    return parse_material_library(*text);
  } catch (const std::runtime_error& problem) {
    refuse("its material library " + in_quotes(name) + ": " + problem.what());
  }
}

void read_pictures(std::vector<MeshMaterial>& materials, const ReadNeighbour& read_neighbour,
                   std::vector<std::string>& not_read) {
  if (!read_neighbour) return;
  ModelPictures pictures(read_neighbour, not_read);
  for (MeshMaterial& material : materials) {
    for (MeshTexture* texture : {&material.base_texture, &material.normal_texture}) {
      if (!texture->file.empty()) texture->picture = pictures.from_file(texture->file);
    }
  }
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error("cannot import the mesh " + path.string() + ": " + why);
}

MeshFormat format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".gltf" || extension == ".glb") return MeshFormat::kGltf;
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl}) {
    if (extension.starts_with('.') && extension.substr(1) == extension_of(format)) return format;
  }
  refuse_file(path, "its extension " + in_quotes(extension) + " is not one of .gltf, .glb, .obj, .ply, .stl");
}

TriangleMesh import_from(std::string_view bytes, const std::filesystem::path& path, MeshFormat format,
                         const ReadNeighbour& read_neighbour, ImportReport& report) {
  try {
    return parse_mesh(bytes, format, read_neighbour, &report.not_read);
  } catch (const std::runtime_error& problem) {
    refuse_file(path, problem.what());
  }
}

}  // namespace

TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format, const ReadNeighbour& read_neighbour,
                        std::vector<std::string>* not_read) {
  if (bytes.empty()) refuse("it is empty");
  std::vector<std::string> unread;
  std::vector<std::string>& left_out = not_read != nullptr ? *not_read : unread;
  if (format == MeshFormat::kGltf) return parse_gltf(bytes, read_neighbour, left_out);
  const MeshFileContents contents = check_mesh_file(bytes, format);
  const std::string extension = extension_of(format);
  Assimp::Importer importer;
  keep_only(importer, extension);
  const std::string_view shown = contents.geometry.empty() ? bytes : contents.geometry;
  importer.SetIOHandler(new SingleFile("mesh." + extension, shown));  // the importer deletes it
  const aiScene* scene = importer.ReadFile("mesh." + extension, aiProcess_Triangulate);
  if (scene == nullptr) refuse(one_line(importer.GetErrorString()));

  MeshSoup soup = gather(*scene, contents);
  std::vector<MeshMaterial> materials;
  name_parts(contents.parts, read_material_library(contents.material_library, read_neighbour, left_out),
             soup.parts, materials);
  read_pictures(materials, read_neighbour, left_out);
  TriangleMesh mesh = mesh_of(std::move(soup));
  mesh.materials = std::move(materials);
  return mesh;
}

TriangleMesh import_mesh(const std::filesystem::path& path, ImportReport* report) {
  ImportReport own;
  ImportReport& made = report != nullptr ? *report : own;
  made = {};
  const MeshFormat format = format_of(path);
  const std::vector<std::byte> bytes = base::read_file(path, kMaxFileBytes);
  made.files.push_back(path);
  return import_from(text_of(bytes), path, format, neighbours_of(path, made.files), made);
}

TriangleMesh import_mesh(std::span<const std::byte> bytes, const std::filesystem::path& name,
                         ImportReport* report) {
  ImportReport own;
  ImportReport& made = report != nullptr ? *report : own;
  made = {};
  return import_from(text_of(bytes), name, format_of(name), nullptr, made);
}

}  // namespace softcell::ppu
