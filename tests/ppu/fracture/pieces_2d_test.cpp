// Bodies of two dimensions that fall into pieces: what hangs together, what is drawn, and what is kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../lattices_2d.h"
#include "ppu/bodies/break_body.h"
#include "softcell/soft_bodies/skin_2d.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

SoftBodySettings paper() { return {.cell_size = 0.1f, .half_width = 1, .density = 10}; }

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Momenta of bodies together, about the origin.
struct Momenta2d {
  double mass = 0, angular_momentum = 0;
  Vector2d momentum{0, 0}, moment{0, 0};

  void add(const SoftBody<2>& body) {
    for (std::size_t i = 0; i < body.positions().size(); ++i) {
      const double m = double{body.model().masses()[i]};
      const Vector2d x = body.position(i).cast<double>(), v = body.velocities()[i].cast<double>();
      mass += m;
      moment += m * x;
      momentum += m * v;
      angular_momentum += m * cross(x, v);
    }
  }
};

void expect_equal(const Momenta2d& a, const Momenta2d& b) {
  EXPECT_NEAR(a.mass, b.mass, 1e-6 * b.mass);
  EXPECT_LT((a.moment - b.moment).norm(), 1e-6 * b.mass);
  EXPECT_LT((a.momentum - b.momentum).norm(), 1e-6 * b.mass);
  EXPECT_NEAR(a.angular_momentum, b.angular_momentum, 1e-6 * b.mass);
}

void stir_2d(SoftBody<2>& body, std::mt19937& random) {
  std::uniform_real_distribution<float> number(-1, 1);
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    const float x = number(random), y = number(random), u = number(random), v = number(random);
    body.set_particle(i, body.position(i) + 0.02f * Vector2f(x, y), 3 * Vector2f(u, v));
  }
}

std::vector<std::uint32_t> all_faces_2d(const SoftBodyModel<2>& model) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < model.cracks().faces.size(); ++f) faces.push_back(f);
  return faces;
}

double area_of(const Skin2d& skin) {
  double area = 0;
  for (const auto& [a, b, c] : skin.triangles)
    area +=
        cross((skin.rest[b] - skin.rest[a]).cast<double>(), (skin.rest[c] - skin.rest[a]).cast<double>()) / 2;
  return area;
}

/// Its triangles fill its outlines, and each vertex is drawn where it was in the whole.
void expect_valid_skin(const Skin2d& skin, const Lattice<2>& lattice) {
  std::vector<Vector2f> particles;
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) particles.push_back(lattice.rest_position(i));
  std::vector<Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
  deform(skin, particles, positions, slopes);
  for (std::size_t v = 0; v < skin.rest.size(); ++v) {
    const Vector2f wanted = lattice.origin + lattice.spacing * skin.rest[v];
    EXPECT_LT((positions[v] - wanted).norm(), 1e-5f);
  }
  std::set<std::array<std::uint32_t, 2>> sides;
  for (const auto& [a, b, c] : skin.triangles)
    for (const auto& side : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
      EXPECT_TRUE(sides.insert(side).second) << "two triangles have a side in one direction";
  std::size_t outer = 0, of_outlines = 0;
  for (const auto& [a, b] : sides) outer += sides.contains({b, a}) ? 0 : 1;
  double area = 0;
  for (const auto& loop : skin.outlines) {
    EXPECT_GE(loop.size(), 3u);
    of_outlines += loop.size();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      EXPECT_TRUE(sides.contains({a, b}));
      area += cross(skin.rest[a].cast<double>(), skin.rest[b].cast<double>()) / 2;
    }
  }
  EXPECT_EQ(outer, of_outlines);
  EXPECT_NEAR(area, area_of(skin), 1e-3);
  for (const std::uint32_t cell : skin.cells) EXPECT_LT(cell, lattice.cells.size());
}

