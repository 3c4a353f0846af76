// Bodies that break in any way, for long: nothing goes bad, leaks or slows down. ci/soak runs the long form.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "../contacts/contact_world.h"
#include "fracture_checks.h"
#include "softcell/dma/address_space.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint32_t seed) : random_(seed) {}
  float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  Vector3f vector(float most) { return {number(-most, most), number(-most, most), number(-most, most)}; }
  std::size_t below(std::size_t count) { return random_() % count; }

 private:
  std::mt19937 random_;
};

double energy_of_motion(const BulletSoftBodies& bodies) {
  double energy = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (std::size_t i = 0; i < bodies[b].positions().size(); ++i)
      energy += 0.5 * double{bodies[b].model().masses()[i]} *
                bodies[b].velocities()[i].cast<double>().squaredNorm();
  return energy;
}

std::shared_ptr<const SoftBodyModel<3>> any_model(RandomNumbers& random) {
  SoftBodySettings settings{.cell_size = 0.1f,
                            .half_width = 1 + static_cast<int>(random.below(2)),
                            .alpha = random.number(0.3f, 0.9f),
                            .damping = random.number(0, 0.3f)};
  settings.fracture = Fracture{.stretch = random.number(0.01f, 0.15f)};
  if (random.below(2) == 0) settings.fracture->turn = random.number(0.05f, 0.5f);
  const std::vector<TriangleMesh> meshes{make_box({0.8f, 0.3f, 0.2f}, 0.1f), make_sphere(0.3f, 2),
                                         make_torus(0.3f, 0.12f, 16, 8)};
  return make_soft_body_model(meshes[random.below(meshes.size())], settings,
                              [&](const Vector3f&) { return random.number(0, 3); });
}

/// Nothing but hits adds energy: there is no gravity, and what bodies are attached to stands still, or is another body.
TEST(RandomBreaks, LeaveNoNanNoDanglingReferenceAndNoMoreEnergy) {
  for (std::uint32_t seed = 1; seed <= (kSlowBuild ? 3 : 12); ++seed) {
    RandomNumbers random(seed);
    SpeRuntime spes({.spes = 2});
    ContactWorld world({0, 0, 0}, seed % 2 == 0 ? &spes : nullptr);
    std::vector<AttachmentId> attachments;
    double most = 0;  // J: what there may be
    const auto hit = [&](SoftBody<3>& body) {
      const double before = energy_of_motion(world.bodies);
      const Vector3f at = body.position(random.below(body.positions().size())), by = random.vector(6);
      for (std::size_t i = 0; i < body.positions().size(); ++i)
        if ((body.position(i) - at).norm() < 0.2f) body.add_particle_velocity(i, by);
      most = std::max(most, before) + std::max(0.0, energy_of_motion(world.bodies) - before);
    };
    for (int i = 0; i < 4; ++i) world.bodies.add(any_model(random), {0.9f * static_cast<float>(i), 0, 0});
    for (int i = 0; i < 150; ++i) {
      SoftBody<3>& body = world.bodies[random.below(world.bodies.size())];
      const Vector3f at = body.position(random.below(body.positions().size()));
      switch (random.below(8)) {
        case 0:
          hit(body);
          break;
        case 1:
          world.bodies.cut(body, Cut::plane(at, random.vector(1)));
          break;
        case 2:
          world.bodies.begin_cut(body, Cut::stroke(at, random.vector(0.3f), random.vector(0.3f)));
          break;
        case 3:
          attachments.push_back(world.bodies.attach(body, Patch<3>::of_surface(at, 0.35f)));
          break;
        case 4: {
          SoftBody<3>& other = world.bodies[random.below(world.bodies.size())];
          if (&other == &body) break;
          const Vector3f there = other.position(random.below(other.positions().size()));
          AttachmentSettings<3> rope;
          rope.kind = AttachmentKind::kRope;
          attachments.push_back(world.bodies.attach(body, Patch<3>::of_surface(at, 0.35f), other,
                                                    Patch<3>::of_surface(there, 0.35f), rope));
          break;
        }
        case 5:
          if (world.bodies.size() > 3) world.bodies.remove(body);
          break;
        case 6:
          if (attachments.empty()) break;
          world.bodies.detach(attachments.back());
          attachments.pop_back();
          break;
        default:
          world.bodies.begin_ahead(1.0f / 120);
      }
      world.run(1, 2);
      if (i % 3 == 0) {
        for (const BrokenSoftBody& broken : world.bodies.poll_broken()) {
          for (const SoftBody<3>* piece : broken.pieces) {
            EXPECT_GT(piece->model().mass(), 0);
          }
        }
      }
      for (const EndedAttachment& ended : world.bodies.poll_ended_attachments())
        std::erase(attachments, ended.id);
      const double now = energy_of_motion(world.bodies);
      ASSERT_TRUE(std::isfinite(now)) << "seed " << seed << ", step " << i;
      EXPECT_LT(now, 1.1 * most + 1) << "seed " << seed << ", step " << i;
    }
  }
}

