#include "scene_view_2d.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include "ppu/numbers/half.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// Shares of the height of what the picture shows.
constexpr float kPlateDepth = 0.03f;  // of rigid bodies
constexpr float kBackWall = 0.04f;    // behind z = 0
constexpr float kEye = 50;            // so far away that what is 4 % nearer looks 1 permille larger
// How far around a thing the picture depends on it: shadows fall down and to the right on what is at most a
// tenth behind, under a light that is half as high as it is near, and their edges are soft.
constexpr float kShadowReach = 0.08f;
constexpr float kHandRadius = 0.008f;
constexpr int kCirclePoints = 48;
constexpr float kMarkRadius = 0.12f, kMarkDistance = 0.65f;  // shares of a circle's radius

constexpr std::array<std::array<std::uint32_t, 2>, 1> kHandLink{{{0, 1}}};

/// A plate with this outline, counter-clockwise, from -depth to depth in z.
void extrude(const std::vector<Vector2f>& outline, float depth, std::vector<Vector3f>& positions,
             std::vector<Vector3f>& normals, std::vector<render::Triangle>& triangles) {
  SC_ASSERT(outline.size() >= 3, "a plate with {} corners", outline.size());
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const Vector2f& corner : outline) {
    positions.emplace_back(corner.x(), corner.y(), depth);
    normals.push_back(Vector3f::UnitZ());
  }
  for (std::uint32_t i = 2; i < n; ++i) triangles.push_back({0, i - 1, i});
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vector2f a = outline[i], b = outline[(i + 1) % n], along = (b - a).normalized();
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const Vector2f& corner : {a, b}) {
      for (const float z : {depth, -depth}) {
        positions.emplace_back(corner.x(), corner.y(), z);
        normals.emplace_back(along.y(), -along.x(), 0);
      }
    }
    triangles.push_back({first, first + 1, first + 3});
    triangles.push_back({first, first + 3, first + 2});
  }
}

struct OutlineOf {
  std::vector<Vector2f> operator()(const Box2dShape& box) const {
    const float x = box.size.x() / 2, y = box.size.y() / 2;
    return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  }
  std::vector<Vector2f> operator()(const PolygonShape& polygon) const { return polygon.corners; }
  std::vector<Vector2f> operator()(const CircleShape& circle) const {
    std::vector<Vector2f> outline;
    for (int i = 0; i < kCirclePoints; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / kCirclePoints;
      outline.emplace_back(circle.radius * std::cos(angle), circle.radius * std::sin(angle));
    }
    return outline;
  }
};

render::Colour darker(const render::Colour& colour) { return 0.45f * colour; }
render::Colour lighter(const render::Colour& colour) {
  return 0.75f * colour + render::Colour::Constant(0.25f);
}

}  // namespace

SceneView2d::SceneView2d(const Scene2d& scene, const Simulation2d& simulation, render::Renderer& renderer,
                         View2d view)
    : scene_(scene), simulation_(simulation), renderer_(renderer), view_(view) {
  for (const RigidBody2d& body : scene_.rigid_bodies) add_rigid_body(body);
  add_back_wall();
  SC_ASSERT(simulation_.soft_bodies() == scene_.soft_bodies.size(), "a simulation of {} bodies of {}",
            simulation_.soft_bodies(), scene_.soft_bodies.size());
  std::vector<float> margins;
  for (std::size_t b = 0; b < simulation_.soft_bodies(); ++b) {
    const ppu::SoftBodyModel<2>& model = simulation_.soft_body(b).model();
    add_soft_body(model);
    margins.push_back(std::max(model.contact_radius(), 0.2f * model.lattice().spacing));
  }
  moved_.emplace(scene_, std::move(margins));
}

void SceneView2d::add_plate(const std::vector<Vector2f>& corners, const render::Colour& colour) {
  std::vector<Vector3f> positions, normals;
  std::vector<render::Triangle> triangles;
  extrude(corners, kPlateDepth * scene_.camera.height, positions, normals, triangles);
  statics_.push_back({.mesh = renderer_.add_static_mesh(positions, normals, triangles), .colour = colour});
}

void SceneView2d::add_rigid_body(const RigidBody2d& body) {
  add_plate(std::visit(OutlineOf{}, body.shape), body.colour);
  if (std::holds_alternative<CircleShape>(body.shape)) {
    circles_.push_back(statics_.size() - 1);
    marks_.emplace_back();
  }
}

