#include "scene_view.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::demos {
namespace {

constexpr float kVeil = 0.3f;     // opacity of bodies through which marks must be seen
constexpr float kGlass = 0.15f;   // opacity of a wall that hides the scene
constexpr float kBoxFaces = 100;  // metres: larger than any box, so that each face is one square

std::vector<std::array<std::uint32_t, 2>> links_of(const ppu::Lattice<3>& lattice) {
  std::vector<std::array<std::uint32_t, 2>> links;
  for (std::uint32_t a = 0; a < lattice.particles.size(); ++a) {
    for (const std::uint32_t b : lattice.neighbours[a]) {
      // Only the edges of cells: all 26 neighbours would hide the picture.
      if (a < b && (lattice.particles[a] - lattice.particles[b]).lpNorm<1>() == 1) links.push_back({a, b});
    }
  }
  return links;
}

/// How the vertices that the kernel `skin` would write are embedded in the lattice, for the GPU to compute them.
std::vector<render::CellVertex> cell_vertices(const ppu::Embedding& embedding) {
  std::vector<render::CellVertex> vertices;
  vertices.reserve(4 * embedding.groups.size());
  for (const ppu::SkinPart& part : embedding.parts) {
    for (std::uint32_t g = 0; g < part.group_count; ++g) {
      const spu::SkinGroup& group = embedding.groups[part.first_group + g];
      for (std::size_t lane = 0; lane < 4; ++lane) {
        render::CellVertex& vertex = vertices.emplace_back();
        for (std::size_t k = 0; k < 8; ++k) vertex.corner[k] = part.particle(group.corner[k]);
        vertex.place = {group.xi[lane], group.eta[lane], group.zeta[lane]};
        vertex.normal = {group.normal_x[lane], group.normal_y[lane], group.normal_z[lane]};
      }
    }
  }
  SC_ASSERT(vertices.size() == 4 * embedding.groups.size(), "{} vertices in {} groups of four",
            vertices.size(), embedding.groups.size());
  return vertices;
}

/// The opacity of a wall: low if the eye looks through it from outside, so that it does not hide what is behind it.
float wall_opacity(const RigidBox& wall, const Eigen::Matrix4f& pose, const Eigen::Vector3f& eye) {
  // Outside is away from the middle of the framework, across the wall's thickness.
  const int across = wall.size.x() < wall.size.z() ? 0 : 2;
  const Eigen::Vector3f centre = pose.block<3, 1>(0, 3);
  Eigen::Vector3f outwards = pose.block<3, 1>(0, across);
  if (wall.position[across] < 0) outwards = -outwards;
  const float outside = (eye - centre).dot(outwards) / wall.size[across];  // in thicknesses
  const float clear = std::clamp(outside, 0.0f, 1.0f);
  return std::min(wall.opacity, 1 + clear * (kGlass - 1));
}

Eigen::Vector3f down(const Shown3d& shown) { return -shown.tilt.transpose().col(1); }

}  // namespace

SceneView::SceneView(const Scene& scene, const Simulation3d& simulation, render::Renderer& renderer,
                     View view)
    : scene_(scene),
      simulation_(simulation),
      renderer_(renderer),
      view_(view),
      looks_(renderer),
      hands_(renderer),
      ropes_(renderer) {
  const auto add_static = [&](const ppu::TriangleMesh& mesh) {
    Moved3d::Box& box = static_boxes_.emplace_back();
    for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
    return renderer_.add_static_mesh(mesh.positions, mesh.normals, mesh.triangles);
  };
  for (const RigidBox& box : scene_.boxes) {
    statics_.push_back({.mesh = add_static(ppu::make_box(box.size, kBoxFaces)),
                        .colour = box.colour,
                        .opacity = box.opacity,
                        .pattern = box.pattern,
                        .always_shadow = box.opacity >= 1});
  }
  for (const Obstacle& obstacle : scene_.obstacles) {
    render::StaticDraw draw{.mesh = add_static(obstacle.mesh), .colour = obstacle.colour};
    draw.pose.topRightCorner<3, 1>() = obstacle.position;
    if (obstacle.own_materials && MeshLooks::has_looks(obstacle.mesh)) {
      parts_.push_back(looks_.upload(obstacle.mesh, obstacle.colour, draw.mesh));
      draw.parts = parts_.back();
    }
    statics_.push_back(draw);
  }
  rigid_parts_ = add_parts(scene_.rigid_bodies, add_static, statics_);
}

