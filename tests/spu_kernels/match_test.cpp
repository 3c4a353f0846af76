// The kernel match on an SPE against the PPU's solver in double precision, and against what must be true of
// any solver.

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
#include <vector>

#include "ppu/lattices.h"
#include "ppu/matching/stiffness.h"
#include "ppu/particle_vectors.h"
#include "ppu/reference/shape_matching.h"
#include "ppu/spe_bodies/job_records.h"
#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/shapes.h"
#include "spu_kernels/checked_runs.h"
#include "spu_kernels/kernel_image.h"
#include "spu_kernels/stepped_bodies.h"
#include "support/slow_build.h"

namespace softcell {
namespace {

using Eigen::Vector3d;
using ppu::Lattice;
using ppu::MatchSettings;
using ppu::test::energy;
using ppu::test::largest_difference;
using ppu::test::momentum;
using ppu::test::Random;
using ppu::test::total_mass;
using Vectors = std::vector<Vector3d>;

/// A multiple of 2^-20, which a float holds exactly up to 16.
Vector3d rounded(const Vector3d& v) { return (v * 0x1p20).array().round() * 0x1p-20; }

constexpr MatchSettings kOnlyGoals{.pull = 1, .damping = 0};  // with velocities of zero: dv = g - x

/// One body on an SPE.
class MatchRig {
 public:
  MatchRig(Lattice<3> body, int half_width, const ls_sim::SpeOptions& options = {.spes = 1},
           std::size_t bodies = 1, std::size_t bodies_per_job = 1)
      : lattice(std::move(body)),
        masses(ppu::particle_masses(lattice, 1000)),
        plan(lattice, half_width, masses),
        match_plan(lattice, plan),
        image_(test::kernel_image("match", options.findings != nullptr)),
        jobs_(memory_, options, job_loop_),
        spes(memory_, jobs_, image_, match_plan, bodies, bodies_per_job) {
    set(rest(), Vectors(lattice.particles.size(), Vector3d::Zero()));
    double largest = 0;
    for (const Vector3d& a : rest()) largest = std::max(largest, (a - rest()[0]).norm());
    size = largest;
  }

  Vectors rest() const {
    Vectors x;
    for (std::size_t i = 0; i < lattice.particles.size(); ++i)
      x.push_back(lattice.rest_position(i).cast<double>());
    return x;
  }

  void set(const Vectors& x, const Vectors& v) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      spes.positions(0)[i] = of(x[i]);
      spes.velocities(0)[i] = of(v[i]);
    }
  }
  Vectors positions() { return from(spes.positions(0)); }
  Vectors velocities() { return from(spes.velocities(0)); }

  /// g - x by the kernel.
  Vectors pulls(const Vectors& x, MatchSettings settings = kOnlyGoals) {
    set(x, Vectors(x.size(), Vector3d::Zero()));
    spes.step(settings);
    return velocities();
  }

  /// What the engine does after the solver.
  void advance(double h) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      auto& x = spes.positions(0)[i];
      const auto& v = spes.velocities(0)[i];
      x.x += static_cast<float>(h) * v.x;
      x.y += static_cast<float>(h) * v.y;
      x.z += static_cast<float>(h) * v.z;
    }
  }

  Vector3d angular_momentum(const Vectors& x, const Vectors& v) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < v.size(); ++i) sum += double{masses[i]} * (x[i] - x[0]).cross(v[i]);
    return sum;
  }
  static spu::SkinCorner of(const Vector3d& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
  }

  Lattice<3> lattice;
  std::vector<float> masses;
  ppu::MatchingPlan<float, 3> plan;
  ppu::MatchPlan match_plan;
  double size = 0;

 private:
  static Vectors from(std::span<const spu::SkinCorner> vectors) {
    Vectors result;
    for (const auto& v : vectors) result.emplace_back(v.x, v.y, v.z);
    return result;
  }

  dma::AddressSpace memory_;
  ls_sim::KernelImage image_, job_loop_ = test::kernel_image("job_loop");
  ppu::JobSystem jobs_;

 public:
  test::SteppedBodies<3> spes;
};

