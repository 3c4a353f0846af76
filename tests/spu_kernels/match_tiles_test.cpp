// The kernel match_tiles against the kernel match, bit for bit, and on bodies that match cannot hold against
// the PPU's solver in double precision.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/lattices.h"
#include "ppu/reference/shape_matching.h"
#include "ppu/spe_bodies/job_records.h"
#include "spu_kernels/checked_runs.h"
#include "spu_kernels/kernel_image.h"
#include "spu_kernels/stepped_bodies.h"

namespace softcell {
namespace {

using Eigen::Vector3d;
using ppu::Lattice;
using ppu::MatchSettings;
using ppu::TileShape;
using ppu::test::Random;
using Vectors = std::vector<Vector3d>;
using Vector = spu::SkinCorner;

Vector of(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

/// What both kernels' bodies have in common.
struct Model {
  Model(Lattice<3> body, int half_width)
      : lattice(std::move(body)), w(half_width), matching(lattice, w, ppu::particle_masses(lattice, 1000)) {}

  /// Bent, turned and shaken by up to `noise` metres.
  Vectors deformed(std::uint64_t seed, double noise) const {
    Random random(seed);
    const Eigen::Quaterniond turn = random.rotation();
    Vectors x;
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      Vector3d p = lattice.rest_position(i).cast<double>();
      p.x() += 0.05 * p.y() * p.y();
      x.push_back(turn * p + Vector3d(3, -2, 1) + noise * random.vector());
      x.back() = (x.back() * 0x1p18).array().round() * 0x1p-18;  // as floats hold it
    }
    return x;
  }

  Lattice<3> lattice;
  int w;
  ppu::MatchingPlan<float, 3> matching;
};

/// A body in tiles.
class TiledBody {
 public:
  explicit TiledBody(const Model& model, TileShape shape = {},
                     const ls_sim::SpeOptions& options = {.spes = 1})
      : plan(model.lattice, model.matching, shape),
        kernel_(test::kernel_image("match_tiles", options.findings != nullptr)),
        jobs_(memory_, options, job_loop_),
        spes(memory_, jobs_, kernel_, plan) {}

  void set(const Vectors& x, const Vectors& v) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      spes.positions()[plan.place_of()[i]] = of(x[i]);
      spes.velocities()[plan.place_of()[i]] = of(v[i]);
    }
  }
  std::vector<Vector> velocities() {
    std::vector<Vector> v;
    for (const std::uint32_t place : plan.place_of()) v.push_back(spes.velocities()[place]);
    return v;
  }
  std::vector<ls_sim::SpeStatistics> statistics() const { return jobs_.statistics(); }

  ppu::TilePlan plan;

 private:
  dma::AddressSpace memory_;
  ls_sim::KernelImage job_loop_ = test::kernel_image("job_loop"), kernel_;
  ppu::JobSystem jobs_;

 public:
  test::SteppedTiles spes;
};

/// The same body whole.
class WholeBody {
 public:
  explicit WholeBody(const Model& model)
      : jobs_(memory_, {.spes = 1}, job_loop_),
        spes(memory_, jobs_, kernel_, ppu::MatchPlan(model.lattice, model.matching), 1) {}

  void set(const Vectors& x, const Vectors& v) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      spes.positions(0)[i] = of(x[i]);
      spes.velocities(0)[i] = of(v[i]);
    }
  }
  std::vector<Vector> velocities() { return {spes.velocities(0).begin(), spes.velocities(0).end()}; }

 private:
  dma::AddressSpace memory_;
  ls_sim::KernelImage job_loop_ = test::kernel_image("job_loop"), kernel_ = test::kernel_image("match");
  ppu::JobSystem jobs_;

 public:
  test::SteppedBodies<3> spes;
};

/// Number of the first vector that differs in a bit; -1: none.
int first_difference(const std::vector<Vector>& a, const std::vector<Vector>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::memcmp(&a[i], &b[i], sizeof a[i]) != 0) return static_cast<int>(i);
  return -1;
}

Vectors random_velocities(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Vectors v;
  for (std::size_t i = 0; i < count; ++i) v.push_back(0.1 * random.vector());
  return v;
}

