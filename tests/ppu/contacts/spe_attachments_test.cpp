// The kernel `attach` on SPEs does what AttachmentRows do, which are its scalar twin; and in worlds SPEs hold what the PPU holds.

#include "ppu/spe_bodies/spe_attachments.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "../soft_body_2d_scenes.h"
#include "contact_world.h"
#include "ppu/contact_solver/attach_units.h"
#include "ppu/contact_solver/contact_solver.h"
#include "ppu/spe_bodies/spe_contacts.h"
#include "softcell/ls_sim/timing.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kEdge = 0.1f;  // metres, of cells
constexpr int kRounds = 3, kIterations = 4;

/// Two bodies, a rigid one that moves and one that does not, and attachments between them, all a little off.
struct Scene {
  /// @param off  metres, along each axis, of each particle at most
  explicit Scene(const std::vector<AttachmentSettings<3>>& settings, float off = 0.004f)
      : model(make_soft_body_model(make_box({0.3f, 0.3f, 0.3f}, kEdge), settings_of(kEdge))) {
    std::mt19937 random(5);
    const auto number = [&](float half) {
      return std::uniform_real_distribution<float>(-half, half)(random);
    };
    const auto vector = [&](float half) {  // in this order with any compiler
      const float x = number(half), y = number(half), z = number(half);
      return Vector3f(x, y, z);
    };
    const Lattice<3>& lattice = model.lattice();
    for (std::size_t b = 0; b < 2; ++b)
      for (std::size_t i = 0; i < lattice.particles.size(); ++i)
        at_first[b].push_back(lattice.rest_position(i) + Vector3f(0.35f * static_cast<float>(b), 0, 0));
    for (const bool moves : {true, false}) {
      ContactRigid& rigid = rigids.emplace_back();
      rigid.centre = {0.2f, moves ? 0.3f : -0.3f, 0.05f};
      rigid.velocity = vector(0.5f);
      rigid.spin = vector(2);
      if (!moves) continue;
      rigid.inverse_mass = 0.4f;
      rigid.inverse_inertia = Vector3f(3, 5, 4).asDiagonal();
      rigid.inverse_inertia(0, 1) = rigid.inverse_inertia(1, 0) = 0.5f;
    }
    for (const AttachmentSettings<3>& one : settings) add(one);
    for (std::size_t b = 0; b < 2; ++b) {
      for (const Vector3f& p : at_first[b]) positions[b].push_back(p + vector(off));
      ContactBody& body = bodies.emplace_back();
      body.model = &model;
      body.positions = positions[b];
      body.inverse_masses = model.inverse_masses;
      for (const Vector3f& p : positions[b]) {
        body.velocities.push_back(vector(1));
        body.ends.push_back(p + kStep * body.velocities.back());
        body.pushes.push_back(Vector3f::Zero());
      }
      body.box = box_of_step(body.positions, body.velocities, kStep);
    }
  }

  /// To the world, to both rigid bodies, and of the two soft ones, each with a patch of its own.
  void add(const AttachmentSettings<3>& settings) {
    const auto patch = [&](std::size_t body, float least, float most, int axis) {
      PatchParticles<3> particles;
      for (std::uint32_t i = 0; i < at_first[body].size(); ++i) {
        const float place = model.lattice().rest_position(i)[axis];
        if (place < least || place > most) continue;
        particles.particles.push_back(i);
        particles.positions.push_back(at_first[body][i]);
        particles.masses.push_back(model.masses()[i]);
      }
      return particles;
    };
    AttachmentSettings<3> with_point = settings;
    if (settings.kind == AttachmentKind::kRope) with_point.point = Vector3f(0.1f, 0.35f, 0);
    if (settings.kind == AttachmentKind::kRope) with_point.length = 0.15f;
    if (settings.kind == AttachmentKind::kHinge) with_point.axis = {0.2f, 1, 0.3f};
    const auto add_to_frame = [&](std::size_t body, std::uint32_t rigid, int axis) {
      AttachmentFrame<3> frame;
      if (rigid != kNone) frame.position = frame.end_position = rigids[rigid].centre;
      frame.end_position.y() += rigid == kNone ? 0.002f : 0;
      rows.push_back(std::make_unique<AttachmentRows<3>>(with_point, patch(body, 0.02f, 1, axis), frame));
      attachments.add(
          {.rows = rows.back().get(), .a = static_cast<std::uint32_t>(body), .rigid = rigid, .frame = frame});
    };
    add_to_frame(0, kNone, 1);
    add_to_frame(1, 0, 1);
    add_to_frame(0, 1, 2);
    rows.push_back(
        std::make_unique<AttachmentRows<3>>(settings, patch(0, 0.02f, 1, 0), patch(1, -1, -0.02f, 0)));
    attachments.add({.rows = rows.back().get(), .a = 0, .b = 1});
  }