/// Turned, bent, and shaken by up to `noise` metres; exactly as floats hold it.
Vectors deformed(const MatchRig& rig, std::uint64_t seed, double noise) {
  Random random(seed);
  const Eigen::Quaterniond turn = random.rotation();
  const Vector3d shift = 3 * random.vector();
  Vectors x;
  for (Vector3d p : rig.rest()) {
    p.x() += 0.3 * p.y() * p.y() / rig.size;
    p = turn * p + shift + noise * random.vector();
    x.push_back(rounded(p));
  }
  return x;
}

Vectors reference_goals(const MatchRig& rig, int half_width, const Vectors& x) {
  const auto plan = std::make_shared<const ppu::MatchingPlan<double, 3>>(rig.lattice, half_width, rig.masses);
  ppu::ShapeMatcher<double, 3> matcher(plan);
  Vectors g(x.size());
  matcher.goals(x, g);
  return g;
}

TEST(Match, GoalsAgreeWithTheReferenceOnEveryLattice) {
  for (const auto& [name, lattice] : ppu::test::all_lattices()) {
    for (int w = 1; w <= 4; ++w) {
      MatchRig rig(lattice, w);
      const Vectors x = deformed(rig, 17, 0.02);
      const Vectors expected = reference_goals(rig, w, x), pulls = rig.pulls(x);
      for (std::size_t i = 0; i < x.size(); ++i)
        ASSERT_LT((pulls[i] - (expected[i] - x[i])).norm(), 1e-5 * rig.size)
            << name << ", w = " << w << ", particle " << i << ", residual " << rig.spes.residual(0);
    }
  }
}

/// Runs a check on every lattice with every half-width.
template <typename Check>
void for_all_bodies(const Check& check) {
  ppu::test::for_every_half_width(ppu::test::all_lattices(), 1, [&](const Lattice<3>& lattice, int w) {
    MatchRig rig(lattice, w);
    check(rig, w);
  });
}

Vectors zero(std::size_t count) { return Vectors(count, Vector3d::Zero()); }

// Metres, or metres^2, per kilogram of body: bodies are about a metre long.
constexpr double kMomentum = 1e-5;
constexpr double kRigid = 3e-6;  // metres

TEST(Match, KeepsLinearAndAngularMomentum) {
  for_all_bodies([](MatchRig& rig, int) {
    const Vectors x = deformed(rig, 3, 0.04), pulls = rig.pulls(x);
    EXPECT_LT(momentum(rig.masses, pulls).norm() / total_mass(rig.masses), kMomentum);
    EXPECT_LT(rig.angular_momentum(x, pulls).norm() / total_mass(rig.masses), kMomentum);
    EXPECT_GT(largest_difference(pulls, zero(x.size())), 1e-3);  // there was something to do
  });
}

TEST(Match, DampingKeepsMomentaAndAddsNoEnergy) {
  for_all_bodies([](MatchRig& rig, int) {
    const Vectors x = deformed(rig, 5, 0.02);
    Random random(6);
    Vectors v;
    for (std::size_t i = 0; i < x.size(); ++i) v.push_back(rounded(random.vector()));
    for (const float k : {0.1f, 1.0f}) {
      rig.set(x, v);
      rig.spes.step({.pull = 0, .damping = k});
      Vectors change = rig.velocities();
      EXPECT_LT(energy(rig.masses, change), energy(rig.masses, v));
      for (std::size_t i = 0; i < v.size(); ++i) change[i] -= v[i];
      EXPECT_LT(momentum(rig.masses, change).norm() / total_mass(rig.masses), kMomentum);
      EXPECT_LT(rig.angular_momentum(x, change).norm() / total_mass(rig.masses), kMomentum);
    }
    rig.set(x, v);
    rig.spes.step({.pull = 0, .damping = 0});
    EXPECT_EQ(largest_difference(rig.velocities(), v), 0);
  });
}

TEST(Match, DampingAgreesWithTheReference) {
  for_all_bodies([](MatchRig& rig, int w) {
    const Vectors x = deformed(rig, 7, 0.02);
    Random random(8);
    Vectors v;
    for (std::size_t i = 0; i < x.size(); ++i) v.push_back(rounded(random.vector()));
    rig.set(x, v);
    rig.spes.step({.pull = 15, .damping = 0.3f});
    const auto plan = std::make_shared<const ppu::MatchingPlan<double, 3>>(rig.lattice, w, rig.masses);
    ppu::ShapeMatcher<double, 3> matcher(plan);
    matcher.step_velocities(x, v, 0.25, 1.0 / 60, double{0.3f});
    EXPECT_LT(largest_difference(rig.velocities(), v), 1e-4);  // m/s; a pull of 1e-5 of the body is 1.5e-4
  });
}

