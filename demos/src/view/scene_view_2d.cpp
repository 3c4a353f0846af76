#include "scene_view_2d.h"

#include <algorithm>
#include <set>
#include <span>
#include <utility>
#include <variant>

#include "rope_drawing.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;

// Fractions of the visible height.
constexpr float kLine = 0.0034f;
constexpr float kRounding = 0.009f, kBevel = 0.022f;  // of rigid bodies
constexpr float kHandRadius = 0.011f;
constexpr float kMarkRadius = 0.13f, kMarkDistance = 0.62f;  // fractions of a circle's radius

constexpr float kLeastLine = 1.6f;  // pixels: thinner lines would not hide the steps in a shape's edge
constexpr float kPale = 0.28f;      // opacity of bodies under their particles

// How far from a thing the picture depends on it, in pixels, besides its shadow: the shadow is blurred in squares of four pixels and drawn
// between their centres, and lines have soft edges.
constexpr float kReach = 16;

render::Colour darker(const render::Colour& colour) { return 0.45f * colour; }

/// The side of the paper's squares: small enough to show sizes, and a whole number of metres or a binary fraction of one.
float squares_for(float height) {
  constexpr float kFewest = 20;  // in the picture's height
  float side = 0.25f;
  while (height / side < kFewest) side /= 2;
  while (height / side >= 2 * kFewest) side *= 2;
  return side;
}

}  // namespace

SceneView2d::SceneView2d(const Scene2d& scene, const Simulation2d& simulation, render::Renderer& renderer,
                         View2d view)
    : scene_(scene), simulation_(simulation), renderer_(renderer), view_(view), moved_(scene) {
  for (const RigidBody2d& body : scene_.rigid_bodies) add_rigid_body(body);
  SC_ASSERT(simulation_.soft_bodies() >= scene_.soft_bodies.size(), "a simulation of {} bodies of {}",
            simulation_.soft_bodies(), scene_.soft_bodies.size());
  simulation_.show(now_);
  follow_bodies(now_);
}

void SceneView2d::add_rigid_body(const RigidBody2d& body) {
  const float height = scene_.camera.height;
  const bool firm = body.mass == 0;
  RigidBody& added = rigid_bodies_.emplace_back(
      RigidBody{.shape = rigid_shape_2d(body, kRounding * height, firm ? 0 : kBevel * height),
                .id = {},
                .firm = firm,
                .mark_radius = {},
                .vertices = {},
                .outline = {},
                .mark = {}});
  added.id = renderer_.add_shape(added.shape.triangles);
  added.vertices = added.shape.vertices;
  added.outline = added.shape.outline;
  if (const auto* circle = std::get_if<CircleShape>(&body.shape); circle != nullptr && !firm)
    added.mark_radius = circle->radius;
}

/// Makes the shapes of bodies that are new, or that have broken since they were last drawn.
void SceneView2d::follow_bodies(const Shown2d& shown) {
  const std::size_t count = shown.models.size();
  for (std::size_t b = count; b < soft_bodies_.size(); ++b) soft_bodies_[b]->shape.remove_from(renderer_);
  soft_bodies_.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    if (soft_bodies_[b] && soft_bodies_[b]->model == shown.models[b]) continue;
    if (soft_bodies_[b]) soft_bodies_[b]->shape.remove_from(renderer_);
    soft_bodies_[b] = make_soft_body(scene_.soft_bodies[shown.sources[b]], shown.models[b]);
  }
}

std::unique_ptr<SceneView2d::SoftBody> SceneView2d::make_soft_body(
    const SoftBody2dPlacement& body, std::shared_ptr<const ppu::SoftBodyModel<2>> model) {
  SC_ASSERT(model != nullptr, "body '{}' without a model", body.name);
  std::set<Link> edges;
  for (const auto& corners : model->lattice().corners) {
    // Corner k is at (k & 1, k >> 1).
    const auto [a, b, c, d] = corners;
    for (const auto& [from, to] : {Link{a, b}, Link{c, d}, Link{a, c}, Link{b, d}})
      edges.insert({std::min(from, to), std::max(from, to)});
  }
  const ppu::SoftBodyModel<2>& of = *model;
  return std::make_unique<SoftBody>(SoftBody{.model = std::move(model),
                                             .colour = body.colour,
                                             .shape = SoftShape2d(body, of, renderer_, stickers_, wholes_),
                                             .particles = {},
                                             .outer = {},
                                             .at_cut = {},
                                             .inner = {},
                                             .edges = std::vector<Link>(edges.begin(), edges.end())});
}

