// What the library refuses of a scene is said with the place in the scene's file.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <variant>

#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"

namespace softcell::demos {
namespace {

/// What reading or a simulation of the scene says; empty: it begins.
std::string refusal(const std::string& text, const SimulationOptions& options = {}) {
  try {
    const auto scene = parse_scene(text, "s.toml");
    if (const auto* const flat = std::get_if<Scene2d>(&scene))
      Simulation2d simulation(*flat, options);
    else
      Simulation3d simulation(std::get<Scene>(scene), options);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

constexpr const char* kCube =
    "[[soft_body]]\nname = \"cube\"\ncell_size = 0.25\nshape = { kind = \"box\", size = [1, 1, 1] }\n";
constexpr const char* kTwoCells =
    "dimension = 2\n[[soft_body]]\nname = \"b\"\ncell_size = 0.2\nrows = [\"##\"]\n";

TEST(RefusedScene, ABodyThatIsTooLargeToYieldIsNamed) {
  EXPECT_EQ(
      refusal("[[soft_body]]\ncell_size = 0.05\nplasticity = { yield = 0.1 }\nshape = { kind = \"box\" }\n")
          .find("s.toml:1:1: soft body 1: a plastic soft body has at most 4096 particles; this one has"),
      0u);
}

TEST(RefusedScene, AnAttachmentThatFindsNoSurfaceIsNamed) {
  EXPECT_EQ(refusal(kCube + std::string("[[attach]]\nbody = \"cube\"\nat = [0, 0, 0]\nradius = 0.1\n"))
                .find("s.toml:5:1: attach 1: no surface of the soft body is within"),
            0u);
  EXPECT_EQ(refusal(kTwoCells + std::string("[[attach]]\nbody = \"b\"\nat = [9, 0]\nradius = 0.1\n"))
                .find("s.toml:6:1: attach 1: "),
            0u);
}

TEST(RefusedScene, ABodyThatCannotBreakAsItsContactsAreSpheresIsNamed) {
  const std::string fracture = "fracture = { stretch = 0.1 }\n";
  EXPECT_EQ(refusal(kCube + fracture), "");
  EXPECT_EQ(refusal(kCube + fracture, {.contacts = ppu::ContactMethod::kSpheres})
                .find("s.toml:1:1: soft body 1 ('cube'): a soft body with a fracture touches with spheres"),
            0u)
      << refusal(kCube + fracture, {.contacts = ppu::ContactMethod::kSpheres});
  // At once, and not when the time of the cut has come.
  const std::string cut = "[[cut]]\nbody = \"cube\"\ntime = 9\npoint = [0, 0, 0]\nnormal = [1, 0, 0]\n";
  EXPECT_EQ(refusal(kCube + cut), "");
  EXPECT_EQ(refusal(kCube + cut, {.contacts = ppu::ContactMethod::kSpheres})
                .find("s.toml:5:1: cut 1: the soft body to be cut touches with spheres"),
            0u)
      << refusal(kCube + cut, {.contacts = ppu::ContactMethod::kSpheres});
}

TEST(RefusedScene, ACutThatIsNeitherAPlaneNorAStrokeIsNamed) {
  const auto refused = [](const std::string& fields) {
    return refusal(kCube + std::string("[[cut]]\nbody = \"cube\"\ntime = 9\npoint = [0, 0, 0]\n") + fields);
  };
  EXPECT_EQ(refused(""), "s.toml:5:1: cut 1 needs either the field 'normal' or the fields 'edge' and 'way'");
  EXPECT_EQ(refused("edge = [1, 0, 0]\n"), "s.toml:5:1: cut 1 has the field 'edge', so it needs 'way', too");
  EXPECT_EQ(refused("way = [1, 0, 0]\n"), "s.toml:5:1: cut 1 has the field 'way', so it needs 'edge', too");
  EXPECT_EQ(refused("normal = [1, 0, 0]\nway = [1, 0, 0]\n"),
            "s.toml:10:1: cut 1 has the field 'normal', so it may not have 'way'");
  EXPECT_EQ(refused("normal = [0, 0, 0]\n"), "s.toml:9:1: normal of cut 1 must not be 0");
}

}  // namespace
}  // namespace softcell::demos
