#include "test_scene.h"

#include <cmath>
#include <complex>
#include <utility>

namespace softcell::render::test {
namespace {

/// Points of the unit circle, made by turning a quarter turn's root again and again: square roots only, the
/// same everywhere.
/// @pre segments is a power of two times 4
std::vector<Eigen::Vector2f> unit_circle(int segments) {
  std::complex<double> step(0, 1);
  for (int n = 4; n < segments; n *= 2) {  // the half angle: the normalised mean of the step and 1
    step += 1.0;
    step /= std::sqrt(step.real() * step.real() + step.imag() * step.imag());
  }
  std::vector<Eigen::Vector2f> points;
  double x = 1;
  double y = 0;
  for (int i = 0; i < segments; ++i) {
    points.emplace_back(static_cast<float>(x), static_cast<float>(y));
    const double turned = x * step.real() - y * step.imag();
    y = x * step.imag() + y * step.real();
    x = turned;
  }
  return points;
}

int power_of_two_at_least(int value) {
  int result = 4;
  while (result < value) result *= 2;
  return result;
}

void add_quad(std::vector<std::uint32_t>& indices, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  indices.insert(indices.end(), {a, b, c, a, c, d});
}

/// The three axes of face 0..5 of a cube: two along it and one out of it, right-handed.
struct Face {
  Eigen::Vector3f u, v, out;
};
Face cube_face(int face) {
  Face result;
  const float sign = face % 2 == 0 ? 1.0f : -1.0f;
  result.out = sign * Eigen::Vector3f::Unit(face / 2);
  result.u = Eigen::Vector3f::Unit((face / 2 + 1) % 3);
  result.v = sign * Eigen::Vector3f::Unit((face / 2 + 2) % 3);
  return result;
}

}  // namespace

void SkinnedMesh::add_vertex(const Eigen::Vector3f& position, const Eigen::Vector3f& normal) {
  for (const float value :
       {position.x(), position.y(), position.z(), 1.0f, normal.x(), normal.y(), normal.z(), 0.0f}) {
    vertices.push_back(Eigen::half(value).x);
  }
}

SkinnedMesh make_torus(int ring_segments, int tube_segments) {
  const std::vector<Eigen::Vector2f> ring = unit_circle(power_of_two_at_least(ring_segments));
  const std::vector<Eigen::Vector2f> tube = unit_circle(power_of_two_at_least(tube_segments));
  SkinnedMesh mesh;
  for (const Eigen::Vector2f& around : ring) {
    for (const Eigen::Vector2f& across : tube) {
      const Eigen::Vector3f normal(around.x() * across.x(), across.y(), around.y() * across.x());
      mesh.add_vertex(Eigen::Vector3f(0.6f * around.x(), 0, 0.6f * around.y()) + 0.25f * normal, normal);
    }
  }
  const auto rings = static_cast<std::uint32_t>(ring.size());
  const auto tubes = static_cast<std::uint32_t>(tube.size());
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < tubes; ++j) {
      const std::uint32_t next_i = (i + 1) % rings;
      const std::uint32_t next_j = (j + 1) % tubes;
      add_quad(mesh.indices, i * tubes + j, i * tubes + next_j, next_i * tubes + next_j, next_i * tubes + j);
    }
  }
  return mesh;
}

SkinnedMesh make_sphere(int subdivisions) {
  SkinnedMesh mesh;
  const auto side = static_cast<std::uint32_t>(subdivisions) + 1;
  for (int face = 0; face < 6; ++face) {
    const Face axes = cube_face(face);
    const std::uint32_t first = static_cast<std::uint32_t>(face) * side * side;
    for (std::uint32_t j = 0; j < side; ++j) {
      for (std::uint32_t i = 0; i < side; ++i) {
        const float u = 2 * static_cast<float>(i) / static_cast<float>(subdivisions) - 1;
        const float v = 2 * static_cast<float>(j) / static_cast<float>(subdivisions) - 1;
        const Eigen::Vector3f normal = (axes.out + u * axes.u + v * axes.v).normalized();
        mesh.add_vertex(0.55f * normal, normal);
        if (i + 1 < side && j + 1 < side) {
          const std::uint32_t corner = first + j * side + i;
          add_quad(mesh.indices, corner, corner + 1, corner + side + 1, corner + side);
        }
      }
    }
  }
  return mesh;
}

