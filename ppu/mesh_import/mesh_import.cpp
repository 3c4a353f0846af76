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
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "ppu/mesh/vertex_normals.h"
#include "ppu/mesh_import/material_library.h"
#include "ppu/mesh_import/mesh_file_text.h"
#include "ppu/mesh_import/parse_mesh.h"
#include "softcell/base/assert.h"
#include "softcell/base/read_file.h"

namespace softcell::ppu {
namespace {

/// 4 million triangles take a quarter of it as text.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxMaterialLibraryBytes = std::uint64_t{16} << 20;

const char* extension_of(MeshFormat format) {
  switch (format) {
    case MeshFormat::kObj:
      return "obj";
    case MeshFormat::kPly:
      return "ply";
    case MeshFormat::kStl:
      return "stl";
  }
  return "";
}

/// All of the library's world: one file, in memory. Whatever the file refers to (materials, textures) does
/// not exist.
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

/// Corners and triangles as the library delivers them, checked; degenerate triangles left out.
struct Soup {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;              ///< none, or one of any length per position
  std::vector<Eigen::Vector2f> texture_coordinates;  ///< none, or one per position
  std::vector<Eigen::Vector4f> colours;              ///< none, or one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> number_in_file;  ///< of each triangle, those of area zero counted
};

Eigen::Vector3f vector_of(const aiVector3D& v) {
  return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};  // + 0 turns -0 into 0, which is equal and must look equal
}

/// The texture coordinates and colours of one of the library's meshes, behind those of the ones before.
void gather_attributes(const aiMesh& mesh, const MeshFileContents& contents, Soup& soup) {
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

Soup gather(const aiScene& scene, const MeshFileContents& contents) {
  Soup soup;
  bool normals = contents.has_normals;
  std::size_t delivered = 0;
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
      ++delivered;
      std::array<std::uint32_t, 3> triangle{};
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) refuse("a face's index is out of range");
        triangle[k] = base + face.mIndices[k];
      }
      const auto& [a, b, c] = triangle;
      const double area = area_vector(soup.positions[a], soup.positions[b], soup.positions[c]).norm();
      if (area <= 0) continue;
      soup.triangles.push_back(triangle);
      soup.number_in_file.push_back(static_cast<std::uint32_t>(delivered - 1));
    }
  }
  if (delivered != contents.triangles) {
    refuse("only " + std::to_string(delivered) + " of its " + std::to_string(contents.triangles) +
           " triangles could be read; some of its polygons may cross themselves");
  }
  if (soup.triangles.empty()) refuse("all its triangles have area zero");
  SC_ASSERT(soup.number_in_file.size() == soup.triangles.size(), "{} numbers of {} triangles",
            soup.number_in_file.size(), soup.triangles.size());
  SC_ASSERT(!contents.has_texture_coordinates || soup.texture_coordinates.size() == soup.positions.size(),
            "{} texture coordinates of {} positions", soup.texture_coordinates.size(), soup.positions.size());
  SC_ASSERT(!contents.has_colours || soup.colours.size() == soup.positions.size(),
            "{} colours of {} positions", soup.colours.size(), soup.positions.size());
  if (!normals) soup.normals.clear();
  return soup;
}

/// For each of `count` items the number of its class of equal ones; classes are numbered in order of their
/// first item.
/// @param compare  (a, b) -> bool on item numbers, a strict weak order
template <class Compare>
std::vector<std::uint32_t> number_equal(std::size_t count, Compare compare) {
  std::vector<std::uint32_t> order(count), number(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return compare(a, b) || (!compare(b, a) && a < b); });
  // First the lowest item of each class, then, since that comes before the others, its number.
  for (std::size_t i = 0; i < count; ++i) {
    const bool first = i == 0 || compare(order[i - 1], order[i]);
    number[order[i]] = first ? order[i] : number[order[i - 1]];
  }
  std::uint32_t classes = 0;
  for (std::uint32_t item = 0; item < count; ++item)
    number[item] = number[item] == item ? classes++ : number[number[item]];
  return number;
}

auto components(const Eigen::Vector3f& v) { return std::make_tuple(v.x(), v.y(), v.z()); }

