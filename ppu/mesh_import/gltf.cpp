#include "ppu/mesh_import/gltf.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "ppu/mesh_import/colour.h"
#include "ppu/mesh_import/gltf_accessors.h"
#include "ppu/mesh_import/gltf_json.h"
#include "ppu/mesh_import/gltf_materials.h"
#include "ppu/mesh_import/mesh_file_check.h"
#include "ppu/mesh_import/mesh_file_text.h"
#include "ppu/mesh_import/mesh_soup.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr std::uint64_t kTriangles = 4, kStrip = 5, kFan = 6;  // modes, as OpenGL numbers them
constexpr std::size_t kMaxDepthOfNodes = 1000;

/// Extensions that change the geometry: a file that requires another one is refused.
bool may_be_required(std::string_view extension) {
  return extension == "KHR_mesh_quantization" || extension == "KHR_texture_transform" ||
         extension == "KHR_lights_punctual" || extension == "EXT_texture_webp" ||
         extension == "KHR_texture_basisu" || extension.starts_with("KHR_materials_");
}

void check_extensions(const GltfValue& root) {
  for (std::size_t i = 0; i < root.size("extensionsRequired"); ++i) {
    const std::string& extension = root.text_at("extensionsRequired", i);
    if (!may_be_required(extension)) {
      refuse("it requires the extension " + name_in_quotes(extension) +
             ", which softcell does not read; export it without compression and the like");
    }
  }
}

/// The transform from a node's frame to its parent's.
Eigen::Affine3d transform_of(const GltfValue& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  std::array<double, 16> matrix{};
  if (node.numbers("matrix", matrix)) {
    transform.affine() = Eigen::Map<const Eigen::Matrix4d>(matrix.data()).topRows<3>();  // by columns
    return transform;
  }
  std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
  std::array<double, 4> rotation{0, 0, 0, 1};
  node.numbers("translation", translation);
  node.numbers("scale", scale);
  node.numbers("rotation", rotation);
  Eigen::Quaterniond turn(rotation[3], rotation[0], rotation[1], rotation[2]);
  if (!(std::abs(turn.norm() - 1) < 0.01)) node.refuse("its rotation is not a quaternion of length 1");
  turn.normalize();
  transform.linear() = turn.toRotationMatrix() * Eigen::Vector3d(scale.data()).asDiagonal();
  transform.translation() = Eigen::Vector3d(translation.data());
  return transform;
}

class GltfImport {
 public:
  GltfImport(const GltfDocument& document, const ReadNeighbour& read_neighbour,
             std::vector<std::string>& not_read)
      : root_(document.json),
        buffers_(root_, document.bytes, read_neighbour),
        materials_(root_, buffers_, read_neighbour, not_read),
        not_read_(not_read) {}

  TriangleMesh run() {
    check_extensions(root_);
    if (root_.has("animations")) add_not_read("animations");
    if (root_.has("skins")) add_not_read("skins");
    visited_.resize(root_.size("nodes"));
    for (const std::uint32_t node : roots()) walk(node);
    if (triangles_ == 0) refuse("it has no triangles in its scene; a mesh of triangles was expected");
    if (soup_.triangles.empty()) refuse("all its triangles have area zero");
    drop_what_no_primitive_has();
    TriangleMesh mesh = mesh_of(std::move(soup_));
    mesh.materials = std::move(looks_);
    return mesh;
  }

 private:
  struct Attributes {
    GltfAccessor& position;
    GltfAccessor* normal = nullptr;
    GltfAccessor* texture = nullptr;
    GltfAccessor* colour = nullptr;
    GltfCoordinates coordinates = {};
  };

  void add_not_read(const std::string& phrase) { ppu::add_not_read(not_read_, phrase); }