TEST(Pieces2d, BrokenAtAllFacesAreSingleCellsWithAllMassAndBothMomenta) {
  std::mt19937 random(7);
  for (const auto& [name, lattice] : test::all_lattices_2d()) {
    SCOPED_TRACE(name);
    SoftBody<2> body(make_soft_body_model(lattice, paper()));
    stir_2d(body, random);
    Momenta2d before, after;
    before.add(body);
    const auto pieces = pieces_of(body, all_faces_2d(body.model()));
    std::size_t cells = 0;
    for (const BodyPiece<2>& piece : pieces) {
      after.add(piece.body);
      const Lattice<2>& own = piece.body.model().lattice();
      cells += own.cells.size();
      EXPECT_TRUE(piece.body.model().is_piece());
      for (std::size_t i = 0; i < own.particles.size(); ++i) {
        EXPECT_EQ(own.particles[i], lattice.particles[piece.particle_of[i]]);
        EXPECT_EQ(piece.body.position(i), body.position(piece.particle_of[i]));
      }
    }
    EXPECT_EQ(cells, lattice.cells.size());
    // Cells that touch at a corner only have no face in common: that corner stays one particle, and they one body.
    EXPECT_EQ(pieces.size(), name == "touching at a corner" ? 1 : lattice.cells.size());
    expect_equal(after, before);
  }
}

TEST(Pieces2d, OfRandomBreaksAreDrawnAsWhatTheyWereOfTheWhole) {
  std::mt19937 random(11);
  for (const auto& [name, lattice] : test::all_lattices_2d())
    for (const float margin : {0.0f, 0.34f, 0.5f}) {
      SCOPED_TRACE(name + ", margin " + std::to_string(margin));
      const Skin2d whole = make_skin_2d(lattice, margin);
      std::vector<SoftBody<2>> bodies{SoftBody<2>(make_soft_body_model(lattice, paper()))};
      stir_2d(bodies[0], random);
      Momenta2d before;
      before.add(bodies[0]);
      for (int round = 0; round < 4; ++round) {
        for (std::size_t b = 0, count = bodies.size(); b < count; ++b) {
          std::vector<std::uint32_t> faces;
          for (std::uint32_t f = 0; f < bodies[b].model().cracks().faces.size(); ++f)
            if (random() % 5 == 0) faces.push_back(f);
          auto pieces = pieces_of(bodies[b], faces);
          bodies[b] = pieces.front().body;
          for (std::size_t i = 1; i < pieces.size(); ++i) bodies.push_back(pieces[i].body);
        }
        Momenta2d after;
        double area = 0;
        std::size_t triangles = 0;
        for (const SoftBody<2>& body : bodies) {
          after.add(body);
          const Skin2d skin = skin_of_piece(whole, lattice, body.model().lattice());
          expect_valid_skin(skin, body.model().lattice());
          area += area_of(skin);
          triangles += skin.triangles.size();
        }
        expect_equal(after, before);
        EXPECT_NEAR(area, area_of(whole), 1e-3);
        EXPECT_EQ(triangles, whole.triangles.size());
      }
    }
}

/// The two sides of a crack are drawn apart where its particles are.
TEST(Pieces2d, ACrackThatEndsInTheBodyOpensInThePicture) {
  const Lattice<2> lattice = test::rectangle(6, 4);
  SoftBody<2> body(make_soft_body_model(lattice, paper()));
  // From the lower edge to the middle, between the third and the fourth column.
  const float x = lattice.origin.x() + 0.3f;
  EXPECT_TRUE(cut(body, Cut2d::stroke({x + 0.001f, lattice.origin.y() - 1}, {0, 1.199f})).empty());
  ASSERT_TRUE(body.model().is_piece());
  EXPECT_EQ(body.model().particles(), lattice.particles.size() + 2);
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    const auto& at = body.model().lattice().particles[i];
    EXPECT_EQ(body.model().is_at_cut(i), at.x() == 3 && at.y() < 2);
  }
  const Skin2d whole = make_skin_2d(lattice, 0.5f);
  const Skin2d skin = skin_of_piece(whole, lattice, body.model().lattice());
  expect_valid_skin(skin, body.model().lattice());
  ASSERT_EQ(skin.outlines.size(), 1u);
  // Drawn with all particles of the cells on the left moved to the left, a gap opens from the edge to where the crack ends.
  std::vector<bool> on_left(body.positions().size());
  for (std::size_t c = 0; c < body.model().lattice().cells.size(); ++c)
    if (body.model().lattice().cells[c].x() < 3)
      for (const std::uint32_t i : body.model().lattice().corners[c]) on_left[i] = true;
  std::vector<Vector2f> particles(body.positions().begin(), body.positions().end());
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (on_left[i]) particles[i].x() -= 0.05f;
  std::vector<Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
  deform(skin, particles, positions, slopes);
  const auto drawn_at = [&](const Vector2f& rest, bool left) {
    float nearest = 1;
    for (std::size_t v = 0; v < skin.rest.size(); ++v) {
      const Vector2f wanted = lattice.origin + 0.1f * rest - Vector2f(left ? 0.05f : 0, 0);
      if ((skin.rest[v] - rest).norm() < 1e-6f) nearest = std::min(nearest, (positions[v] - wanted).norm());
    }
    return nearest;
  };
  for (const float y : {0.0f, 1.0f}) {
    EXPECT_LT(drawn_at({3, y}, true), 1e-5f) << y;
    EXPECT_LT(drawn_at({3, y}, false), 1e-5f) << y;
  }
}

