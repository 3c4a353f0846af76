// The kernel match_2d on an SPE: bit for bit its scalar twin, close to the PPU's solver in double precision,
// and what must be true of any solver.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ppu/lattices.h"
#include "ppu/lattices_2d.h"
#include "ppu/matching/stiffness.h"
#include "ppu/particle_vectors.h"
#include "ppu/reference/shape_matching.h"
#include "ppu/spe_bodies/job_records.h"
#include "softcell/ls_sim/findings.h"
#include "spu_kernels/checked_runs.h"
#include "spu_kernels/kernel_image.h"
#include "spu_kernels/match_2d_twin.h"
#include "spu_kernels/stepped_bodies.h"
#include "support/slow_build.h"

namespace softcell {
namespace {

using Eigen::Vector2d;
using ppu::Lattice;
using ppu::test::energy;
using ppu::test::largest_difference;
using ppu::test::momentum;
using ppu::test::Random;
using ppu::test::total_mass;
using Settings = ppu::MatchSettings;
using Vectors = std::vector<Vector2d>;

constexpr Settings kOnlyGoals{.pull = 1, .damping = 0};  // with velocities of zero: dv = g - x

Vector2d random_vector(Random& random) {
  const double x = random.next(), y = random.next();
  return {x, y};
}

/// A multiple of 2^-20, which a float holds exactly up to 16. (Not by way of float and back: g++ 12 leaves
/// both conversions of a pair out, -O2 -fsanitize=thread.)
Vector2d rounded(const Vector2d& v) { return (v * 0x1p20).array().round() * 0x1p-20; }

spu::MatchVector2d of(const Vector2d& v) { return {static_cast<float>(v.x()), static_cast<float>(v.y())}; }

/// Bodies of one model on SPEs.
class MatchRig2d {
 public:
  MatchRig2d(Lattice<2> body, int half_width, const ls_sim::SpeOptions& options = {.spes = 1},
             std::size_t bodies = 1, std::size_t bodies_per_job = 1)
      : lattice(std::move(body)),
        masses(uneven_masses(lattice)),
        plan(lattice, half_width, masses),
        match_plan(lattice, plan),
        image_(test::kernel_image("match_2d", options.findings != nullptr)),
        jobs_(memory_, options, job_loop_),
        spes(memory_, jobs_, image_, match_plan, bodies, bodies_per_job) {
    set(rest(), Vectors(masses.size(), Vector2d::Zero()));
    for (const Vector2d& a : rest()) size = std::max(size, (a - rest()[0]).norm());
  }

  Vectors rest() const {
    Vectors x;
    for (std::size_t i = 0; i < masses.size(); ++i) x.push_back(lattice.rest_position(i).cast<double>());
    return x;
  }

  void set(const Vectors& x, const Vectors& v, std::size_t body = 0) {
    std::ranges::transform(x, spes.positions(body).begin(), of);
    std::ranges::transform(v, spes.velocities(body).begin(), of);
  }
  Vectors positions() { return from(spes.positions(0)); }
  Vectors velocities() { return from(spes.velocities(0)); }

  void step(const Settings& settings) { spes.step(settings); }

  /// g - x by the kernel.
  Vectors pulls(const Vectors& x, const Settings& settings = kOnlyGoals) {
    set(x, Vectors(x.size(), Vector2d::Zero()));
    step(settings);
    return velocities();
  }

  /// What the engine does after the solver.
  void advance(float h) {
    for (std::size_t i = 0; i < masses.size(); ++i) {
      auto& x = spes.positions(0)[i];
      const auto& v = spes.velocities(0)[i];
      x = {x.x + h * v.x, x.y + h * v.y};
    }
  }

  double angular_momentum(const Vectors& x, const Vectors& v) const {
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vector2d r = x[i] - x[0];
      sum += double{masses[i]} * (r.x() * v[i].y() - r.y() * v[i].x());
    }
    return sum;
  }

  Lattice<2> lattice;
  std::vector<float> masses;
  ppu::MatchingPlan<float, 2> plan;
  ppu::MatchPlan2d match_plan;
  double size = 0;  ///< metres

