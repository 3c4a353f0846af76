// The state of every scene after a while, as 64-bit hashes beside the golden images: a picture forgives the last bit, a hash does not.
//
// tests/demos/scene_hashes.txt has a row for each scene. Where a change of bits is intended, SOFTCELL_UPDATE_HASHES=1
// build/release/scene_hash_tests writes the file anew; the commit says why.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"
#include "support/slow_build.h"

namespace softcell::demos {

/// In the names of tests.
void PrintTo(const SceneListing& scene, std::ostream* out) { *out << scene.dimension << "d"; }

namespace {

constexpr const char* kHowToRenew =
    "If the change of bits is intended, write tests/demos/scene_hashes.txt anew with "
    "SOFTCELL_UPDATE_HASHES=1 build/release/scene_hash_tests, and say in the commit why.";

/// The number of frames of 1/60 s that a scene runs; few for the one that is large.
int frames_of(const SceneListing& scene) { return scene.name == "big" ? 5 : 60; }

std::uint64_t hash_after(const SceneListing& listing, int frames, const SimulationOptions& options = {}) {
  if (listing.dimension == 2) {
    const Scene2d scene = load_scene_2d(listing.name);
    Simulation2d simulation(scene, options);
    for (int frame = 0; frame < frames; ++frame) simulation.step();
    return simulation.state_hash();
  }
  const Scene scene = load_scene_3d(listing.name);
  Simulation3d simulation(scene, options);
  for (int frame = 0; frame < frames; ++frame) simulation.step();
  simulation.finish();
  return simulation.state_hash();
}

/// A row of the file: what was simulated, and the hash of its state.
std::string row(const SceneListing& scene, int frames, std::uint64_t hash) {
  return fmt::format("{:16} {}d {:4} {:016x}", scene.name, scene.dimension, frames, hash);
}

/// The rows of the file by the name of their scene, comments left out.
std::map<std::string, std::string> stored_rows() {
  std::map<std::string, std::string> rows;
  std::ifstream file(SOFTCELL_SCENE_HASHES);
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') rows[line.substr(0, line.find(' '))] = line;
  }
  return rows;
}

class SceneHash : public testing::TestWithParam<SceneListing> {};

TEST_P(SceneHash, IsTheStoredOne) {
  if (kSlowBuild && GetParam().name == "big")
    GTEST_SKIP() << "the scene big takes half a minute with sanitizers, which run the other scenes";
  const int frames = frames_of(GetParam());
  const std::string now = row(GetParam(), frames, hash_after(GetParam(), frames));
  EXPECT_EQ(now, stored_rows()[GetParam().name]) << kHowToRenew;
}

/// Kernels as a compiler for the SPU has made them, each instruction interpreted: the same bits.
TEST_P(SceneHash, IsTheStoredOneByInterpretedKernels) {
  const SimulationOptions interpreted{.machine = ls_sim::Machine::kSpu};
  if (GetParam().name == "big")
    GTEST_SKIP() << "the scene big takes half a minute; the tests BothBuilds run its kernels, those of tiles";
  // Nothing that a sanitizer finds depends on the scene, so long as all kernels of bodies and contacts run.
  if (kSlowBuild && GetParam().dimension == 3 && GetParam().name != "arena")
    GTEST_SKIP() << "minutes with sanitizers, which run the scene arena with the same kernels";
  // Those whose rows would take many seconds: as many frames as show all kernels.
  std::map<std::string, int> shorter{{"claw", 12},    {"jellies", 12}, {"penguins", 1}, {"pile", 30},
                                     {"pillows", 20}, {"ragdoll", 30}, {"tyres", 20}};
  if (kSlowBuild) shorter.emplace("arena", 10);
  if (const auto few = shorter.find(GetParam().name); few != shorter.end()) {
    const int frames = few->second;
    EXPECT_EQ(hash_after(GetParam(), frames, interpreted), hash_after(GetParam(), frames));
    return;
  }
  const int frames = frames_of(GetParam());
  const std::string now = row(GetParam(), frames, hash_after(GetParam(), frames, interpreted));
  EXPECT_EQ(now, stored_rows()[GetParam().name]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneHash, testing::ValuesIn(list_scenes()), [](const auto& test) {
  return fmt::format("{}_{}d", test.param.name, test.param.dimension);
});

TEST(SceneHashes, AreOfScenesThatThereAre) {
  std::map<std::string, std::string> rows = stored_rows();
  for (const SceneListing& scene : list_scenes()) rows.erase(scene.name);
  for (const auto& [name, stored] : rows)
    ADD_FAILURE() << "there is no scene for the row: " << stored << "\n" << kHowToRenew;
}

}  // namespace

/// Writes the file anew. @return  whether it could be written.
bool update_hashes() {
  std::ostringstream text;
  text << "# Scene, dimension, frames, state_hash: see scene_hash_test.cpp.\n";
  for (const SceneListing& scene : list_scenes()) {
    const int frames = frames_of(scene);
    text << row(scene, frames, hash_after(scene, frames)) << "\n";
  }
  std::ofstream file(SOFTCELL_SCENE_HASHES);
  file << text.str() << std::flush;
  return file.good();
}

}  // namespace softcell::demos

int main(int argc, char** argv) {
  if (std::getenv("SOFTCELL_UPDATE_HASHES") != nullptr) return softcell::demos::update_hashes() ? 0 : 1;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