  void begin() {
    attached.clear();
    for (ContactBody& body : bodies)
      attached.push_back(
          {body.positions, body.velocities, body.pushes, body.inverse_masses, body.spacing(), false});
    attachments.begin(attached, rigids, kStep);
  }

  static constexpr std::uint32_t kNone = AttachmentInStep<3>::kNone;
  ContactModel model;
  std::vector<Vector3f> at_first[2], positions[2];
  std::vector<ContactBody> bodies;
  std::vector<ContactRigid> rigids;
  std::vector<std::unique_ptr<AttachmentRows<3>>> rows;
  Attachments<3> attachments;
  std::vector<AttachedBody<3>> attached;
};

void solve_on_ppu(Scene& scene) {
  scene.begin();
  for (int round = 0; round < kRounds; ++round) scene.attachments.iterate(kIterations);
  scene.attachments.finish();
}

/// What a substep hands to its worker.
struct Handed {
  /// @param worker  has begun the substep
  Handed(Scene& scene, SpeContacts& worker) {
    scene.begin();
    sets.begin(scene.rigids);
    AttachUnits::begin(scene.attachments, sets);
    sets.arrange(worker);
    units.write(scene.attachments, scene.bodies.size(), scene.rigids.size(), sets);
  }
  RigidSets sets;
  AttachUnits units;  // none: the kernel cannot solve all attachments
};

/// @return  how many units there were
std::size_t solve_on_spes(Scene& scene, SpeRuntime& spes) {
  SpeContacts worker(spes.memory(), spes.jobs(),
                     {spes.kernel("contact_find"), spes.kernel("contact_solve"), spes.kernel("attach")});
  worker.begin(scene.bodies, kStep);
  Handed handed(scene, worker);
  auto& [sets, units] = handed;
  if (units.units().empty()) return 0;
  worker.hold(units.units(), kIterations);
  sets.put();
  SolveStages stages;
  for (int round = 0; round < kRounds; ++round) {
    stages.stages.push_back(static_cast<std::uint32_t>(stages.units.size()));
    for (std::uint32_t unit = 0; unit < units.units().size(); ++unit) {
      stages.units.push_back(static_cast<std::uint32_t>(stages.groups.size()));
      stages.groups.push_back({.contacts = {}, .attachments = unit, .ends = round + 1 == kRounds});
    }
  }
  worker.solve(stages);
  for (std::uint32_t i = 0; i < scene.bodies.size(); ++i)
    worker.take(i, scene.bodies[i].velocities, scene.bodies[i].pushes);
  sets.take();
  worker.read(units.units());
  units.read(scene.attachments);
  scene.attachments.take_back_spin();
  return units.units().size();
}

void expect_near(const Vector3f& found, const Vector3f& expected, float tolerance, const std::string& what) {
  EXPECT_LT((found - expected).norm(), tolerance)
      << what << ": " << found.transpose() << ", not " << expected.transpose();
}

void expect_same(const Scene& spes, const Scene& ppu) {
  float most = 0;
  for (std::size_t b = 0; b < ppu.bodies.size(); ++b) {
    for (std::size_t i = 0; i < ppu.bodies[b].velocities.size(); ++i) {
      const std::string what = "particle " + std::to_string(i) + " of " + std::to_string(b);
      expect_near(spes.bodies[b].velocities[i], ppu.bodies[b].velocities[i], 2e-4f, what);
      // Iterations end when velocities have settled, for rounding one sooner or later; pushes may not have, then.
      const Vector3f push = ppu.bodies[b].pushes[i];
      expect_near(spes.bodies[b].pushes[i], push, 2e-4f + 0.01f * push.norm(), what + ", push");
      most = std::max(most, ppu.bodies[b].velocities[i].norm());
    }
  }
  EXPECT_GT(most, 0.1f);
  for (std::size_t i = 0; i < ppu.rigids.size(); ++i) {
    expect_near(spes.rigids[i].velocity, ppu.rigids[i].velocity, 2e-4f, "rigid body");
    expect_near(spes.rigids[i].spin, ppu.rigids[i].spin, 1e-3f, "its spin");
  }
  for (std::size_t i = 0; i < ppu.rows.size(); ++i) {
    const Vector3f force = ppu.rows[i]->state().force;
    expect_near(spes.rows[i]->state().force, force, 0.01f + 1e-3f * force.norm(), "force");
    EXPECT_EQ(spes.rows[i]->broke(), ppu.rows[i]->broke()) << i;
  }
}