void SceneView2d::add_back_wall() {
  const float reach = 4 * scene_.camera.height, depth = kBackWall * scene_.camera.height;
  const std::array<Vector3f, 4> corners{
      {{-reach, -reach, 0}, {reach, -reach, 0}, {reach, reach, 0}, {-reach, reach, 0}}};
  std::array<Vector3f, 4> normals;
  normals.fill(Vector3f::UnitZ());
  const std::array<render::Triangle, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  render::StaticDraw wall{.mesh = renderer_.add_static_mesh(corners, normals, triangles),
                          .colour = render::srgb(0xE4E1DA)};
  wall.pose.topRightCorner<3, 1>() = Vector3f(scene_.camera.centre.x(), scene_.camera.centre.y(), -depth);
  statics_.push_back(wall);
}

void SceneView2d::add_soft_body(const ppu::SoftBodyModel<2>& model) {
  Body& body = bodies_.emplace_back();
  body.model = &model;
  body.particles.resize(model.particles());
  body.outer.resize(model.outer().size());
  body.inner.resize(model.inner().size());
  std::vector<std::uint32_t> indices;
  std::map<Link, int> cells_at;  // of each edge
  for (const auto& corners : model.lattice().corners) {
    // Corner k is at (k & 1, k >> 1).
    const auto [a, b, c, d] = corners;
    indices.insert(indices.end(), {a, b, d, a, d, c});
    for (const auto& [from, to] : {Link{a, b}, Link{c, d}, Link{a, c}, Link{b, d}})
      ++cells_at[{std::min(from, to), std::max(from, to)}];
  }
  for (const auto& [edge, cells] : cells_at) {
    body.edges.push_back(edge);
    if (cells == 1) body.outline.push_back(edge);
  }
  body.mesh = renderer_.add_mesh(indices);
}

void SceneView2d::place_rigid_bodies(const std::vector<Pose2d>& poses) {
  SC_ASSERT(poses.size() == scene_.rigid_bodies.size() && circles_.size() == marks_.size(),
            "{} poses of {} rigid bodies, {} marks on {} circles", poses.size(), scene_.rigid_bodies.size(),
            marks_.size(), circles_.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose2d& pose = poses[i];
    Eigen::Matrix4f& matrix = statics_[i].pose;
    matrix.topLeftCorner<2, 2>() << pose.cosine, -pose.sine, pose.sine, pose.cosine;
    matrix.topRightCorner<2, 1>() = pose.position;
  }
  for (std::size_t i = 0; i < circles_.size(); ++i) {
    const RigidBody2d& body = scene_.rigid_bodies[circles_[i]];
    const float radius = std::get<CircleShape>(body.shape).radius;
    const Eigen::Matrix4f& pose = statics_[circles_[i]].pose;
    marks_[i] = {
        (pose * Eigen::Vector4f(kMarkDistance * radius, 0, 1.5f * kPlateDepth * scene_.camera.height, 1))
            .head<3>()};
    lattices_.push_back({marks_[i], {}, kMarkRadius * radius, darker(body.colour)});
  }
}

void SceneView2d::place_particles(Body& body, const std::vector<Vector2f>& positions) const {
  SC_ASSERT(positions.size() == body.particles.size(), "a body of {} particles has {}", body.particles.size(),
            positions.size());
  const auto place = [&](std::uint32_t particle) {
    return Vector3f(positions[particle].x(), positions[particle].y(), 0);
  };
  for (std::uint32_t i = 0; i < positions.size(); ++i) body.particles[i] = place(i);
  const ppu::SoftBodyModel<2>& model = *body.model;
  std::transform(model.outer().begin(), model.outer().end(), body.outer.begin(), place);
  std::transform(model.inner().begin(), model.inner().end(), body.inner.begin(), place);
}

void SceneView2d::draw_as_dots(std::size_t b) {
  const Body& body = bodies_[b];
  const ppu::SoftBodyModel<2>& model = *body.model;
  const render::Colour& colour = scene_.soft_bodies[b].colour;
  // The outer particles as large as they are to others.
  lattices_.push_back({body.outer, {}, model.contact_radius(), colour});
  lattices_.push_back({body.inner, {}, 0.2f * model.lattice().spacing, lighter(colour)});
}

void SceneView2d::draw_as_lattice(std::size_t b) {
  const Body& body = bodies_[b];
  const float radius = 0.13f * body.model->lattice().spacing;
  lattices_.push_back({body.particles, body.edges, radius, scene_.soft_bodies[b].colour});
}