float SceneView2d::line_width() const {
  return scene_.camera.height * std::max(kLine, kLeastLine / static_cast<float>(renderer_.height()));
}

void SceneView2d::draw_rigid_body(std::size_t index, const Pose2d& pose) {
  RigidBody& body = rigid_bodies_[index];
  const render::Colour& colour = scene_.rigid_bodies[index].colour;
  const auto turned = [&](const Vector2f& v) {
    return Vector2f(pose.cosine * v.x() - pose.sine * v.y(), pose.sine * v.x() + pose.cosine * v.y());
  };
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    body.vertices[i].position = pose.position + turned(body.shape.vertices[i].position);
    body.vertices[i].slope = turned(body.shape.vertices[i].slope);
  }
  for (std::size_t i = 0; i < body.outline.size(); ++i)
    body.outline[i] = pose.position + turned(body.shape.outline[i]);
  drawing_.shapes.push_back({.shape = body.id,
                             .vertices = body.vertices,
                             .colour = colour,
                             .fill = body.firm ? render::Fill2d::kHatched : render::Fill2d::kPlain});
  // Walls overlap: the fixed bodies have one common outline around all of them.
  auto& lines = body.firm ? drawing_.lines_below : drawing_.lines;
  lines.push_back({.points = body.outline,
                   .closed = true,
                   .width = (body.firm ? 2 : 1) * line_width(),
                   .colour = ink_of(colour)});
  if (!body.mark_radius) return;
  body.mark = {pose.position + turned({kMarkDistance * *body.mark_radius, 0})};
  drawing_.dots.push_back({.centres = body.mark,
                           .radius = kMarkRadius * *body.mark_radius,
                           .colour = darker(colour),
                           .opacity = 0.8f});
}

void SceneView2d::draw_soft_body(std::size_t index, View2d view) {
  SoftBody& body = *soft_bodies_[index];
  const render::Colour& colour = body.colour;
  const float spacing = body.model->lattice().spacing;
  body.shape.draw(drawing_, line_width(), view == View2d::kFilled ? 1 : kPale);
  if (view == View2d::kLattice) {
    drawing_.links.push_back({.points = body.particles,
                              .links = body.edges,
                              .width = 0.7f * line_width(),
                              .colour = darker(colour)});
    drawing_.dots.push_back({.centres = body.particles, .radius = 0.13f * spacing, .colour = colour});
  } else if (view == View2d::kDots) {
    // The outer particles with the radius of their contacts.
    const auto& positions = body.particles;
    body.outer.clear(), body.at_cut.clear(), body.inner.clear();
    for (const std::uint32_t i : body.model->outer())
      (body.model->is_at_cut(i) ? body.at_cut : body.outer).push_back(positions[i]);
    for (const std::uint32_t i : body.model->inner()) body.inner.push_back(positions[i]);
    const float radius = body.model->contact_radius();
    drawing_.dots.push_back({.centres = body.outer, .radius = radius, .colour = colour, .opacity = 0.55f});
    if (!body.at_cut.empty())
      drawing_.dots.push_back(
          {.centres = body.at_cut, .radius = radius / 2, .colour = colour, .opacity = 0.55f});
    for (const auto& centres : {std::span<const Vector2f>(body.outer), std::span<const Vector2f>(body.at_cut),
                                std::span<const Vector2f>(body.inner)})
      drawing_.dots.push_back({.centres = centres, .radius = 0.13f * spacing, .colour = darker(colour)});
  }
}

/// Draws ropes straight when they are taut, else as a parabola.
void SceneView2d::draw_ropes(const Shown2d& shown) {
  constexpr int kSegments2d = 24;
  ropes_.resize(shown.ropes.size());
  for (std::size_t i = 0; i < shown.ropes.size(); ++i) {
    const ShownRope<2>& rope = shown.ropes[i];
    const Vector2f way = rope.ends[1] - rope.ends[0];
    const float sag = rope_sag(way.norm(), rope.length);
    ropes_[i].clear();
    for (int k = 0; k <= kSegments2d; ++k) {
      const float share = static_cast<float>(k) / kSegments2d;
      ropes_[i].push_back(rope.ends[0] + share * way - Vector2f(0, 4 * sag * share * (1 - share)));
    }
    const std::span<const Vector2f> points(ropes_[i]);
    drawing_.lines.push_back({.points = points, .width = rope.thickness, .colour = rope.colour});
    for (const auto& end : {points.first(1), points.last(1)})
      drawing_.dots.push_back({.centres = end, .radius = rope.thickness, .colour = rope.colour});
  }
}