/// Makes the meshes of bodies that are new, or that have broken since they were last drawn.
void SceneView::follow_bodies(const Shown3d& shown) {
  const std::size_t before = lattice_buffers_.size(), count = shown.bodies.size();
  bool changed = before != count;
  for (std::size_t b = count; b < before; ++b) renderer_.remove_mesh(skinned_[b].mesh);
  lattice_buffers_.resize(count);
  skinned_.resize(count);
  skinned_parts_.resize(count);
  lattices_.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    LatticeBuffers& buffers = lattice_buffers_[b];
    if (buffers.model == shown.bodies[b].model) continue;
    changed = true;
    buffers.model = shown.bodies[b].model;
    const ppu::SoftBodyModel<3>& model = *buffers.model;
    const SoftBodyPlacement& placement = scene_.soft_bodies[shown.bodies[b].source];
    if (b < before) renderer_.remove_mesh(skinned_[b].mesh);
    skinned_[b] = {.mesh = add_skinned_mesh(model), .colour = placement.colour};
    skinned_parts_[b].clear();
    if (placement.own_materials && MeshLooks::has_looks(model.mesh()))
      skinned_parts_[b] =
          looks_.upload(model.mesh(), model.embedding().vertex_of_slot, placement.colour, skinned_[b].mesh);
    buffers.particles.resize(model.lattice().particles.size());
    buffers.links = links_of(model.lattice());
  }
  if (!changed) return;
  std::vector<std::shared_ptr<const ppu::MatchingPlan<float, 3>>> plans;
  for (std::size_t b = 0; b < count; ++b) {
    const LatticeBuffers& buffers = lattice_buffers_[b];
    skinned_[b].parts = skinned_parts_[b];
    lattices_[b] = {buffers.particles, buffers.links, buffers.model->lattice().spacing * 0.12f,
                    skinned_[b].colour};
    plans.push_back(buffers.model->plan());
  }
  rotations_.set_bodies(std::move(plans));
  moved_.forget();
}

render::MeshId SceneView::add_skinned_mesh(const ppu::SoftBodyModel<3>& model) {
  const ppu::Embedding& embedding = model.embedding();
  const render::MeshId mesh =
      simulation_.skin() == Skin::kSpe
          ? renderer_.add_mesh(embedding.indices)
          : renderer_.add_cell_mesh(embedding.indices, cell_vertices(embedding), model.particles());
  std::vector<Eigen::Vector3f> positions, normals;
  for (const std::uint32_t vertex : embedding.vertex_of_slot) {
    positions.push_back(model.mesh().positions[vertex]);
    normals.push_back(model.mesh().normals[vertex]);
  }
  renderer_.set_rest_shape(mesh, positions, normals);
  return mesh;
}

void SceneView::update_meshes(const Shown3d& shown) {
  SC_ASSERT(shown.bodies.size() == skinned_.size(), "{} bodies in the view of {}", shown.bodies.size(),
            skinned_.size());
  for (std::size_t b = 0; b < skinned_.size(); ++b) {
    const Shown3d::Body& body = shown.bodies[b];
    if (simulation_.skin() == Skin::kSpe) {
      renderer_.update_mesh(skinned_[b].mesh, std::as_bytes(std::span(body.vertices)));
    } else {
      renderer_.update_corners(skinned_[b].mesh, std::as_bytes(std::span(body.particles)), body.origin);
    }
    skinned_[b].origin = body.origin;
    Moved3d::Box box;
    for (const Eigen::Vector4f& particle : body.particles) box.extend(particle.head<3>());
    skinned_[b].box = box;
  }
}

void SceneView::update_lattices(const Shown3d& shown) {
  for (std::size_t b = 0; b < lattice_buffers_.size(); ++b) {
    const auto& corners = shown.bodies[b].particles;
    SC_ASSERT(corners.size() == lattice_buffers_[b].particles.size(), "body {} has {} particles of {}", b,
              corners.size(), lattice_buffers_[b].particles.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      lattice_buffers_[b].particles[i] = corners[i].head<3>();
    }
  }
}

void SceneView::draw_mesh(const Shown3d& shown, float opacity) {
  update_meshes(shown);
  for (render::SkinnedDraw& item : skinned_) item.opacity = opacity;
  frame_.skinned = skinned_;
}

void SceneView::draw_lattice(const Shown3d& shown) {
  update_lattices(shown);
  frame_.lattices = lattices_;
}

void SceneView::draw_rotations(const Shown3d& shown) {
  constexpr std::array<std::uint32_t, 3> kRedGreenBlue{0xD03020, 0x208030, 0x2050D0};
  rotations_.update(shown.bodies);
  marks_.clear();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Lines& lines = rotations_.axes()[axis];
    marks_.push_back({lines.ends, lines.links, 0, render::srgb(kRedGreenBlue[axis])});
  }
  frame_.lattices = marks_;
}

