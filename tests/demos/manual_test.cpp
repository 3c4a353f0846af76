// docs/guide/soft-bodies.md is true: its scene loads, and its table of stiffnesses is what one measures.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "ppu/matching/stiffness.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "support/scratch_folder.h"
#include "support/slow_build.h"
#include "support/text_file.h"

namespace softcell::demos {
namespace {

const std::string& manual() {
  static const std::string text = test::text_of(SOFTCELL_USER_MANUAL_MD);
  return text;
}

TEST(Manual, ItsSceneLoadsWithAModelOfOnesOwn) {
  static const std::regex block("```toml\n(# mine\\.toml\n[^`]*)```");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(manual(), found, block));
  const tests::ScratchFolder folder;
  std::ofstream(folder / "mine.toml") << found[1].str();
  std::ofstream(folder / "mine.obj")
      << "v 0 0 0\nv 3 0 0\nv 0 4 0\nv 0 0 5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  EXPECT_EQ(load_scene_3d(folder / "mine.toml").soft_bodies.size(), 1u);
}

struct Row {
  double spacing;  ///< metres
  int steps;       ///< a second
  int half_width;
  double modulus;  ///< over density, m^2/s^2
};

/// The table of E/rho at alpha = 1.
std::vector<Row> rows() {
  static const std::regex line(
      "\\| ([0-9.]+) m \\| 1/([0-9]+) s \\| ([0-9,]+) \\| ([0-9,]+) \\| ([0-9,]+) \\| ([0-9,]+) \\|");
  std::vector<Row> all;
  for (auto row = std::sregex_iterator(manual().begin(), manual().end(), line); row != std::sregex_iterator();
       ++row) {
    for (int w = 1; w <= 4; ++w) {
      const std::string modulus =
          std::regex_replace((*row)[static_cast<std::size_t>(w + 2)].str(), std::regex(","), "");
      all.push_back({std::stod((*row)[1]), std::stoi((*row)[2]), w, std::stod(modulus)});
    }
  }
  return all;
}

TEST(Manual, ItsTableOfStiffnessesIsTheFormula) {
  ASSERT_EQ(rows().size(), 20u);
  for (const Row& row : rows())
    EXPECT_EQ(row.modulus,
              std::round(ppu::specific_modulus(row.spacing, 1.0 / row.steps, 1, row.half_width)));
}

/// Hangs a bar up that is one cell thick and 24 long, in a gravity that stretches it by a hundredth at most,
/// and measures how much its middle does.
/// @param stiffness  a material's field and its value  @return E/rho, m^2/s^2
double measured_modulus(const Row& row, const std::string& stiffness, double expected) {
  constexpr int kCells = 24, kFrom = 7, kTo = 17;  // away from the ends, which the regions cut
  const double s = row.spacing, length = kCells * s, gravity = 0.01 * expected / length;
  std::string text = fmt::format(
      "[world]\ngravity = {}\nsubsteps = {}\n[[soft_body]]\nname = \"bar\"\nshape = {{ kind = \"box\", size "
      "= [{}, {}, {}], "
      "step = {} }}\ncell_size = {}\nhalf_width = {}\n{}\ndamping = 0.3\n",
      gravity, row.steps / 60, s, length, s, s, s, row.half_width, stiffness);
  for (const double x : {-s / 2, s / 2}) {
    for (const double z : {-s / 2, s / 2})
      text += fmt::format(
          "[[drag]]\nbody = \"bar\"\nbegin = 0\nend = 1000\nfrom = [{0}, {1}, {2}]\nto = [{0}, {1}, {2}]\n",
          x, length / 2, z);
  }
  const Scene scene = std::get<Scene>(parse_scene(text, "bar.toml"));
  Simulation3d simulation(scene, {});
  const auto height_of_row = [&](int number) {
    const auto& grid = simulation.model(0).lattice().particles;
    double sum = 0;
    for (std::uint32_t i = 0; i < grid.size(); ++i)
      if (grid[i].y() == number) sum += double{simulation.soft_body(0).position(i).y()};
    return sum / 4;
  };
  // It swings about its rest with a period of at most 118 substeps, ever less.
  const int frames = 1800 * 60 / row.steps;
  double stretch = 0;
  for (int frame = 0; frame < frames; ++frame) {
    simulation.step();
    if (frame >= frames / 2)
      stretch += (height_of_row(kTo) - height_of_row(kFrom) - (kTo - kFrom) * s) / (frames - frames / 2);
  }
  return gravity * s * s * (kTo * kTo - kFrom * kFrom) / 2 / stretch;
}

TEST(Manual, ItsTableOfStiffnessesIsWhatABarOnTheSpesHas) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers; its numbers are the same bits in every build";
  for (const Row& row : rows()) {
    const double measured = measured_modulus(row, "alpha = 1", row.modulus);
    EXPECT_NEAR(measured / row.modulus, 1, 0.05)
        << row.spacing << " m, 1/" << row.steps << " s, w = " << row.half_width << ": " << measured;
  }
}

TEST(Manual, AModulusThatIsAskedForIsWhatABarHas) {
  const Row row{.spacing = 0.1, .steps = 120, .half_width = 2, .modulus = 100};
  EXPECT_NEAR(measured_modulus(row, "modulus = 100", 100), 100, 5);
}

TEST(Manual, AFrequencyIsTheStiffnessOfItsAlpha) {
  for (const int steps : {120, 240}) {
    const Row row{.spacing = 0.1, .steps = steps, .half_width = 2, .modulus = 0};
    const double alpha = ppu::alpha_from_frequency(10, 1.0 / steps);
    const double expected = ppu::specific_modulus(row.spacing, 1.0 / steps, alpha, row.half_width);
    EXPECT_NEAR(measured_modulus(row, "frequency = 10", expected) / expected, 1, 0.05) << steps;
  }
}

}  // namespace
}  // namespace softcell::demos
