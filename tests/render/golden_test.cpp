#include "support/golden.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "temporary_directory.h"

namespace softcell::test {
namespace {

using render::Image;
using Names = std::vector<std::string>;

class GoldenTest : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("SOFTCELL_UPDATE_GOLDENS"); }

  void update(const Image& image, const std::string& name) {
    ::setenv("SOFTCELL_UPDATE_GOLDENS", "1", 1);
    EXPECT_TRUE(compare_with_golden(image, name, folders_));
    ::unsetenv("SOFTCELL_UPDATE_GOLDENS");
  }

  const render::test::TemporaryDirectory golden_;
  const render::test::TemporaryDirectory failures_;
  const GoldenFolders folders_{golden_ / "", failures_ / ""};
};

TEST_F(GoldenTest, PassesForTheSamePictureAndLeavesNothing) {
  update(Image(20, 10), "picture");
  EXPECT_TRUE(compare_with_golden(Image(20, 10), "picture", folders_));
  EXPECT_TRUE(failures_.entries().empty());
}

TEST_F(GoldenTest, LeavesThreePicturesAndNamesThemWhenItFails) {
  update(Image(20, 10), "picture");
  Image other(20, 10);
  other.pixel(3, 4)[0] = 200;
  const testing::AssertionResult result = compare_with_golden(other, "picture", folders_);
  EXPECT_FALSE(result);
  EXPECT_EQ(failures_.entries(),
            (Names{"picture.actual.png", "picture.difference.png", "picture.expected.png"}));
  for (const std::string& name : failures_.entries()) {
    EXPECT_NE(std::string(result.message()).find((failures_ / name).string()), std::string::npos) << name;
  }
  EXPECT_EQ(render::read_png(failures_ / "picture.actual.png"), other);
}

TEST_F(GoldenTest, FailsForAnotherSize) {
  update(Image(20, 10), "picture");
  EXPECT_FALSE(compare_with_golden(Image(10, 20), "picture", folders_));
  EXPECT_EQ(failures_.entries(), (Names{"picture.actual.png", "picture.expected.png"}));
}

TEST_F(GoldenTest, FailsWithoutAGoldenPicture) {
  EXPECT_FALSE(compare_with_golden(Image(20, 10), "picture", folders_));
  EXPECT_EQ(failures_.entries(), Names{"picture.actual.png"});
}

}  // namespace
}  // namespace softcell::test
