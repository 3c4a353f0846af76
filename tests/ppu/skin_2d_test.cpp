// The smooth shape of bodies in two dimensions.

#include "softcell/soft_bodies/skin_2d.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/lattices_2d.h"
#include "support/contract.h"

namespace softcell::ppu {
namespace {

using namespace test;
using Eigen::Vector2f;

float cross(const Vector2f& a, const Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

std::vector<Vector2f> at_rest(const Lattice<2>& lattice) {
  std::vector<Vector2f> positions;
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) positions.push_back(lattice.rest_position(i));
  return positions;
}

float area_of_triangles(const Skin2d& skin) {
  float area = 0;
  for (const auto& [a, b, c] : skin.triangles)
    area += 0.5f * cross(skin.rest[b] - skin.rest[a], skin.rest[c] - skin.rest[a]);
  return area;
}

float area_of_outlines(const Skin2d& skin) {
  float area = 0;
  for (const auto& loop : skin.outlines) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      area += 0.5f * cross(skin.rest[loop[i]], skin.rest[loop[(i + 1) % loop.size()]]);
  }
  return area;
}

/// Checks the skins of all lattices and of the margins between which something changes.
template <class Check>
void for_all_skins(const Check& check) {
  for (const auto& [name, lattice] : all_lattices_2d()) {
    for (const float margin : {0.0f, 0.34f, 0.35f, 0.5f}) {
      SCOPED_TRACE(name + ", margin " + std::to_string(margin));
      check(lattice, make_skin_2d(lattice, margin), margin);
    }
  }
}

TEST(Skin2d, TrianglesFillTheOutlinesWithoutGapsAndOverlaps) {
  for_all_skins([](const Lattice<2>&, const Skin2d& skin, float) {
    ASSERT_FALSE(skin.triangles.empty());
    ASSERT_EQ(skin.cells.size(), skin.triangles.size());
    for (const auto& [a, b, c] : skin.triangles)
      EXPECT_GT(cross(skin.rest[b] - skin.rest[a], skin.rest[c] - skin.rest[a]), 0)
          << a << " " << b << " " << c;
    EXPECT_NEAR(area_of_triangles(skin), area_of_outlines(skin), 1e-3f * area_of_triangles(skin));
    // Each edge belongs to two triangles in opposite directions, or to one and an outline.
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const auto& [a, b, c] : skin.triangles) {
      for (const auto& edge : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
        EXPECT_TRUE(edges.insert(edge).second) << "two triangles have an edge in one direction";
    }
    std::size_t outer = 0, of_outlines = 0;
    for (const auto& [a, b] : edges) outer += edges.contains({b, a}) ? 0 : 1;
    for (const auto& loop : skin.outlines) {
      of_outlines += loop.size();
      for (std::size_t i = 0; i < loop.size(); ++i)
        EXPECT_TRUE(edges.contains({loop[i], loop[(i + 1) % loop.size()]}));
    }
    EXPECT_EQ(outer, of_outlines);
  });
}

TEST(Skin2d, AStraightEdgeIsAsFarFromTheCellsAsTheMargin) {
  const Lattice<2> lattice = rectangle(12, 9);
  for (const float margin : {0.0f, 0.2f, 0.5f}) {
    float most = 0;
    for (const Vector2f& rest : make_skin_2d(lattice, margin).rest) most = std::max(most, rest.x());
    EXPECT_NEAR(most, 12 + margin, 0.02f);
  }
}

TEST(Skin2d, StairsAreGone) {
  // A slope of 45 degrees in steps of a cell: the edge lies on a line, but near the ends.
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < 16; ++i) rows.push_back(std::string(i + 1, '#') + std::string(15 - i, '.'));
  const Skin2d skin = make_skin_2d(lattice_of_rows(rows), 0.5f);
  float least = 100, most = -100;
  ASSERT_EQ(skin.outlines.size(), 1u);
  for (const std::uint32_t vertex : skin.outlines[0]) {
    const Vector2f& at = skin.rest[vertex];
    if (at.x() < 5 || at.x() > 11 || at.y() < 3) continue;
    const float across = (at.x() + at.y()) / std::sqrt(2.0f);
    least = std::min(least, across);
    most = std::max(most, across);
  }
  EXPECT_LT(most - least, 0.06f) << "cells; the stairs are 0.71 high";
}