StaticMeshId add_unit_box(Renderer& renderer) {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Triangle> triangles;
  for (int face = 0; face < 6; ++face) {
    const Face axes = cube_face(face);
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const auto& [u, v] : {std::pair(-1.0f, -1.0f), {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
      positions.push_back(0.5f * (axes.out + u * axes.u + v * axes.v));
      normals.push_back(axes.out);
    }
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
  }
  return renderer.add_static_mesh(positions, normals, triangles);
}

Eigen::Matrix4f box_pose(const Eigen::Vector3f& centre, const Eigen::Vector3f& size) {
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();
  for (int axis = 0; axis < 3; ++axis) pose(axis, axis) = size[axis];
  pose.block<3, 1>(0, 3) = centre;
  return pose;
}

TestScene::TestScene(Renderer& renderer, int detail) {
  const auto add_body = [&](const SkinnedMesh& mesh, const Eigen::Vector3f& origin, const Colour& colour) {
    SkinnedDraw item;
    item.mesh = renderer.add_mesh(mesh.indices);
    item.origin = origin;
    item.colour = colour;
    renderer.update_mesh(item.mesh, mesh.bytes());
    skinned_.push_back(item);
  };
  add_body(make_torus(32 * detail, 16 * detail), {-1.0f, 0.25f, 0.7f}, srgb(0xE4572E));
  add_body(make_sphere(8 * detail), {0.9f, 0.55f, 0.9f}, srgb(0x2E9CCA));

  // The floor is a mesh of its own in metres, so that its tiles are.
  const std::vector<Eigen::Vector3f> corners{{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
  const std::vector<Eigen::Vector3f> up(4, Eigen::Vector3f(0, 1, 0));
  const std::vector<Triangle> halves{{0, 1, 2}, {0, 2, 3}};
  StaticDraw floor;
  floor.mesh = renderer.add_static_mesh(corners, up, halves);
  floor.colour = srgb(0xC9CCD1);
  floor.pattern = Pattern::kTiles;
  statics_.push_back(floor);

  const StaticMeshId box = add_unit_box(renderer);
  StaticDraw crate;
  crate.mesh = box;
  const Eigen::Matrix3f turn = (Eigen::Matrix3f() << 0.8f, 0, 0.6f, 0, 1, 0, -0.6f, 0, 0.8f).finished();
  crate.pose = box_pose({0.1f, 0.4f, -1.1f}, {1.6f, 0.8f, 0.8f});
  crate.pose.block<3, 3>(0, 0) = turn * crate.pose.block<3, 3>(0, 0).eval();
  crate.colour = srgb(0xE8B33F);
  statics_.push_back(crate);

  for (int wall = 0; wall < 4; ++wall) {
    const float sign = wall % 2 == 0 ? 1.0f : -1.0f;
    StaticDraw item;
    item.mesh = box;
    item.pose = wall < 2 ? box_pose({0, 0.5f, sign * 4.05f}, {8.2f, 1, 0.1f})
                         : box_pose({sign * 4.05f, 0.5f, 0}, {0.1f, 1, 8});
    item.colour = srgb(0xAEC6D8);
    item.opacity = 0.35f;
    statics_.push_back(item);
  }

  for (std::uint32_t z = 0; z < 4; ++z) {
    for (std::uint32_t y = 0; y < 4; ++y) {
      for (std::uint32_t x = 0; x < 4; ++x) {
        const std::uint32_t index = x + 4 * y + 16 * z;
        particles_.push_back(
            Eigen::Vector3f(1.9f, 0.06f, -1.6f) +
            0.3f * Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)));
        if (x > 0) links_.push_back({index - 1, index});
        if (y > 0) links_.push_back({index - 4, index});
        if (z > 0) links_.push_back({index - 16, index});
      }
    }
  }
  LatticeDraw lattice;
  lattice.particles = particles_;
  lattice.links = links_;
  lattice.radius = 0.06f;
  lattice.colour = srgb(0x3E8E41);
  lattices_.push_back(lattice);
}

FrameDescription TestScene::frame() const {
  FrameDescription frame;
  frame.camera.eye = {3.6f, 3.4f, 6.2f};
  frame.camera.target = {0.1f, 0.2f, 0};
  frame.camera.tan_half_fov_y = 0.35f;
  frame.light.shadow_radius = 6;
  frame.skinned = skinned_;
  frame.statics = statics_;
  frame.lattices = lattices_;
  return frame;
}

}  // namespace softcell::render::test