/// Steps with all kinds of settings; velocities are kept, positions are new each time.
template <typename Body>
std::vector<Vector> stepped(const Model& model, Body& body) {
  const MatchSettings settings[] = {{.pull = 30, .damping = 0.2f},
                                    {.pull = 30, .damping = 0},
                                    {.pull = 60, .damping = 1, .least_iterations = 2, .most_iterations = 2}};
  std::vector<Vector> all;
  for (std::uint64_t step = 0; step < std::size(settings); ++step) {
    body.set(model.deformed(step < 2 ? 20 : 21, 0.01 * static_cast<double>(step + 1)),
             random_velocities(model.lattice.particles.size(), step));
    body.spes.step(settings[step]);
    const std::vector<Vector> v = body.velocities();
    all.insert(all.end(), v.begin(), v.end());
  }
  return all;
}

TEST(MatchTiles, GivesTheBitsOfTheWholeBodyOnEveryLattice) {
  for (const auto& [name, lattice] : ppu::test::all_lattices()) {
    for (int w = 1; w <= 4; ++w) {
      const Model model(lattice, w);
      WholeBody whole(model);
      const std::vector<Vector> expected = stepped(model, whole);
      for (const TileShape shape : {TileShape{}, {3, 2}, {1, 1}, {100, 3}}) {
        TiledBody tiled(model, shape);
        ASSERT_EQ(first_difference(expected, stepped(model, tiled)), -1)
            << name << ", w = " << w << ", tiles of " << shape.planes << " planes and " << shape.rows
            << " rows";
      }
    }
  }
}

TEST(MatchTiles, GivesTheBitsOfTheWholeBodyAcrossRestarts) {
  const Model model(ppu::test::block(40, 4, 2), 2);
  WholeBody whole(model);
  const std::vector<Vector> expected = stepped(model, whole);
  for (const TileShape shape : {TileShape{16, 2}, {10, 5}, {}}) {
    TiledBody tiled(model, shape);
    EXPECT_EQ(first_difference(expected, stepped(model, tiled)), -1) << shape.planes;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(tiled.spes.residual()),
              std::bit_cast<std::uint32_t>(whole.spes.residual(0)));
  }
}

/// With one SPE, jobs run on what the jobs before have left in the local store; with six, each SPE begins with a fresh one.
TEST(MatchTiles, GivesTheSameBytesOnAnySpesUnderEverySchedule) {
  const Model model(ppu::test::block(12, 9, 2), 2);
  WholeBody whole(model);
  const std::vector<Vector> expected = stepped(model, whole);
  for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
    for (int spes = 1; spes <= 6; ++spes) {
      TiledBody tiled(model, {4, 3}, {.spes = spes, .schedule = dma::parse_schedule(schedule)});
      std::vector<Vector> actual;
      ASSERT_NO_THROW(actual = stepped(model, tiled))
          << schedule << ", " << spes << " SPEs" << test::kDependsOnTheSchedule;
      ASSERT_EQ(first_difference(expected, actual), -1)
          << schedule << ", " << spes << " SPEs" << test::kDependsOnTheSchedule;
    }
  }
}

TEST(MatchTiles, GoalsOfALargeBodyAgreeWithTheReference) {
  const Model model(ppu::test::block(39, 29, 9), 2);  // 12,000 particles
  const Vectors x = model.deformed(5, 0.02), zero(x.size(), Vector3d::Zero());
  TiledBody tiled(model, {}, {.spes = 3});
  EXPECT_GT(tiled.spes.tiles(), 3u);
  tiled.set(x, zero);
  tiled.spes.step({.pull = 1, .damping = 0});
  const auto plan = std::make_shared<const ppu::MatchingPlan<double, 3>>(
      model.lattice, model.w, ppu::particle_masses(model.lattice, 1000));
  ppu::ShapeMatcher<double, 3> matcher(plan);
  Vectors g(x.size());
  matcher.goals(x, g);
  const std::vector<Vector> pulls = tiled.velocities();
  constexpr double kSize = 5;  // metres, the diagonal
  Vector3d momentum = Vector3d::Zero(), angular = Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector3d pull(pulls[i].x, pulls[i].y, pulls[i].z);
    ASSERT_LT((pull - (g[i] - x[i])).norm(), 1e-5 * kSize) << i;
    const double m = double{model.matching.particle_constants()[i].mass};
    momentum += m * pull;
    angular += m * (x[i] - x[0]).cross(pull);
    mass += m;
  }
  EXPECT_LT(momentum.norm() / mass, 1e-5);
  EXPECT_LT(angular.norm() / mass, 1e-5 * kSize * kSize);
}

