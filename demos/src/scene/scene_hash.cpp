#include "scene_hash.h"

#include <xxhash.h>

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

namespace softcell::demos {
namespace {

/// Takes values in order. Structs are taken apart by structured bindings, so that a field that is added is
/// noticed here by the compiler.
class Hash {
 public:
  std::uint64_t value() const { return value_; }

  template <class... Values>
  void add(const Values&... values) {
    (take(values), ...);
  }

 private:
  void take_bytes(const void* data, std::size_t size) { value_ = XXH3_64bits_withSeed(data, size, value_); }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void take(Number number) { take_bytes(&number, sizeof number); }
  template <class Scalar, int Rows>
  void take(const Eigen::Matrix<Scalar, Rows, 1>& vector) {
    take_bytes(vector.data(), sizeof(Scalar) * Rows);
  }
  template <class Value, std::size_t Size>
  void take(const std::array<Value, Size>& values) {
    for (const Value& value : values) take(value);
  }
  template <class Value>
  void take(const std::optional<Value>& value) {
    take(value.has_value());
    if (value) take(*value);
  }
  template <class Value>
  void take(const std::vector<Value>& values) {
    take(values.size());
    for (const Value& value : values) take(value);
  }
  template <class... Alternatives>
  void take(const std::variant<Alternatives...>& value) {
    take(value.index());
    std::visit([this](const auto& alternative) { this->take(alternative); }, value);
  }

  /// What scenes did not always have says nothing where it is as it always was: older recordings still fit.
  template <class Value>
  void add_unless(const Value& value, const Value& usual) {
    if (value != usual) add(value);
  }

  void take(const ppu::TriangleMesh& mesh) {
    const auto& [positions, normals, triangles, texture_coordinates, colours, parts] = mesh;
    add(positions, triangles);  // all else is looks
  }
  void take(const ppu::SoftBodySettings& settings) {
    const auto& [cell_size, half_width, density, alpha, damping, friction, contacts, frequency,
                 damping_time] = settings;
    add(cell_size, half_width, density, alpha, damping, friction, frequency, damping_time);
    add_unless(contacts, true);
  }
  void take(const SoftBodyPlacement& body) {
    const auto& [name, mesh, settings, position, twist, colour] = body;
    add(mesh, settings, position);
    add_unless(twist, 0.0f);
  }
  void take(const RigidBox& box) {
    const auto& [size, mass, position, colour, opacity, pattern] = box;
    add(size, mass, position);
  }
  void take(const Obstacle& obstacle) {
    const auto& [mesh, position, colour] = obstacle;
    add(mesh, position);
  }
  void take(const TiltScript& tilt) {
    const auto& [amplitude_x, amplitude_z, period_x, period_z, begin] = tilt;
    add(amplitude_x, amplitude_z, period_x, period_z, begin);
  }
  void take(const SoftBody2dPlacement& body) {
    const auto& [name, cells, settings, position, contact_radius, colour] = body;
    add(cells, settings, position, contact_radius);
  }
  void take(const Box2dShape& box) { take(box.size); }
  void take(const CircleShape& circle) { take(circle.radius); }
  void take(const PolygonShape& polygon) { take(polygon.corners); }
  void take(const RigidBody2d& body) {
    const auto& [shape, mass, position, angle, colour] = body;
    add(shape, mass, position, angle);
  }

  std::uint64_t value_ = 0;
};

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
  const auto& [name, title, soft_bodies, boxes, obstacles, tilt, gravity, friction, substeps, frames, camera,
               light, script, pictures, files] = scene;
  Hash hash;
  hash.add(3, soft_bodies, boxes, obstacles, tilt, gravity, friction, substeps);
  return hash.value();
}

std::uint64_t scene_hash(const Scene2d& scene) {
  const auto& [name, title, soft_bodies, rigid_bodies, gravity, friction, substeps, frames, camera, script,
               pictures, files] = scene;
  Hash hash;
  hash.add(2, soft_bodies, rigid_bodies, gravity, friction, substeps);
  return hash.value();
}

}  // namespace softcell::demos