  /// The nodes of the scene; if the file has no scene, all nodes without a parent.
  std::vector<std::uint32_t> roots() const {
    std::vector<std::uint32_t> found;
    const std::size_t nodes = root_.size("nodes"), scenes = root_.size("scenes");
    if (scenes > 0) {
      const GltfValue scene = root_.item("scenes", root_.index("scene", "scenes", scenes).value_or(0));
      for (std::size_t i = 0; i < scene.size("nodes"); ++i)
        found.push_back(scene.index_at("nodes", i, "nodes", nodes));
      return found;
    }
    std::vector<bool> is_child(nodes);
    for (std::size_t n = 0; n < nodes; ++n) {
      const GltfValue node = root_.item("nodes", n);
      for (std::size_t c = 0; c < node.size("children"); ++c)
        is_child[node.index_at("children", c, "nodes", nodes)] = true;
    }
    for (std::uint32_t n = 0; n < nodes; ++n) {
      if (!is_child[n]) found.push_back(n);
    }
    return found;
  }

  /// Adds the meshes of a node and of those below it, in order of depth, without recursion.
  void walk(std::uint32_t first) {
    struct Step {
      std::uint32_t node;
      std::size_t depth;
      Eigen::Affine3d parent;
    };
    std::vector<Step> steps{{first, 0, Eigen::Affine3d::Identity()}};
    while (!steps.empty()) {
      const Step step = steps.back();
      steps.pop_back();
      const GltfValue node = root_.item("nodes", step.node);
      if (visited_[step.node]) node.refuse("it is the child of two nodes, or of itself");
      visited_[step.node] = true;
      if (step.depth > kMaxDepthOfNodes)
        node.refuse("it is more than " + std::to_string(kMaxDepthOfNodes) + " nodes deep");
      const Eigen::Affine3d here = step.parent * transform_of(node);
      if (const auto mesh = node.index("mesh", "meshes", root_.size("meshes"))) add_mesh(node, *mesh, here);
      for (std::size_t c = node.size("children"); c-- > 0;)
        steps.push_back({node.index_at("children", c, "nodes", root_.size("nodes")), step.depth + 1, here});
    }
  }

  void add_mesh(const GltfValue& node, std::uint32_t number, const Eigen::Affine3d& transform) {
    const GltfValue mesh = root_.item("meshes", number);
    const std::string object =
        node.has("name") ? node.text("name", kMaxMeshNameBytes) : mesh.text("name", kMaxMeshNameBytes);
    for (std::size_t p = 0; p < mesh.size("primitives"); ++p) {
      if (++primitives_ > kMaxMeshParts)
        refuse("its scene has more than " + std::to_string(kMaxMeshParts) + " primitives");
      add_primitive(mesh.item("primitives", p), object, transform);
    }
  }