void SceneView::draw_contacts(const Shown3d& shown) {
  constexpr float kRadius = 0.025f, kLength = 0.3f;  // metres
  draw_mesh(shown, kVeil);
  points_.clear();
  normals_.clear();
  for (const ppu::Contact& contact : shown.contacts) {
    points_.push_back(contact.position);
    normals_.add(contact.position, contact.position + kLength * contact.normal);
  }
  marks_ = {{points_, {}, kRadius, render::srgb(0xC02018)},
            {normals_.ends, normals_.links, 0, render::srgb(0xC02018)}};
  if (!marked_.empty()) marks_.push_back({marked_, {}, 2.2f * kRadius, render::srgb(0xFFC800)});
  frame_.lattices = marks_;
}

std::optional<render::PixelRect> SceneView::changes(const Shown3d& shown) {
  restless_.clear();
  for (const render::SkinnedDraw& item : skinned_) restless_.push_back(*item.box);
  for (const ShownRope<3>& rope : shown.ropes) restless_.push_back(around_rope(rope, down(shown)));
  return moved_.since_last(frame_, {.soft_bodies = restless_,
                                    .static_meshes = static_boxes_,
                                    .picture_width = renderer_.width(),
                                    .picture_height = renderer_.height()});
}

void SceneView::draw_ropes_and_hands(const Shown3d& shown) {
  if (shown.hands.empty() && shown.ropes.empty()) return;
  with_more_ = statics_;
  ropes_.append(shown.ropes, down(shown), with_more_);
  if (!shown.hands.empty()) {
    frame_.changes.reset();
    moved_.forget();
    marks_with_hands_.assign(frame_.lattices.begin(), frame_.lattices.end());
    hands_.append(shown.hands, frame_.camera, with_more_, marks_with_hands_);
    frame_.lattices = marks_with_hands_;
  }
  frame_.statics = with_more_;
}

const render::Image& SceneView::draw() { return draw(0); }

const render::Image& SceneView::draw(float turn) {
  simulation_.show(now_);
  Look look;
  look.view = static_cast<int>(view_);
  look.turn = turn;
  draw(now_, look.view, seen_from(scene_, look, now_.tilt));
  return renderer_.pixels();
}

void SceneView::draw(const Shown3d& shown, const Look& look) {
  boxes_.clear();
  for (const Shown3d::Body& body : shown.bodies) {
    ppu::Bounds<3>& box = boxes_.emplace_back().bounds;
    box.low = box.high = body.particles.front().head<3>();
    for (const Eigen::Vector4f& particle : body.particles) {
      box.low = box.low.cwiseMin(particle.head<3>());
      box.high = box.high.cwiseMax(particle.head<3>());
    }
  }
  append_rigid(scene_, shown.box_poses, boxes_);
  marked_.clear();
  if (look.marked) marked_.push_back(*look.marked);
  draw(shown, look.view, kept_outside(seen_from(scene_, look, shown.tilt), boxes_));
}

void SceneView::draw(const Shown3d& shown, int view, const render::Camera& camera) {
  follow_bodies(shown);
  const std::size_t boxes = scene_.boxes.size();
  SC_ASSERT(shown.box_poses.size() == boxes + scene_.rigid_bodies.size(),
            "{} poses of {} boxes and {} bodies", shown.box_poses.size(), boxes, scene_.rigid_bodies.size());
  for (std::size_t i = 0; i < boxes; ++i) {
    statics_[i].pose = shown.box_poses[i];
    if (scene_.boxes[i].wall)
      statics_[i].opacity = wall_opacity(scene_.boxes[i], shown.box_poses[i], camera.eye);
  }
  for (const DrawnPart& part : rigid_parts_)
    statics_[part.draw].pose = shown.box_poses[boxes + part.body] * part.pose_in_body;

  frame_ = {};
  frame_.camera = camera;
  frame_.light = scene_.light;
  frame_.light.toward = shown.tilt.transpose() * scene_.light.toward;
  frame_.statics = statics_;
  switch (static_cast<View>(view)) {
    case View::kMesh:
      draw_mesh(shown, 1);
      break;
    case View::kLattice:
      draw_lattice(shown);
      break;
    case View::kRotations:
      draw_rotations(shown);
      break;
    case View::kContacts:
      draw_contacts(shown);
      break;
  }
  if (static_cast<View>(view) == View::kMesh) {
    frame_.changes = changes(shown);
  } else {
    moved_.forget();
  }
  draw_ropes_and_hands(shown);
  renderer_.render(frame_);
}

}  // namespace softcell::demos
