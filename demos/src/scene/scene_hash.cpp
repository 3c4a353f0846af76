#include "scene_hash.h"

#include <xxhash.h>

#include <array>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

namespace softcell::demos {
namespace {

/// Hashes values in order. Structs are taken apart by structured bindings, so that the compiler reports here when a field is added.
class Hash {
 public:
  std::uint64_t value() const { return value_; }

  template <class... Values>
  void add(const Values&... values) {
    (add(values), ...);
  }
  /// Adds nothing for a feature that older scenes did not have, if it has the value that it always had: older recordings still fit.
  template <class Value>
  void add_unless(const Value& value, const Value& usual) {
    if (value != usual) add(value);
  }

 private:
  void add_bytes(const void* data, std::size_t size) { value_ = XXH3_64bits_withSeed(data, size, value_); }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) { add_bytes(&number, sizeof number); }
  template <class Scalar, int Rows>
  void add(const Eigen::Matrix<Scalar, Rows, 1>& vector) {
    add_bytes(vector.data(), sizeof(Scalar) * Rows);
  }
  template <class Value, std::size_t Size>
  void add(const std::array<Value, Size>& values) {
    for (const Value& value : values) add(value);
  }
  template <class Value>
  void add(const std::optional<Value>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    for (const Value& value : values) add(value);
  }
  template <class... Alternatives>
  void add(const std::variant<Alternatives...>& value) {
    add(value.index());
    std::visit([this](const auto& alternative) { this->add(alternative); }, value);
  }

  void add(const ppu::TriangleMesh& mesh) {
    const auto& [positions, normals, triangles, texture_coordinates, colours, parts, materials] = mesh;
    add(positions, triangles);  // everything else only affects looks
  }
  void add(const ppu::SoftBodySettings& settings) {
    const auto& [cell_size, half_width, density, alpha, damping, friction, restitution, contacts,
                 self_contacts, frequency, damping_time, plasticity, fracture] = settings;
    add(cell_size, half_width, density, alpha, damping, friction, frequency, damping_time);
    add_unless(restitution, 0.0f);
    add_unless(contacts, true);
    if (!self_contacts) add('s');
    if (plasticity) add('p', plasticity->yield, plasticity->creep, plasticity->limit);
    if (!fracture) return;
    const auto& [stretch, turn, least_cells] = *fracture;
    add('b', stretch, turn);
    add_unless(least_cells, ppu::Fracture{}.least_cells);
  }
  void add(const SoftBodyPlacement& body) {
    const auto& [name, described, mesh, settings, position, twist, colour, own_materials, strengths] = body;
    add(mesh, settings, position);
    add_unless(twist, 0.0f);
    add_strengths(strengths);
  }
  template <int Dimension>
  void add_strengths(const std::vector<StrengthSlab<Dimension>>& strengths) {
    for (const auto& [point, normal, thickness, strength] : strengths)
      add('s', point, normal, thickness, strength);
  }
  void add(const RigidBox& box) {
    const auto& [size, mass, position, rotation, colour, opacity, pattern, wall] = box;
    add(size, mass, position);
    add_unless(Eigen::Vector4f(rotation.coeffs()), Eigen::Vector4f(0, 0, 0, 1));
  }
  void add(const Obstacle& obstacle) {
    const auto& [mesh, position, colour, own_materials] = obstacle;
    add(mesh, position);
  }
  void add(const ppu::RigidShape& shape) {
    const auto& [kind, size, radius, height, position, rotation] = shape;
    add(static_cast<int>(kind), size, radius, height, position, Eigen::Vector4f(rotation.coeffs()));
  }
  void add(const Motion::Stop& stop) {
    const auto& [time, offset, angle] = stop;
    add(time, offset, angle);
  }
  void add(const Motion& motion) {
    const auto& [axis, spin, swing, period, stops] = motion;
    add(axis, spin, swing, period, stops);
  }
  void add(const RigidPart& part) { add(part.shape); }
  void add(const RigidBody& rigid) {
    const auto& [name, parts, mass, position, rotation, friction, opacity, motion] = rigid;
    add(parts, mass, position, Eigen::Vector4f(rotation.coeffs()), friction, motion);
  }
  void add(const Joint& joint) {
    const auto& [a, b, point, axis, speed, torque] = joint;
    add(a, b, point, axis, speed, torque);
  }
  template <int kDimension>
  void add(const AttachmentPlacement<kDimension>& attachment) {
    const auto& [described, body, other, box, rigid, at, radius, other_at, other_radius, settings, thickness,
                 colour] = attachment;
    const auto& [kind, point, axis, length, compliance, break_force, touch] = settings;
    add(body, other, box, at, radius, other_at, other_radius);
    add(static_cast<int>(kind), point, axis, length, compliance, break_force, touch);
    add_unless(rigid, std::optional<std::size_t>());
  }
  void add(const TiltScript& tilt) {
    const auto& [amplitude_x, amplitude_z, period_x, period_z, begin] = tilt;
    add(amplitude_x, amplitude_z, period_x, period_z, begin);
  }
  void add(const SoftBody2dPlacement& body) {
    const auto& [name, described, cells, settings, position, contact_radius, colour, coloured_cells, face,
                 ring, picture, strengths] = body;
    add(cells, settings, position, contact_radius);
    add_strengths(strengths);
  }
  void add(const Box2dShape& box) { add(box.size); }
  void add(const CircleShape& circle) { add(circle.radius); }
  void add(const PolygonShape& polygon) { add(polygon.corners); }
  void add(const RigidBody2d& body) {
    const auto& [name, shape, mass, position, angle, colour] = body;
    add(shape, mass, position, angle);
  }
  template <int Dimension>
  void add(const Beginning<Dimension>& begin) {
    const auto& [gravity, tilt, time_scale, frames, seconds, soft_bodies, rigid_bodies, ended_attachments,
                 pins] = begin;
    add(gravity, tilt, time_scale, frames, seconds, ended_attachments);
    for (const auto& [positions, velocities, rest] : soft_bodies) add(positions, velocities, rest);
    for (const auto& [body, point, radius, particles] : pins) add(body, point, radius, particles);
    for (const auto& [body, position, rotation, velocity, angular_velocity] : rigid_bodies) {
      add(body, position, velocity, angular_velocity);
      if constexpr (Dimension == 3) {
        add(Eigen::Vector4f(rotation.coeffs()));
      } else {
        add(rotation);
      }
    }
  }