 private:
  static std::vector<float> uneven_masses(const Lattice<2>& lattice) {
    std::vector<float> masses = ppu::particle_masses(lattice, 1000);
    for (std::size_t i = 0; i < masses.size(); ++i) masses[i] *= 1 + 0.25f * static_cast<float>(i % 3);
    return masses;
  }
  static Vectors from(std::span<const spu::MatchVector2d> vectors) {
    Vectors result;
    for (const auto& v : vectors) result.emplace_back(v.x, v.y);
    return result;
  }

  dma::AddressSpace memory_;
  ls_sim::KernelImage image_, job_loop_ = test::kernel_image("job_loop");
  ppu::JobSystem jobs_;

 public:
  test::SteppedBodies<2> spes;
};

/// Turned, bent, and shaken by up to `noise` metres; exactly as floats hold it.
Vectors deformed(const MatchRig2d& rig, std::uint64_t seed, double noise) {
  Random random(seed);
  const Eigen::Rotation2Dd turn(3 * random.next());
  const Vector2d shift = 3 * random_vector(random);
  Vectors x;
  for (Vector2d p : rig.rest()) {
    p.x() += 0.3 * p.y() * p.y() / rig.size;
    p = turn * p + shift + noise * random_vector(random);
    x.push_back(rounded(p));
  }
  return x;
}

Vectors random_velocities(const MatchRig2d& rig, std::uint64_t seed, double fastest) {
  Random random(seed);
  Vectors v;
  for (std::size_t i = 0; i < rig.masses.size(); ++i) v.push_back(rounded(random_vector(random) * fastest));
  return v;
}

ppu::ShapeMatcher<double, 2> reference(const MatchRig2d& rig, int half_width) {
  return ppu::ShapeMatcher<double, 2>(
      std::make_shared<const ppu::MatchingPlan<double, 2>>(rig.lattice, half_width, rig.masses));
}

/// Runs a check on every lattice with every half-width.
template <typename Check>
void for_all_bodies(const Check& check) {
  ppu::test::for_every_half_width(ppu::test::all_lattices_2d(), 0, [&](const Lattice<2>& lattice, int w) {
    MatchRig2d rig(lattice, w);
    check(rig, w);
  });
}

Vectors zero(std::size_t count) { return Vectors(count, Vector2d::Zero()); }

// Metres, or metres^2, per kilogram of body: bodies are about a metre long.
constexpr double kMomentum = 1e-5;
constexpr double kRigid = 3e-6;  // metres

TEST(Match2d, IsItsScalarTwinBitForBit) {
  for_all_bodies([](MatchRig2d& rig, int w) {
    const Vectors start = deformed(rig, 1, 0.05), v0 = random_velocities(rig, 2, 1);
    rig.set(start, v0);
    test::Match2dTwin twin(rig.match_plan);
    for (int step = 0; step < 5; ++step) {
      const std::vector<spu::MatchVector2d> x(rig.spes.positions(0).begin(), rig.spes.positions(0).end());
      std::vector<spu::MatchVector2d> v(rig.spes.velocities(0).begin(), rig.spes.velocities(0).end());
      const Settings settings{.pull = 20, .damping = step == 3 ? 0 : 0.1f * static_cast<float>(w + 1)};
      twin.step(x, v, settings.pull, settings.damping);
      rig.step(settings);
      ASSERT_EQ(std::memcmp(v.data(), rig.spes.velocities(0).data(), v.size() * sizeof v[0]), 0)
          << "step " << step;
      ASSERT_EQ(std::memcmp(x.data(), rig.spes.positions(0).data(), x.size() * sizeof x[0]), 0);
      for (std::size_t r = 0; r < twin.directions.size(); ++r) {
        const auto& group = std::as_const(rig.spes).rotations(0)[r / 4];
        ASSERT_EQ(std::bit_cast<std::uint32_t>(group.cosine[r % 4]),
                  std::bit_cast<std::uint32_t>(twin.directions[r].x));
        ASSERT_EQ(std::bit_cast<std::uint32_t>(group.sine[r % 4]),
                  std::bit_cast<std::uint32_t>(twin.directions[r].y));
      }
      rig.advance(1.0f / 60);
    }
  });
}

TEST(Match2d, GoalsAgreeWithTheReferenceOnEveryLattice) {
  for_all_bodies([](MatchRig2d& rig, int w) {
    const Vectors x = deformed(rig, 17, 0.02), pulls = rig.pulls(x);
    Vectors expected(x.size());
    reference(rig, w).goals(x, expected);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_LT((pulls[i] - (expected[i] - x[i])).norm(), 1e-5 * rig.size) << "particle " << i;
  });
}

TEST(Match2d, GoalsOfTheLargestBodyAgreeWithTheReference) {
  for (int w = 1; w <= 4; ++w) {
    MatchRig2d rig(ppu::test::rectangle(35, 35), w);  // 1296 particles
    const Vectors x = deformed(rig, 12, 0.02), pulls = rig.pulls(x);
    Vectors expected(x.size());
    reference(rig, w).goals(x, expected);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_LT((pulls[i] - (expected[i] - x[i])).norm(), 1e-5 * rig.size) << "w " << w << ", particle " << i;
  }
}

TEST(Match2d, DampingAgreesWithTheReference) {
  for_all_bodies([](MatchRig2d& rig, int w) {
    const Vectors x = deformed(rig, 7, 0.02);
    Vectors v = random_velocities(rig, 8, 1);
    rig.set(x, v);
    rig.step({.pull = 15, .damping = 0.3f});
    reference(rig, w).step_velocities(x, v, 0.25, 1.0 / 60, double{0.3f});
    EXPECT_LT(largest_difference(rig.velocities(), v), 1e-4);  // m/s; a pull of 1e-5 of the body is 1.5e-4
  });
}

TEST(Match2d, KeepsLinearAndAngularMomentum) {
  for_all_bodies([](MatchRig2d& rig, int w) {
    const Vectors x = deformed(rig, 3, 0.04), pulls = rig.pulls(x);
    EXPECT_LT(momentum(rig.masses, pulls).norm() / total_mass(rig.masses), kMomentum);
    EXPECT_LT(std::abs(rig.angular_momentum(x, pulls)) / total_mass(rig.masses), kMomentum);
    // There was something to do; regions of one particle have nothing to do.
    if (w > 0) {
      EXPECT_GT(largest_difference(pulls, zero(x.size())), 1e-3);
    } else {
      EXPECT_LT(largest_difference(pulls, zero(x.size())), kRigid);
    }
  });
}

TEST(Match2d, DampingKeepsMomentaAndAddsNoEnergy) {
  for_all_bodies([](MatchRig2d& rig, int w) {
    const Vectors x = deformed(rig, 5, 0.02), v = random_velocities(rig, 6, 1);
    for (const float k : {0.1f, 1.0f}) {
      rig.set(x, v);
      rig.step({.pull = 0, .damping = k});
      Vectors change = rig.velocities();
      if (w > 0) {
        EXPECT_LT(energy(rig.masses, change), energy(rig.masses, v));
      }
      for (std::size_t i = 0; i < v.size(); ++i) change[i] -= v[i];
      EXPECT_LT(momentum(rig.masses, change).norm() / total_mass(rig.masses), kMomentum);
      EXPECT_LT(std::abs(rig.angular_momentum(x, change)) / total_mass(rig.masses), kMomentum);
    }
    rig.set(x, v);
    rig.step({.pull = 0, .damping = 0});
    EXPECT_EQ(largest_difference(rig.velocities(), v), 0);
  });
}

TEST(Match2d, LeavesRigidMotionAlone) {
  for_all_bodies([](MatchRig2d& rig, int) {
    const Eigen::Rotation2Dd turn(2.3);
    const double omega = 1.5;
    Vectors x, v;
    for (const Vector2d& p : rig.rest()) {
      x.push_back(turn * p + Vector2d(0.2, 0.4));
      v.push_back(Vector2d(0.3, -0.5) + omega * Vector2d(-x.back().y(), x.back().x()));
    }
    EXPECT_LT(largest_difference(rig.pulls(x), zero(x.size())), kRigid * std::max(1.0, rig.size));
    rig.set(x, v);
    rig.step({.pull = 0, .damping = 1});
    EXPECT_LT(largest_difference(rig.velocities(), v), 2e-5 * std::max(1.0, rig.size));
  });
}

TEST(Match2d, RestStaysRest) {
  constexpr int kSteps = 1000;
  for (const auto& [name, lattice] : ppu::test::all_lattices_2d()) {
    for (int w = 1; w <= 4; ++w) {
      SCOPED_TRACE(name + ", w = " + std::to_string(w));
      MatchRig2d rig(lattice, w);
      // Truncation shortens coordinates about the body's origin: what is connected is under a pressure of one
      // part in 10^7, parts that are not come together.
      const double allowed = name == "disconnected" ? 8e-6 * kSteps : 2e-4 * std::max(1.0, rig.size);  // m/s
      for (int step = 0; step < kSteps; ++step) {
        rig.step({.pull = 60, .damping = 0.1f});
        rig.advance(1.0f / 60);
      }
      EXPECT_LT(largest_difference(rig.velocities(), zero(rig.masses.size())), allowed);
      EXPECT_LT(largest_difference(rig.positions(), rig.rest()), 10 * allowed);
    }
  }
}

TEST(Match2d, WorksFarFromTheOriginOfTheWorld) {
  MatchRig2d rig(ppu::test::rectangle(6, 5), 2);
  Vectors near = deformed(rig, 11, 0.02), far;
  for (Vector2d& p : near) {
    p = (p * 1024).array().round() / 1024;  // exact in both places
    far.push_back(p + Vector2d(4096, -2048));
  }
  EXPECT_LT(largest_difference(rig.pulls(near), rig.pulls(far)), kRigid);
}

TEST(Match2d, FlatAndInvertedBodiesGetFiniteGoals) {
  for_all_bodies([](MatchRig2d& rig, int) {
    for (const Vector2d& stretch : {Vector2d(1, 0), Vector2d(0, 1), Vector2d(0, 0), Vector2d(-1, 1),
                                    Vector2d(1e-6, 1), Vector2d(-0.2, 0.5)}) {
      Vectors x;
      for (const Vector2d& p : rig.rest()) x.push_back(stretch.cwiseProduct(p) + Vector2d(1, 2));
      for (int step = 0; step < 3; ++step) {
        const Vectors pulls = rig.pulls(x, {.pull = 1, .damping = 0.1f});
        for (const Vector2d& pull : pulls) ASSERT_LT(pull.norm(), 3 * rig.size) << stretch.transpose();
      }
    }
  });
}

TEST(Match2d, PartsThatDoNotTouchNeverInfluenceEachOther) {
  MatchRig2d rig(ppu::test::lattice_of_rows({"##..###", "##..###"}), 4);
  Vectors x = deformed(rig, 8, 0.02);
  // Momentum is held for the body as a whole, so what is compared is the pull before that: both parts keep
  // theirs.
  const Vectors before = rig.pulls(x);
  x.back() += Vector2d(0.03, -0.02);
  const Vectors after = rig.pulls(x);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_LT((before[i] - after[i]).norm(), kRigid) << i;
  EXPECT_GT((before.back() - after.back()).norm(), 1e-3);
}

TEST(Match2d, ABodyThatIsNoNumberIsNamedAndLeftAloneAndTheOthersAreNot) {
  MatchRig2d rig(ppu::test::rectangle(2, 2), 1, {.spes = 1}, 3, 3);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    for (const bool position : {true, false}) {
      const Vectors good = deformed(rig, 9, 0.03);
      Vectors x = rig.rest(), v(x.size(), Vector2d(1, 2));
      (position ? x : v)[8].y() = bad;  // the last one of an odd number
      rig.set(good, zero(x.size()), 0);
      rig.set(x, v, 1);
      rig.set(good, zero(x.size()), 2);
      try {
        rig.step({.pull = 60, .damping = 0.1f});
        FAIL() << "went unnoticed";
      } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("not finite: body 1"), std::string::npos) << error.what();
      }
      EXPECT_EQ(rig.spes.velocities(1)[4].x, 1);
      EXPECT_EQ(rig.spes.velocities(1)[4].y, 2);
      for (const std::size_t body : {0u, 2u}) EXPECT_NE(rig.spes.velocities(body)[0].x, 0);
    }
  }
}

