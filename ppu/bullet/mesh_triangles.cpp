#include "ppu/bullet/mesh_triangles.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btOptimizedBvh.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include <cstddef>
#include <optional>
#include <typeinfo>

#include "ppu/bullet/bullet_vector.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Triangle = std::array<Eigen::Vector3f, 3>;

/// A part of a mesh, locked while it is read.
class LockedPart {
 public:
  LockedPart(const btStridingMeshInterface& mesh, int part) : mesh_(mesh), part_(part) {
    mesh.getLockedReadOnlyVertexIndexBase(&corners_, corner_count_, corner_type_, corner_stride_, &faces_,
                                          face_stride_, face_count_, index_type_, part);
  }
  ~LockedPart() { mesh_.unLockReadOnlyVertexBase(part_); }
  LockedPart(const LockedPart&) = delete;
  LockedPart& operator=(const LockedPart&) = delete;

  int number() const { return part_; }

  Triangle triangle(int face) const {
    SC_ASSERT(face >= 0 && face < face_count_, "triangle {} of {}", face, face_count_);
    const unsigned char* const indices = faces_ + std::ptrdiff_t{face} * face_stride_;
    const btVector3& scaling = mesh_.getScaling();
    Triangle result;
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned char* const at = corners_ + std::ptrdiff_t{corner_of(indices, k)} * corner_stride_;
      result[k] = corner_type_ == PHY_FLOAT ? scaled(reinterpret_cast<const float*>(at), scaling)
                                            : scaled(reinterpret_cast<const double*>(at), scaling);
    }
    return result;
  }

 private:
  template <typename Real>
  static Eigen::Vector3f scaled(const Real* corner, const btVector3& scaling) {
    return {static_cast<float>(corner[0]) * scaling.x(), static_cast<float>(corner[1]) * scaling.y(),
            static_cast<float>(corner[2]) * scaling.z()};
  }
  int corner_of(const unsigned char* indices, std::size_t k) const {
    if (index_type_ == PHY_SHORT) return reinterpret_cast<const unsigned short*>(indices)[k];
    if (index_type_ == PHY_UCHAR) return indices[k];
    return reinterpret_cast<const int*>(indices)[k];
  }

  const btStridingMeshInterface& mesh_;
  int part_;
  const unsigned char *corners_ = nullptr, *faces_ = nullptr;
  int corner_count_ = 0, face_count_ = 0, corner_stride_ = 0, face_stride_ = 0;
  PHY_ScalarType corner_type_ = PHY_FLOAT, index_type_ = PHY_INTEGER;
};

/// Finds triangles through the mesh's tree: processAllTriangles() locks the mesh anew for each triangle, which takes longer than finding
/// it.
class FromTree final : public btNodeOverlapCallback {
 public:
  FromTree(const btStridingMeshInterface& mesh, std::vector<Triangle>& triangles)
      : mesh_(mesh), triangles_(triangles) {}

  void processNode(int part, int face) override {
    if (!part_ || part_->number() != part) {
      part_.reset();
      part_.emplace(mesh_, part);
    }
    triangles_.push_back(part_->triangle(face));
  }

 private:
  const btStridingMeshInterface& mesh_;
  std::vector<Triangle>& triangles_;
  std::optional<LockedPart> part_;
};

class FromShape final : public btTriangleCallback {
 public:
  explicit FromShape(std::vector<Triangle>& triangles) : triangles_(triangles) {}

  void processTriangle(btVector3* corner, int, int) override {
    triangles_.push_back({to_eigen(corner[0]), to_eigen(corner[1]), to_eigen(corner[2])});
  }

 private:
  std::vector<Triangle>& triangles_;
};

}  // namespace

void find_triangles(const btConcaveShape& shape, const Bounds<3>& box, std::vector<Triangle>& triangles) {
  // A program's own type of mesh may find its triangles in another way.
  if (typeid(shape) == typeid(btBvhTriangleMeshShape)) {
    // Trees and meshes are not const even for reading.
    auto& mesh = const_cast<btBvhTriangleMeshShape&>(static_cast<const btBvhTriangleMeshShape&>(shape));
    if (const btOptimizedBvh* const tree = mesh.getOptimizedBvh()) {
      FromTree found(*mesh.getMeshInterface(), triangles);
      return tree->reportAabbOverlappingNodex(&found, to_bullet(box.low), to_bullet(box.high));
    }
  }
  FromShape found(triangles);
  shape.processAllTriangles(&found, to_bullet(box.low), to_bullet(box.high));
}

}  // namespace softcell::ppu
