#include "softcell/render/png_io.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "temporary_directory.h"

namespace softcell::render {
namespace {

using test::error_of;
using test::TemporaryDirectory;
using testing::ExitedWithCode;

Image noise(int width, int height, bool opaque) {
  Image image(width, height);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : image.rgba) {
    state = state * 1664525u + 1013904223u;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  if (opaque) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  }
  return image;
}

TEST(Png, RoundTripKeepsEveryChannel) {
  const TemporaryDirectory directory;
  for (const bool opaque : {true, false}) {
    for (const PngEffort effort : {PngEffort::kFast, PngEffort::kSmall}) {
      const Image image = noise(37, 21, opaque);
      write_png(directory / "picture.png", image, effort);
      EXPECT_EQ(read_png(directory / "picture.png"), image) << "opaque " << opaque;
    }
  }
  EXPECT_EQ(directory.entries(), std::vector<std::string>{"picture.png"});
}

TEST(Png, KeepsTextsOfAnyAlphabet) {
  const TemporaryDirectory directory;
  const std::vector<PngText> texts{
      {"Software", "softcell"}, {"Scene", "l\xC3\xA4mmchen \xF0\x9F\x90\x91"}, {"Command", ""}};
  write_png(directory / "picture.png", noise(9, 5, true), PngEffort::kFast, texts);
  const std::vector<PngText> read = read_png_texts(directory / "picture.png");
  ASSERT_EQ(read.size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_EQ(read[i].keyword, texts[i].keyword);
    EXPECT_EQ(read[i].text, texts[i].text);
  }
  EXPECT_EQ(read_png(directory / "picture.png"), noise(9, 5, true));
  write_png(directory / "plain.png", noise(9, 5, true));
  EXPECT_TRUE(read_png_texts(directory / "plain.png").empty());
}

TEST(Picture, IsReadAndRefusedInOneSentence) {
  const TemporaryDirectory directory;
  write_png(directory / "picture.png", noise(37, 21, false));
  EXPECT_EQ(read_picture(directory / "picture.png"), noise(37, 21, false));
  write_png(directory / "wide.png", Image(kMaxPictureSide + 1, 1));
  EXPECT_EQ(error_of([&] { read_picture(directory / "wide.png"); }),
            "cannot read " + directory.string() +
                "/wide.png: it has 4097 by 1 pixels; a picture may have at most 4096 a side");
  EXPECT_NE(error_of([&] { read_picture("/dev/zero"); }).find("/dev/zero"), std::string::npos);
  EXPECT_NE(error_of([&] { read_picture(directory / "none.png"); }).find("none.png"), std::string::npos);
  std::ofstream(directory / "text.png") << "This is no picture at all, whatever its name says.";
  EXPECT_NE(error_of([&] { read_picture(directory / "text.png"); }).find("text.png"), std::string::npos);
  std::filesystem::resize_file(directory / "picture.png", 200);
  EXPECT_NE(error_of([&] { read_picture(directory / "picture.png"); }).find("picture.png"),
            std::string::npos);
}

TEST(MakeSmaller, TakesTheMeanInLinearLight) {
  // Half of white is encoded as 188, not as 128.
  Image chess(6, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      for (int c = 0; c < 3; ++c) chess.pixel(x, y)[c] = (x + y) % 2 == 0 ? 255 : 0;
      chess.pixel(x, y)[3] = 255;
    }
  }
  Image result;
  make_smaller(chess, 2, result);
  ASSERT_EQ(result.width, 3);
  ASSERT_EQ(result.height, 2);
  for (std::size_t i = 0; i < result.rgba.size(); ++i) EXPECT_NEAR(result.rgba[i], i % 4 == 3 ? 255 : 188, 1);
}

TEST(MakeSmaller, LeavesPlainColoursAsTheyAre) {
  for (int value = 0; value < 256; ++value) {
    Image plain(3, 3);
    std::fill(plain.rgba.begin(), plain.rgba.end(), static_cast<std::uint8_t>(value));
    Image result;
    make_smaller(plain, 3, result);
    EXPECT_EQ(result.rgba, std::vector<std::uint8_t>(4, static_cast<std::uint8_t>(value)));
    make_smaller(plain, 1, result);
    EXPECT_EQ(result, plain);
  }
}