TEST(Match, LeavesRigidMotionAlone) {
  for_all_bodies([](MatchRig& rig, int) {
    const Eigen::Quaterniond turn = Random(9).rotation();
    const Vector3d velocity(0.3, -0.5, 0.2), omega(1, 2, -0.5);
    Vectors x, v;
    for (const Vector3d& p : rig.rest()) {
      x.push_back(turn * p + Vector3d(0.2, 0.4, -0.3));
      v.push_back(velocity + omega.cross(x.back()));
    }
    EXPECT_LT(largest_difference(rig.pulls(x), zero(x.size())), kRigid);
    rig.set(x, v);
    rig.spes.step({.pull = 0, .damping = 1});
    EXPECT_LT(largest_difference(rig.velocities(), v), 2e-5);
  });
}

TEST(Match, RestStaysRest) {
  constexpr int kSteps = 1000;
  for (const auto& [name, lattice] : ppu::test::all_lattices()) {
    // Truncation shortens coordinates about the body's origin: what is connected is under a pressure of one
    // part in 10^7, parts that are not come together.
    const double allowed = name == "disconnected" ? 5e-6 * kSteps : 2e-4;  // m/s
    for (int w = 1; w <= 4; ++w) {
      SCOPED_TRACE(name + ", w = " + std::to_string(w));
      MatchRig rig(lattice, w);
      for (int step = 0; step < kSteps; ++step) {
        rig.spes.step({.pull = 60, .damping = 0.1f});
        rig.advance(1.0 / 60);
      }
      EXPECT_LT(largest_difference(rig.velocities(), zero(rig.masses.size())), allowed);
      EXPECT_LT(momentum(rig.masses, rig.velocities()).norm() / total_mass(rig.masses), 3e-8)
          << "m/s: it drifts";
      EXPECT_LT(largest_difference(rig.positions(), rig.rest()), 10 * allowed);
    }
  }
}

TEST(Match, WorksFarFromTheOriginOfTheWorld) {
  MatchRig rig(ppu::test::block(6, 5, 4), 2);
  Vectors near = deformed(rig, 11, 0.02), far;
  for (Vector3d& p : near) {
    p = (p * 1024).array().round() / 1024;  // exact in both places
    far.push_back(p + Vector3d(4096, -2048, 512));
  }
  EXPECT_LT(largest_difference(rig.pulls(near), rig.pulls(far)), kRigid);
}

TEST(Match, FlatAndInvertedBodiesGetFiniteGoals) {
  for_all_bodies([](MatchRig& rig, int) {
    for (const Vector3d& stretch : {Vector3d(1, 1, 0), Vector3d(1, 0, 0), Vector3d(0, 0, 0),
                                    Vector3d(-1, 1, 1), Vector3d(1e-6, 1, 1), Vector3d(-0.2, 0.5, 1)}) {
      Vectors x;
      for (const Vector3d& p : rig.rest()) x.push_back(stretch.cwiseProduct(p) + Vector3d(1, 2, 3));
      for (int step = 0; step < 3; ++step) {
        const Vectors pulls = rig.pulls(x, {.pull = 1, .damping = 0.1f});
        for (const Vector3d& pull : pulls) ASSERT_LT(pull.norm(), 3 * rig.size) << stretch.transpose();
      }
    }
  });
}

TEST(Match, ABodyThatIsNoNumberIsNamedAndLeftAlone) {
  MatchRig rig(ppu::test::block(2, 2, 2), 1);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    for (const bool position : {true, false}) {
      Vectors x = rig.rest(), v(x.size(), Vector3d(1, 2, 3));
      (position ? x : v)[5].y() = bad;
      rig.set(x, v);
      try {
        rig.spes.step({.pull = 60, .damping = 0.1f});
        FAIL() << "went unnoticed";
      } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("not finite: body 0"), std::string::npos) << error.what();
      }
      EXPECT_EQ(rig.velocities()[4], Vector3d(1, 2, 3));
    }
  }
}