/// Of this process, resident, in megabytes.
double megabytes_in_use() {
  std::ifstream file("/proc/self/statm");
  double program = 0, resident = 0;
  file >> program >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// 100 bars a second are torn, most of them in two, and taken away a fifth of a second later.
TEST(RandomBreaks, AHundredASecondNeitherLeakNorSlowDown) {
  const char* const wanted = std::getenv("SOFTCELL_SOAK_SECONDS");
  const int steps = 100 * (wanted != nullptr ? std::clamp(std::atoi(wanted), 3, 60) : 3);
  SpeRuntime spes({.spes = 2});
  ContactWorld world({0, 0, 0}, &spes);
  SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1, .alpha = 0.5f, .damping = 0.1f};
  settings.fracture = Fracture{.stretch = 0.05f};
  const auto model =
      make_soft_body_model(make_box({1.2f, 0.2f, 0.2f}, 0.1f), settings,
                           [](const Vector3f& at) { return std::abs(at.x()) < 0.11f ? 1.0f : 1e3f; });
  EXPECT_GT(model->particles(), 100u);  // so that another thread makes the pieces
  std::deque<std::pair<int, const SoftBody<3>*>> bodies;
  std::size_t breaks = 0, pieces = 0;
  struct Third {
    double seconds = 0, megabytes = 0;
    std::uint64_t least_free = std::numeric_limits<std::uint64_t>::max();
  } thirds[3];
  for (int i = 0; i < steps; ++i) {
    const auto begin = std::clock();
    SoftBody<3>& bar =
        world.bodies.add(model, {0, 0.5f * static_cast<float>(i % 8), 0.5f * static_cast<float>(i / 8 % 8)});
    for (std::size_t p = 0; p < bar.positions().size(); ++p)
      bar.add_particle_velocity(p, Vector3f(bar.position(p).x() > 0 ? 3.0f : -3.0f, 0, 0));
    bodies.emplace_back(i, &bar);
    world.world.stepSimulation(0.01f, 0);
    for (const BrokenSoftBody& broken : world.bodies.poll_broken()) {
      ++breaks;
      for (const SoftBody<3>* piece : broken.pieces) bodies.emplace_back(i, piece), ++pieces;
    }
    while (!bodies.empty() && bodies.front().first < i - 20) {
      world.bodies.remove(*bodies.front().second);
      bodies.pop_front();
    }
    Third& third = thirds[3 * i / steps];
    third.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    third.megabytes = std::max(third.megabytes, megabytes_in_use());
    third.least_free = std::min(third.least_free, spes.memory().free_bytes(dma::Memory::kMain));
  }
  EXPECT_GT(breaks, static_cast<std::size_t>(steps * 9 / 10));
  EXPECT_GT(pieces, static_cast<std::size_t>(steps * 9 / 10));
  EXPECT_LT(world.bodies.size(), 300u);
  RecordProperty("milliseconds_a_break", std::to_string(1e3 * thirds[2].seconds / (steps / 3)));
  EXPECT_LT(thirds[2].seconds, 2 * thirds[1].seconds);
  EXPECT_GE(thirds[2].least_free + 100'000, thirds[1].least_free);
  if (SC_ADDRESS_SANITIZER || SC_THREAD_SANITIZER) return;  // they keep freed memory for a while
  EXPECT_LT(thirds[2].megabytes, thirds[1].megabytes + 3);
}

}  // namespace
}  // namespace softcell::ppu