TEST(Pieces2d, ParticlesAtCutsHaveSmallerCirclesAndOthersBehindThemCollideToo) {
  const Lattice<2> lattice = test::rectangle(8, 8);
  SoftBody<2> body(make_soft_body_model(lattice, paper()));
  const auto pieces = cut(body, Cut2d::line({lattice.origin.x() + 0.4f, 0}, {1, 0}));
  ASSERT_EQ(pieces.size(), 1u);
  for (const SoftBody<2>* const piece : {static_cast<const SoftBody<2>*>(&body), &pieces[0]}) {
    const SoftBodyModel<2>& model = piece->model();
    EXPECT_EQ(model.lattice().cells.size(), 32u);
    for (std::uint32_t i = 0; i < model.particles(); ++i) {
      const int x = model.lattice().particles[i].x();
      EXPECT_EQ(model.is_at_cut(i), x == 4);
      EXPECT_EQ(model.contact_radius(i), x == 4 ? 0.025f : 0.05f);
      EXPECT_TRUE(x < 3 || x > 5 || std::ranges::binary_search(model.outer(), i)) << i;
    }
  }
  EXPECT_FALSE(SoftBody<2>(make_soft_body_model(lattice, paper())).model().is_at_cut(0));
}

TEST(Pieces2d, FacesBreakByStretchAndByTurnAtTheLimitsStated) {
  for (const double beyond : {0.98, 1.02}) {
    SoftBodySettings settings = paper();
    settings.fracture = Fracture{.stretch = 0.1f};
    SoftBody<2> bar(make_soft_body_model(test::rectangle(9, 1), settings));
    for (std::size_t i = 0; i < bar.positions().size(); ++i) {
      const Vector2f x = bar.position(i);
      bar.set_particle(i, {x.x() * static_cast<float>(1 + 0.1 * beyond), x.y()}, {0, 0});
    }
    EXPECT_EQ(break_where_strained(bar).size(), beyond > 1 ? 8u : 0u);

    // Cells to the left and to the right of the middle are sheared by s and -s: the rotation nearest to [[1, 0], [s, 1]] has the tangent s / 2.
    constexpr double kTurn = 0.2;
    const auto shear = static_cast<float>(2 * std::tan(kTurn * beyond / 2));
    settings.fracture = Fracture{.turn = static_cast<float>(kTurn)};
    SoftBody<2> bent(make_soft_body_model(test::rectangle(2, 1), settings));
    const float middle = bent.centre_of_mass().x();
    for (std::size_t i = 0; i < bent.positions().size(); ++i) {
      const Vector2f x = bent.position(i);
      bent.set_particle(i, {x.x(), x.y() - shear * std::abs(x.x() - middle)}, {0, 0});
    }
    EXPECT_EQ(break_where_strained(bent).size(), beyond > 1 ? 1u : 0u);
  }
}