TEST(Match, RefusesABodyThatDoesNotFit) {
  const Lattice<3> lattice = ppu::test::block(11, 10, 10);  // 1452 particles
  const ppu::MatchingPlan<float, 3> plan(lattice, 2, ppu::particle_masses(lattice, 1000));
  try {
    const ppu::MatchPlan match_plan(lattice, plan);
    FAIL() << "fits";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("1452 particles"), std::string::npos) << error.what();
  }
}

TEST(Match, RefusesAJobWhosePlanDoesNotFit) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop"), image = test::kernel_image("match");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  dma::Buffer<spu::MatchPlanHeader> plans(memory, "plans", 4, {.element_bytes = 4});
  for (spu::MatchPlanHeader& plan : plans.span()) {
    plan.bytes = 128;
    plan.particles = plan.regions = 1;
    plan.slots = 2;
  }
  plans[0].bytes = spu::kMatchArenaBytes;
  plans[1].particles = 0xFFFFFFFF;
  plans[2].regions = 0x10000000;
  plans[3].slots = 0x05555556;  // whose bytes, as 32 bits, are few
  dma::Buffer<spu::MatchJob> descriptors(memory, "jobs", 4, {.record = ppu::kMatchJobRecord});
  ppu::JobChain chain(system, "refused", 1);
  for (std::size_t i = 0; i < 4; ++i) {
    descriptors[i].plan_ea = plans.ea(i).value;
    descriptors[i].body_count = 1;
    chain.clear();
    chain.add({system.load(image), descriptors.ea(i)});
    chain.kick();
    chain.wait();
    ASSERT_EQ(chain.failures().size(), 1u) << i;
    EXPECT_NE(chain.failures()[0].message.find("status 1"), std::string::npos) << chain.failures()[0].message;
  }
}

TEST(Match, AnEmptyJobIsDone) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop"), image = test::kernel_image("match");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  dma::Buffer<spu::MatchJob> jobs(memory, "jobs", 1, {.record = ppu::kMatchJobRecord});
  ppu::JobChain chain(system, "empty", 1);
  chain.add({system.load(image), jobs.ea()});
  chain.kick();
  chain.wait();
  EXPECT_TRUE(chain.failures().empty());
}

TEST(Match, ABlockOfAThousandFits) {
  for (int w = 1; w <= 4; ++w) {
    MatchRig rig(ppu::test::block(9, 9, 9), w);
    const Vectors x = deformed(rig, 12, 0.02), expected = reference_goals(rig, w, x), pulls = rig.pulls(x);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_LT((pulls[i] - (expected[i] - x[i])).norm(), 1e-5 * rig.size) << i;
  }
}

/// Velocities of seven bodies after three steps, two bodies or more to a job.
std::vector<spu::SkinCorner> seven_bodies(const ls_sim::SpeOptions& options) {
  MatchRig rig(ppu::test::block(4, 3, 3), 2, options, 7, 2);
  for (std::size_t b = 0; b < 7; ++b)
    std::ranges::transform(deformed(rig, 20 + b, 0.03), rig.spes.positions(b).begin(), MatchRig::of);
  for (int step = 0; step < 3; ++step) rig.spes.step({.pull = 30, .damping = 0.2f});
  std::vector<spu::SkinCorner> all;
  for (std::size_t b = 0; b < 7; ++b)
    all.insert(all.end(), rig.spes.velocities(b).begin(), rig.spes.velocities(b).end());
  return all;
}

/// With one SPE, jobs run on what the jobs before have left in the local store; with six, each SPE begins with a fresh one.
TEST(Match, GivesTheSameBytesOnAnySpesUnderEverySchedule) {
  const std::vector<spu::SkinCorner> expected = seven_bodies({.spes = 1});
  for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
    for (const int spes : {1, 3, 6}) {
      std::vector<spu::SkinCorner> all;
      ASSERT_NO_THROW(all = seven_bodies({.spes = spes, .schedule = dma::parse_schedule(schedule)}))
          << schedule << ", " << spes << " SPEs" << test::kDependsOnTheSchedule;
      ASSERT_EQ(std::memcmp(expected.data(), all.data(), all.size() * sizeof all[0]), 0)
          << schedule << ", " << spes << " SPEs" << test::kDependsOnTheSchedule;
    }
  }
}

