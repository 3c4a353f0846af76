#include "ppu/bullet/convex_hull.h"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <LinearMath/btConvexHullComputer.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/obstacles/round_edges.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// Faces and edges of the hull of some points.
void find_hull(const std::vector<btVector3>& points, std::vector<Eigen::Vector4f>& planes,
               std::vector<ObstacleEdge>& edges) {
  btConvexHullComputer hull;
  hull.compute(reinterpret_cast<const float*>(points.data()), sizeof(btVector3),
               static_cast<int>(points.size()), 0, 0);
  for (int f = 0; f < hull.faces.size(); ++f) {
    // Newell's normal: it exists even for a face of nearly collinear corners.
    Vector3f normal = Vector3f::Zero();
    float height = 0;
    int corners = 0;
    const btConvexHullComputer::Edge* const first = &hull.edges[hull.faces[f]];
    const btConvexHullComputer::Edge* edge = first;
    do {
      const Vector3f a = to_eigen(hull.vertices[edge->getSourceVertex()]);
      const Vector3f b = to_eigen(hull.vertices[edge->getTargetVertex()]);
      normal += a.cross(b);
      if (edge->getSourceVertex() < edge->getTargetVertex()) edges.push_back({a, b});
      edge = edge->getNextEdgeOfFace();
      ++corners;
    } while (edge != first);
    if (!(normal.norm() > 0)) continue;
    normal.normalize();
    for (edge = first; corners > 0; --corners, edge = edge->getNextEdgeOfFace())
      height = edge == first ? normal.dot(to_eigen(hull.vertices[edge->getSourceVertex()]))
                             : std::max(height, normal.dot(to_eigen(hull.vertices[edge->getSourceVertex()])));
    planes.push_back({normal.x(), normal.y(), normal.z(), height});
  }
}

/// The longest vector from `from` to a point after `measured` has projected it.
template <class Measured>
Vector3f farthest(const std::vector<btVector3>& points, const Vector3f& from, const Measured& measured) {
  Vector3f most = Vector3f::Zero();
  for (const btVector3& point : points) {
    const Vector3f difference = measured(Vector3f(to_eigen(point) - from));
    if (difference.squaredNorm() > most.squaredNorm()) most = difference;
  }
  return most;
}

/// Points in one plane or on one line have no inside out of which something could be pushed: each is replaced by two or four, on both
/// sides. Points that all coincide stay as they are.
/// @return  whether any point was replaced
bool give_volume(std::vector<btVector3>& points) {
  if (points.empty()) return false;
  const Vector3f origin = to_eigen(points.front());
  const Vector3f along = farthest(points, origin, [](const Vector3f& d) { return d; });
  const float length = along.norm();
  if (!(length > 0)) return false;
  const Vector3f x = along / length;
  const Vector3f across =
      farthest(points, origin, [&](const Vector3f& d) { return Vector3f(d - d.dot(x) * x); });
  const bool is_line = across.norm() < kNoLength * length;
  const Vector3f y = is_line ? x.unitOrthogonal() : across.normalized(), z = x.cross(y);
  const auto widen = [&](const Vector3f& direction) {
    const btVector3 side = to_bullet(Vector3f(kThickness * length * direction));
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
      points.push_back(points[i] + side);
      points[i] -= side;
    }
  };
  const Vector3f out = farthest(points, origin, [&](const Vector3f& d) { return Vector3f(d.dot(z) * z); });
  const bool is_flat = is_line || out.norm() < kNoLength * length;
  if (is_line) widen(y);
  if (is_flat) widen(z);
  return is_flat;
}

/// Collects the corners of a mesh's triangles.
struct CornersOfMesh final : btInternalTriangleIndexCallback {
  explicit CornersOfMesh(std::vector<btVector3>& to) : corners(to) {}
  void internalProcessTriangleIndex(btVector3* triangle, int, int) override {
    corners.insert(corners.end(), triangle, triangle + 3);
  }
  std::vector<btVector3>& corners;
};

/// Appends the corners of a polyhedron. @return  false: the shape is none
bool append_corners(const btConvexShape& shape, std::vector<btVector3>& corners) {
  const auto append_each = [&](const btPolyhedralConvexShape& polyhedron) {
    for (int i = 0; i < polyhedron.getNumVertices(); ++i) polyhedron.getVertex(i, corners.emplace_back());
    return true;
  };
  switch (shape.getShapeType()) {
    case CONVEX_HULL_SHAPE_PROXYTYPE: {
      const auto& hull = static_cast<const btConvexHullShape&>(shape);
      for (int i = 0; i < hull.getNumPoints(); ++i) corners.push_back(hull.getScaledPoint(i));
      return true;
    }
    case CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE: {  // whose own list of corners is empty
      CornersOfMesh all(corners);
      const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
      static_cast<const btConvexTriangleMeshShape&>(shape).getMeshInterface()->InternalProcessAllTriangles(
          &all, -far, far);
      return true;
    }
    case CONVEX_POINT_CLOUD_SHAPE_PROXYTYPE:
    case TETRAHEDRAL_SHAPE_PROXYTYPE:
    case TRIANGLE_SHAPE_PROXYTYPE:
      return append_each(static_cast<const btPolyhedralConvexShape&>(shape));
    default:
      return false;
  }
}

