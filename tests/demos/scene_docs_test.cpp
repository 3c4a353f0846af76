// docs/reference/scenes.md is true: its examples load, and it has every field that the readers know.

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "scene_file/scene_library.h"
#include "support/scratch_folder.h"
#include "support/text_file.h"

namespace softcell::demos {
namespace {

const std::string& document() {
  static const std::string text = test::text_of(SOFTCELL_SCENES_MD);
  return text;
}

TEST(SceneDocs, EveryExampleLoads) {
  const tests::ScratchFolder folder;
  // ```toml, and in the first line the file's name behind the comment sign.
  static const std::regex block("```(toml|lua)\n(?:#|--) ([a-z]+\\.(?:toml|lua))\n([^`]*)```");
  std::vector<std::string> files;
  const auto end = std::sregex_iterator();
  for (auto match = std::sregex_iterator(document().begin(), document().end(), block); match != end;
       ++match) {
    const std::string name = (*match)[2];
    std::ofstream(folder / name) << (*match)[3].str();
    files.push_back(name);
  }
  ASSERT_EQ(files.size(), 6u);
  for (const std::string& name : files) {
    if (name == "comb.lua") continue;  // a lattice: comb.toml loads it
    const auto scene = load_scene(folder / name);
    std::visit([](const auto& s) { EXPECT_EQ(s.soft_bodies.size(), 1u) << s.title; }, scene);
  }
}

/// A scene with one field too many in some table: the sentence lists the fields that the table has.
class SceneDocsFields : public testing::TestWithParam<const char*> {};

TEST_P(SceneDocsFields, AreAllInTheReference) {
  std::string sentence;
  try {
    parse_scene(GetParam(), "s.toml");
  } catch (const std::runtime_error& error) {
    sentence = error.what();
  }
  const std::size_t list = sentence.find("; it has ");
  ASSERT_NE(list, std::string::npos) << sentence;
  static const std::regex name("[a-z_0-9]+");
  const std::string fields = sentence.substr(list + 9);
  for (auto match = std::sregex_iterator(fields.begin(), fields.end(), name); match != std::sregex_iterator();
       ++match) {
    EXPECT_NE(document().find("`" + match->str()), std::string::npos) << match->str() << ": " << sentence;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Tables, SceneDocsFields,
    testing::Values(
        "QQQQQQQQQ = 1", "dimension = 2\nQQQQQQQQQ = 1", "[world]\nQQQQQQQQQ = 1",
        "[framework]\nQQQQQQQQQ = 1", "dimension = 2\n[framework]\nQQQQQQQQQ = 1",
        "[materials.a]\nQQQQQQQQQ = 1", "[camera]\nQQQQQQQQQ = 1", "dimension = 2\n[camera]\nQQQQQQQQQ = 1",
        "[light]\nQQQQQQQQQ = 1", "[tilt]\nQQQQQQQQQ = 1", "[begin]\nQQQQQQQQQ = 1",
        "dimension = 2\n[begin]\nQQQQQQQQQ = 1", "[[box]]\nQQQQQQQQQ = 1",
        "dimension = 2\n[[box]]\nQQQQQQQQQ = 1", "[[obstacle]]\nQQQQQQQQQ = 1",
        "dimension = 2\n[[circle]]\nQQQQQQQQQ = 1", "dimension = 2\n[[polygon]]\nQQQQQQQQQ = 1",
        "[[soft_body]]\nQQQQQQQQQ = 1", "dimension = 2\n[[soft_body]]\nQQQQQQQQQ = 1",
        "[[impulse]]\nQQQQQQQQQ = 1", "[[drag]]\nQQQQQQQQQ = 1", "[[gravity]]\nQQQQQQQQQ = 1",
        "[[pause]]\nQQQQQQQQQ = 1", "[[reset]]\nQQQQQQQQQ = 1", "[[box]]\nrotation = { QQQQQQQQQ = 1 }",
        "[[rigid_body]]\nQQQQQQQQQ = 1", "[[rigid_body]]\nparts = [{ kind = \"box\", QQQQQQQQQ = 1 }]",
        "[[rigid_body]]\nshape = { kind = \"cone\", QQQQQQQQQ = 1 }",
        "[[rigid_body]]\nshape = { kind = \"box\" }\nmotion = { QQQQQQQQQ = 1 }",
        "[[rigid_body]]\nshape = { kind = \"box\" }\nmotion = { stops = [{ QQQQQQQQQ = 1 }] }",
        "[[joint]]\nQQQQQQQQQ = 1", "dimension = 2\n[[attach]]\nQQQQQQQQQ = 1", "[[attach]]\nQQQQQQQQQ = 1"));

}  // namespace
}  // namespace softcell::demos
