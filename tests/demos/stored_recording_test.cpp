// The recordings of tests/demos/recordings in which a user pulls at a body of a scene: done again, each ends in the state that is in it.
// What is stored in git, no run of the same program has made: a recording must stay what it was from one version to the next.
//
// Where a change of bits is intended, SOFTCELL_UPDATE_HASHES=1 build/release/stored_recording_tests writes these files anew.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "input/input_log.h"
#include "replayed.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

/// A user takes the first body of a scene after ten frames, pulls it aside and lets go.
template <int Dimension>
class User {
 public:
  /// What he does in a frame; valid until the next call.
  template <class Simulation>
  std::span<const InputEvent<Dimension>> in_frame(std::int64_t frame, const Simulation& simulation) {
    if (frame < kTakes || frame > kLetsGo) return {};
    event_.hand = kUsersHand;
    event_.action = frame == kTakes ? Action::kHold : frame == kLetsGo ? Action::kRelease : Action::kMoveHand;
    if (event_.action == Action::kHold) {
      event_.body = 0;
      event_.value = simulation.soft_body(0).position(0);
    } else if (event_.action == Action::kMoveHand) {
      event_.value.x() += 0.03f;
    }
    return {&event_, 1};
  }

 private:
  static constexpr std::int64_t kTakes = 10, kLetsGo = 40;
  InputEvent<Dimension> event_;
};

template <class Simulation, int Dimension, class Scene>
void record(Scene scene) {
  InputLog<Dimension> log({.record = recording_file(scene.name), .replay = {}});
  log.begin(scene);
  Simulation simulation(scene, {});
  User<Dimension> user;
  for (std::int64_t frame = 0; frame < 90; ++frame) {
    simulation.step(user.in_frame(frame, simulation));
    log.record(frame, simulation.last_events());
  }
  log.save(simulation.state_hash());
}

template <class Replay>
void expect_recorded_end(const std::string& name) {
  for (const auto& [spes, schedule] : {std::pair{1, "lazy"}, {5, "random:7"}}) {
    const SimulationOptions options{.spes = spes, .schedule = dma::parse_schedule(schedule)};
    EXPECT_NO_THROW(Replay(name, {}, options)) << spes << " SPEs, " << schedule;
    if (kSlowBuild) return;
  }
}

/// Scenes in 3D: bodies that are held, stay bent, break and are cut; and those that show contacts.
const std::vector<std::string> kScenes3d{"break", "bridge", "car_crash",  "cut",   "gap",  "hang",
                                         "knot",  "pile",   "torus_fold", "touch", "tyres"};
/// The scene in 2D: a man who loses an arm.
const std::vector<std::string> kScenes2d{"man_breaks"};

const auto name_of = [](const auto& scene) { return scene.param; };

class StoredRecording3d : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, StoredRecording3d, testing::ValuesIn(kScenes3d), name_of);
TEST_P(StoredRecording3d, EndsAsItDid) { expect_recorded_end<Replayed3d>(GetParam()); }

class StoredRecording2d : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, StoredRecording2d, testing::ValuesIn(kScenes2d), name_of);
TEST_P(StoredRecording2d, EndsAsItDid) { expect_recorded_end<Replayed>(GetParam()); }

}  // namespace

void update_recordings() {
  for (const std::string& scene : kScenes3d) record<Simulation3d, 3>(load_scene_3d(scene));
  for (const std::string& scene : kScenes2d) record<Simulation2d, 2>(load_scene_2d(scene));
}

}  // namespace softcell::demos

int main(int argc, char** argv) {
  if (std::getenv("SOFTCELL_UPDATE_HASHES") != nullptr) {
    softcell::demos::update_recordings();
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
