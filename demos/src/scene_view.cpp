#include "scene_view.h"

#include <algorithm>
#include <cmath>

#include "softcell/ppu/shapes.h"

namespace softcell::demos {
namespace {

constexpr float kBoxFaces = 100;  // metres: larger than any box, so that each face is one square

std::vector<std::array<std::uint32_t, 2>> links_of(const ppu::Lattice& lattice) {
  std::vector<std::array<std::uint32_t, 2>> links;
  for (std::uint32_t a = 0; a < lattice.particles.size(); ++a) {
    for (const std::uint32_t b : lattice.neighbours[a]) {
      // Only the edges of cells: all 26 neighbours would hide the picture.
      if (a < b && (lattice.particles[a] - lattice.particles[b]).lpNorm<1>() == 1) links.push_back({a, b});
    }
  }
  return links;
}

/// How the vertices that the kernel `skin` would write hang in the lattice: for the GPU to make them.
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
  return vertices;
}

/// The camera where the user has moved it: about the point it looks at, and never over the top.
render::Camera orbited(render::Camera camera, const Look& look) {
  if (look.turn == 0 && look.rise == 0 && look.distance == 1) return camera;  // the scene's own, to the bit
  constexpr float kLowest = 0.03f, kHighest = 1.5f;                           // above the horizon, radians
  const Eigen::Vector3f from_target = camera.eye - camera.target;
  const float distance = from_target.norm();
  const float turn = std::atan2(from_target.x(), from_target.z()) + look.turn;
  const float rise = std::clamp(std::asin(std::clamp(from_target.y() / distance, -1.0f, 1.0f)) + look.rise,
                                kLowest, kHighest);
  const Eigen::Vector3f direction(std::cos(rise) * std::sin(turn), std::sin(rise),
                                  std::cos(rise) * std::cos(turn));
  camera.eye = camera.target + look.distance * distance * direction;
  return camera;
}

}  // namespace

SceneView::SceneView(const Scene& scene, const Simulation3d& simulation, render::Renderer& renderer,
                     View view)
    : scene_(scene), simulation_(simulation), renderer_(renderer), view_(view) {
  const auto add_static = [&](const ppu::TriangleMesh& mesh) {
    return renderer_.add_static_mesh(mesh.positions, mesh.normals, mesh.triangles);
  };
  for (const RigidBox& box : scene_.boxes) {
    statics_.push_back({.mesh = add_static(ppu::make_box(box.size, kBoxFaces)),
                        .colour = box.colour,
                        .opacity = box.opacity,
                        .pattern = box.pattern});
  }
  for (const Obstacle& obstacle : scene_.obstacles) {
    render::StaticDraw draw{.mesh = add_static(obstacle.mesh), .colour = obstacle.colour};
    draw.pose.topRightCorner<3, 1>() = obstacle.position;
    statics_.push_back(draw);
  }

  lattice_buffers_.resize(simulation_.soft_bodies());
  for (std::size_t b = 0; b < simulation_.soft_bodies(); ++b) {
    const ppu::SoftBodyModel& model = simulation_.model(b);
    const auto& colour = scene_.soft_bodies[b].colour;
    skinned_.push_back({.mesh = add_skinned_mesh(model), .colour = colour});
    LatticeBuffers& buffers = lattice_buffers_[b];
    buffers.particles.resize(model.lattice().particles.size());
    buffers.links = links_of(model.lattice());
    lattices_.push_back({buffers.particles, buffers.links, model.lattice().spacing * 0.12f, colour});
  }
}

render::MeshId SceneView::add_skinned_mesh(const ppu::SoftBodyModel& model) {
  const ppu::Embedding& embedding = model.embedding();
  if (simulation_.skin() == Skin::kSpe) return renderer_.add_mesh(embedding.indices);
  return renderer_.add_cell_mesh(embedding.indices, cell_vertices(embedding), model.particles());
}

void SceneView::update_meshes(const Shown3d& shown) {
  for (std::size_t b = 0; b < skinned_.size(); ++b) {
    const Shown3d::Body& body = shown.bodies[b];
    if (simulation_.skin() == Skin::kSpe) {
      renderer_.update_mesh(skinned_[b].mesh, std::as_bytes(std::span(body.vertices)));
    } else {
      renderer_.update_corners(skinned_[b].mesh, std::as_bytes(std::span(body.particles)), body.origin);
    }
    skinned_[b].origin = body.origin;
  }
}

void SceneView::update_lattices(const Shown3d& shown) {
  for (std::size_t b = 0; b < lattice_buffers_.size(); ++b) {
    const auto& corners = shown.bodies[b].particles;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      lattice_buffers_[b].particles[i] = {corners[i].x, corners[i].y, corners[i].z};
    }
  }
}

render::Camera SceneView::tilted_camera(const Shown3d& shown, const Look& look) const {
  // The world is simulated in the ground's frame; what tilts there is the observer.
  const Eigen::Matrix3f to_ground = shown.tilt.transpose();
  render::Camera camera = orbited(scene_.camera, look);
  camera.eye = to_ground * camera.eye;
  camera.target = to_ground * camera.target;
  camera.up = to_ground * camera.up;
  return camera;
}

const render::Image& SceneView::draw() {
  simulation_.show(now_);
  draw(now_, {.view = static_cast<int>(view_)});
  return renderer_.pixels();
}

void SceneView::draw(const Shown3d& shown, const Look& look) {
  for (std::size_t i = 0; i < shown.box_poses.size(); ++i) statics_[i].pose = shown.box_poses[i];

  render::FrameDescription frame;
  frame.camera = tilted_camera(shown, look);
  frame.light = scene_.light;
  frame.light.toward = shown.tilt.transpose() * scene_.light.toward;
  frame.statics = statics_;
  if (static_cast<View>(look.view) == View::kMesh) {
    update_meshes(shown);
    frame.skinned = skinned_;
  } else {
    update_lattices(shown);
    frame.lattices = lattices_;
  }
  renderer_.render(frame);
}

}  // namespace softcell::demos