TEST(MatchTiles, DampingOfALargeBodyAgreesWithTheReference) {
  const Model model(ppu::test::block(20, 35, 8), 2);
  const Vectors x = model.deformed(7, 0.02);
  Vectors v = random_velocities(x.size(), 8);
  for (Vector3d& each : v) each = (each * 0x1p20).array().round() * 0x1p-20;
  TiledBody tiled(model, {}, {.spes = 2});
  tiled.set(x, v);
  tiled.spes.step({.pull = 15, .damping = 0.3f});
  const auto plan = std::make_shared<const ppu::MatchingPlan<double, 3>>(
      model.lattice, model.w, ppu::particle_masses(model.lattice, 1000));
  ppu::ShapeMatcher<double, 3> matcher(plan);
  matcher.step_velocities(x, v, 0.25, 1.0 / 60, double{0.3f});
  const std::vector<Vector> velocities = tiled.velocities();
  for (std::size_t i = 0; i < v.size(); ++i)
    ASSERT_LT((Vector3d(velocities[i].x, velocities[i].y, velocities[i].z) - v[i]).norm(), 6e-4) << i;
}

TEST(MatchTiles, RestStaysRest) {
  const Model model(ppu::test::block(19, 21, 5), 2);
  TiledBody tiled(model, {}, {.spes = 2});
  Vectors rest;
  for (std::size_t i = 0; i < model.lattice.particles.size(); ++i)
    rest.push_back(model.lattice.rest_position(i).cast<double>());
  tiled.set(rest, Vectors(rest.size(), Vector3d::Zero()));
  for (int step = 0; step < 200; ++step) {
    tiled.spes.step({.pull = 60, .damping = 0.1f});
    for (std::size_t place = 0; place < tiled.plan.places(); ++place) {
      Vector& x = tiled.spes.positions()[place];
      const Vector& v = tiled.spes.velocities()[place];
      x = {x.x + v.x / 60, x.y + v.y / 60, x.z + v.z / 60, 0};
    }
  }
  for (const Vector& v : tiled.velocities()) {
    ASSERT_LT(std::abs(v.x), 2e-4);
    ASSERT_LT(std::abs(v.y), 2e-4);
    ASSERT_LT(std::abs(v.z), 2e-4);
  }
}

TEST(MatchTiles, ABodyThatIsNoNumberIsLeftAlone) {
  const Model model(ppu::test::block(6, 6, 2), 1);
  TiledBody tiled(model, {3, 2}, {.spes = 3}), untouched(model, {3, 2});
  const Vectors x = model.deformed(1, 0.02), v = random_velocities(x.size(), 2);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    for (const bool position : {true, false}) {
      for (const std::size_t which : {std::size_t{0}, x.size() / 2, x.size() - 1}) {
        Vectors bad_x = x, bad_v = v;
        (position ? bad_x : bad_v)[which].z() = bad;
        tiled.set(bad_x, bad_v);
        const std::vector<Vector> before = tiled.velocities();
        EXPECT_THROW(tiled.spes.step({.pull = 60, .damping = 0.1f}), std::runtime_error);
        EXPECT_EQ(first_difference(before, tiled.velocities()), -1);
      }
    }
  }
  // Rotations too: it goes on as one that has seen nothing of this.
  tiled.set(x, v);
  untouched.set(x, v);
  tiled.spes.step({.pull = 60, .damping = 0.1f});
  untouched.spes.step({.pull = 60, .damping = 0.1f});
  EXPECT_EQ(first_difference(tiled.velocities(), untouched.velocities()), -1);
}