  std::uint64_t value_ = 0;
};

}  // namespace

std::uint64_t scene_hash(const Scene& scene, ppu::ContactMethod contacts) {
  const auto& [name, title, soft_bodies, boxes, obstacles, rigid_bodies, joints, attachments, tilt, gravity,
               friction, restitution, substeps, own_contacts, sleep, frames, camera, light, script, cuts,
               pictures, files, notes, begin, document] = scene;
  Hash hash;
  hash.add(3, soft_bodies, boxes, obstacles, tilt, gravity, friction, substeps);
  hash.add_unless(restitution, 0.0f);
  hash.add_unless(static_cast<int>(contacts), static_cast<int>(ppu::ContactMethod::kSpheres));
  if (!attachments.empty()) hash.add('a', attachments);  // nothing is added for a scene that has none
  if (!rigid_bodies.empty()) hash.add('r', rigid_bodies);
  if (!joints.empty()) hash.add('j', joints);
  hash.add_unless(static_cast<int>(sleep), 0);
  if (begin) hash.add('b', *begin);
  for (const ScriptedCut<3>& cut : cuts)
    hash.add('c', cut.time, cut.body, cut.where.corner, cut.where.along, cut.where.across, cut.where.has_end);
  return hash.value();
}

std::uint64_t scene_hash(const Scene2d& scene, ppu::ContactMethod contacts) {
  const auto& [name, title, soft_bodies, rigid_bodies, attachments, gravity, friction, restitution, substeps,
               own_contacts, sleep, frames, camera, script, cuts, pictures, files, begin, document] = scene;
  Hash hash;
  hash.add(2, soft_bodies, rigid_bodies, gravity, friction, substeps);
  hash.add_unless(restitution, 0.0f);
  if (!attachments.empty()) hash.add('a', attachments);
  hash.add_unless(static_cast<int>(contacts), static_cast<int>(ppu::ContactMethod::kSpheres));
  hash.add_unless(static_cast<int>(sleep), 0);
  if (begin) hash.add('b', *begin);
  for (const ScriptedCut<2>& cut : cuts)
    hash.add('c', cut.time, cut.body, cut.where.from, cut.where.way, cut.where.has_end);
  return hash.value();
}

}  // namespace softcell::demos