TEST(Skin2d, GapsOfACellStayOpenAndNotchesAreFilled) {
  EXPECT_EQ(make_skin_2d(lattice_of_rows({"#.#.#", "#.#.#", "#.#.#", "#####"}), 0.5f).outlines.size(), 1u);
  const Skin2d comb = make_skin_2d(lattice_of_rows({"#.#", "#.#", "#.#", "###"}), 0.5f);
  bool open = true;
  for (const auto& [a, b, c] : comb.triangles) {
    const Vector2f middle = (comb.rest[a] + comb.rest[b] + comb.rest[c]) / 3;
    if (std::abs(middle.x() - 1.5f) < 0.05f && middle.y() > 1.3f) open = false;
  }
  EXPECT_TRUE(open) << "something is drawn in the middle of the gap";
  const Skin2d notch = make_skin_2d(lattice_of_rows({"#.#", "###"}), 0.5f);
  bool filled = false;
  for (const auto& [a, b, c] : notch.triangles) {
    const Vector2f middle = (notch.rest[a] + notch.rest[b] + notch.rest[c]) / 3;
    filled = filled || (std::abs(middle.x() - 1.5f) < 0.1f && middle.y() > 1.2f);
  }
  EXPECT_TRUE(filled);
}

TEST(Skin2d, HolesHaveOutlinesOfTheirOwn) {
  EXPECT_EQ(
      make_skin_2d(lattice_of_rows({"#####", "#...#", "#...#", "#...#", "#####"}), 0.5f).outlines.size(), 2u);
  EXPECT_EQ(make_skin_2d(lattice_of_rows({"##..###", "##..###"}), 0.3f).outlines.size(), 2u);
}

TEST(Skin2d, SlopesPointOutwardsAtTheEdgeAndVanishInside) {
  const Skin2d skin = make_skin_2d(rectangle(12, 12), 0.5f);
  for (const std::uint32_t vertex : skin.outlines.at(0)) {
    const Vector2f away = skin.rest[vertex] - Vector2f(6, 6);
    EXPECT_GT(skin.slopes[vertex].dot(away.normalized()), 0.3f);
    EXPECT_LT(skin.slopes[vertex].norm(), 0.8f);
  }
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    if ((skin.rest[i] - Vector2f(6, 6)).cwiseAbs().maxCoeff() < 4) {
      EXPECT_LT(skin.slopes[i].norm(), 0.01f);
    }
  }
}

// Any affine map of the particles moves the whole skin by the same map, margins included; slopes turn as normals.
TEST(Skin2d, FollowsAffineMapsExactly) {
  for_all_skins([](const Lattice<2>& lattice, const Skin2d& skin, float) {
    Eigen::Matrix2f stretch;
    stretch << 0.6f, -1.1f, 0.9f, 0.4f;
    const Vector2f shift(3, -2);
    std::vector<Vector2f> particles = at_rest(lattice);
    for (Vector2f& particle : particles) particle = stretch * particle + shift;
    std::vector<Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
    deform(skin, particles, positions, slopes);
    const Eigen::Matrix2f cofactors = stretch.determinant() * stretch.inverse().transpose();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vector2f expected = stretch * (lattice.origin + lattice.spacing * skin.rest[i]) + shift;
      ASSERT_LT((positions[i] - expected).norm(), 1e-5f) << i;
      ASSERT_LT((slopes[i] - cofactors * skin.slopes[i]).norm(), 1e-4f) << i;
    }
  });
}

/// A bent bar, and where a skin's vertices are drawn then.
std::vector<Vector2f> placed(const Skin2d& skin, std::span<const Vector2f> particles) {
  std::vector<Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
  deform(skin, particles, positions, slopes);
  return positions;
}

/// Bent to a circle of 10 cells about (0, 10).
Vector2f bent(const Vector2f& at) {
  const float angle = at.x() / 10, radius = 10 - at.y();
  return {radius * std::sin(angle), 10 - radius * std::cos(angle)};
}