/// Some all around, with which a search begins; and the points in these directions tell whether a shape has changed.
const std::vector<btVector3>& directions() {
  static const auto all = [] {
    std::vector<btVector3> directions;
    for (const Vector3f& direction : make_sphere(1, 4).positions) directions.push_back(to_bullet(direction));
    return directions;
  }();
  return all;
}

/// Half of the longest edge of a box around some points, metres.
float half_length(const std::vector<btVector3>& points) {
  btVector3 low = points.front(), high = low;
  for (const btVector3& point : points) {
    low.setMin(point);
    high.setMax(point);
  }
  return 0.5f * (high - low)[(high - low).maxAxis()];
}

/// Where the shape reaches farther than its hull by more than a tolerance (metres): the point that is farthest beyond each face.
std::vector<btVector3> points_beyond(const btConvexShape& shape, std::span<const Eigen::Vector4f> planes,
                                     float tolerance) {
  std::vector<btVector3> points;
  for (const Eigen::Vector4f& plane : planes) {
    const btVector3 point = shape.localGetSupportingVertex(to_bullet(plane.head<3>()));
    if (plane.head<3>().dot(to_eigen(point)) > plane.w() + tolerance) points.push_back(point);
  }
  return points;
}

/// The local scaling, if it is the same along all axes; else 0.
float uniform_scaling(const btCollisionShape& shape) {
  const btVector3& scaling = shape.getLocalScaling();
  return scaling.x() == scaling.y() && scaling.y() == scaling.z() ? scaling.x() : 0;
}

}  // namespace

void ConvexHull::follow(const btConvexShape& shape) {
  points_.clear();
  const bool is_polyhedron = append_corners(shape, points_);
  if (!is_polyhedron)
    for (const btVector3& direction : directions())
      points_.push_back(shape.localGetSupportingVertex(direction));
  if (points_ == before_ && !planes_.empty()) return;
  before_ = points_;
  std::vector<ObstacleEdge> edges;
  const auto make = [&] {
    planes_.clear();
    edges.clear();
    find_hull(points_, planes_, edges);
  };
  constexpr std::size_t kMany = 1000;
  const float tolerance = is_polyhedron ? 0 : kTolerance * half_length(points_);
  if (is_polyhedron) give_volume(points_);
  make();
  while (!is_polyhedron && points_.size() < kMany) {
    const std::vector<btVector3> more = points_beyond(shape, planes_, tolerance);
    if (more.empty()) break;
    points_.insert(points_.end(), more.begin(), more.end());
    make();
  }
  if (!is_polyhedron && give_volume(points_)) make();
  edges_.clear();
  add_edges_of_hull(edges, planes_, edges_);
}

bool is_sphere_or_capsule(const btCollisionShape& shape) {
  if (shape.getShapeType() != MULTI_SPHERE_SHAPE_PROXYTYPE || !(uniform_scaling(shape) > 0)) return false;
  const auto& spheres = static_cast<const btMultiSphereShape&>(shape);
  return spheres.getSphereCount() == 1 ||
         (spheres.getSphereCount() == 2 && spheres.getSphereRadius(0) == spheres.getSphereRadius(1));
}

void set_sphere_or_capsule(const btMultiSphereShape& shape, Obstacle& obstacle) {
  SC_ASSERT(is_sphere_or_capsule(shape), "{} spheres as a sphere or capsule", shape.getSphereCount());
  const float scaling = uniform_scaling(shape);
  const Vector3f first = scaling * to_eigen(shape.getSpherePosition(0));
  const Vector3f last = scaling * to_eigen(shape.getSpherePosition(shape.getSphereCount() - 1));
  obstacle.kind = ObstacleKind::kBox;
  obstacle.position += obstacle.rotation * (0.5f * (first + last));
  const Vector3f along = last - first;
  if (along.squaredNorm() > 0)
    obstacle.rotation =
        obstacle.rotation * Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitY(), along).toRotationMatrix();
  obstacle.extent = {0, 0.5f * along.norm(), 0};
  obstacle.rounding = scaling * shape.getSphereRadius(0);
}

}  // namespace softcell::ppu