TEST(Match, ItsCheckedImageFindsNothingAndGivesTheSameBytes) {
  const std::vector<spu::SkinCorner> expected = seven_bodies({.spes = 1});
  test::expect_no_findings([&](const ls_sim::SpeOptions& options) {
    const std::vector<spu::SkinCorner> all = seven_bodies(options);
    EXPECT_EQ(std::memcmp(expected.data(), all.data(), all.size() * sizeof all[0]), 0);
  });
}

TEST(Match, GivesTheSameBitsWithEveryCompiler) {
  MatchRig rig(ppu::test::block(4, 3, 5), 2);
  rig.set(deformed(rig, 30, 0.03), zero(rig.masses.size()));
  for (int step = 0; step < 20; ++step) {
    rig.spes.step({.pull = 30, .damping = 0.1f});
    rig.advance(1.0 / 60);
  }
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const spu::SkinCorner& v : rig.spes.velocities(0)) {
    for (const float component : {v.x, v.y, v.z})
      hash = (hash ^ std::bit_cast<std::uint32_t>(component)) * 0x100000001b3u;
  }
  EXPECT_EQ(hash, 3401988004868052312u)
      << "the kernel computes something else than it did, or in another mode: if "
         "SpeGroupTest.AKernelRoundsAndFlushesAsAnSpuDoes fails, too, look there first";
}

TEST(Match, StiffnessOfABarPulledAtItsEndsIsTheFormula) {
  constexpr double kStep = 1.0 / 60, kDensity = 1000;
  constexpr int kCells = 40;
  for (int w = 1; w <= 3; ++w) {
    MatchRig bar(ppu::test::block(kCells, 1, 1), w);
    const double s = double{bar.lattice.spacing};
    const double modulus = kDensity * ppu::specific_modulus(s, kStep, 1, w);
    const double force = 0.01 * modulus * s * s;  // stretches by 1 %
    const auto at = [&](std::size_t i) { return bar.lattice.particles[i].x(); };
    for (int step = 0; step < 6000; ++step) {
      bar.spes.step({.pull = static_cast<float>(1 / kStep), .damping = 0});
      for (std::size_t i = 0; i < bar.masses.size(); ++i) {
        auto& v = bar.spes.velocities(0)[i];
        const double share = at(i) == 0 ? -1 : at(i) == kCells ? 1 : 0;
        v.x += static_cast<float>(share * kStep * force / 4 / double{bar.masses[i]});
        for (float* component : {&v.x, &v.y, &v.z}) *component *= 0.95f;  // the air, so that it comes to rest
      }
      bar.advance(kStep);
    }
    constexpr int kFrom = 10, kTo = 30;  // away from the ends, which the regions cut
    double from = 0, to = 0;
    const Vectors x = bar.positions();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (at(i) == kFrom) from += x[i].x() / 4;
      if (at(i) == kTo) to += x[i].x() / 4;
    }
    EXPECT_NEAR(0.01 / ((to - from) / ((kTo - kFrom) * s) - 1), 1, 0.05) << "w " << w;
  }
}

TEST(Match, EnergyStaysBoundedWithoutDamping) {
  for (const double h : {1.0 / 240, 1.0 / 60, 0.1}) {
    for (const int w : {1, 2}) {
      for (const double alpha : {0.25, 1.0}) {
        MatchRig rig(ppu::test::block(3, 3, 2), w);
        Random random(40);
        Vectors v;
        for (std::size_t i = 0; i < rig.masses.size(); ++i)
          v.push_back(random.vector() * (0.1 / 5 / h / std::sqrt(3.0)));  // |v| h <= s / 5
        rig.set(rig.rest(), v);
        const double before = energy(rig.masses, v);
        double most = 0;
        for (int step = 0; step < (kSlowBuild ? 500 : 10000); ++step) {
          rig.spes.step({.pull = static_cast<float>(alpha / h), .damping = 0});
          rig.advance(h);
          if (step % 10 == 0) most = std::max(most, energy(rig.masses, rig.velocities()));
        }
        EXPECT_LT(most, 1.1 * before) << "h " << h << " w " << w << " alpha " << alpha;
      }
    }
  }
}

}  // namespace
}  // namespace softcell