void SceneView2d::draw_hands(const Shown2d& shown) {
  hands_.assign(shown.hands.begin(), shown.hands.end());
  const float radius = kHandRadius * scene_.camera.height;
  const render::Colour colour = render::srgb(0x263247);
  for (const auto& hand : hands_) {
    drawing_.lines.push_back({.points = hand, .width = 0.35f * radius, .colour = colour});
    const std::span<const Vector2f> ends(hand);
    drawing_.dots.push_back({.centres = ends.first(1), .radius = 0.6f * radius, .colour = colour});
    drawing_.dots.push_back({.centres = ends.last(1), .radius = radius, .colour = colour});
    drawing_.dots.push_back(
        {.centres = ends.last(1), .radius = 0.55f * radius, .colour = render::srgb(0xF6F1E6)});
  }
}

std::optional<render::PixelRect> SceneView2d::changes(const Shown2d& shown, View2d view) {
  Moved2d::Box soft;
  for (const auto& body : soft_bodies_) {
    soft.extend(body->shape.box());
    const Vector2f radius = Vector2f::Constant(body->model->contact_radius());
    for (const Vector2f& particle : body->particles) {
      soft.extend(particle - radius);
      soft.extend(particle + radius);
    }
  }
  for (const auto& rope : ropes_)
    for (const Vector2f& point : rope) soft.extend(point);
  for (const ShownRope<2>& rope : shown.ropes) {
    soft.extend(Vector2f(rope.ends[0] + Vector2f::Constant(2 * rope.thickness)));
    soft.extend(Vector2f(rope.ends[0] - Vector2f::Constant(2 * rope.thickness)));
  }
  const Moved2d::Box moved = moved_.since_last(shown, soft);
  if (drawn_view_ != view) {
    drawn_view_ = view;
    return std::nullopt;
  }
  if (moved.isEmpty()) return render::PixelRect{};
  const Camera2d& camera = scene_.camera;
  SC_ASSERT(camera.height > 0, "a camera that shows {} m", camera.height);
  const float pixels = static_cast<float>(renderer_.height()) / camera.height;  // per metre
  const auto from_middle = [&](float metres, int side) {
    return static_cast<float>(side) / 2 + pixels * metres;
  };
  const render::Shadow2d shadow;
  const float shadow_reach = shadow.offset.cwiseAbs().maxCoeff() + shadow.blur;
  const Vector2f reach = Vector2f::Constant(std::max(shadow_reach, kHandRadius) * camera.height +
                                            2 * line_width() + kReach / pixels);
  const Vector2f low = moved.min() - reach - camera.centre, high = moved.max() + reach - camera.centre;
  // Clamped, because a body that has gone far away must not leave the range of int.
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
  follow_bodies(shown);
  SC_ASSERT(shown.particles.size() == soft_bodies_.size() && shown.rigid_poses.size() == rigid_bodies_.size(),
            "{} soft and {} rigid bodies in the view of {} and {}", shown.particles.size(),
            shown.rigid_poses.size(), soft_bodies_.size(), rigid_bodies_.size());
  const auto view = static_cast<View2d>(look.view);
  drawing_.clear();
  // Fixed bodies lie below those that move.
  for (const bool firm : {true, false}) {
    for (std::size_t i = 0; i < rigid_bodies_.size(); ++i) {
      if (rigid_bodies_[i].firm == firm) draw_rigid_body(i, shown.rigid_poses[i]);
    }
  }
  for (std::size_t b = 0; b < soft_bodies_.size(); ++b) {
    soft_bodies_[b]->particles.assign(shown.particles[b].begin(), shown.particles[b].end());
    soft_bodies_[b]->shape.deform(shown.particles[b]);
    draw_soft_body(b, view);
  }
  draw_ropes(shown);
  draw_hands(shown);
  renderer_.render({.centre = scene_.camera.centre,
                    .height = scene_.camera.height,
                    .paper = {.squares = squares_for(scene_.camera.height)},
                    .lines_below = drawing_.lines_below,
                    .shapes = drawing_.shapes,
                    .links = drawing_.links,
                    .lines = drawing_.lines,
                    .dots = drawing_.dots,
                    .changes = changes(shown, view)});
}

}  // namespace softcell::demos
