#include "softcell/soft_bodies/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattices.h"
#include "ppu/lattice/embedding.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;
using test::all_lattices;
using test::block;

/// An axis-aligned box of twelve triangles.
TriangleMesh box(const Vector3f& low, const Vector3f& high) {
  TriangleMesh mesh;
  for (unsigned k = 0; k < 8; ++k)
    mesh.positions.emplace_back(k & 1u ? high.x() : low.x(), k & 2u ? high.y() : low.y(),
                                k & 4u ? high.z() : low.z());
  mesh.normals.assign(8, Vector3f::UnitZ());
  const std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

double total_mass(const Lattice<3>& lattice, float density) {
  const std::vector<float> masses = particle_masses(lattice, density);
  return std::accumulate(masses.begin(), masses.end(), 0.0);
}

void expect_covers(const Lattice<3>& lattice, const TriangleMesh& mesh) {
  std::set<std::array<int, 3>> occupied;
  for (const Vector3i& cell : lattice.cells) occupied.insert({cell.x(), cell.y(), cell.z()});
  for (const Vector3f& position : mesh.positions) {
    const Eigen::Vector3d grid =
        (position - lattice.origin).cast<double>() / static_cast<double>(lattice.spacing);
    bool inside = false;
    constexpr double kHair = 1e-4;  // what the embedding forgives
    for (unsigned k = 0; k < 8; ++k) {
      std::array<int, 3> cell;
      for (unsigned d = 0; d < 3; ++d)
        cell[d] = static_cast<int>(std::floor(grid[d] + ((k >> d) & 1u ? kHair : -kHair)));
      inside = inside || occupied.contains(cell);
    }
    EXPECT_TRUE(inside) << position.transpose();
  }
}

std::string message_of(const TriangleMesh& mesh, float cell_size) {
  try {
    voxelize(mesh, cell_size);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(LatticeFromCells, JoinsCornersAndSortsThem) {
  const std::vector<Vector3i> cells{{1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  const Lattice<3> lattice = lattice_from_cells(cells, 0.5f, {1, 2, 3});
  EXPECT_EQ(lattice.cells, (std::vector<Vector3i>{{0, 0, 0}, {1, 0, 0}}));
  ASSERT_EQ(lattice.particles.size(), 12u);
  EXPECT_EQ(lattice.particles[0], Vector3i(0, 0, 0));
  EXPECT_EQ(lattice.particles[1], Vector3i(0, 0, 1));
  EXPECT_EQ(lattice.particles[11], Vector3i(2, 1, 1));
  EXPECT_EQ(lattice.rest_position(11), Vector3f(2, 2.5f, 3.5f));
  EXPECT_EQ(lattice.fill, (std::vector<float>{1, 1}));
  for (std::size_t c = 0; c < 2; ++c)
    for (int k = 0; k < 8; ++k)
      EXPECT_EQ(lattice.particles[lattice.corners[c][static_cast<std::size_t>(k)]],
                lattice.cells[c] + Vector3i(k & 1, (k >> 1) & 1, k >> 2));
}

TEST(LatticeFromCells, LinksParticlesThatShareACell) {
  for (const auto& [name, lattice] : all_lattices()) {
    std::vector<std::set<std::uint32_t>> expected(lattice.particles.size());
    for (const auto& corners : lattice.corners)
      for (const std::uint32_t a : corners)
        for (const std::uint32_t b : corners)
          if (a != b) expected[a].insert(b);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto list = lattice.neighbours[i];
      ASSERT_EQ(std::vector(list.begin(), list.end()), std::vector(expected[i].begin(), expected[i].end()))
          << name;
    }
  }
}

TEST(LatticeFromCells, CellsTouchingAtAnEdgeShareItsTwoParticles) {
  const Lattice<3> lattice = lattice_from_cells(std::vector<Vector3i>{{0, 0, 0}, {1, 1, 0}}, 1, {0, 0, 0});
  EXPECT_EQ(lattice.particles.size(), 14u);
  int shared = 0;
  for (std::size_t i = 0; i < 14; ++i) shared += lattice.neighbours[i].size() == 13 ? 1 : 0;
  EXPECT_EQ(shared, 2);
}

TEST(LatticeFromCells, TakesNegativeIndicesAndRefusesWhatPassesTheLimits) {
  EXPECT_EQ(lattice_from_cells(std::vector<Vector3i>{{-5, -5, -5}}, 1, {0, 0, 0}).particles[0],
            Vector3i(-5, -5, -5));
  EXPECT_NO_THROW(lattice_from_cells(test::block_cells(256, 1, 1), 1, {0, 0, 0}));
  EXPECT_THROW(lattice_from_cells(test::block_cells(257, 1, 1), 1, {0, 0, 0}), std::runtime_error);
  constexpr int kFar = std::numeric_limits<int>::max() - 1;
  EXPECT_THROW(lattice_from_cells(std::vector<Vector3i>{{-kFar, 0, 0}, {kFar, 0, 0}}, 1, {0, 0, 0}),
               std::runtime_error);
  for (const int index :
       {1'000'001, -1'000'001, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
    EXPECT_THROW(lattice_from_cells(std::vector<Vector3i>{{0, index, 0}}, 1, {0, 0, 0}), std::runtime_error)
        << index;
  EXPECT_NO_THROW(lattice_from_cells(std::vector<Vector3i>{{1'000'000, 0, -1'000'000}}, 1, {0, 0, 0}));
  EXPECT_NO_THROW(lattice_from_cells(test::block_cells(255, 63, 63), 1, {0, 0, 0}));  // 2^20 particles
  EXPECT_THROW(lattice_from_cells(test::block_cells(255, 64, 63), 1, {0, 0, 0}), std::runtime_error);
  EXPECT_THROW(lattice_from_cells(std::vector<Vector3i>{}, 1, {0, 0, 0}), std::runtime_error);
  for (const float spacing : {0.0f, -1.0f, NAN, INFINITY})
    EXPECT_THROW(lattice_from_cells(test::block_cells(1, 1, 1), spacing, {0, 0, 0}), std::runtime_error);
  for (const float origin : {NAN, INFINITY})
    EXPECT_THROW(lattice_from_cells(test::block_cells(1, 1, 1), 1, {0, origin, 0}), std::runtime_error);
}

TEST(ParticleMasses, AddUpToDensityTimesVolume) {
  for (const auto& [name, lattice] : all_lattices())
    EXPECT_NEAR(total_mass(lattice, 500), 500 * 1e-3 * static_cast<double>(lattice.cells.size()), 1e-4)
        << name;
  Lattice<3> lattice = block(2, 1, 1, 1.0f);
  lattice.fill = {0.5f, 1.0f};
  const std::vector<float> masses = particle_masses(lattice, 8);
  EXPECT_EQ(masses[0], 0.5f);
  EXPECT_EQ(masses[4], 1.5f);
  EXPECT_EQ(masses[8], 1.0f);
  for (const float density : {0.0f, -1.0f, NAN, INFINITY})
    EXPECT_THROW(particle_masses(lattice, density), std::invalid_argument);
}

TEST(OuterParticles, AreThoseWithoutEightCells) {
  const Lattice<3> lattice = block(4, 3, 3);
  const std::vector<bool> outer = outer_particles(lattice);
  EXPECT_EQ(std::count(outer.begin(), outer.end(), false), 3 * 2 * 2);
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const Vector3i& at = lattice.particles[i];
    EXPECT_EQ(outer[i], at.minCoeff() == 0 || at.x() == 4 || at.y() == 3 || at.z() == 3);
  }
}

TEST(Voxelize, ABoxOfWholeCellsIsThatManyCells) {
  for (const Vector3f& low :
       {Vector3f(0, 0, 0), Vector3f(-0.5f, -0.25f, -0.35f), Vector3f(3.3f, -7.7f, 0.123f)}) {
    const TriangleMesh mesh = box(low, low + Vector3f(1.0f, 0.5f, 0.7f));
    const Lattice<3> lattice = voxelize(mesh, 0.1f);
    EXPECT_EQ(lattice.cells.size(), 10u * 5u * 7u);
    EXPECT_EQ(lattice.particles.size(), 11u * 6u * 8u);
    expect_covers(lattice, mesh);
    for (const float fill : lattice.fill) EXPECT_NEAR(fill, 1, 1e-3);
    EXPECT_NEAR(total_mass(lattice, 1000), 350, 0.1);
  }
}

// Far from the origin, where the grid's own origin is rounded by as much as the mesh's coordinates.
TEST(Voxelize, ABoxThatStandsOutOfItsGridByRoundingIsSolid) {
  constexpr float kUlp = 0x1p-17f;  // of 64 to 128
  for (int d = 0; d < 3; ++d) {
    for (const float at : {70.0f, 77.7f, -79.9f, 78.9f, -70.00001f}) {
      for (int k = -14; k <= 14; ++k) {
        Vector3f low(0, 0, 0), high(1, 1, 1);
        low[d] = at, high[d] = at + 1 + static_cast<float>(k) * kUlp;
        const TriangleMesh mesh = box(low, high);
        const Lattice<3> lattice = voxelize(mesh, 0.1f);
        const std::size_t cells = lattice.cells.size();
        EXPECT_TRUE(cells == 1000 || cells == 1100) << cells << " of " << low[d] << " to " << high[d];
        expect_covers(lattice, mesh);
        EXPECT_NO_THROW(embed(mesh, lattice)) << low[d] << " to " << high[d];
      }
    }
  }
}

TEST(Voxelize, OverhangsEquallyOnBothSides) {
  const TriangleMesh mesh = box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f});
  const Lattice<3> lattice = voxelize(mesh, 0.3f);
  EXPECT_EQ(lattice.cells.size(), 64u);
  EXPECT_TRUE(lattice.origin.isApprox(Vector3f(-0.6f, -0.6f, -0.6f)));
  expect_covers(lattice, mesh);
}

TEST(Voxelize, MassFollowsTheMeshNotTheCells) {
  // 1 m^3 in cells that overhang: the fill fractions see lines at the quarters of a cell.
  const Lattice<3> cube = voxelize(box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}), 0.15f);
  EXPECT_NEAR(total_mass(cube, 1), 1, 0.1);
  const Lattice<3> sphere = voxelize(make_sphere(1.0f, 24), 0.15f);
  EXPECT_NEAR(total_mass(sphere, 1), 4.18879, 0.35);  // cells hardly touched count as a quarter full
  for (const float fill : sphere.fill) {
    EXPECT_GE(fill, 0.25f);
    EXPECT_LE(fill, 1.0f);
  }
}

TEST(Voxelize, FillsTheInsideAndLeavesTheHoles) {
  const Lattice<3> sphere = voxelize(make_sphere(1.0f, 16), 0.1f);
  EXPECT_NEAR(static_cast<double>(sphere.cells.size()) * 1e-3, 4.18879 + 0.5 * 0.1 * 12.566,
              0.5);  // and half a skin
  const Lattice<3> torus = voxelize(make_torus(1.0f, 0.3f, 48, 24), 0.1f);
  EXPECT_EQ(std::ranges::count(torus.cells, Vector3i(13, 3, 13)), 0);  // the hole's middle
  EXPECT_EQ(std::ranges::count(torus.cells, Vector3i(3, 3, 13)), 1);   // inside the tube
}

TEST(Voxelize, FillsTheCavityOfADoubleWalledMesh) {
  TriangleMesh mesh = box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f});
  TriangleMesh inner = box({-0.27f, -0.27f, -0.27f}, {0.27f, 0.27f, 0.27f});
  for (auto& triangle : inner.triangles) std::swap(triangle[1], triangle[2]);
  append(mesh, inner);
  const Lattice<3> lattice = voxelize(mesh, 0.1f);
  // The flood does not reach the cavity, which therefore is filled, but weighs nothing where a surface tells
  // so.
  EXPECT_EQ(lattice.cells.size(), 1000u);
  EXPECT_LT(total_mass(lattice, 1), 1.0 - 0.54 * 0.54 * 0.54 + 4.0 * 4.0 * 4.0 * 1e-3 + 0.1);
}

