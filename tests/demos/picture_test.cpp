// Bodies from pictures, films and their frames.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "demo/pictures.h"
#include "scene/scene_hash.h"
#include "scene_file/picture_cells.h"
#include "scene_file/scene_library.h"
#include "softcell/render/png_io.h"
#include "support/scratch_folder.h"
#include "support/text_file.h"
#include "view/sticker.h"

namespace softcell::demos {
namespace {

/// '#' is opaque, and red; all else transparent.
render::Image picture_of(const std::vector<std::string>& rows) {
  render::Image image(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (std::size_t x = 0; x < rows[y].size(); ++x) {
      std::uint8_t* const pixel = image.pixel(static_cast<int>(x), static_cast<int>(y));
      pixel[0] = 200;
      pixel[3] = rows[y][x] == '#' ? 255 : 0;
    }
  }
  return image;
}

PictureCells cells_of(const std::vector<std::string>& rows, double cells) {
  return cells_of_picture(std::make_shared<const render::Image>(picture_of(rows)), cells);
}

std::set<std::pair<int, int>> set_of(const std::vector<Eigen::Vector2i>& cells) {
  std::set<std::pair<int, int>> set;
  for (const Eigen::Vector2i& cell : cells) set.insert({cell.x(), cell.y()});
  EXPECT_EQ(set.size(), cells.size());
  return set;
}

std::string refusal(const auto& make) {
  try {
    make();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(PictureCells, ArePixelsWhereTheyAreAsLarge) {
  const PictureCells made = cells_of({".....", ".##..", ".####", "....."}, 4);
  EXPECT_EQ(set_of(made.cells),
            (std::set<std::pair<int, int>>{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1}, {1, 1}}));
  EXPECT_EQ(made.picture.cell_pixels, 1);
  EXPECT_EQ(made.picture.low, Eigen::Vector2f(-1, -1)) << "the silhouette begins at grid index 0";
}

TEST(PictureCells, MayBeSmallerThanPixels) {
  const PictureCells made = cells_of({"#.", "##"}, 8);
  EXPECT_EQ(made.cells.size(), 48u);
  EXPECT_EQ(made.picture.cell_pixels, 0.25f);
}

TEST(PictureCells, HaveHalfOfTheirAreaInside) {
  // Cells of two pixels: three of four pixels are enough, one is not, where the body is near.
  EXPECT_EQ(set_of(cells_of({"#.....", "##....", "######", "######"}, 3).cells),
            (std::set<std::pair<int, int>>{{0, 0}, {1, 0}, {2, 0}, {0, 1}}));
  EXPECT_EQ(set_of(cells_of({".....#", "#....#", "######", "######"}, 3).cells),
            (std::set<std::pair<int, int>>{{0, 0}, {1, 0}, {2, 0}, {2, 1}}));
}

TEST(PictureCells, KeepThinParts) {
  // A stalk that is a pixel wide, in cells of four pixels.
  std::vector<std::string> rows(16, "#...............");
  for (std::size_t i = 12; i < 16; ++i) rows[i] = std::string(16, '#');
  const auto cells = set_of(cells_of(rows, 4).cells);
  EXPECT_TRUE(cells.contains({0, 2}) || cells.contains({0, 3}));
  EXPECT_TRUE(cells.contains({0, 0}) && cells.contains({3, 0}));
}

TEST(PictureCells, SeparatePiecesAreOneBody) {
  EXPECT_EQ(set_of(cells_of({"##..##", "##..##"}, 6).cells).size(), 8u);
}

TEST(PictureCells, RefuseWhatIsNoBody) {
  EXPECT_NE(refusal([] {
              cells_of({"...", "..."}, 4);
            }).find("the picture is transparent"),
            std::string::npos);
  EXPECT_NE(refusal([] { cells_of({"##", "##"}, 1e9); }).find("may be at most 256 long"), std::string::npos);
}

TEST(PictureCells, OfALargePictureComeFromASmallerOne) {
  render::Image large(3000, 1500);
  for (std::size_t i = 0; i < large.rgba.size(); ++i) large.rgba[i] = i % 4 == 3 ? 255 : 90;
  const render::Image kept = kept_picture(large);
  EXPECT_EQ(kept.width, 1000);
  EXPECT_EQ(kept.height, 500);
  EXPECT_EQ(kept.pixel(500, 250)[1], 90);
  EXPECT_EQ(kept.pixel(999, 499)[3], 255);
}

TEST(PictureCells, OfANarrowPictureThatIsMadeSmallerAreThere) {
  for (const auto& [width, height] : {std::pair(4096, 1), std::pair(1500, 1), std::pair(2, 2047)}) {
    render::Image narrow(width, height);
    std::ranges::fill(narrow.rgba, std::uint8_t{255});
    const render::Image kept = kept_picture(narrow);
    EXPECT_LE(std::max(kept.width, kept.height), 1024);
    for (std::size_t i = 3; i < kept.rgba.size(); i += 4)
      ASSERT_EQ(kept.rgba[i], 255) << width << " " << i / 4;
  }
}

TEST(Sticker, HasAWhiteBorderAroundTheSilhouette) {
  const Sticker sticker = make_sticker(picture_of({"....", ".#..", "...."}), 0.5f);
  const int scale = sticker.scale, border = sticker.border;
  EXPECT_EQ(scale, 128);
  const auto pixel = [&](float x, float y) {
    return sticker.image.pixel(border + static_cast<int>(x * static_cast<float>(scale)),
                               border + static_cast<int>(y * static_cast<float>(scale)));
  };
  const std::uint8_t *inside = pixel(1.5f, 1.5f), *beside = pixel(0.8f, 1.5f), *away = pixel(0.4f, 1.5f);
  EXPECT_EQ(std::vector<int>(inside, inside + 4), (std::vector<int>{200, 0, 0, 255}));
  EXPECT_EQ(std::vector<int>(beside, beside + 4), (std::vector<int>{255, 255, 255, 255}));
  EXPECT_EQ(away[3], 0);
  // Round at the corners: 0.5 beyond one along the diagonal is outside.
  EXPECT_EQ(pixel(0.6f, 0.6f)[3], 0);
  EXPECT_EQ(pixel(0.7f, 0.7f)[3], 255);
  EXPECT_FALSE(sticker.has_something({0, 0}, {10, 10}));
  EXPECT_TRUE(sticker.has_something({0, 0}, {1e6f, 1e6f}));
}

class PictureScenes : public testing::Test {
 protected:
  std::string error_of_scene(const std::string& body) {
    return refusal([&] { load(body); });
  }
  Scene2d load(const std::string& body) {
    std::ofstream(folder_ / "s.toml") << "dimension = 2\n[[soft_body]]\n" << body;
    return load_scene_2d(folder_ / "s.toml");
  }
  void SetUp() override {
    render::write_png(folder_ / "cat.png", picture_of({"##..", "####", "####"}));
    render::write_png(folder_ / "nothing.png", picture_of({"....", "...."}));
  }
  const tests::ScratchFolder folder_;
};

TEST_F(PictureScenes, HaveBodiesAsLargeAsTheySay) {
  const Scene2d scene = load("image = 'cat.png'\nlongest_side = 3\ncell_size = 0.75\n");
  ASSERT_EQ(scene.soft_bodies.size(), 1u);
  const SoftBody2dPlacement& cat = scene.soft_bodies[0];
  EXPECT_EQ(cat.cells.size(), 10u);
  EXPECT_FLOAT_EQ(cat.settings.cell_size, 0.75f);
  ASSERT_NE(cat.picture, nullptr);
  EXPECT_EQ(cat.picture->image->width, 4);
  const Scene2d usual = load("image = 'cat.png'\n");
  EXPECT_FLOAT_EQ(usual.soft_bodies[0].settings.cell_size, 0.1f) << "a twentieth of two metres";
  EXPECT_EQ(scene.files.size(), 2u) << "nothing may be written over the picture";
}

TEST_F(PictureScenes, AreWhatTheirCellsAre) {
  // A recording goes on with another painting of the same silhouette, and with colours and a face.
  const Scene2d scene = load("image = 'cat.png'\nlongest_side = 3\ncell_size = 0.75\n");
  Scene2d other = scene;
  other.soft_bodies[0].picture = nullptr;
  other.soft_bodies[0].face = Face2d{};
  other.soft_bodies[0].coloured_cells.resize(3);
  EXPECT_EQ(scene_hash(scene), scene_hash(other));
}

TEST_F(PictureScenes, RefuseBadPicturesInOneSentence) {
  EXPECT_NE(error_of_scene("image = 'none.png'").find("s.toml:3:1: there is no picture file 'none.png'"),
            std::string::npos)
      << error_of_scene("image = 'none.png'");
  EXPECT_NE(error_of_scene("image = '../cat.png'").find("is outside"), std::string::npos);
  EXPECT_NE(error_of_scene("image = '/dev/zero'").find("is outside"), std::string::npos);
  EXPECT_NE(error_of_scene("image = 's.toml'").find("cannot read"), std::string::npos);
  EXPECT_NE(error_of_scene("image = 'nothing.png'").find("the picture is transparent"), std::string::npos);
  std::filesystem::create_symlink("/etc/hostname", folder_ / "link.png");
  EXPECT_NE(error_of_scene("image = 'link.png'").find("is outside"), std::string::npos);
  EXPECT_NE(
      error_of_scene("image = 'cat.png'\nrows = ['#']").find("has several of rows, shape, lattice and image"),
      std::string::npos);
  EXPECT_NE(error_of_scene("rows = ['#']\ncell_size = 1\nlongest_side = 2").find("which only an image has"),
            std::string::npos);
  EXPECT_NE(error_of_scene("image = 'cat.png'\nlongest_side = 0.001").find("no smaller than 0.001"),
            std::string::npos);
  EXPECT_NE(
      error_of_scene("rows = ['#']\ncell_size = 1\nface = { centre = [3, 3] }").find("on none of its cells"),
      std::string::npos);
  EXPECT_NE(error_of_scene("rows = ['#']\ncell_size = 1\ncell_colours = [{ low = [0.5, 0], high = [1, 1] }]")
                .find("low of colour 1"),
            std::string::npos);
}

TEST_F(PictureScenes, TheUsersPictureTakesTheBodysPlace) {
  const OwnPicture own{.image = std::make_shared<const render::Image>(picture_of({"####", "#..#"})),
                       .cells = 8};
  const Scene2d scene = load_scene_2d("picture", own);
  const SoftBody2dPlacement& body = scene.soft_bodies.at(0);
  EXPECT_EQ(body.cells.size(), 24u);
  EXPECT_FLOAT_EQ(body.settings.cell_size, 3.0f / 8);
  EXPECT_EQ(body.picture->image, own.image);
  EXPECT_FALSE(body.face);
  EXPECT_THROW(load_scene_2d("man", own), NoPlaceForModel);
}

TEST(FilmRate, ShowsSoManyFramesInEachSecond) {
  for (int rate = 1; rate <= 60; ++rate) {
    const FilmRate film(rate);
    EXPECT_TRUE(film.shows(0)) << "the first";
    int in_second = 0, longest = 0, since = 0;
    for (int frame = 0; frame < 600; ++frame) {
      since = film.shows(frame) ? 0 : since + 1;
      longest = std::max(longest, since);
      if (frame >= 540) in_second += film.shows(frame) ? 1 : 0;
    }
    EXPECT_EQ(in_second, rate);
    EXPECT_LE(longest, (60 + rate - 1) / rate - 1) << "evenly";
  }
  EXPECT_EQ(FilmRate::usual("a.gif").per_second(), 20);
  EXPECT_EQ(FilmRate::usual("a.webm").per_second(), 60);
}

}  // namespace
}  // namespace softcell::demos
