// Meshes whose vertices the GPU makes: the pictures are those of vertices made here, from the equations.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

#include "cell_skinner.h"
#include "pinned_context.h"
#include "softcell/render/image_compare.h"
#include "test_scene.h"

namespace softcell::render {
namespace {

using test::pinned_context;
using Corner = Eigen::Vector4f;  // the fourth is not read
using Vectors = std::vector<Eigen::Vector3d>;

float value_of(std::uint16_t half) { return static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(half)); }

/// The corners 0..8 of two cubes of edge 1.4 m that share a face: x from -1.4 to 0, and from 0 to 1.4.
constexpr double kEdge = 1.4;
constexpr std::array<std::array<std::uint32_t, 8>, 2> kCells{
    {{0, 1, 3, 4, 6, 7, 9, 10}, {1, 2, 4, 5, 7, 8, 10, 11}}};

Vectors rest_corners() {
  Vectors corners;
  for (int z = 0; z < 2; ++z) {
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 3; ++x) corners.emplace_back(kEdge * (x - 1), kEdge * (y - 0.5), kEdge * (z - 0.5));
    }
  }
  return corners;
}

/// A torus in the two cells. It comes in binary16 numbers; moved, many of these would lie just between two
/// others, where the last bit of a sum decides. Hence the odd scale.
struct HungTorus {
  static constexpr float kShrink = 0.9731f;

  HungTorus() : shape(test::make_torus(32, 16)) {
    for (std::size_t v = 0; v < shape.vertices.size(); v += 8) {
      const auto value = [&](std::size_t i) { return kShrink * value_of(shape.vertices[v + i]); };
      const std::size_t cell = value(0) < 0 ? 0 : 1;
      CellVertex vertex{.corner = kCells[cell],
                        .normal = Eigen::Vector3f(value(4), value(5), value(6)).normalized()};
      const auto edge = static_cast<float>(kEdge);
      vertex.place = {value(0) / edge + (cell == 0 ? 1.0f : 0.0f), value(1) / edge + 0.5f,
                      value(2) / edge + 0.5f};
      vertices.push_back(vertex);
    }
  }

  test::SkinnedMesh shape;
  std::vector<CellVertex> vertices;
};

/// In double, straight from the equations.
test::SkinnedMesh evaluate(const HungTorus& torus, const Vectors& corners, const Eigen::Vector3f& origin) {
  test::SkinnedMesh mesh;
  mesh.indices = torus.shape.indices;
  for (const CellVertex& vertex : torus.vertices) {
    Eigen::Vector3d x(0, 0, 0);
    Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
    for (unsigned k = 0; k < 8; ++k) {
      Eigen::Vector3d weight, slope;
      for (unsigned d = 0; d < 3; ++d) {
        const bool high = ((k >> d) & 1u) != 0;
        const double place = static_cast<double>(vertex.place[d]);
        weight[d] = high ? place : 1 - place;
        slope[d] = high ? 1 : -1;
      }
      const Eigen::Vector3d& corner = corners[vertex.corner[k]];
      x += weight.prod() * corner;
      f += corner * Eigen::RowVector3d(slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                                       weight[0] * weight[1] * slope[2]);
    }
    // cof(F) N
    const Eigen::Vector3d normal = f.determinant() * f.inverse().transpose() * vertex.normal.cast<double>();
    mesh.add_vertex((x - origin.cast<double>()).cast<float>(), normal.normalized().cast<float>());
  }
  return mesh;
}

std::vector<Corner> as_given(const Vectors& corners) {
  std::vector<Corner> given;
  for (const Eigen::Vector3d& c : corners)
    given.emplace_back(static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z()),
                       std::nanf(""));
  return given;
}

using Map = Eigen::Vector3d (*)(const Eigen::Vector3d&);

Eigen::Vector3d at_rest(const Eigen::Vector3d& x) { return x; }
Eigen::Vector3d affine(const Eigen::Vector3d& x) {
  return {0.9 * x.x() + 0.3 * x.y(), 1.2 * x.y() - 0.2 * x.z(), 0.8 * x.z() + 0.1 * x.x()};
}
Eigen::Vector3d bent_far_away(const Eigen::Vector3d& x) {
  return {100 + x.x() + 0.2 * x.y() * x.z(), -20 + x.y() + 0.25 * x.x() * x.x(),
          7 + x.z() - 0.2 * x.x() * x.y()};
}

/// The moved corners as floats, which are handed over.
Vectors moved_corners(Map map) {
  Vectors corners;
  for (const Eigen::Vector3d& corner : rest_corners())
    corners.emplace_back(map(corner).cast<float>().cast<double>());
  return corners;
}
/// So that all numbers are positive.
Eigen::Vector3f origin_below(Map map) {
  return (map({0, 0, 0}) - Eigen::Vector3d::Constant(2)).cast<float>();
}

