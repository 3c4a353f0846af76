#pragma once
// Makes the surfaces of soft bodies on the SPEs as vertex buffers of half floats, ready for upload, one frame late.
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
#include <stdexcept>
#include <string>
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
  /// draw_order(model).mesh_vertex.size() vertices; empty before the body's first frame is finished. Valid until the next begin_frame(),
  /// finish_frame(), add() or remove().
  std::span<const HalfVertex> vertices;
  Eigen::Vector3f origin{0, 0, 0};  ///< metres, world: all positions in this frame are relative to it
};

/// How the vertices of all bodies of one model are drawn. Valid as long as the model.
struct DrawOrder {
  std::span<const std::uint32_t> indices;  ///< three vertices for each triangle of model.mesh(), in order
  /// For each vertex its number in the mesh. The SPEs skin four vertices of a lattice cell at a time, so vertices have another order than
  /// in the mesh, and some occur twice.
  std::span<const std::uint32_t> mesh_vertex;

  /// Returns an attribute of the mesh's vertices (texture coordinates, colours) in this order. If the mesh does not have the attribute,
  /// `of_mesh` is empty, and so is the result.
  /// @throws std::invalid_argument  it has values, but none for one of the mesh's vertices
  template <class Value>
  std::vector<Value> reorder(const std::vector<Value>& of_mesh) const {
    std::vector<Value> reordered;
    if (of_mesh.empty()) return reordered;
    reordered.reserve(mesh_vertex.size());
    for (const std::uint32_t vertex : mesh_vertex) {
      if (vertex >= of_mesh.size())
        throw std::invalid_argument("a mesh attribute has " + std::to_string(of_mesh.size()) +
                                    " values, but vertex " + std::to_string(vertex) +
                                    " needs one; give one value for each vertex, or none");
      reordered.push_back(of_mesh[vertex]);
    }
    return reordered;
  }
};

/// The order of the model's vertices; empty for a model without a mesh. Any thread.
DrawOrder draw_order(const SoftBodyModel<3>& model);

/// Skins bodies on SPEs. Used by one thread, between the steps of the bodies.
class SpeSkinner {
 public:
  /// @param spes  must outlive the skinner. @throws std::runtime_error  as SpeRuntime::kernel().
  explicit SpeSkinner(SpeRuntime& spes);
  /// For your own job system. `skin` is the image of that kernel. All three must outlive the skinner.
  SpeSkinner(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& skin);
  /// Waits for the SPEs.
  ~SpeSkinner();
  SpeSkinner(const SpeSkinner&) = delete;
  SpeSkinner& operator=(const SpeSkinner&) = delete;

  /// Waits for the frame under way and adds a body to the frames to come. The body must stay in place until remove(). A body that breaks or
  /// is cut, or to which a body of another model is assigned, has another model: remove() it before the next frame and add() it again, and
  /// its other pieces. A saved copy of the body has the same model as long as the body has not broken.
  /// @throws std::invalid_argument  its model has no mesh, or it was added before.
  /// @throws std::runtime_error     main memory is full; as finish_frame().
  void add(const SoftBody<3>& body);
  /// Waits for the frame under way and removes a body: call it before the body is destroyed.
  /// @throws std::invalid_argument  it was not added. @throws std::runtime_error  as finish_frame().
  void remove(const SoftBody<3>& body);

  /// Copies the present positions of all particles and starts skinning on the SPEs. Never waits: if the SPEs have not finished the frame
  /// before, it does nothing, and the picture stays as it is.
  /// @return whether a frame has begun.
  /// @throws std::runtime_error  a job of the previous frame has failed, or a body has another model than when it was added; the
  ///                             message says which.
  bool begin_frame();

  /// Waits for the frame under way, if there is one, and makes it the one that vertices() shows: for pictures that must not depend on the
  /// speed of the host, and for a single picture.
  /// @throws std::runtime_error  one of its jobs has failed; the message says why.
  void finish_frame();

  /// The body's vertices in the newest finished frame. Each begin_frame() makes the frame before it the finished one, so vertices are one
  /// frame late.
  /// @throws std::invalid_argument  the body was not added.
  SkinnedVertices vertices(const SoftBody<3>& body) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ppu