void SceneView2d::draw_filled(std::size_t b, const std::vector<Vector2f>& positions) {
  Body& body = bodies_[b];
  SC_ASSERT(!positions.empty(), "body {} of {} has no particles", b, bodies_.size());
  const Vector2f origin = positions.front();
  vertices_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vector2f p = positions[i] - origin;
    vertices_[i] = {
        ppu::half_from_float(p.x()), ppu::half_from_float(p.y()), 0, 0, 0, 0, ppu::half_from_float(1), 0};
  }
  renderer_.update_mesh(body.mesh, std::as_bytes(std::span(vertices_)));
  const render::Colour& colour = scene_.soft_bodies[b].colour;
  skinned_.push_back(
      {.mesh = body.mesh, .origin = {origin.x(), origin.y(), 0}, .colour = colour, .two_sided = true});
  lattices_.push_back({body.particles, body.outline, 0, darker(colour)});
}

void SceneView2d::draw_hands(const Shown2d& shown) {
  hands_.clear();
  const float z = 2 * kPlateDepth * scene_.camera.height;
  for (const auto& [particle, hand] : shown.hands)
    hands_.push_back({Vector3f(particle.x(), particle.y(), z), Vector3f(hand.x(), hand.y(), z)});
  for (const auto& hand : hands_)
    lattices_.push_back({hand, kHandLink, kHandRadius * scene_.camera.height, render::srgb(0x202428)});
}

std::optional<render::PixelRect> SceneView2d::changes(const Shown2d& shown, View2d view) {
  const Moved2d::Box moved = moved_->since_last(shown);
  if (drawn_view_ != view) {
    drawn_view_ = view;
    return std::nullopt;
  }
  if (moved.isEmpty()) return render::PixelRect{};
  const Camera2d& camera = scene_.camera;
  SC_ASSERT(camera.height > 0, "a camera that shows {} m", camera.height);
  const float pixels = static_cast<float>(renderer_.height()) / camera.height;  // of a metre
  const auto from_middle = [&](float metres, int side) {
    return static_cast<float>(side) / 2 + pixels * metres;
  };
  const Vector2f reach = Vector2f::Constant(kShadowReach * camera.height + 2 / pixels);
  const Vector2f low = moved.min() - reach - camera.centre, high = moved.max() + reach - camera.centre;
  // A body that has gone far away must not leave the range of numbers either.
  const auto pixel = [&](float at, int side) {
    return static_cast<int>(std::clamp(at, -1.0f, static_cast<float>(side) + 1));
  };
  const int width = renderer_.width(), height = renderer_.height();
  return render::PixelRect{.left = pixel(from_middle(low.x(), width), width),
                           .top = pixel(from_middle(-high.y(), height), height),
                           .right = pixel(from_middle(high.x(), width), width) + 1,
                           .bottom = pixel(from_middle(-low.y(), height), height) + 1};
}

const render::Image& SceneView2d::draw() {
  simulation_.show(now_);
  draw(now_, {.view = static_cast<int>(view_)});
  return renderer_.pixels();
}

void SceneView2d::draw(const Shown2d& shown, const Look& look) {
  SC_ASSERT(shown.particles.size() == bodies_.size(), "{} bodies in the view of {}", shown.particles.size(),
            bodies_.size());
  skinned_.clear();
  lattices_.clear();
  place_rigid_bodies(shown.rigid_poses);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    place_particles(bodies_[b], shown.particles[b]);
    switch (static_cast<View2d>(look.view)) {
      case View2d::kDots:
        draw_as_dots(b);
        break;
      case View2d::kLattice:
        draw_as_lattice(b);
        break;
      case View2d::kFilled:
        draw_filled(b, shown.particles[b]);
        break;
    }
  }
  draw_hands(shown);

  const float height = scene_.camera.height;
  const Vector3f centre(scene_.camera.centre.x(), scene_.camera.centre.y(), 0);
  render::FrameDescription frame;
  frame.camera = {.eye = centre + Vector3f(0, 0, kEye * height),
                  .target = centre,
                  .up = {0, 1, 0},
                  .tan_half_fov_y = 0.5f / kEye,
                  .near_plane = (kEye - 1) * height,
                  .far_plane = (kEye + 1) * height};
  frame.light.toward = {-0.35f, 0.5f, 1};
  frame.light.shadow_centre = centre;
  frame.light.shadow_radius = height;
  frame.skinned = skinned_;
  frame.statics = statics_;
  frame.lattices = lattices_;
  frame.changes = changes(shown, static_cast<View2d>(look.view));
  renderer_.render(frame);
}

}  // namespace softcell::demos
