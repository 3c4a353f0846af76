// Bodies that break in any way, for long: nothing goes bad, leaks or slows down. ci/soak runs the long form.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
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
#include "../soft_body_2d_scenes.h"
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

std::shared_ptr<const SoftBodyModel<3>> any_model(RandomNumbers& random, std::uint32_t least_cells) {
  SoftBodySettings settings{.cell_size = 0.1f,
                            .half_width = 1 + static_cast<int>(random.below(2)),
                            .alpha = random.number(0.3f, 0.9f),
                            .damping = random.number(0, 0.3f)};
  settings.fracture = Fracture{.stretch = random.number(0.01f, 0.15f), .least_cells = least_cells};
  if (random.below(2) == 0) settings.fracture->turn = random.number(0.05f, 0.5f);
  const std::vector<TriangleMesh> meshes{make_box({0.8f, 0.3f, 0.2f}, 0.1f), make_sphere(0.3f, 2),
                                         make_torus(0.3f, 0.12f, 16, 8)};
  return make_soft_body_model(meshes[random.below(meshes.size())], settings,
                              [&](const Vector3f&) { return random.number(0, 3); });
}

/// Nothing but hits adds energy: there is no gravity, and what bodies are attached to stands still, or is another body. With the last seeds
/// small pieces vanish.
TEST(RandomBreaks, LeaveNoNanNoDanglingReferenceAndNoMoreEnergy) {
  constexpr std::uint32_t kSeeds = kSlowBuild ? 3 : 12, kMoreSeeds = kSlowBuild ? 1 : 6;
  std::size_t vanished = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds + kMoreSeeds; ++seed) {
    const std::uint32_t least_cells = seed <= kSeeds ? 1 : 5;
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
    for (int i = 0; i < 4; ++i)
      world.bodies.add(any_model(random, least_cells), {0.9f * static_cast<float>(i), 0, 0});
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
          vanished += broken.vanished;
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
  EXPECT_GT(vanished, 0u);
}