TEST(Pieces2d, TheWeakerCellOfAFaceDecides) {
  SoftBodySettings settings = paper();
  settings.fracture = Fracture{.stretch = 0.1f};
  const Lattice<2> lattice = test::rectangle(9, 1);
  const auto weak = [&](const Vector2f& at) {
    return std::abs(at.x() - lattice.origin.x() - 0.45f) < 0.02f ? 0.5f : 1.0f;
  };
  SoftBody<2> bar(make_soft_body_model(lattice, settings, 0.5f, weak));
  for (std::size_t i = 0; i < bar.positions().size(); ++i)
    bar.set_particle(i, {1.06f * bar.position(i).x(), bar.position(i).y()}, {0, 0});
  EXPECT_EQ(break_where_strained(bar).size(), 2u);
  EXPECT_THROW(make_soft_body_model(lattice, settings, 0.5f, [](const Vector2f&) { return -1.0f; }),
               std::runtime_error);
}

TEST(Pieces2d, VanishIfTheyHaveFewerCellsThanStated) {
  const Lattice<2> lattice = test::rectangle(12, 1);
  const auto at = [&](int cell) {
    return Cut2d::line({lattice.origin.x() + 0.1f * static_cast<float>(cell) + 0.001f, 0}, {1, 0});
  };
  for (const std::uint32_t least_cells : {1u, 2u, 3u, 4u, 1000u}) {
    SCOPED_TRACE(least_cells);
    SoftBodySettings settings = paper();
    settings.fracture = Fracture{.stretch = 0.1f, .least_cells = least_cells};
    SoftBody<2> body(make_soft_body_model(lattice, settings));
    std::vector<std::uint32_t> faces;
    for (const int cell : {1, 4, 6})
      for (const std::uint32_t face : faces_across(body, at(cell))) faces.push_back(face);
    const auto planned = plan_pieces(body.shared_model(), faces, least_cells_of(body));
    std::vector<std::size_t> stay, vanished, expected_stay{6}, expected_vanished;
    for (const BodyPiece<2>& piece : planned.stay) {
      const SoftBodyModel<2>& model = piece.body.model();
      stay.push_back(model.lattice().cells.size());
      EXPECT_NEAR(model.mass(), body.model().mass() * static_cast<float>(stay.back()) / 12, 1e-6f);
    }
    for (const auto& particles : planned.vanished) vanished.push_back(particles.size() / 2 - 1);
    for (const std::size_t cells : {1u, 3u, 2u})
      (cells < least_cells ? expected_vanished : expected_stay).push_back(cells);
    EXPECT_EQ(stay, expected_stay);
    EXPECT_EQ(vanished, expected_vanished);
    EXPECT_EQ(cut(body, at(6)).size(), 6 < least_cells ? 0u : 1u);
    EXPECT_EQ(body.model().lattice().cells.size(), 6u);
    // All faces break: the largest piece stays, a single cell.
    for (std::size_t i = 0; i < body.positions().size(); ++i) {
      const Vector2f x = body.position(i);
      body.set_particle(i, {1.2f * x.x(), x.y()}, {0, 0});
    }
    EXPECT_EQ(break_where_strained(body).size(), 1 < least_cells ? 0u : 5u);
    EXPECT_EQ(body.model().lattice().cells.size(), 1u);
  }
}

TEST(Pieces2d, ACutThatIsNoneIsRefused) {
  SoftBody<2> body(make_soft_body_model(test::rectangle(4, 4), paper()));
  EXPECT_THROW(cut(body, Cut2d::stroke({0, 0}, {0, 0})), std::invalid_argument);
  EXPECT_THROW(cut(body, Cut2d::stroke({0, std::nanf("")}, {1, 0})), std::invalid_argument);
  EXPECT_TRUE(cut(body, Cut2d::line({5, 5}, {1, 0})).empty());
  EXPECT_FALSE(body.model().is_piece());
  // A stroke cuts what it passes, a line everything.
  EXPECT_TRUE(cut(body, Cut2d::stroke(body.centre_of_mass() + Vector2f(0.001f, -0.001f), {0, 1})).empty());
  EXPECT_TRUE(body.model().is_piece());
  EXPECT_EQ(cut(body, Cut2d::line(body.centre_of_mass() + Vector2f(0.001f, 0), {1, 0})).size(), 1u);
}

}  // namespace
}  // namespace softcell::ppu
