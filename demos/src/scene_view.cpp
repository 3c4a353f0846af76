#include "scene_view.h"

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
    skinned_.push_back({.mesh = renderer_.add_mesh(model.embedding().indices), .colour = colour});
    if (view_ == View::kLattice) {
      LatticeBuffers& buffers = lattice_buffers_[b];
      buffers.particles.resize(model.lattice().particles.size());
      buffers.links = links_of(model.lattice());
      lattices_.push_back({buffers.particles, buffers.links, model.lattice().spacing * 0.12f, colour});
    }
  }
}

void SceneView::update_lattices() {
  for (std::size_t b = 0; b < lattice_buffers_.size(); ++b) {
    const auto corners = simulation_.shown_particles(b);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      lattice_buffers_[b].particles[i] = {corners[i].x, corners[i].y, corners[i].z};
    }
  }
}

render::Camera SceneView::tilted_camera() const {
  // The world is simulated in the ground's frame; what tilts there is the observer.
  const Eigen::Matrix3f to_ground = simulation_.shown_tilt().transpose();
  render::Camera camera = scene_.camera;
  camera.eye = to_ground * camera.eye;
  camera.target = to_ground * camera.target;
  camera.up = to_ground * camera.up;
  return camera;
}

const render::Image& SceneView::draw() {
  const auto poses = simulation_.shown_box_poses();
  for (std::size_t i = 0; i < poses.size(); ++i) statics_[i].pose = poses[i];

  render::FrameDescription frame;
  frame.camera = tilted_camera();
  frame.light = scene_.light;
  frame.light.toward = simulation_.shown_tilt().transpose() * scene_.light.toward;
  frame.statics = statics_;
  if (view_ == View::kMesh) {
    for (std::size_t b = 0; b < skinned_.size(); ++b) {
      const ppu::SkinnedBody body = simulation_.shown(b);
      renderer_.update_mesh(skinned_[b].mesh, std::as_bytes(body.vertices));
      skinned_[b].origin = body.origin;
    }
    frame.skinned = skinned_;
  } else {
    update_lattices();
    frame.lattices = lattices_;
  }
  renderer_.render(frame);
  return renderer_.pixels();
}

}  // namespace softcell::demos