/// The resident memory of this process, megabytes.
double megabytes_in_use() {
  std::ifstream file("/proc/self/statm");
  double program = 0, resident = 0;
  file >> program >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// A soak of so many steps of 10 ms each, in thirds.
class Soak {
 public:
  Soak() {
    const char* const wanted = std::getenv("SOFTCELL_SOAK_SECONDS");
    steps_ = 100 * (wanted != nullptr ? std::clamp(std::atoi(wanted), 3, 60) : 3);
  }
  int steps() const { return steps_; }
  void begin_step() { began_ = std::clock(); }
  void end_step(int step, SpeRuntime& spes) {
    Third& third = thirds_[3 * step / steps_];
    third.seconds += static_cast<double>(std::clock() - began_) / CLOCKS_PER_SEC;
    third.megabytes = std::max(third.megabytes, megabytes_in_use());
    third.least_free = std::min(third.least_free, spes.memory().free_bytes(dma::Memory::kMain));
  }
  double milliseconds_a_step(int third) const { return 1e3 * thirds_[third].seconds / (steps_ / 3); }
  void expect_no_leak_and_as_fast_as_before() const {
    for (const int third : {1, 2}) {
      const std::string name = "third_" + std::to_string(third + 1);
      testing::Test::RecordProperty(name + "_milliseconds_a_step",
                                    std::to_string(milliseconds_a_step(third)));
      testing::Test::RecordProperty(name + "_megabytes", std::to_string(thirds_[third].megabytes));
    }
    EXPECT_LT(thirds_[2].seconds, 2 * thirds_[1].seconds);
    EXPECT_GE(thirds_[2].least_free + 100'000, thirds_[1].least_free);
    if (SC_ADDRESS_SANITIZER || SC_THREAD_SANITIZER) return;  // they keep freed memory for a while
    EXPECT_LT(thirds_[2].megabytes, thirds_[1].megabytes + 3);
  }

 private:
  struct Third {
    double seconds = 0, megabytes = 0;
    std::uint64_t least_free = std::numeric_limits<std::uint64_t>::max();
  };
  int steps_ = 0;
  std::clock_t began_ = 0;
  std::array<Third, 3> thirds_;
};

/// Where the bar of a step begins, metres: those of a second before have gone.
template <int kDimension>
Eigen::Vector<float, kDimension> place_of_bar(int step) {
  Eigen::Vector<float, kDimension> place = Eigen::Vector<float, kDimension>::Zero();
  if constexpr (kDimension == 3)
    place.template tail<2>() << 0.5f * static_cast<float>(step % 8), 0.5f * static_cast<float>(step / 8 % 8);
  else
    place.y() = 0.5f * static_cast<float>(step % 64);
  return place;
}

/// In each step a bar comes whose halves fly apart; they are taken away a fifth of a second later.
/// @param bodies  a coupling  @param step_world  by 10 ms
template <int kDimension, class Bodies, class StepWorld>
void tear_a_hundred_bars_a_second(Bodies& bodies, SpeRuntime& spes,
                                  const std::shared_ptr<const SoftBodyModel<kDimension>>& model,
                                  const StepWorld& step_world) {
  EXPECT_GT(model->particles(), 100u);  // so that another thread makes the pieces
  std::deque<std::pair<int, const SoftBody<kDimension>*>> there;
  std::size_t breaks = 0, pieces = 0;
  Soak soak;
  for (int i = 0; i < soak.steps(); ++i) {
    soak.begin_step();
    SoftBody<kDimension>& bar = bodies.add(model, place_of_bar<kDimension>(i));
    Eigen::Vector<float, kDimension> apart = Eigen::Vector<float, kDimension>::Zero();
    for (std::size_t p = 0; p < bar.positions().size(); ++p) {
      apart.x() = bar.position(p).x() > 0 ? 3.0f : -3.0f;
      bar.add_particle_velocity(p, apart);
    }
    there.emplace_back(i, &bar);
    step_world();
    for (const auto& broken : bodies.poll_broken()) {
      ++breaks;
      for (const SoftBody<kDimension>* piece : broken.pieces) there.emplace_back(i, piece), ++pieces;
    }
    while (!there.empty() && there.front().first < i - 20) {
      bodies.remove(*there.front().second);
      there.pop_front();
    }
    soak.end_step(i, spes);
  }
  EXPECT_GT(breaks, static_cast<std::size_t>(soak.steps() * 9 / 10));
  EXPECT_GT(pieces, static_cast<std::size_t>(soak.steps() * 9 / 10));
  EXPECT_LT(bodies.size(), 300u);
  soak.expect_no_leak_and_as_fast_as_before();
}

SoftBodySettings brittle_bar() {
  SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1, .alpha = 0.5f, .damping = 0.1f};
  settings.fracture = Fracture{.stretch = 0.05f};
  return settings;
}
/// It breaks in its middle only.
float strength_along_bar(float x) { return std::abs(x) < 0.11f ? 1.0f : 1e3f; }

TEST(RandomBreaks, AHundredASecondNeitherLeakNorSlowDown) {
  SpeRuntime spes({.spes = 2});
  ContactWorld world({0, 0, 0}, &spes);
  const auto model = make_soft_body_model(make_box({1.2f, 0.2f, 0.2f}, 0.1f), brittle_bar(),
                                          [](const Vector3f& at) { return strength_along_bar(at.x()); });
  tear_a_hundred_bars_a_second<3>(world.bodies, spes, model, [&] { world.world.stepSimulation(0.01f, 0); });
}

class RandomBreaks2d : public testing::TestWithParam<ContactMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, RandomBreaks2d,
                         testing::Values(ContactMethod::kSpheres, ContactMethod::kSurface), name_of_method);

TEST_P(RandomBreaks2d, AHundredASecondNeitherLeakNorSlowDown) {
  SpeRuntime spes({.spes = 2});
  World2d w(0, GetParam(), spes);
  std::vector<Eigen::Vector2i> cells;
  for (int x = -25; x < 25; ++x) cells.push_back({x, 0});
  const auto model =
      make_soft_body_model(lattice_from_cells(cells, 0.1f), brittle_bar(), 0.5f,
                           [](const Eigen::Vector2f& at) { return strength_along_bar(at.x()); });
  tear_a_hundred_bars_a_second<2>(w.soft, spes, model, [&] { w.soft.step(0.01f); });
}

}  // namespace
}  // namespace softcell::ppu