class CellMeshTest : public testing::Test {
 protected:
  Image draw(MeshId mesh, const Eigen::Vector3f& origin) {
    const SkinnedDraw item{.mesh = mesh, .origin = origin, .colour = srgb(0xD9822B)};
    FrameDescription frame;
    frame.camera.eye = origin + Eigen::Vector3f(2, 4, 5);
    frame.camera.target = origin + Eigen::Vector3f(1, 1, 1);
    frame.light.shadow_centre = frame.camera.target;
    frame.light.shadow_radius = 4;
    frame.skinned = std::span(&item, 1);
    renderer_.render(frame);
    return renderer_.pixels();
  }

  void update(MeshId mesh, const std::vector<Corner>& corners, const Eigen::Vector3f& origin) {
    renderer_.update_corners(mesh, std::as_bytes(std::span(corners)), origin);
  }

  void expect_picture_of_the_equations(Map map) {
    const Vectors corners = moved_corners(map);
    const Eigen::Vector3f origin = origin_below(map);

    const MeshId on_gpu = renderer_.add_cell_mesh(torus_.shape.indices, torus_.vertices, corners.size());
    update(on_gpu, as_given(corners), origin);
    const Image actual = draw(on_gpu, origin);

    const test::SkinnedMesh expected_mesh = evaluate(torus_, corners, origin);
    const MeshId given = renderer_.add_mesh(expected_mesh.indices);
    renderer_.update_mesh(given, expected_mesh.bytes());
    const Image expected = draw(given, origin);

    const MeshId nothing = renderer_.add_mesh({});
    EXPECT_GT(compare(expected, draw(nothing, origin)).over_8, 2000u) << "the torus is not to be seen";
    const ImageDifference difference = compare(actual, expected);
    EXPECT_TRUE(within_golden_rule(difference)) << describe(difference);
  }

  Renderer renderer_{pinned_context(), {.width = 320, .height = 240}};
  const HungTorus torus_;
};

TEST_F(CellMeshTest, DrawsAtRestWhatItIsMadeOf) { expect_picture_of_the_equations(at_rest); }
TEST_F(CellMeshTest, DrawsWhatAnAffineMapMakesOfIt) { expect_picture_of_the_equations(affine); }

struct NamedMap {
  const char* name;
  Map map;
};
void PrintTo(const NamedMap& named, std::ostream* out) { *out << named.name; }

/// The GPU's vertices themselves, read back.
class CellSkinnerTest : public testing::TestWithParam<NamedMap> {
 protected:
  CellSkinnerTest() {
    const auto load = [](void* context, const char* name) {
      return static_cast<GlContext*>(context)->function(name);
    };
    pinned_context().make_current();
    gladLoadGLContextUserPtr(&gl_, load, &pinned_context());
  }

  std::vector<std::uint16_t> skin(const HungTorus& torus, const Vectors& corners,
                                  const Eigen::Vector3f& origin) {
    const CellMesh mesh(gl_, torus.vertices, corners.size());
    const GlObject out = make_buffer(gl_);
    std::vector<std::uint16_t> halves(8 * torus.vertices.size());
    const auto bytes = static_cast<GLsizeiptr>(halves.size() * sizeof halves[0]);
    gl_.BindBuffer(GL_ARRAY_BUFFER, out.name());
    gl_.BufferData(GL_ARRAY_BUFFER, bytes, nullptr, GL_STREAM_COPY);
    const std::vector<Corner> given = as_given(corners);
    CellSkinner(gl_).skin(mesh, std::as_bytes(std::span(given)), origin, out);
    gl_.BindBuffer(GL_ARRAY_BUFFER, out.name());
    gl_.GetBufferSubData(GL_ARRAY_BUFFER, 0, bytes, halves.data());
    EXPECT_EQ(gl_.GetError(), static_cast<GLenum>(GL_NO_ERROR));
    return halves;
  }

  GladGLContext gl_{};
};

TEST_P(CellSkinnerTest, IsTheEquationsToTheNearestHalf) {
  const HungTorus torus;
  const Vectors corners = moved_corners(GetParam().map);
  const Eigen::Vector3f origin = origin_below(GetParam().map);
  const std::vector<std::uint16_t> actual = skin(torus, corners, origin);
  const std::vector<std::uint16_t> expected = evaluate(torus, corners, origin).vertices;
  ASSERT_EQ(actual.size(), expected.size());
  std::size_t others = 0;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    // Where a value lies all but between two halves, rounding in float decides: a unit in the last place, and
    // near 0, where halves are finer than floats are exact, what that is at 2^-6.
    const float unit = std::max(std::abs(value_of(expected[i])), 0x1p-6f) * 0x1p-10f;
    EXPECT_NEAR(value_of(actual[i]), value_of(expected[i]), unit)
        << "vertex " << i / 8 << " number " << i % 8;
    others += std::abs(value_of(actual[i]) - value_of(expected[i])) > unit / 2;
  }
  EXPECT_LE(others, actual.size() / 100);
}

