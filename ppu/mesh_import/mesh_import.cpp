#include "softcell/mesh_import/mesh_import.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>

#include "ppu/mesh/vertex_normals.h"
#include "ppu/mesh_import/mesh_file_text.h"
#include "ppu/mesh_import/parse_mesh.h"

namespace softcell::ppu {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1}
                                         << 30;  // 4 million triangles take a quarter of it as text

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
  std::vector<Eigen::Vector3f> normals;  ///< none, or one of any length per position
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Eigen::Vector3f vector_of(const aiVector3D& v) {
  return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};  // + 0 turns -0 into 0, which is equal and must look equal
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
      if (area > 0) soup.triangles.push_back(triangle);
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

std::string read_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse("there is no such file");
  if (std::filesystem::is_directory(status)) refuse("it is a directory; a mesh file was expected");
  if (!std::filesystem::is_regular_file(status)) refuse("it is not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) refuse("its size cannot be found: " + error.message());
  if (size == 0) refuse("it is empty");
  if (size > kMaxFileBytes) refuse("it is larger than 1 GiB");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse("it cannot be opened: " + std::string(std::strerror(errno)));
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) refuse("it cannot be read to its end");
  return bytes;
}

MeshFormat format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl}) {
    if (extension.starts_with('.') && extension.substr(1) == extension_of(format)) return format;
  }
  refuse("its extension " + in_quotes(extension) + " is not one of .obj, .ply, .stl");
}

}  // namespace

TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format) {
  const MeshFileContents contents = check_mesh_file(bytes, format);
  const std::string extension = extension_of(format);
  Assimp::Importer importer;
  keep_only(importer, extension);
  const std::string_view shown = contents.geometry.empty() ? bytes : contents.geometry;
  importer.SetIOHandler(new SingleFile("mesh." + extension, shown));  // the importer deletes it
  const aiScene* scene = importer.ReadFile("mesh." + extension, aiProcess_Triangulate);
  if (scene == nullptr) refuse(one_line(importer.GetErrorString()));

  Soup soup = gather(*scene, contents);
  if (!soup.normals.empty() && normalize(soup.normals)) return with_given_normals(soup);
  weld(soup);
  return with_smooth_normals(soup.positions, soup.triangles);
}

TriangleMesh import_mesh(const std::filesystem::path& path) {
  try {
    const MeshFormat format = format_of(path);
    return parse_mesh(read_file(path), format);
  } catch (const std::runtime_error& problem) {
    throw std::runtime_error("cannot import the mesh " + path.string() + ": " + problem.what());
  }
}

}  // namespace softcell::ppu