TEST(MatchTiles, AStepTakesEachTileThroughFourPasses) {
  const Model model(ppu::test::block(95, 63, 4), 2);
  TiledBody tiled(model, {}, {.spes = 6});
  const Vectors x = model.deformed(1, 0.01);
  tiled.set(x, Vectors(x.size(), Vector3d::Zero()));
  for (int step = 0; step < 3; ++step) tiled.spes.step({.pull = 60, .damping = 0.1f});
  std::uint64_t jobs = 0;
  for (const ls_sim::SpeStatistics& spe : tiled.statistics()) jobs += spe.jobs;
  EXPECT_EQ(jobs, 3 * 4 * tiled.spes.tiles());
}

// A tile's first slices have no output, and without damping nothing to fetch either; nor have those of a
// ragged body that lie between.
TEST(MatchTiles, CheckedKernelsFindNothing) {
  constexpr std::size_t kMostParticles = 150;  // checks take their time
  for (const auto& [name, lattice] : ppu::test::all_lattices()) {
    if (lattice.particles.size() > kMostParticles) continue;
    SCOPED_TRACE(name);
    const Model model(lattice, 2);
    test::expect_no_findings([&](const ls_sim::SpeOptions& options) {
      TiledBody tiled(model, {2, 2}, options);
      stepped(model, tiled);
    });
  }
}

TEST(MatchTiles, TakesASliceThatFitsALocalStoreAndRefusesAHigherOne) {
  const auto plan_of = [](int rows) {
    const Model model(ppu::test::block(2, rows, 200), 4);
    return ppu::TilePlan(model.lattice, model.matching, {.planes = 0, .rows = 16});
  };
  EXPECT_NO_THROW(plan_of(2)) << "three rows of 201 particles are not many";
  try {
    plan_of(12);
    FAIL() << "13 rows of 201 particles fit";
  } catch (const ppu::BodyTooLarge& error) {
    EXPECT_NE(std::string(error.what()).find("bytes of local store"), std::string::npos) << error.what();
  }
}

TEST(MatchTiles, RefusesShapesAndSettingsOutOfRange) {
  const Model model(ppu::test::block(2, 2, 2), 1);
  EXPECT_THROW(ppu::TilePlan(model.lattice, model.matching, {.planes = -1, .rows = 0}),
               std::invalid_argument);
  TiledBody tiled(model);
  EXPECT_THROW(tiled.spes.step({.pull = -1, .damping = 0}), std::invalid_argument);
  EXPECT_THROW(tiled.spes.step({.pull = 1, .damping = 1.5f}), std::invalid_argument);
}

TEST(MatchTiles, RefusesAJobThatDoesNotFit) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop"),
                            image = test::kernel_image("match_tiles");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  dma::Buffer<Vector> positions(memory, "positions", 4, {.element_bytes = 4});
  dma::Buffer<spu::TiledBody> body(memory, "body", 1, {.record = ppu::kTiledBodyRecord});
  dma::Buffer<spu::TileJob> descriptor(memory, "job", 1, {.record = ppu::kTileJobRecord});
  descriptor[0].body_ea = body.ea().value;
  ppu::JobChain chain(system, "refused", 1);
  chain.add({system.load(image), descriptor.ea()});
  body[0] = {};
  body[0].positions_ea = positions.ea().value;
  chain.kick();
  chain.wait();
  EXPECT_TRUE(chain.failures().empty()) << "a job that fits is done: " << chain.failures()[0].message;
  for (const spu::TileLimits limits : {spu::TileLimits{0xFFFFFFFF, 0, 0, 0, 0},
                                       {0, 0x10000000, 0, 0, 0},
                                       {0, 0, 0x10000000, 0, 0},
                                       {0, 0, 0, 0xFFFFFFF0, 0},
                                       {0, 0, 0, 0, 0x05555556}}) {
    for (const bool up : {true, false}) {
      body[0] = {};
      body[0].positions_ea = positions.ea().value;
      (up ? body[0].up : body[0].down) = limits;
      chain.kick();
      chain.wait();
      ASSERT_EQ(chain.failures().size(), 1u);
      EXPECT_NE(chain.failures()[0].message.find("status 1"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace softcell