TEST(Match2d, RefusesAJobWhosePlanDoesNotFit) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop"), image = test::kernel_image("match_2d");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  dma::Buffer<spu::MatchPlanHeader2d> plans(memory, "plans", 4, {.element_bytes = 4});
  for (spu::MatchPlanHeader2d& plan : plans.span()) {
    plan.bytes = 128;
    plan.particles = plan.regions = 1;
    plan.slots = 2;
  }
  plans[0].bytes = spu::kMatch2dArenaBytes;
  plans[1].particles = 0xFFFFFFFF;
  plans[2].regions = 0x10000000;
  plans[3].slots = 0x08000000;  // whose bytes, as 32 bits, are none
  for (std::size_t i = 0; i < 4; ++i) {
    dma::Buffer<spu::MatchJob2d> job(memory, "job", 1, {.record = ppu::kMatchJob2dRecord});
    job[0].plan_ea = plans.ea(i).value;
    job[0].body_count = 1;
    ppu::JobChain chain(system, "refused", 1);
    chain.add({system.load(image), job.ea()});
    chain.kick();
    chain.wait();
    ASSERT_EQ(chain.failures().size(), 1u);
    EXPECT_NE(chain.failures()[0].message.find("status 1"), std::string::npos) << chain.failures()[0].message;
  }
}