INSTANTIATE_TEST_SUITE_P(Maps, CellSkinnerTest,
                         testing::Values(NamedMap{"at rest", at_rest}, NamedMap{"affine", affine},
                                         NamedMap{"bent, far away", bent_far_away}));

TEST_F(CellMeshTest, KeepsTheRestNormalWhereACellIsFlat) {
  // All corners on the ground: cof(F) is 0 but for its y column, and of normals along x nothing is left.
  std::vector<CellVertex> triangle(3);
  for (std::uint32_t k = 0; k < 8; ++k)
    for (CellVertex& vertex : triangle) vertex.corner[k] = k;
  triangle[1].place = {0, 0, 1};
  triangle[2].place = {1, 0, 0};
  for (CellVertex& vertex : triangle) vertex.normal = {0, 0.6f, 0.8f};
  std::vector<Corner> flat(8, Corner(0, 0, 0, 0));  // a point: no normal at all
  const std::vector<std::uint32_t> indices{0, 1, 2};
  const MeshId mesh = renderer_.add_cell_mesh(indices, triangle, 8);
  update(mesh, flat, {-1, -1, -1});
  const Image nothing = draw(renderer_.add_mesh({}), {-1, -1, -1});
  EXPECT_EQ(draw(mesh, {-1, -1, -1}), nothing);  // and no NaN that would be drawn
  EXPECT_EQ(renderer_.uploaded_bytes(), 8 * kCellCornerBytes);
}

TEST_F(CellMeshTest, DrawsNothingBeforeItsCornersAreGiven) {
  const Vectors corners = rest_corners();
  const MeshId mesh = renderer_.add_cell_mesh(torus_.shape.indices, torus_.vertices, corners.size());
  EXPECT_EQ(draw(mesh, {0, 0, 0}), draw(renderer_.add_mesh({}), {0, 0, 0}));
}

TEST_F(CellMeshTest, CountsWhatIsUploaded) {
  const Vectors corners = rest_corners();
  const MeshId cells = renderer_.add_cell_mesh(torus_.shape.indices, torus_.vertices, corners.size());
  update(cells, as_given(corners), {0, 0, 0});
  update(cells, as_given(corners), {0, 0, 0});
  EXPECT_EQ(renderer_.uploaded_bytes(), 2 * 12 * kCellCornerBytes);
  const MeshId given = renderer_.add_mesh(torus_.shape.indices);
  renderer_.update_mesh(given, torus_.shape.bytes());
  EXPECT_EQ(renderer_.uploaded_bytes(), 2 * 12 * kCellCornerBytes + torus_.shape.bytes().size());
}

TEST_F(CellMeshTest, RefusesWhatDoesNotFit) {
  const std::vector<std::uint32_t> indices{0, 1, 2};
  std::vector<CellVertex> vertices(3);
  EXPECT_THROW(renderer_.add_cell_mesh(std::span(indices).first(2), vertices, 1), std::invalid_argument);
  EXPECT_THROW(renderer_.add_cell_mesh(indices, std::span(vertices).first(2), 1), std::invalid_argument);
  EXPECT_THROW(renderer_.add_cell_mesh(indices, vertices, 0), std::invalid_argument);
  EXPECT_THROW(renderer_.add_cell_mesh(indices, vertices, std::size_t{1} << 40), std::invalid_argument);
  vertices[2].corner[7] = 4;
  EXPECT_THROW(renderer_.add_cell_mesh(indices, vertices, 4), std::invalid_argument);

  const MeshId cells = renderer_.add_cell_mesh(indices, vertices, 5);
  const MeshId given = renderer_.add_mesh(indices);
  const std::vector<std::byte> bytes(5 * kCellCornerBytes);
  EXPECT_NO_THROW(renderer_.update_corners(cells, bytes, {0, 0, 0}));
  EXPECT_THROW(renderer_.update_corners(cells, std::span(bytes).first(4 * kCellCornerBytes), {0, 0, 0}),
               std::invalid_argument);
  EXPECT_THROW(renderer_.update_corners(given, bytes, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(renderer_.update_mesh(cells, bytes), std::invalid_argument);
  EXPECT_THROW(renderer_.update_corners({.value = 99}, bytes, {0, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::render