class SpeAttachments : public ::testing::TestWithParam<std::vector<AttachmentSettings<3>>> {};

TEST_P(SpeAttachments, DoWhatThePpuDoes) {
  Scene ppu(GetParam()), on_spes(GetParam());
  solve_on_ppu(ppu);
  SpeRuntime spes({.spes = 2});
  EXPECT_EQ(solve_on_spes(on_spes, spes), 1u);
  expect_same(on_spes, ppu);
}

std::vector<std::vector<AttachmentSettings<3>>> cases() {
  using Kind = AttachmentKind;
  std::vector<std::vector<AttachmentSettings<3>>> all;
  for (const Kind kind : {Kind::kWeld, Kind::kHinge, Kind::kRope}) {
    all.push_back({{.kind = kind}});
    all.push_back({{.kind = kind, .compliance = 2e-5f}});
    all.push_back({{.kind = kind, .break_force = 60}});
  }
  all.push_back({{.kind = Kind::kRope}, {.kind = Kind::kWeld, .compliance = 1e-4f}, {.kind = Kind::kHinge}});
  return all;
}
INSTANTIATE_TEST_SUITE_P(Kinds, SpeAttachments, ::testing::ValuesIn(cases()));

/// Attachments that contradict each other.
TEST(SpeAttachments, PushesAreHeldBelowTheirLimit) {
  const std::vector<AttachmentSettings<3>> settings{{.kind = AttachmentKind::kWeld},
                                                    {.kind = AttachmentKind::kHinge}};
  Scene ppu(settings, 0.06f), on_spes(settings, 0.06f), without(settings, 0.06f);
  solve_on_ppu(ppu);
  SpeRuntime spes({.spes = 1});
  ASSERT_EQ(solve_on_spes(on_spes, spes), 1u);
  without.begin();
  for (int round = 0; round < kRounds; ++round) without.attachments.iterate(kIterations);
  float limited = 0;
  for (std::size_t b = 0; b < 2; ++b) {
    for (std::size_t i = 0; i < ppu.bodies[b].pushes.size(); ++i) {
      const Vector3f& push = ppu.bodies[b].pushes[i];
      limited = std::max(limited, (push - without.bodies[b].pushes[i]).norm());
      expect_near(on_spes.bodies[b].pushes[i], push, 3e-3f, "push " + std::to_string(i));
    }
  }
  EXPECT_GT(limited, 0.1f) << "none was above it";
}

TEST(SpeAttachments, BreakForcesAreReached) {
  Scene scene(std::vector<AttachmentSettings<3>>{{.break_force = 60}});
  solve_on_ppu(scene);
  int broke = 0;
  for (const auto& rows : scene.rows) {
    broke += rows->broke();
    EXPECT_LT(rows->state().force.norm(), 60.01f);
  }
  EXPECT_GT(broke, 0) << "else the cases above say nothing";
}

/// Alone each attachment is a unit, and each is solved at once or not.
TEST(SpeAttachments, OneAloneDoesWhatThePpuDoes) {
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
    for (std::size_t which = 0; which < 4; ++which) {
      const auto keep = [&](Scene& scene) {
        const std::uint32_t none = Scene::kNone;
        scene.attachments.clear();
        const std::uint32_t rigid = which == 1 ? 0 : which == 2 ? 1 : none;
        AttachmentFrame<3> frame;
        if (rigid != none) frame.position = frame.end_position = scene.rigids[rigid].centre;
        scene.attachments.add({.rows = scene.rows[which].get(),
                               .a = which == 1 ? 1u : 0u,
                               .b = which == 3 ? 1 : none,
                               .rigid = rigid,
                               .frame = frame});
      };
      const std::vector<AttachmentSettings<3>> settings{{.kind = kind}};
      Scene ppu(settings), on_spes(settings);
      keep(ppu), keep(on_spes);
      solve_on_ppu(ppu);
      SpeRuntime spes({.spes = 1});
      ASSERT_EQ(solve_on_spes(on_spes, spes), 1u);
      SCOPED_TRACE("kind " + std::to_string(static_cast<int>(kind)) + ", " + std::to_string(which));
      expect_same(on_spes, ppu);
    }
  }
}

