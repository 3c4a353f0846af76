// Looks of SPEs at how much bodies are strained: they miss nothing, see little that is not there, and change no result.

#include "ppu/spe_bodies/strain_looks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "ppu/bodies/break_body.h"
#include "ppu/fracture/cracks.h"
#include "ppu/matching/plastic_flow.h"
#include "ppu/matching/rest_lattice.h"
#include "soft_body_2d_scenes.h"
#include "soft_body_scenes.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_solver.h"
#include "spu_kernels/kernel_image.h"

namespace softcell::ppu {
namespace {

constexpr float kGlassCell = 0.2f, kStepOfLooks = 1.0f / 120;

template <int kDimension>
using VectorOf = Eigen::Vector<float, kDimension>;

SoftBodySettings glass(std::optional<float> stretch, std::optional<float> turn) {
  SoftBodySettings settings{.cell_size = kGlassCell, .half_width = 2, .density = 200, .alpha = 0.5f};
  settings.fracture = Fracture{.stretch = stretch, .turn = turn};
  return settings;
}

std::shared_ptr<const SoftBodyModel<3>> model_of(const Eigen::Vector3i& cells,
                                                 const SoftBodySettings& settings) {
  return block_model(cells, settings);
}
std::shared_ptr<const SoftBodyModel<2>> model_of(const Eigen::Vector2i& cells,
                                                 const SoftBodySettings& settings) {
  return rectangle_model(cells, settings);
}

/// SPEs that look at bodies, or leave it to the PPU.
template <int kDimension>
struct LookingSpes {
  explicit LookingSpes(bool look = true, const ls_sim::SpeOptions& options = {.spes = 2})
      : jobs(memory, options, job_loop), solver(memory, jobs, kernels(look ? &strain : nullptr)) {}

  MatchKernels<kDimension> kernels(const ls_sim::KernelImage* look) {
    if constexpr (kDimension == 3)
      return {match, match_tiles, look};
    else
      return {match_2d, look};
  }
  /// One step, in which nothing moves. @return  whether a face may have broken
  bool may_break(SoftBody<kDimension>& body) {
    SoftBody<kDimension>* const bodies[] = {&body};
    solver.kick(bodies, kStepOfLooks);
    solver.finish();
    return solver.may_break(body);
  }