TEST(Voxelize, OverlappingPartsCountOnce) {
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  append(mesh, box({0.25f, 0.25f, 0.25f}, {0.75f, 0.75f, 1}));
  EXPECT_NEAR(total_mass(voxelize(mesh, 0.1f), 1), 1, 1e-3);
}

TEST(Voxelize, ForgivesHolesSmallerThanACell) {
  TriangleMesh mesh = make_box({1, 1, 1}, 0.05f);
  const std::size_t cells = voxelize(mesh, 0.1f).cells.size();
  mesh.triangles.erase(mesh.triangles.begin() + 400, mesh.triangles.begin() + 402);  // one square of 5 cm
  const Lattice<3> lattice = voxelize(mesh, 0.1f);
  EXPECT_EQ(lattice.cells.size(), cells);
  EXPECT_NEAR(total_mass(lattice, 1), 1, 0.02);
}

TEST(Voxelize, AFlatMeshIsOneLayerOfCells) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, Vector3f::UnitZ());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Lattice<3> lattice = voxelize(mesh, 0.25f);
  EXPECT_EQ(lattice.cells.size(), 16u);
  for (const float fill : lattice.fill) EXPECT_EQ(fill, 0.5f);  // open: nothing can be said
}

TEST(Voxelize, CoversEveryShapeAtEverySize) {
  const std::vector<TriangleMesh> meshes{make_sphere(0.5f, 10), make_torus(0.7f, 0.2f, 24, 12),
                                         make_car(2.0f), make_box({1, 0.31f, 0.07f}, 0.1f)};
  for (const TriangleMesh& mesh : meshes)
    for (const float cell_size : {0.07f, 0.1f, 0.23f, 0.5f, 0.9f}) {
      const Lattice<3> lattice = voxelize(mesh, cell_size);
      expect_covers(lattice, mesh);
      EXPECT_EQ(lattice.cells, voxelize(mesh, cell_size).cells);
    }
}