/// In the SPU's byte order, with the SPU compiler's code; and instrumented.
TEST(SpeAttachments, AllBuildsGiveTheSameBits) {
  const std::vector<AttachmentSettings<3>> all{{.kind = AttachmentKind::kRope},
                                               {.kind = AttachmentKind::kWeld, .break_force = 90},
                                               {.kind = AttachmentKind::kHinge}};
  const auto velocities = [&](const SpeRuntimeOptions& options) {
    SpeRuntime spes(options);
    Scene scene(all);
    EXPECT_EQ(solve_on_spes(scene, spes), 1u);
    for (const ls_sim::Finding& finding : spes.findings().list()) ADD_FAILURE() << finding.fault.message();
    std::vector<Vector3f> result;
    for (const ContactBody& body : scene.bodies) {
      result.insert(result.end(), body.velocities.begin(), body.velocities.end());
      result.insert(result.end(), body.pushes.begin(), body.pushes.end());
    }
    for (const ContactRigid& rigid : scene.rigids) result.push_back(rigid.velocity);
    return result;
  };
  const std::vector<Vector3f> expected = velocities({.spes = 2});
  EXPECT_EQ(velocities({.spes = 1, .machine = ls_sim::Machine::kSpu}), expected);
  EXPECT_EQ(velocities({.spes = 1, .schedule = dma::parse_schedule("random:2"), .checked = true}), expected);
}

/// What has its sides for itself is solved at once; one iteration finds what four would find. Not so where two hold one body.
TEST(SpeAttachments, ThoseAloneAreSolvedOnce) {
  const auto velocities = [](bool in_common, int iterations) {
    Scene scene(std::vector<AttachmentSettings<3>>{{.kind = AttachmentKind::kWeld}});
    scene.attachments.clear();
    scene.attachments.add({.rows = scene.rows[0].get(), .a = 0});
    scene.attachments.add({.rows = scene.rows[1].get(), .a = 1, .rigid = 0});
    if (in_common) scene.attachments.add({.rows = scene.rows[2].get(), .a = 0, .rigid = 1});
    scene.begin();
    scene.attachments.iterate(iterations);
    scene.attachments.finish();
    return std::pair(scene.bodies[0].velocities, scene.bodies[1].velocities);
  };
  EXPECT_EQ(velocities(false, 4), velocities(false, 1));
  EXPECT_NE(velocities(true, 4).first, velocities(true, 1).first);
}

/// Bodies without attachments in common are solved at the same time; what does not fit is left to the PPU.
TEST(SpeAttachments, AreInUnitsAndWithinLimits) {
  Scene scene(std::vector<AttachmentSettings<3>>{{.kind = AttachmentKind::kWeld}});
  scene.begin();
  SpeRuntime spes({.spes = 1});
  SpeContacts worker(spes.memory(), spes.jobs(),
                     {spes.kernel("contact_find"), spes.kernel("contact_solve"), spes.kernel("attach")});
  worker.begin(scene.bodies, kStep);
  const auto units_of = [&] { return Handed(scene, worker).units.units().size(); };
  // What has nothing in common goes into one unit as long as there is room.
  const auto points_of = [](const Scene& of, std::size_t which) {
    return of.rows[which]->particles(false).size();
  };
  scene.attachments.clear();
  const std::size_t both = points_of(scene, 0) + points_of(scene, 1);
  EXPECT_LT(both, spu::kAttachMaxPoints / 2);
  scene.attachments.add({.rows = scene.rows[0].get(), .a = 0});
  scene.attachments.add({.rows = scene.rows[1].get(), .a = 1, .rigid = 0});
  EXPECT_EQ(units_of(), 1u);
  // Too much for one, but not for two; together it is too much.
  std::size_t points = both;
  while (points <= spu::kAttachMaxPoints) {
    scene.add({.kind = AttachmentKind::kWeld});
    points += both;
  }
  scene.attachments.clear();
  for (std::size_t i = 0; i < scene.rows.size(); i += 4) {
    scene.attachments.add({.rows = scene.rows[i].get(), .a = 0});
    scene.attachments.add({.rows = scene.rows[i + 1].get(), .a = 1, .rigid = 0});
  }
  EXPECT_EQ(units_of(), 2u);
  scene.attachments.add({.rows = scene.rows[2].get(), .a = 0, .rigid = 0});
  EXPECT_EQ(units_of(), 0u) << "both hold on to one rigid body";
  scene.attachments.clear();
  scene.attachments.add({.rows = scene.rows[1].get(), .a = 1, .rigid = 0});
  scene.rigids[0].inverse_inertia.setZero();
  EXPECT_EQ(units_of(), 0u) << "the kernel's welds are to rigid bodies that turn";
}