TEST(Match2d, AnEmptyJobIsDone) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop"), image = test::kernel_image("match_2d");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  const dma::Buffer<spu::MatchJob2d> job(memory, "job", 1, {.record = ppu::kMatchJob2dRecord});
  ppu::JobChain chain(system, "empty", 1);
  chain.add({system.load(image), job.ea()});
  chain.kick();
  chain.wait();
  EXPECT_TRUE(chain.failures().empty());
}

TEST(Match2d, SettingsOutOfRangeAreNamed) {
  MatchRig2d rig(ppu::test::rectangle(2, 2), 1);
  EXPECT_THROW(rig.step({.pull = -1, .damping = 0}), std::invalid_argument);
  EXPECT_THROW(rig.step({.pull = std::nanf(""), .damping = 0}), std::invalid_argument);
  EXPECT_THROW(rig.step({.pull = 1, .damping = 1.5f}), std::invalid_argument);
}

/// Velocities of seven bodies after three steps.
std::vector<spu::MatchVector2d> seven_bodies(const ls_sim::SpeOptions& options) {
  MatchRig2d rig(ppu::test::lattice_of_rows({"####..", "#..#..", "######"}), 2, options, 7, 3);
  for (std::size_t b = 0; b < 7; ++b) rig.set(deformed(rig, 20 + b, 0.03), zero(rig.masses.size()), b);
  for (int step = 0; step < 3; ++step) rig.step({.pull = 30, .damping = 0.2f});
  std::vector<spu::MatchVector2d> all;
  for (std::size_t b = 0; b < 7; ++b)
    all.insert(all.end(), rig.spes.velocities(b).begin(), rig.spes.velocities(b).end());
  return all;
}