TEST(Voxelize, RefusesCellSizesThatAreNoSize) {
  const TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(message_of(mesh, 0), "cell size 0 m: expected a positive number of metres");
  EXPECT_EQ(message_of(mesh, -0.1f), "cell size -0.1 m: expected a positive number of metres");
  EXPECT_EQ(message_of(mesh, INFINITY), "cell size inf m: expected a positive number of metres");
  EXPECT_EQ(message_of(mesh, std::numeric_limits<float>::quiet_NaN()),
            "cell size nan m: expected a positive number of metres");
}

TEST(Voxelize, RefusesOneCellForTheWholeMesh) {
  const TriangleMesh mesh = box({0, 0, 0}, {1, 0.5f, 0.2f});
  for (const float cell_size : {1.0f, 5.0f, 1e30f})
    EXPECT_NE(message_of(mesh, cell_size)
                  .find("is too large: one cell would hold the whole mesh, which is 1 m long"),
              std::string::npos)
        << message_of(mesh, cell_size);
  EXPECT_EQ(message_of(mesh, 0.9f), "no error");
}

TEST(Voxelize, RefusesCellsTooSmallForTheLimits) {
  const TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  for (const float cell_size : {1e-3f, 1e-9f, 1e-38f, 1e-45f})
    EXPECT_NE(message_of(mesh, cell_size)
                  .find("is too small: the mesh is 1 m long and may be at most 256 cells long"),
              std::string::npos)
        << message_of(mesh, cell_size);
  for (const float cell_size : {0.0095f, 1.0f / 256})
    EXPECT_NE(message_of(mesh, cell_size)
                  .find("is too small: the lattice would have more than 1048576 particles; use about"),
              std::string::npos)
        << message_of(mesh, cell_size);
  EXPECT_EQ(message_of(mesh, 0.0265f), "no error");
}

TEST(CountParticles, CountsThoseThatVoxelizeMakesAndThoseOfLatticesThatItRefuses) {
  const TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  for (const float cell_size : {0.7f, 0.3f, 0.05f})
    EXPECT_EQ(count_particles(mesh, cell_size), voxelize(mesh, cell_size).particles.size()) << cell_size;
  EXPECT_EQ(count_particles(mesh, 1.0f / 128), 129u * 129u * 129u);
  EXPECT_THROW(count_particles(mesh, 1e-3f), std::runtime_error);
}

TEST(Voxelize, RefusesMeshesItCannotPlace) {
  EXPECT_EQ(message_of({}, 0.1f), "the mesh has no triangles; a soft body needs a surface");
  EXPECT_NE(message_of(box({1e6f, 0, 0}, {1e6f + 1, 1, 1}), 0.1f).find("too far"), std::string::npos);
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.positions[3].y() = NAN;
  EXPECT_EQ(message_of(mesh, 0.1f), "the mesh has a coordinate that is NaN or infinite");
}

}  // namespace
}  // namespace softcell::ppu