// Cells of few corners would be seen as such: the outline turns from vertex to vertex by no more than the bend needs.
TEST(Skin2d, ABentBarHasNoKinksBetweenCells) {
  const Lattice<2> lattice = rectangle(12, 2);
  std::vector<Vector2f> particles;
  for (const auto& at : lattice.particles) particles.push_back(bent(at.cast<float>()));
  const Skin2d skin = make_skin_2d(lattice, 0.5f);
  const std::vector<Vector2f> positions = placed(skin, particles);
  float most = 0;
  const auto& loop = skin.outlines.at(0);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2f& at = skin.rest[loop[i]];
    if (at.x() < 2 || at.x() > 10) continue;
    EXPECT_LT((positions[loop[i]] - bent(at)).norm(), 0.03f) << at.transpose();
    const Vector2f before = positions[loop[i]] - positions[loop[(i + loop.size() - 1) % loop.size()]];
    const Vector2f behind = positions[loop[(i + 1) % loop.size()]] - positions[loop[i]];
    if (before.norm() > 0.1f && behind.norm() > 0.1f)
      most = std::max(most, std::abs(cross(before.normalized(), behind.normalized())));
  }
  EXPECT_LT(most, 0.045f)
      << "radians; a cell that is bent as a whole turns by 0.1 at its ends, a quarter of it by 0.025";
}

TEST(Skin2d, ADiscIsRound) {
  const Lattice<2> lattice =
      lattice_of_rows({"..###..", ".#####.", "#######", "#######", "#######", ".#####.", "..###.."});
  const Vector2f middle(3.5f, 3.5f);
  const Skin2d skin =
      make_skin_2d(lattice, 0.5f, [&](const Vector2f& at) { return (at - middle).norm() - 3.5f; });
  ASSERT_EQ(skin.outlines.size(), 1u);
  for (const std::uint32_t vertex : skin.outlines[0]) {
    EXPECT_NEAR((skin.rest[vertex] - middle).norm(), 4, 0.02f);
    EXPECT_NEAR(skin.slopes[vertex].norm(), 0.62f, 0.05f);
  }
  EXPECT_NEAR(area_of_triangles(skin), 3.14159f * 16, 0.3f);
}

TEST(Skin2d, ADiscStaysSmoothWhereItIsPressed) {
  // Corners of its stairs are pushed in by a floor, as contacts do; the particles between them are not.
  const Lattice<2> lattice =
      lattice_of_rows({"...####...", "..######..", ".########.", "##########", "##########", "##########",
                       "##########", ".########.", "..######..", "...####..."});
  const Vector2f middle(5, 5);
  const Skin2d skin =
      make_skin_2d(lattice, 0.5f, [&](const Vector2f& at) { return (at - middle).norm() - 5.2f; });
  std::vector<Vector2f> particles = at_rest(lattice);
  const Vector2f down = Vector2f(-1, -1).normalized();
  const auto depth = [&](const Vector2f& at) {
    return ((at - lattice.origin) / lattice.spacing - middle).dot(down);
  };
  for (Vector2f& at : particles)
    if (const float below = depth(at) - 4.4f; below > 0) at -= lattice.spacing * below * down;
  const std::vector<Vector2f> positions = placed(skin, particles);
  float least = 100, most = 0;
  for (const std::uint32_t vertex : skin.outlines.at(0)) {
    const Vector2f in = skin.rest[vertex] - middle;
    if (in.dot(down) < 0 || std::abs(in.x() - in.y()) > 2.2f) continue;
    least = std::min(least, depth(positions[vertex]));
    most = std::max(most, depth(positions[vertex]));
  }
  EXPECT_LT(most - least, 0.25f) << "cells, along the flat part";
}

TEST(SkinParts2d, CoverTheShapeOnce) {
  for (const auto& [name, lattice] : all_lattices_2d()) {
    SCOPED_TRACE(name);
    std::vector<std::uint32_t> parts;
    for (const auto& cell : lattice.cells)
      parts.push_back(static_cast<std::uint32_t>((cell.x() + 64) / 3 % 2 + 2 * ((cell.y() + 64) / 3 % 2)));
    const std::vector<Skin2d> skins = make_skin_parts_2d(lattice, 0.5f, {}, parts);
    EXPECT_EQ(skins.size(), 1 + *std::max_element(parts.begin(), parts.end()));
    float area = 0;
    for (const Skin2d& skin : skins) {
      area += area_of_triangles(skin);
      EXPECT_NEAR(area_of_triangles(skin), area_of_outlines(skin), 1e-3f * area_of_triangles(skin) + 1e-4f);
      for (const auto& [a, b, c] : skin.triangles)
        EXPECT_GT(cross(skin.rest[b] - skin.rest[a], skin.rest[c] - skin.rest[a]), 0);
    }
    const float whole = area_of_triangles(make_skin_2d(lattice, 0.5f));
    // Where three parts meet, their corners are cut off and overlap, by less than a quarter of a cell.
    EXPECT_NEAR(area, whole, 0.02f * whole);
  }
}