/// Equal positions joined; unused ones stay.
void weld(Soup& soup) {
  const auto number = number_equal(soup.positions.size(), [&](std::uint32_t a, std::uint32_t b) {
    return components(soup.positions[a]) < components(soup.positions[b]);
  });
  std::vector<Eigen::Vector3f> welded;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == welded.size()) welded.push_back(soup.positions[i]);
  }
  soup.positions = std::move(welded);
  for (auto& triangle : soup.triangles) {
    for (std::uint32_t& corner : triangle) corner = number[corner];
  }
}

/// Makes the file's normals unit vectors. @return false when one cannot be: then none of them is used.
bool normalize(std::vector<Eigen::Vector3f>& normals) {
  for (Eigen::Vector3f& normal : normals) {
    const Eigen::Vector3d exact = normal.cast<double>();
    const double length = exact.norm();
    if (!(length > 1e-6 && std::isfinite(length))) return false;
    normal = (exact / length).cast<float>();
  }
  return true;
}

/// A vertex for each different pair of position and normal that a triangle uses, in the order of their first
/// use.
TriangleMesh with_given_normals(const Soup& soup) {
  SC_ASSERT(soup.normals.size() == soup.positions.size(), "{} normals for {} positions", soup.normals.size(),
            soup.positions.size());
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : soup.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  const auto key = [&](std::uint32_t i) {
    const std::uint32_t corner = corners[i];
    return std::tuple_cat(components(soup.positions[corner]), components(soup.normals[corner]));
  };
  const auto number =
      number_equal(corners.size(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  TriangleMesh mesh;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (number[i] == mesh.positions.size()) {
      mesh.positions.push_back(soup.positions[corners[i]]);
      mesh.normals.push_back(soup.normals[corners[i]]);
    }
    if (i % 3 == 0) mesh.triangles.push_back({number[i], number[i + 1], number[i + 2]});
  }
  return mesh;
}

/// Gives the mesh's corners the texture coordinates and colours of the soup's: a vertex whose corners differ
/// in them becomes several. A mesh whose vertices each have one keeps its order of vertices.
/// @param corners  the soup's vertices, three for each of the mesh's triangles, before any were joined
void carry_attributes(const Soup& soup, std::span<const std::array<std::uint32_t, 3>> corners,
                      TriangleMesh& mesh) {
  SC_ASSERT(corners.size() == mesh.triangles.size(), "the corners of {} triangles for {}", corners.size(),
            mesh.triangles.size());
  const auto texture = [&](std::uint32_t corner) {
    return soup.texture_coordinates.empty() ? Eigen::Vector2f(0, 0) : soup.texture_coordinates[corner];
  };
  const auto colour = [&](std::uint32_t corner) {
    return soup.colours.empty() ? Eigen::Vector4f(0, 0, 0, 0) : soup.colours[corner];
  };
  const auto key = [&](std::uint32_t i) {
    const std::uint32_t corner = corners[i / 3][i % 3];
    const Eigen::Vector2f t = texture(corner);
    const Eigen::Vector4f c = colour(corner);
    return std::make_tuple(mesh.triangles[i / 3][i % 3], t.x(), t.y(), c.x(), c.y(), c.z(), c.w());
  };
  const auto number = number_equal(3 * mesh.triangles.size(),
                                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  TriangleMesh split;
  split.triangles.resize(mesh.triangles.size());
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (number[i] == split.positions.size()) {
      const std::uint32_t vertex = mesh.triangles[i / 3][i % 3], corner = corners[i / 3][i % 3];
      split.positions.push_back(mesh.positions[vertex]);
      split.normals.push_back(mesh.normals[vertex]);
      if (!soup.texture_coordinates.empty()) split.texture_coordinates.push_back(texture(corner));
      if (!soup.colours.empty()) split.colours.push_back(colour(corner));
    }
    split.triangles[i / 3][i % 3] = number[i];
  }
  mesh = std::move(split);
}

/// The file's parts, counted in the triangles that are left.
/// @param number_in_file  of each triangle left, ascending
std::vector<MeshPart> parts_of(std::vector<MeshPart> parts, std::span<const std::uint32_t> number_in_file) {
  SC_ASSERT(std::ranges::is_sorted(number_in_file), "the numbers of {} triangles do not ascend",
            number_in_file.size());
  std::uint32_t next = 0;
  for (MeshPart& part : parts) {
    const std::uint32_t end = part.first_triangle + part.triangle_count;
    part.first_triangle = next;
    while (next < number_in_file.size() && number_in_file[next] < end) ++next;
    part.triangle_count = next - part.first_triangle;
  }
  std::erase_if(parts, [](const MeshPart& part) { return part.triangle_count == 0; });
  return parts;
}

void find_materials(const std::string& name, const ReadNeighbour& read_neighbour,
                    std::vector<MeshPart>& parts) {
  if (name.empty() || !read_neighbour) return;
  const std::optional<std::string> text = read_neighbour(name);
  if (!text) return;
  MaterialLibrary library;
  try {
    library = parse_material_library(*text);
  } catch (const std::runtime_error& problem) {
    refuse("its material library " + in_quotes(name) + ": " + problem.what());
  }
  for (MeshPart& part : parts) {
    const auto material = library.find(part.material);
    if (part.material.empty() || material == library.end()) continue;
    part.base_colour = material->second.base_colour;
    part.texture = material->second.texture;
  }
}

std::string_view text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A material library that lies in the folder of the mesh's file. Names that lead elsewhere name no file here.
std::optional<std::string> read_neighbour_of(const std::filesystem::path& mesh, const std::string& name) {
  if (name.find_first_of("/\\") != std::string::npos || name == "." || name == "..") return std::nullopt;
  const std::filesystem::path path = mesh.parent_path() / name;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  return std::string(text_of(base::read_file(path, kMaxMaterialLibraryBytes)));
}

[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error("cannot import the mesh " + path.string() + ": " + why);
}

MeshFormat format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl}) {
    if (extension.starts_with('.') && extension.substr(1) == extension_of(format)) return format;
  }
  refuse_file(path, "its extension " + in_quotes(extension) + " is not one of .obj, .ply, .stl");
}

}  // namespace

TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format, const ReadNeighbour& read_neighbour) {
  if (bytes.empty()) refuse("it is empty");
  const MeshFileContents contents = check_mesh_file(bytes, format);
  const std::string extension = extension_of(format);
  Assimp::Importer importer;
  keep_only(importer, extension);
  const std::string_view shown = contents.geometry.empty() ? bytes : contents.geometry;
  importer.SetIOHandler(new SingleFile("mesh." + extension, shown));  // the importer deletes it
  const aiScene* scene = importer.ReadFile("mesh." + extension, aiProcess_Triangulate);
  if (scene == nullptr) refuse(one_line(importer.GetErrorString()));

  Soup soup = gather(*scene, contents);
  const bool has_attributes = !soup.texture_coordinates.empty() || !soup.colours.empty();
  std::vector<std::array<std::uint32_t, 3>> corners;  // of the triangles, before any are joined
  if (has_attributes) corners = soup.triangles;
  TriangleMesh mesh;
  if (!soup.normals.empty() && normalize(soup.normals)) {
    mesh = with_given_normals(soup);
  } else {
    weld(soup);
    mesh = with_smooth_normals(soup.positions, soup.triangles);
  }
  if (has_attributes) carry_attributes(soup, corners, mesh);
  SC_ASSERT(mesh.normals.size() == mesh.positions.size(), "{} normals of {} positions", mesh.normals.size(),
            mesh.positions.size());
  mesh.parts = parts_of(contents.parts, soup.number_in_file);
  find_materials(contents.material_library, read_neighbour, mesh.parts);
  return mesh;
}

TriangleMesh import_mesh(const std::filesystem::path& path) {
  const MeshFormat format = format_of(path);
  const std::vector<std::byte> bytes = base::read_file(path, kMaxFileBytes);
  try {
    return parse_mesh(text_of(bytes), format,
                      [&](const std::string& name) { return read_neighbour_of(path, name); });
  } catch (const std::runtime_error& problem) {
    refuse_file(path, problem.what());
  }
}

}  // namespace softcell::ppu