TEST(Png, SmallIsSmallerThanFastForAPlainPicture) {
  const TemporaryDirectory directory;
  Image image(200, 200);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) image.pixel(x, y)[0] = static_cast<std::uint8_t>(x ^ y);
  }
  write_png(directory / "fast.png", image, PngEffort::kFast);
  write_png(directory / "small.png", image, PngEffort::kSmall);
  EXPECT_LT(std::filesystem::file_size(directory / "small.png"),
            std::filesystem::file_size(directory / "fast.png"));
}

TEST(Png, NamesTheFileAndTheReasonWhenTheDirectoryIsMissing) {
  const TemporaryDirectory directory;
  const std::string error = error_of([&] { write_png(directory / "none/picture.png", noise(4, 4, true)); });
  EXPECT_EQ(error, "cannot write " + directory.string() + "/none/picture.png: No such file or directory");
}

TEST(Png, NamesTheFileWhenTheDirectoryIsAFile) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file") << "text";
  const std::string error = error_of([&] { write_png(directory / "file/picture.png", noise(4, 4, true)); });
  EXPECT_NE(error.find("Not a directory"), std::string::npos) << error;
}

TEST(Png, RefusesAnEmptyPicture) {
  const TemporaryDirectory directory;
  EXPECT_NE(error_of([&] { write_png(directory / "picture.png", Image()); }).find("empty"),
            std::string::npos);
  EXPECT_TRUE(directory.entries().empty());
}

TEST(Png, ReportsAFullDisk) {
  // Both larger and smaller than the buffer of stdio: the error comes while writing, or only on closing.
  for (const int side : {4, 400}) {
    EXPECT_EQ(error_of([&] { write_png("/dev/full", noise(side, side, true)); }),
              "cannot write /dev/full: No space left on device");
  }
  EXPECT_FALSE(std::filesystem::is_regular_file("/dev/full"));
}

/// Writes `image` while this process may make no file longer than 1000 bytes; prints the error and ends.
[[noreturn]] void write_with_little_room(const std::filesystem::path& path, const Image& image) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{1000, 1000};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::fputs(error_of([&] { write_png(path, image); }).c_str(), stderr);
  std::_Exit(0);
}

TEST(PngDeathTest, KeepsTheOldFileAndLeavesNoHalfWrittenOne) {
  const TemporaryDirectory directory;
  const Image old = noise(8, 8, true);
  write_png(directory / "picture.png", old);
  EXPECT_EXIT(write_with_little_room(directory / "picture.png", noise(200, 200, true)), ExitedWithCode(0),
              "cannot write .*picture.png: File too large");
  EXPECT_EQ(directory.entries(), std::vector<std::string>{"picture.png"});
  EXPECT_EQ(read_png(directory / "picture.png"), old);
}

TEST(Png, ReadingNamesAFileThatIsMissingOrNoPng) {
  const TemporaryDirectory directory;
  EXPECT_EQ(error_of([&] { read_png(directory / "none.png"); }),
            "cannot read " + directory.string() + "/none.png: No such file or directory");
  std::ofstream(directory / "text.png") << "This is no picture at all, whatever its name says.";
  EXPECT_NE(error_of([&] { read_png(directory / "text.png"); }).find("text.png"), std::string::npos);
}

TEST(Png, ReadingRefusesATruncatedFile) {
  const TemporaryDirectory directory;
  write_png(directory / "picture.png", noise(64, 64, true));
  std::filesystem::resize_file(directory / "picture.png",
                               std::filesystem::file_size(directory / "picture.png") / 2);
  EXPECT_NE(error_of([&] { read_png(directory / "picture.png"); }).find("picture.png"), std::string::npos);
}

}  // namespace
}  // namespace softcell::render