TEST(SkinParts2d, MeetInSmoothLines) {
  // Below a slope of 45 degrees in steps of a cell, and above it.
  const Lattice<2> lattice = rectangle(12, 12);
  std::vector<std::uint32_t> parts;
  for (const auto& cell : lattice.cells) parts.push_back(cell.y() > cell.x() ? 1 : 0);
  const std::vector<Skin2d> skins = make_skin_parts_2d(lattice, 0.5f, {}, parts);
  ASSERT_EQ(skins.size(), 2u);
  float least = 100, most = -100;
  for (const std::uint32_t vertex : skins[1].outlines.at(0)) {
    const Vector2f& at = skins[1].rest[vertex];
    if (at.minCoeff() < 2 || at.maxCoeff() > 10) continue;
    least = std::min(least, (at.y() - at.x()) / std::sqrt(2.0f));
    most = std::max(most, (at.y() - at.x()) / std::sqrt(2.0f));
  }
  EXPECT_LT(most - least, 0.3f) << "cells; the stairs are 0.71 high";
}

TEST(Skin2d, EachTriangleKnowsTheCellThatItLiesIn) {
  const Lattice<2> lattice = man132();
  const Skin2d skin = make_skin_2d(lattice, 0.5f);
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    const auto& [a, b, c] = skin.triangles[t];
    const Vector2f middle = (skin.rest[a] + skin.rest[b] + skin.rest[c]) / 3;
    const Vector2f from_cell = middle - lattice.cells[skin.cells[t]].cast<float>() - Vector2f::Constant(0.5f);
    EXPECT_LT(from_cell.cwiseAbs().maxCoeff(), 1.5f);
  }
}

TEST(Cover2d, HasTheCellsAndWhatIsAskedForAroundThem) {
  const Lattice<2> lattice = rectangle(3, 2);
  EXPECT_NEAR(area_of_triangles(make_cover_2d(lattice, [](const Eigen::Vector2i&) { return false; })), 6,
              1e-5f);
  EXPECT_NEAR(area_of_triangles(make_cover_2d(lattice, [](const Eigen::Vector2i&) { return true; })), 20,
              1e-4f);
  EXPECT_NEAR(
      area_of_triangles(make_cover_2d(lattice, [](const Eigen::Vector2i& at) { return at.x() == 3; })), 6 + 4,
      1e-4f);
}

TEST(CellPoint2d, IsWhereItWasAskedFor) {
  const Lattice<2> lattice = man132();
  const std::vector<Vector2f> particles = at_rest(lattice);
  for (const Vector2f& at :
       {Vector2f(8, 14), Vector2f(5, 0), Vector2f(7.25f, 11.5f), Vector2f(-0.5f, 9.5f), Vector2f(30, 40)}) {
    const CellPoint2d point = point_in_cells(lattice, at);
    EXPECT_NEAR(point.share[0] + point.share[1] + point.share[2] + point.share[3], 1, 1e-4f);
    EXPECT_LT((point.at(particles) - (lattice.origin + lattice.spacing * at)).norm(), 1e-3f);
  }
}

TEST(Skin2d, IsOfOneLattice) {
  const Lattice<2> large = rectangle(3, 2), small = rectangle(2, 2);
  const Skin2d skin = make_skin_2d(large, 0.5f);
  EXPECT_NO_THROW(validate(skin, large));
  EXPECT_THROW(validate(skin, small), std::invalid_argument);
  Lattice<2> finer = large;
  finer.spacing *= 0.5f;
  try {
    validate(skin, finer);
    FAIL() << "a skin of larger cells is accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("a skin was made for another lattice: it has cells of "),
              std::string::npos)
        << error.what();
  }
}

TEST(Skin2dContract, RefusesMarginsAndSizesThatDoNotFit) {
  const Lattice<2> lattice = rectangle(2, 2);
  for (const float margin : {-0.1f, 0.6f, NAN}) {
    EXPECT_THROW(make_skin_2d(lattice, margin), std::invalid_argument) << margin;
    EXPECT_THROW(make_skin_parts_2d(lattice, margin, {}, std::vector<std::uint32_t>(4)),
                 std::invalid_argument);
  }
  SC_EXPECT_VIOLATES(make_skin_2d(Lattice<2>(), 0.5f), "has no cells");
  const Skin2d skin = make_skin_2d(lattice, 0.5f);
  std::vector<Vector2f> none;
  SC_EXPECT_VIOLATES(deform(skin, at_rest(lattice), none, none), "room for 0 positions");
}

}  // namespace
}  // namespace softcell::ppu