  void add_primitive(const GltfValue& primitive, const std::string& object,
                     const Eigen::Affine3d& transform) {
    const std::uint64_t mode = primitive.whole("mode", kFan, kTriangles);
    if (mode < kTriangles) return add_not_read("points and lines");
    if (primitive.has("targets")) add_not_read("morph targets");
    for (const std::string& extension : primitive.names("extensions"))
      add_not_read("the extension " + name_in_quotes(extension));
    const auto material = material_of(primitive);
    const Attributes attributes =
        attributes_of(primitive, material ? coordinates_[*material] : GltfCoordinates());
    const std::vector<std::uint32_t> corners = corners_of(primitive, attributes.position.count());
    const std::uint64_t added = mode == kTriangles   ? corners.size() / 3
                                : corners.size() < 3 ? 0
                                                     : corners.size() - 2;
    if (mode == kTriangles && corners.size() % 3 != 0)
      primitive.refuse("its " + std::to_string(corners.size()) +
                       " corners make no whole number of triangles");
    if (triangles_ + added > kMaxMeshTriangles)
      refuse("it has more than " + std::to_string(kMaxMeshTriangles) + " triangles");
    const bool mirrored = transform.linear().determinant() < 0;
    for (std::size_t t = 0; t < added; ++t) {
      std::array<std::uint32_t, 3> triangle;
      if (mode == kTriangles) {
        triangle = {corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]};
      } else if (mode == kStrip) {
        triangle = {corners[t], corners[t + 1 + t % 2], corners[t + 2 - t % 2]};
      } else {
        triangle = {corners[t + 1], corners[t + 2], corners[0]};
      }
      if (mirrored) std::swap(triangle[1], triangle[2]);
      add_corners(attributes, triangle, transform);
    }
    soup_.parts.push_back({.object = object,
                           .material = material,
                           .first_triangle = static_cast<std::uint32_t>(triangles_ - added),
                           .triangle_count = static_cast<std::uint32_t>(added)});
  }

  /// The accessor of that number, made when it is first asked for.
  GltfAccessor& accessor(std::uint32_t number) {
    const auto known = accessors_.find(number);
    if (known != accessors_.end()) return known->second;
    return accessors_.emplace(number, GltfAccessor(root_.item("accessors", number), buffers_)).first->second;
  }

  GltfAccessor* attribute(const GltfValue& attributes, const std::string& name, std::size_t least,
                          std::size_t most) {
    const auto number = attributes.index(name, "accessors", root_.size("accessors"));
    if (!number) return nullptr;
    GltfAccessor& found = accessor(*number);
    if (found.components() < least || found.components() > most)
      attributes.refuse("its " + name + " has " + std::to_string(found.components()) + " numbers an element");
    return &found;
  }

  Attributes attributes_of(const GltfValue& primitive, const GltfCoordinates& coordinates) {
    const GltfValue attributes = primitive.object("attributes");
    GltfAccessor* const position = attribute(attributes, "POSITION", 3, 3);
    if (position == nullptr) attributes.refuse("it has no 'POSITION'");
    Attributes found{.position = *position, .coordinates = coordinates};
    found.normal = attribute(attributes, "NORMAL", 3, 3);
    found.texture = attribute(attributes, "TEXCOORD_" + std::to_string(coordinates.set), 2, 2);
    found.colour = attribute(attributes, "COLOR_0", 3, 4);
    for (const GltfAccessor* other : {found.normal, found.texture, found.colour}) {
      if (other == nullptr || other->count() == position->count()) continue;
      attributes.refuse(other->place() + " has " + std::to_string(other->count()) + " elements for " +
                        std::to_string(position->count()) + " positions");
    }
    has_normals_ = has_normals_ && found.normal != nullptr;
    has_texture_coordinates_ = has_texture_coordinates_ || found.texture != nullptr;
    has_colours_ = has_colours_ || found.colour != nullptr;
    return found;
  }

  std::vector<std::uint32_t> corners_of(const GltfValue& primitive, std::size_t positions) {
    constexpr std::size_t kMost = 3 * kMaxMeshTriangles + 2;
    const auto number = primitive.index("indices", "accessors", root_.size("accessors"));
    const std::size_t count = number ? accessor(*number).count() : positions;
    if (count > kMost) primitive.refuse("it has more than " + std::to_string(kMost) + " corners");
    std::vector<std::uint32_t> corners(count);
    if (!number) {
      for (std::uint32_t i = 0; i < count; ++i) corners[i] = i;
      return corners;
    }
    const GltfAccessor& indices = accessor(*number);
    if (indices.components() != 1 || !indices.is_unsigned() || indices.is_normalized())
      primitive.refuse("its indices, " + indices.place() + ", are not whole numbers of 0 or more");
    for (std::size_t i = 0; i < count; ++i) {
      corners[i] = indices.scalar(i);
      if (corners[i] >= positions) {
        primitive.refuse("its index " + std::to_string(i) + " is " + std::to_string(corners[i]) +
                         ", but it has " + std::to_string(positions) + " vertices");
      }
    }
    return corners;
  }

  /// The number in looks_ of the primitive's material.
  std::optional<std::uint32_t> material_of(const GltfValue& primitive) {
    const auto number = primitive.index("material", "materials", root_.size("materials"));
    if (!number) return std::nullopt;
    const auto known = number_of_material_.find(*number);
    if (known != number_of_material_.end()) return known->second;
    GltfMaterial material = materials_.read(*number);
    looks_.push_back(std::move(material.look));
    coordinates_.push_back(material.coordinates);
    return number_of_material_[*number] = static_cast<std::uint32_t>(looks_.size() - 1);
  }

  /// Three corners of their own for each triangle: equal ones are joined later.
  void add_corners(const Attributes& attributes, const std::array<std::uint32_t, 3>& triangle,
                   const Eigen::Affine3d& transform) {
    const auto first = static_cast<std::uint32_t>(soup_.positions.size());
    const Eigen::Matrix3d linear = transform.linear();
    Eigen::Matrix3d cofactors;  // turn normals: up to length the inverse transpose
    cofactors << linear.col(1).cross(linear.col(2)), linear.col(2).cross(linear.col(0)),
        linear.col(0).cross(linear.col(1));
    const double sign = linear.determinant() < 0 ? -1 : 1;
    for (const std::uint32_t corner : triangle) {
      const Eigen::Vector3d position = attributes.position.element(corner).head<3>().cast<double>();
      soup_.positions.push_back((transform * position).cast<float>().array() + 0.0f);  // + 0 turns -0 into 0
      if (!soup_.positions.back().allFinite()) refuse("it has coordinates that are not finite");
      Eigen::Vector3f normal = Eigen::Vector3f::Zero();
      if (attributes.normal != nullptr) {
        const Eigen::Vector3d given = attributes.normal->element(corner).head<3>().cast<double>();
        normal = (sign * (cofactors * given)).normalized().cast<float>().array() + 0.0f;
      }
      soup_.normals.push_back(normal);
      Eigen::Vector2f at = Eigen::Vector2f::Zero();
      if (attributes.texture != nullptr) {
        const GltfCoordinates& coordinates = attributes.coordinates;
        at = coordinates.linear * attributes.texture->element(corner).head<2>() + coordinates.offset;
        at.y() = 1 - at.y();  // v grows downwards in glTF
        if (!at.allFinite()) refuse("it has texture coordinates that are not finite");
      }
      soup_.texture_coordinates.push_back(at);
      Eigen::Vector4f colour = Eigen::Vector4f::Ones();
      if (attributes.colour != nullptr) {
        colour = attributes.colour->element(corner);
        if (!colour.allFinite()) refuse("it has colours that are not finite");
        colour = srgb_encoded(colour.cwiseMax(0.0f).cwiseMin(1.0f));
      }
      soup_.colours.push_back(colour);
    }
    add_triangle(soup_, {first, first + 1, first + 2}, static_cast<std::uint32_t>(triangles_));
    ++triangles_;
  }

  void drop_what_no_primitive_has() {
    if (!has_normals_) soup_.normals.clear();
    if (!has_texture_coordinates_) soup_.texture_coordinates.clear();
    if (!has_colours_) soup_.colours.clear();
  }

  const GltfValue root_;
  GltfBuffers buffers_;
  GltfMaterials materials_;
  std::vector<std::string>& not_read_;
  std::map<std::uint32_t, GltfAccessor> accessors_;
  std::vector<bool> visited_;  // nodes
  std::size_t primitives_ = 0, triangles_ = 0;
  bool has_normals_ = true, has_texture_coordinates_ = false, has_colours_ = false;
  MeshSoup soup_;
  std::vector<MeshMaterial> looks_;
  std::vector<GltfCoordinates> coordinates_;  // of looks_
  std::map<std::uint32_t, std::uint32_t> number_of_material_;
};

}  // namespace

TriangleMesh parse_gltf(std::string_view file, const ReadNeighbour& read_neighbour,
                        std::vector<std::string>& not_read) {
  const GltfDocument document = read_gltf_document(file);
  return GltfImport(document, read_neighbour, not_read).run();
}

}  // namespace softcell::ppu
