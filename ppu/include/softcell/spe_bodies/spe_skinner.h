#pragma once
// The surfaces of soft bodies as vertex buffers of half floats, made by the SPEs and ready for upload, one
// frame late.
//
//     SpeSkinner skinner(spes);                                  // an SpeRuntime
//     skinner.add(body);                                         // once for each body
//     const DrawOrder order = draw_order(body.model());          // once for each model: index buffer, ...
//     ...
//     // Each frame:
//     world.stepSimulation(...);
//     skinner.begin_frame();                                     // the SPEs start; does not wait
//     const SkinnedVertices drawn = skinner.vertices(body);      // of the newest frame that they have finished
//     upload(drawn.vertices);  set_offset(drawn.origin);
//
//   caller  step 0 | begin 0 | step 1 | begin 1, show 0 | step 2 | begin 2, show 1 | ...
//   SPEs             [ skin 0        ]   [ skin 1             ]   [ skin 2 ...
//
// Vertices exist twice in main memory: the SPEs write one buffer while the caller reads the other.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "softcell/dma/address_space.h"
#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

class SpeRuntime;

/// One vertex, 16 bytes of IEEE 754 binary16 numbers in the host's byte order. In OpenGL: attribute 0 of 3
/// GL_HALF_FLOAT at offset 0, attribute 1 of 3 at offset 8, stride 16.
struct alignas(16) HalfVertex {
  std::uint16_t position[4];  ///< x y z in metres from SkinnedVertices::origin, and 1
  std::uint16_t normal[4];    ///< x y z of a unit vector, and 0
};

/// The vertices of one body.
struct SkinnedVertices {
  /// Of draw_order(model).mesh_vertex.size(); empty before the body's first frame is finished. Valid until
  /// the next begin_frame(), finish_frame(), add() or remove().
  std::span<const HalfVertex> vertices;
  Eigen::Vector3f origin{0, 0, 0};  ///< metres, world: what all positions are relative to in this frame
};

/// How the vertices of all bodies of one model are drawn. Valid as long as the model.
struct DrawOrder {
  std::span<const std::uint32_t> indices;  ///< three vertices for each triangle of model.mesh(), in order
  /// For each vertex the number of the mesh's vertex that it is. The SPEs skin four vertices of a lattice cell
  /// at a time: vertices have another order than the mesh's, and some occur twice.
  std::span<const std::uint32_t> mesh_vertex;

  /// An attribute of the mesh's vertices (texture coordinates, colours) in this order.
  template <class Value>
  std::vector<Value> reorder(const std::vector<Value>& of_mesh) const {
    std::vector<Value> reordered;
    reordered.reserve(mesh_vertex.size());
    for (const std::uint32_t vertex : mesh_vertex) reordered.push_back(of_mesh.at(vertex));
    return reordered;
  }
};

/// The order of the model's vertices; empty for a model without a mesh. Any thread.
DrawOrder draw_order(const SoftBodyModel<3>& model);

/// Skins bodies on SPEs. Used by one thread, between the steps of the bodies.
class SpeSkinner {
 public:
  /// @param spes  outlives the skinner. @throws std::runtime_error  as SpeRuntime::kernel().
  explicit SpeSkinner(SpeRuntime& spes);
  /// For a job system of one's own. `skin` is the image of that kernel. All three outlive the skinner.
  SpeSkinner(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& skin);
  /// Waits for the SPEs.
  ~SpeSkinner();
  SpeSkinner(const SpeSkinner&) = delete;
  SpeSkinner& operator=(const SpeSkinner&) = delete;

  /// Waits for the frame under way and adds a body to the ones to come. The body stays where it is until
  /// remove(). A body that breaks, is cut or is assigned to has another model: remove() it before the next frame and
  /// add() it again, and its other pieces.
  /// @throws std::invalid_argument  its model has no mesh, or it was added before.
  /// @throws std::runtime_error     main memory is full; as finish_frame().
  void add(const SoftBody<3>& body);
  /// Waits for the frame under way and takes a body out: call it before the body goes.
  /// @throws std::invalid_argument  it was not added. @throws std::runtime_error  as finish_frame().
  void remove(const SoftBody<3>& body);

  /// Copies where the particles of all bodies are now and has the SPEs begin to skin them. Never waits: when
  /// the SPEs have not finished the frame before, nothing is done, and the picture stays as it is.
  /// @return whether a frame has begun.
  /// @throws std::runtime_error  a job of the frame before has failed, or a body has another model than when it was added; the
  ///                             sentence says which.
  bool begin_frame();

  /// Waits for the frame under way, if there is one, and makes it the one that vertices() shows: for pictures
  /// that must not depend on the speed of the host, and for a single one.
  /// @throws std::runtime_error  a job of it has failed; the sentence says why.
  void finish_frame();

  /// The body's vertices of the newest frame that is finished. Each begin_frame() makes the frame finished
  /// that began before it: vertices are one frame late.
  /// @throws std::invalid_argument  the body was not added.
  SkinnedVertices vertices(const SoftBody<3>& body) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ppu
