#include "hand_drawing.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::demos {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr float kGloveHeight = 0.16f;  // of the picture's height
constexpr float kThreadEnd = 0.006f;   // radius, also of the picture's height
constexpr std::array<std::array<std::uint32_t, 2>, 1> kThread{{{0, 1}}};

/// A ball of radius 1, stretched and turned by `shape`.
void add_ellipsoid(ppu::TriangleMesh& mesh, const Vector3f& centre, const Matrix3f& shape) {
  static const ppu::TriangleMesh ball = ppu::make_sphere(1, 5);
  SC_ASSERT(shape.determinant() > 0, "an ellipsoid with a volume of {}", shape.determinant());
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Matrix3f to_normal = shape.inverse().transpose();
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    mesh.positions.push_back(centre + shape * ball.positions[i]);
    mesh.normals.push_back((to_normal * ball.normals[i]).normalized());
  }
  for (const auto& [a, b, c] : ball.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

void add_finger(ppu::TriangleMesh& mesh, const Vector3f& knuckle, const Vector3f& tip, float radius) {
  const Vector3f along = (tip - knuckle).normalized(), side = along.unitOrthogonal();
  Matrix3f shape;
  shape << radius * side, radius * along.cross(side), (0.5f * (tip - knuckle).norm() + radius) * along;
  add_ellipsoid(mesh, 0.5f * (knuckle + tip), shape);
}

/// A glove of height 1 with its fingertips together at the origin and the wrist above them.
ppu::TriangleMesh make_glove() {
  ppu::TriangleMesh glove;
  const auto add_ball = [&](const Vector3f& centre, const Vector3f& radii) {
    add_ellipsoid(glove, centre, radii.asDiagonal());
  };
  add_ball({0, 0.62f, 0}, {0.22f, 0.23f, 0.11f});
  add_ball({0, 0.88f, 0}, {0.15f, 0.12f, 0.10f});
  add_ball({0, 0.93f, 0}, {0.20f, 0.06f, 0.15f});  // the cuff
  constexpr float kTipForward = 0.045f;
  for (int finger = 0; finger < 4; ++finger) {
    const float across = -0.165f + 0.11f * static_cast<float>(finger);
    const Vector3f knuckle(across, 0.50f, 0.03f), bend(1.05f * across, 0.27f, 0.12f);
    add_finger(glove, knuckle, bend, 0.062f);
    add_finger(glove, bend, {0.35f * across, 0.05f, kTipForward}, 0.054f);
  }
  const Vector3f bend(0.20f, 0.36f, -0.10f);
  add_finger(glove, {0.14f, 0.58f, -0.04f}, bend, 0.068f);
  add_finger(glove, bend, {0.03f, 0.06f, -0.05f}, 0.058f);
  return glove;
}

}  // namespace

void HandDrawing::append(std::span<const Hand> hands, const render::Camera& camera,
                         std::vector<render::StaticDraw>& statics,
                         std::vector<render::LatticeDraw>& lattices) {
  if (hands.empty()) return;
  if (!has_glove_) {
    const ppu::TriangleMesh glove = make_glove();
    glove_ = renderer_.add_static_mesh(glove.positions, glove.normals, glove.triangles);
    has_glove_ = true;
  }
  threads_.assign(hands.begin(), hands.end());
  const Vector3f back = (camera.eye - camera.target).normalized();
  const Vector3f right = camera.up.cross(back).normalized(), above = back.cross(right);
  // The wrist leans towards the viewer: the hand comes from where the user is.
  Matrix3f turn;
  turn.col(0) = right;
  turn.col(1) = (0.85f * above + 0.5f * back).normalized();
  turn.col(2) = right.cross(turn.col(1));
  for (const Hand& thread : threads_) {
    const Vector3f& at = thread[1];
    const float depth = (camera.eye - at).dot(back);
    if (!(depth > camera.near_plane)) continue;
    const float picture_height = 2 * camera.tan_half_fov_y * depth;
    render::StaticDraw glove{.mesh = glove_, .colour = render::srgb(0xF4F1EA)};
    glove.pose.topLeftCorner<3, 3>() = kGloveHeight * picture_height * turn;
    glove.pose.topRightCorner<3, 1>() = at;
    statics.push_back(glove);
    lattices.push_back({thread, kThread, kThreadEnd * picture_height, render::srgb(0x202428)});
  }
}

}  // namespace softcell::demos