/// A row of bodies hangs on a wall and carries a box, and one stands on it.
TEST(SpeAttachments, HoldInAWorldWhatThePpuHolds) {
  const auto ends_of = [](SpeRuntime* spes, int frames) {
    ContactWorld w({0, -9.81f, 0}, spes);
    w.add_floor();
    std::vector<SoftBody<3>*> bodies;
    for (int i = 0; i < 3; ++i)
      bodies.push_back(&w.add(make_box({0.3f, 0.2f, 0.3f}, kEdge), settings_of(kEdge, 0.8f, 0.4f),
                              {0.31f * static_cast<float>(i), 1, 0}));
    btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 0.1f, 0.1f)), 2, {0.3f, 0.6f, 0});
    w.add(make_box({0.2f, 0.2f, 0.2f}, kEdge), settings_of(kEdge), {0.31f, 1.25f, 0});
    for (std::size_t i = 0; i + 1 < bodies.size(); ++i) {
      const float x = 0.31f * (static_cast<float>(i) + 0.5f);
      w.bodies.attach(*bodies[i], Patch<3>::of_surface({x, 1, 0}, 0.16f), *bodies[i + 1],
                      Patch<3>::of_surface({x, 1, 0}, 0.16f));
    }
    w.bodies.attach(*bodies[0], Patch<3>::of_surface({-0.15f, 1, 0}, 0.12f));
    w.bodies.attach(*bodies[2], Patch<3>::of_surface({0.77f, 1, 0}, 0.12f));
    w.bodies.attach(*bodies[1], Patch<3>::of_surface({0.31f, 0.9f, 0}, 0.12f), box,
                    {.kind = AttachmentKind::kRope, .length = 0.25f});
    w.run(frames);
    std::vector<Vector3f> middles;
    for (std::size_t i = 0; i < w.bodies.size(); ++i) middles.push_back(w.bodies[i].centre_of_mass());
    middles.push_back(to_eigen(box.getWorldTransform().getOrigin()));
    return middles;
  };
  SpeRuntime spes({.spes = 2});
  const std::vector<Vector3f> on_spes = ends_of(&spes, 240), on_ppu = ends_of(nullptr, 240);
  ASSERT_EQ(on_spes.size(), on_ppu.size());
  for (std::size_t i = 0; i < on_ppu.size(); ++i) {
    expect_near(on_spes[i], on_ppu[i], 0.005f, "body " + std::to_string(i));
    EXPECT_GT(on_ppu[i].y(), 0.3f) << i;
  }
  ls_sim::Timing timing(2);
  {
    SpeRuntime timed({.spes = 2, .machine = ls_sim::Machine::kSpu, .timing = &timing});
    ends_of(&timed, 20);
  }
  std::uint64_t jobs = 0;
  for (const ls_sim::KernelCycles& kernel : timing.by_kernel())
    if (kernel.kernel == "attach") jobs = kernel.jobs;
  EXPECT_GT(jobs, 20u) << "else the PPU has solved them";
}