/// With one SPE, jobs run on what the jobs before have left in the local store; with six, each SPE begins with a fresh one.
TEST(Match2d, GivesTheSameBytesOnAnySpesUnderEverySchedule) {
  const std::vector<spu::MatchVector2d> expected = seven_bodies({.spes = 1});
  for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
    for (const int spes : {1, 3, 6}) {
      std::vector<spu::MatchVector2d> all;
      ASSERT_NO_THROW(all = seven_bodies({.spes = spes, .schedule = dma::parse_schedule(schedule)}))
          << schedule << ", " << spes << " SPEs" << test::kDependsOnTheSchedule;
      ASSERT_EQ(std::memcmp(expected.data(), all.data(), all.size() * sizeof all[0]), 0)
          << schedule << ", " << spes << " SPEs" << test::kDependsOnTheSchedule;
    }
  }
}

TEST(Match2d, ItsCheckedImageFindsNothingAndGivesTheSameBytes) {
  const std::vector<spu::MatchVector2d> expected = seven_bodies({.spes = 1});
  test::expect_no_findings([&](const ls_sim::SpeOptions& options) {
    const std::vector<spu::MatchVector2d> all = seven_bodies(options);
    EXPECT_EQ(std::memcmp(expected.data(), all.data(), all.size() * sizeof all[0]), 0);
  });
}

/// What lies between the bodies of a step is left alone, and changes nothing.
TEST(Match2d, StepsSomeOfTheBodies) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop"), image = test::kernel_image("match_2d");
  ppu::JobSystem system(memory, {.spes = 2}, job_loop);
  MatchRig2d man(ppu::test::man132(), 2);
  const Vectors x = deformed(man, 50, 0.03);
  ppu::MatchBodies<2> bodies(memory, man.match_plan, 7);
  for (std::size_t b = 0; b < bodies.size(); ++b) std::ranges::transform(x, bodies.positions(b).begin(), of);
  const std::vector<std::size_t> stepped{0, 2, 3, 4, 6};
  const Settings settings{.pull = 30, .damping = 0.1f};
  ppu::JobChain chain(system, "some bodies", bodies.size());
  bodies.add_jobs(chain, system.load(image), settings, stepped, 2);
  EXPECT_EQ(chain.size(), 4u);  // 0, 2 and 3, 4, 6
  test::run(chain);
  EXPECT_TRUE(bodies.take_results().empty());
  man.pulls(x, settings);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const bool was_stepped = std::ranges::count(stepped, b) != 0;
    EXPECT_EQ(std::memcmp(man.spes.velocities(0).data(), bodies.velocities(b).data(),
                          x.size() * sizeof(spu::MatchVector2d)) == 0,
              was_stepped)
        << b;
    if (!was_stepped) {
      EXPECT_EQ(bodies.velocities(b)[0].x, 0) << b;
    }
  }
}

