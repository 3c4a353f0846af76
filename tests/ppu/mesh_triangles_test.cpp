// Triangles of Bullet's meshes, against what Bullet says.

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/mesh_triangles.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Triangle = std::array<Vector3f, 3>;

/// What processAllTriangles() says.
std::vector<Triangle> said_by_bullet(const btConcaveShape& shape, const Bounds<3>& box) {
  struct Gather final : btTriangleCallback {
    std::vector<Triangle> triangles;
    void processTriangle(btVector3* corner, int, int) override {
      triangles.push_back({to_eigen(corner[0]), to_eigen(corner[1]), to_eigen(corner[2])});
    }
  } gather;
  shape.processAllTriangles(&gather, to_bullet(box.low), to_bullet(box.high));
  return gather.triangles;
}

/// In random boxes. @return  the triangles found in all of them
std::size_t expect_what_bullet_says(const btConcaveShape& shape) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> coordinate(-2, 2);
  std::size_t found = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3f a(coordinate(engine), coordinate(engine), coordinate(engine));
    const Vector3f b(coordinate(engine), coordinate(engine), coordinate(engine));
    const Bounds<3> box{a.cwiseMin(b), a.cwiseMax(b)};
    std::vector<Triangle> triangles(1);  // it appends
    find_triangles(shape, box, triangles);
    triangles.erase(triangles.begin());
    EXPECT_EQ(triangles, said_by_bullet(shape, box)) << i;
    found += triangles.size();
  }
  return found;
}

/// A grid of triangles with hills, in an array of each kind that Bullet knows.
template <typename Real, typename Index>
struct Part {
  static constexpr int kCorners = 12;
  std::vector<Real> corners;
  std::vector<Index> indices;

  explicit Part(float height) {
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> hill(0, 0.5f);
    for (int i = 0; i < kCorners; ++i)
      for (int j = 0; j < kCorners; ++j)
        for (const float x : {0.3f * static_cast<float>(i) - 1.7f, height + hill(engine),
                              0.3f * static_cast<float>(j) - 1.7f, 0.0f})
          corners.push_back(static_cast<Real>(x));
    const auto at = [](int i, int j) { return static_cast<Index>(kCorners * i + j); };
    for (int i = 0; i + 1 < kCorners; ++i)
      for (int j = 0; j + 1 < kCorners; ++j)
        for (const Index k :
             {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i + 1, j)})
          indices.push_back(k);
  }
  void add_to(btTriangleIndexVertexArray& mesh, PHY_ScalarType index_type, PHY_ScalarType corner_type) {
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(indices.size() / 3);
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices.data());
    part.m_triangleIndexStride = 3 * sizeof(Index);
    part.m_numVertices = kCorners * kCorners;
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(corners.data());
    part.m_vertexStride = 4 * sizeof(Real);
    part.m_vertexType = corner_type;
    mesh.addIndexedMesh(part, index_type);
  }
};

template <typename Real, typename Index>
void expect_for_arrays_of(PHY_ScalarType corner_type, PHY_ScalarType index_type) {
  Part<Real, Index> low(-0.5f), high(0.7f);
  btTriangleIndexVertexArray mesh;
  low.add_to(mesh, index_type, corner_type);
  high.add_to(mesh, index_type, corner_type);
  mesh.setScaling({1.1f, 0.9f, 1});
  const btBvhTriangleMeshShape shape(&mesh, true);
  EXPECT_GT(expect_what_bullet_says(shape), 1000u);
}

TEST(MeshTriangles, OfArraysOfEachKindAreWhatBulletSays) {
  expect_for_arrays_of<float, std::int32_t>(PHY_FLOAT, PHY_INTEGER);
  expect_for_arrays_of<float, std::uint16_t>(PHY_FLOAT, PHY_SHORT);
  expect_for_arrays_of<float, std::uint8_t>(PHY_FLOAT, PHY_UCHAR);
  expect_for_arrays_of<double, std::int32_t>(PHY_DOUBLE, PHY_INTEGER);
}

/// It finds its triangles in its own way.
class HalfOfAMesh final : public btBvhTriangleMeshShape {
 public:
  using btBvhTriangleMeshShape::btBvhTriangleMeshShape;
  void processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                           const btVector3& high) const override {
    if (low.x() < 0) btBvhTriangleMeshShape::processAllTriangles(callback, low, high);
  }
};

TEST(MeshTriangles, OfOtherShapesAreWhatBulletSays) {
  Part<float, std::int32_t> part(0);
  btTriangleIndexVertexArray mesh;
  part.add_to(mesh, PHY_INTEGER, PHY_FLOAT);
  btBvhTriangleMeshShape shape(&mesh, true);
  EXPECT_GT(expect_what_bullet_says(btScaledBvhTriangleMeshShape(&shape, {0.5f, 1, 0.7f})), 1000u);
  EXPECT_GT(expect_what_bullet_says(HalfOfAMesh(&mesh, true)), 1000u);
  std::vector<float> heights(100);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = 0.1f * static_cast<float>(i * i % 7);
  const btHeightfieldTerrainShape field(10, 10, heights.data(), 0.0f, 1.0f, 1, false);
  EXPECT_GT(expect_what_bullet_says(field), 100u);
}

/// A program may move the corners of a mesh and refit its tree.
TEST(MeshTriangles, OfAMeshThatHasChangedAreThoseThatItHasNow) {
  Part<float, std::int32_t> part(0);
  btTriangleIndexVertexArray mesh;
  part.add_to(mesh, PHY_INTEGER, PHY_FLOAT);
  btBvhTriangleMeshShape shape(&mesh, true);
  for (float& x : part.corners) x *= 0.8f;
  shape.refitTree({-2, -2, -2}, {2, 2, 2});
  EXPECT_GT(expect_what_bullet_says(shape), 1000u);
}

}  // namespace
}  // namespace softcell::ppu