/// In two dimensions: a column of two particles is one. A plank hangs on a hinge and a rope, carries a box by a weld and one that stands on
/// it; so much more lies on the floor that SPEs solve contacts.
TEST(SpeAttachments, HoldInTwoDimensionsWhatThePpuHolds) {
  struct World {
    World(SpeRuntime& spes, bool with_floor)
        : owned(std::make_unique<World2d>(9.81f, ContactMethod::kSurface, spes)), w(*owned) {
      build(with_floor);
    }
    explicit World(bool with_floor)
        : owned(std::make_unique<World2d>(9.81f, ContactMethod::kSurface)), w(*owned) {
      build(with_floor);
    }
    void build(bool with_floor) {
      using Eigen::Vector2f;
      SoftBodySettings firm;
      firm.cell_size = kEdge;
      firm.half_width = 2;
      firm.density = 100;
      firm.alpha = 0.6f;
      firm.damping = 0.4f;
      if (with_floor) {
        w.add_box({0, -1}, {20, 1});
        for (int i = 0; i < 6; ++i)
          w.soft.add(rectangle_model({14, 14}, firm), {2.0f + 1.6f * static_cast<float>(i), 0});
      }
      plank = &w.soft.add(rectangle_model({12, 2}, firm), {0, 1});
      load = &w.soft.add(rectangle_model({4, 4}, firm), {0.2f, 1.25f});
      other = &w.soft.add(rectangle_model({3, 3}, firm), {-0.7f, 0.65f});
      box = w.add_box({0.5f, 0.85f}, {0.1f, 0.1f}, 100);
      ids.push_back(w.soft.attach(*plank, Patch<2>::of_surface({-0.55f, 1.2f}, 0.15f),
                                  {.kind = AttachmentKind::kHinge}));
      ids.push_back(w.soft.attach(*plank, Patch<2>::of_surface({0.55f, 1.2f}, 0.12f),
                                  {.kind = AttachmentKind::kRope, .point = Vector2f(0.55f, 3)}));
      ids.push_back(w.soft.attach(*plank, Patch<2>::of_surface({0.5f, 1}, 0.15f), *box));
      ids.push_back(w.soft.attach(*plank, Patch<2>::of_surface({-0.6f, 1}, 0.15f), *other,
                                  Patch<2>::of_surface({-0.7f, 0.95f}, 0.15f)));
      ids.push_back(
          w.soft.attach(*other, Patch<2>::of_surface({-0.7f, 0.65f}, 0.12f), {.compliance = 1e-3f}));
    }
    std::unique_ptr<World2d> owned;
    World2d& w;
    SoftBody<2>*plank = nullptr, *load = nullptr, *other = nullptr;
    b2Body* box = nullptr;
    std::vector<AttachmentId> ids;
  };
  SpeRuntime spes({.spes = 2});
  World on_spes(spes, true), on_ppu(true);
  for (int i = 0; i < 120; ++i) {
    on_spes.w.soft.step(kStep);
    on_ppu.w.soft.step(kStep);
    if (i > 20) continue;  // later small differences have grown
    for (std::size_t a = 0; a < on_ppu.ids.size(); ++a) {
      const Eigen::Vector2f force = on_ppu.w.soft.attachment(on_ppu.ids[a])->force;
      EXPECT_LT((on_spes.w.soft.attachment(on_spes.ids[a])->force - force).norm(),
                0.05f + 0.01f * force.norm())
          << "attachment " << a << " in step " << i;
    }
  }
  const auto expect_at = [](const SoftBody<2>& found, const SoftBody<2>& expected, const char* what) {
    EXPECT_LT((found.centre_of_mass() - expected.centre_of_mass()).norm(), 0.01f) << what;
  };
  expect_at(*on_spes.plank, *on_ppu.plank, "plank");
  expect_at(*on_spes.load, *on_ppu.load, "load");
  expect_at(*on_spes.other, *on_ppu.other, "other");
  EXPECT_NEAR(on_spes.box->GetPosition().y, on_ppu.box->GetPosition().y, 0.01f);
  EXPECT_GT(on_spes.box->GetPosition().y, 0.6f) << "it hangs";
  ls_sim::Timing timing(1);
  {
    SpeRuntime timed({.spes = 1, .machine = ls_sim::Machine::kSpu, .timing = &timing});
    World world(timed, true);
    for (int i = 0; i < 4; ++i) world.w.soft.step(kStep);
  }
  std::uint64_t jobs = 0;
  for (const ls_sim::KernelCycles& kernel : timing.by_kernel())
    if (kernel.kernel == "attach") jobs = kernel.jobs;
  EXPECT_GT(jobs, 0u) << "else the PPU has solved them";
}

}  // namespace
}  // namespace softcell::ppu