TEST(Match2d, GivesTheSameBitsWithEveryCompiler) {
  MatchRig2d rig(ppu::test::man132(), 2);
  rig.set(deformed(rig, 30, 0.03), zero(rig.masses.size()));
  for (int step = 0; step < 20; ++step) {
    rig.step({.pull = 30, .damping = 0.1f});
    rig.advance(1.0f / 60);
  }
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const spu::MatchVector2d& v : rig.spes.velocities(0)) {
    for (const float component : {v.x, v.y})
      hash = (hash ^ std::bit_cast<std::uint32_t>(component)) * 0x100000001b3u;
  }
  EXPECT_EQ(hash, 12873996594615942521u)
      << "the kernel computes something else than it did, or in another mode: if "
         "SpeGroupTest.AKernelRoundsAndFlushesAsAnSpuDoes fails, too, look there first";
}

TEST(Match2d, StiffnessOfABarPulledAtItsEndsIsTheFormula) {
  constexpr float kStep = 1.0f / 60;
  constexpr int kCells = 40;
  for (int w = 1; w <= 3; ++w) {
    MatchRig2d bar(ppu::test::rectangle(kCells, 1), w);
    const double s = double{bar.lattice.spacing};
    const auto at = [&](std::size_t i) { return bar.lattice.particles[i].x(); };
    double line_density = total_mass(bar.masses) / (kCells * s);
    // Stretches by 1 %.
    const double force = 0.01 * line_density * ppu::specific_modulus(s, double{kStep}, 1, w);
    for (int step = 0; step < 6000; ++step) {
      bar.step({.pull = 1 / kStep, .damping = 0});
      for (std::size_t i = 0; i < bar.masses.size(); ++i) {
        auto& v = bar.spes.velocities(0)[i];
        const double share = at(i) == 0 ? -1 : at(i) == kCells ? 1 : 0;
        v.x += static_cast<float>(share * double{kStep} * force / 2 / double{bar.masses[i]});
        v = {v.x * 0.95f, v.y * 0.95f};  // the air, so that it comes to rest
      }
      bar.advance(kStep);
    }
    constexpr int kFrom = 10, kTo = 30;  // away from the ends, which the regions cut
    double from = 0, to = 0;
    const Vectors x = bar.positions();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (at(i) == kFrom) from += x[i].x() / 2;
      if (at(i) == kTo) to += x[i].x() / 2;
    }
    EXPECT_NEAR(0.01 / ((to - from) / ((kTo - kFrom) * s) - 1), 1, 0.05) << "w " << w;
  }
}

TEST(Match2d, EnergyStaysBoundedWithoutDamping) {
  for (const double h : {1.0 / 240, 1.0 / 60, 0.1}) {
    for (const int w : {1, 2}) {
      for (const double alpha : {0.25, 1.0}) {
        MatchRig2d rig(ppu::test::rectangle(5, 4), w);
        const Vectors v = random_velocities(rig, 40, 0.1 / 5 / h / std::sqrt(2.0));  // |v| h <= s / 5
        rig.set(rig.rest(), v);
        const double before = energy(rig.masses, v);
        double most = 0;
        for (int step = 0; step < (kSlowBuild ? 500 : 10000); ++step) {
          rig.step({.pull = static_cast<float>(alpha / h), .damping = 0});
          rig.advance(static_cast<float>(h));
          if (step % 10 == 0) most = std::max(most, energy(rig.masses, rig.velocities()));
        }
        EXPECT_LT(most, 1.1 * before) << "h " << h << " w " << w << " alpha " << alpha;
      }
    }
  }
}

}  // namespace
}  // namespace softcell