  dma::AddressSpace memory;
  ls_sim::KernelImage job_loop = softcell::test::kernel_image("job_loop"),
                      match = softcell::test::kernel_image("match"),
                      match_tiles = softcell::test::kernel_image("match_tiles"),
                      match_2d = softcell::test::kernel_image("match_2d"),
                      strain = softcell::test::kernel_image("strain");
  JobSystem jobs;
  SpeSolver<kDimension> solver;
};

/// Turned and moved as a whole, and every particle moved by up to `noise` cells besides.
template <int kDimension>
void shake(SoftBody<kDimension>& body, float noise, const VectorOf<kDimension>& way, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  using Rotation = typename Turning<kDimension>::Rotation;
  Rotation turn;
  if constexpr (kDimension == 3)
    turn = Rotation(Eigen::Vector4f(uniform(random), uniform(random), uniform(random), 1.1f).normalized());
  else
    turn = Rotation(uniform(random));
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    VectorOf<kDimension> off;
    for (float& part : off) part = noise * kGlassCell * uniform(random);
    body.set_particle(i, turn * (body.model().lattice().rest_position(i) + off) + way,
                      VectorOf<kDimension>::Zero());
  }
  body.translate(VectorOf<kDimension>::Zero());  // so that couplings notice
}

/// Expects that SPEs miss nothing of what BreakTest finds, and see few breaks too early.
template <int kDimension, typename Cells>
void expect_that_nothing_is_missed(const Cells& cells, const SoftBodySettings& settings, float most_noise,
                                   const VectorOf<kDimension>& way) {
  LookingSpes<kDimension> spes;
  SoftBody<kDimension> body(model_of(cells, settings));
  std::mt19937 random(5);
  BreakTest<kDimension> test;
  int whole = 0, broken = 0, seen_too_early = 0;
  for (int i = 0; i < 60; ++i) {
    shake<kDimension>(body, most_noise * static_cast<float>(i) / 60, way, random);
    const bool breaks = !strained_faces(body, test).empty(), may_break = spes.may_break(body);
    if (breaks) {
      ASSERT_TRUE(may_break) << i;
    }
    (breaks ? broken : whole) += 1;
    seen_too_early += may_break && !breaks ? 1 : 0;
  }
  EXPECT_GT(whole, 5);
  EXPECT_GT(broken, 5);
  EXPECT_LE(seen_too_early, 3) << "of " << whole;
}

TEST(StrainLooks, MissNothingThatBreaksByStretch) {
  expect_that_nothing_is_missed<3>(Eigen::Vector3i(5, 4, 6), glass(0.1f, {}), 0.3f, {0, 1, 0});
  expect_that_nothing_is_missed<2>(Eigen::Vector2i(12, 13), glass(0.1f, {}), 0.25f, {0, 1});
}

TEST(StrainLooks, MissNothingThatBreaksByTurn) {
  // Rotations differ by less than what they come from: the look sees some bodies too early that only stretch. Not these.
  for (const bool far : {false, true}) {
    SCOPED_TRACE(far);
    LookingSpes<3> spes;
    SoftBody<3> body(model_of(Eigen::Vector3i(5, 4, 6), glass({}, 0.3f)));
    std::mt19937 random(6);
    BreakTest<3> test;
    int broken = 0, calm = 0;
    for (int i = 0; i < 60; ++i) {
      shake<3>(body, 0.004f * static_cast<float>(i),
               far ? Eigen::Vector3f(300, 20, -500) : Eigen::Vector3f(0, 1, 0), random);
      const bool breaks = !strained_faces(body, test).empty(), may_break = spes.may_break(body);
      if (breaks) {
        ASSERT_TRUE(may_break) << i;
      }
      broken += breaks ? 1 : 0, calm += may_break ? 0 : 1;
    }
    EXPECT_GT(broken, 5);
    EXPECT_GT(calm, 5);
  }
}

TEST(StrainLooks, MissNothingInLargeBodiesAndFarFromTheOrigin) {
  // In tiles: 1,452 particles.
  expect_that_nothing_is_missed<3>(Eigen::Vector3i(10, 10, 11), glass(0.1f, {}), 0.3f, {0, 1, 0});
  expect_that_nothing_is_missed<3>(Eigen::Vector3i(5, 4, 6), glass(0.1f, {}), 0.3f, {800, 1, -300});
}

TEST(StrainLooks, SeeAFaceThatIsStrainedToItsLimit) {
  LookingSpes<3> spes;
  SoftBody<3> body(model_of(Eigen::Vector3i(6, 5, 5), glass(0.1f, {})));
  const auto draw_out = [&](float stretch) {
    for (std::size_t i = 0; i < body.positions().size(); ++i)
      body.set_particle(
          i, body.model().lattice().rest_position(i).cwiseProduct(Eigen::Vector3f(1 + stretch, 1, 1)),
          Eigen::Vector3f::Zero());
  };
  for (const float share : {0.0f, 0.5f, 0.9f, 0.98f}) {
    draw_out(0.1f * share);
    EXPECT_FALSE(spes.may_break(body)) << share;
  }
  for (const float share : {1.001f, 1.1f, 3.0f}) {
    draw_out(0.1f * share);
    EXPECT_TRUE(spes.may_break(body)) << share;
  }
}

TEST(StrainLooks, SeeATurnAtItsLimit) {
  LookingSpes<3> spes;
  SoftBody<3> body(model_of(Eigen::Vector3i(12, 4, 4), glass({}, 0.2f)));
  // Bent about z: neighbours along x are turned against each other by `turn`.
  const auto bend_by = [&](float turn) {
    const float radius = kGlassCell / turn;
    for (std::size_t i = 0; i < body.positions().size(); ++i) {
      const Eigen::Vector3f x = body.model().lattice().rest_position(i);
      const float angle = x.x() / radius;
      body.set_particle(
          i, {(radius - x.y()) * std::sin(angle), radius - (radius - x.y()) * std::cos(angle), x.z()},
          Eigen::Vector3f::Zero());
    }
  };
  // Bending is seen at a third of its limit: there deformations differ by nothing but their rotations.
  for (const float share : {0.1f, 0.3f}) {
    bend_by(0.2f * share);
    EXPECT_FALSE(spes.may_break(body)) << share;
  }
  bend_by(0.21f);
  EXPECT_TRUE(spes.may_break(body));
}

TEST(StrainLooks, SmallBodiesAndThoseThatMayFlowAreLeftToThePpu) {
  LookingSpes<3> spes;
  SoftBody<3> small(model_of(Eigen::Vector3i(2, 2, 2), glass(0.1f, {})));
  EXPECT_TRUE(spes.may_break(small));
  SoftBodySettings settings = glass(0.1f, {});
  settings.plasticity = Plasticity{.yield = 0.03f, .creep = 30};
  SoftBody<3> plastic(model_of(Eigen::Vector3i(5, 5, 5), settings));
  EXPECT_TRUE(spes.may_break(plastic));
  LookingSpes<3> blind(false);
  SoftBody<3> body(model_of(Eigen::Vector3i(5, 5, 5), glass(0.1f, {})));
  EXPECT_TRUE(blind.may_break(body));
  EXPECT_FALSE(spes.may_break(body));
}

/// Plastic bodies, whole and in tiles, are bent to and fro around their yield. @return  their last state
template <int kDimension, typename Cells>
std::uint64_t hash_of_bending(bool look, const std::vector<Cells>& sizes,
                              const ls_sim::SpeOptions& options = {.spes = 2}) {
  LookingSpes<kDimension> spes(look, options);
  std::vector<std::unique_ptr<SoftBody<kDimension>>> bodies;
  std::vector<SoftBody<kDimension>*> pointers;
  for (const Cells& cells : sizes) {
    SoftBodySettings settings{.cell_size = kGlassCell, .half_width = 2, .density = 200, .alpha = 0.5f};
    settings.plasticity = Plasticity{.yield = 0.05f, .creep = 40};
    bodies.push_back(std::make_unique<SoftBody<kDimension>>(model_of(cells, settings)));
    pointers.push_back(bodies.back().get());
  }
  for (int step = 0; step < 60; ++step) {
    const float strain = 0.002f * static_cast<float>(step) * (step % 24 < 12 ? 1.0f : 0.2f);
    for (SoftBody<kDimension>* const body : pointers)
      for (std::size_t i = 0; i < body->positions().size(); ++i) {
        VectorOf<kDimension> x = body->model().lattice().rest_position(i);
        x.x() += strain * x.y();
        x.y() *= 1 + strain / 2;
        body->set_particle(i, x, VectorOf<kDimension>::Zero());
      }
    spes.solver.kick(pointers, kStepOfLooks);
    spes.solver.finish();
  }
  std::uint64_t hash = 0;
  for (const auto& body : bodies) {
    EXPECT_TRUE(body->has_own_rest());
    hash = state_hash(*body, hash);
  }
  return hash;
}

TEST(StrainLooks, DoNotChangeWhatFlows) {
  using Cells3 = std::vector<Eigen::Vector3i>;
  const Cells3 sizes{{7, 5, 9}, {10, 10, 11}, {2, 2, 2}};
  const std::uint64_t by_ppu = hash_of_bending<3>(false, sizes);
  EXPECT_EQ(hash_of_bending<3>(true, sizes), by_ppu);
  EXPECT_EQ(hash_of_bending<3>(true, sizes, {.spes = 6, .schedule = dma::parse_schedule("lazy")}), by_ppu);
  const std::vector<Eigen::Vector2i> flat{{14, 15}, {3, 3}};
  EXPECT_EQ(hash_of_bending<2>(true, flat), hash_of_bending<2>(false, flat));
}

/// A bar that is torn by its ends, in a world: breaks are found a step later, and pieces come as before.
std::uint64_t hash_of_tearing(bool look, std::size_t& pieces) {
  LookingSpes<3> spes(look);
  BulletWorld bullet;
  BulletSoftBodies soft(bullet.world(), spes.solver, ContactMethod::kSurface);
  SoftBody<3>& bar = soft.add(model_of(Eigen::Vector3i(14, 4, 4), glass(0.2f, 0.6f)), {0, 0, 0});
  for (std::size_t i = 0; i < bar.positions().size(); ++i)
    bar.set_particle(i, bar.position(i), {6 * bar.position(i).x(), 0, bar.position(i).x()});
  bar.translate({0, 0, 0});
  std::uint64_t hash = 0;
  for (int frame = 0; frame < 30; ++frame) {
    bullet.step(1.0f / 60, 2);
    soft.begin_ahead(kStepOfLooks);
    hash = state_hash(bar, hash);
  }
  pieces = soft.size();
  return hash;
}

TEST(StrainLooks, DoNotChangeWhatBreaks) {
  std::size_t pieces = 0, of_other = 0;
  const std::uint64_t hash = hash_of_tearing(false, pieces);
  EXPECT_GT(pieces, 1u);
  EXPECT_EQ(hash_of_tearing(true, of_other), hash);
  EXPECT_EQ(of_other, pieces);
}

}  // namespace
}  // namespace softcell::ppu
