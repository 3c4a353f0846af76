#include "softcell/render/video.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "temporary_directory.h"

namespace softcell::render {
namespace {

using test::error_of;
using test::TemporaryDirectory;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr std::size_t kRgbBytes = std::size_t{3} * kWidth * kHeight;

Image plain_frame(int width, int height, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* const pixel = image.pixel(x, y);
      pixel[0] = red;
      pixel[1] = green;
      pixel[2] = blue;
      pixel[3] = 255;
    }
  }
  return image;
}

std::vector<char> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool has_ffmpeg() { return std::system("ffmpeg -version >/dev/null 2>&1") == 0; }

/// All frames of a video as packed RGB.
std::vector<char> decode(const std::filesystem::path& video, const std::filesystem::path& scratch) {
  const std::string command =
      "ffmpeg -v error -y -i '" + video.string() + "' -f rawvideo -pix_fmt rgb24 '" + scratch.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return bytes_of(scratch);
}

/// Another PATH for as long as it lives.
class PathOverride {
 public:
  explicit PathOverride(const std::string& path) : old_(std::getenv("PATH")) {
    ::setenv("PATH", path.c_str(), 1);
  }
  ~PathOverride() { ::setenv("PATH", old_.c_str(), 1); }
  PathOverride(const PathOverride&) = delete;
  PathOverride& operator=(const PathOverride&) = delete;

 private:
  std::string old_;
};

/// Puts a shell script named ffmpeg into the directory.
void make_fake_ffmpeg(const TemporaryDirectory& directory, const std::string& script) {
  std::ofstream(directory / "ffmpeg") << "#!/bin/sh\n" << script;
  std::filesystem::permissions(directory / "ffmpeg", std::filesystem::perms::owner_all);
}

class VideoWithFfmpeg : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  }
  const TemporaryDirectory directory_;
};

TEST_F(VideoWithFfmpeg, HoldsEveryFrameInItsColour) {
  constexpr int kFrames = 7;
  VideoWriter video(directory_ / "demo.mp4", kWidth, kHeight, 30);
  for (int i = 0; i < kFrames; ++i) video.add_frame(plain_frame(kWidth, kHeight, 200, 60, 30));
  EXPECT_FALSE(std::filesystem::exists(directory_ / "demo.mp4")) << "before it is whole";
  video.finish();
  EXPECT_EQ(directory_.entries(), std::vector<std::string>{"demo.mp4"});

  const std::vector<char> frames = decode(directory_ / "demo.mp4", directory_ / "frames");
  ASSERT_EQ(frames.size(), kFrames * kRgbBytes);
  const std::size_t middle = kRgbBytes / 2 + std::size_t{3} * kWidth / 2;
  EXPECT_NEAR(static_cast<std::uint8_t>(frames[middle]), 200, 6);
  EXPECT_NEAR(static_cast<std::uint8_t>(frames[middle + 1]), 60, 6);
  EXPECT_NEAR(static_cast<std::uint8_t>(frames[middle + 2]), 30, 6);
}

TEST_F(VideoWithFfmpeg, PadsOddSizesToEvenOnes) {
  VideoWriter video(directory_ / "odd.mp4", 63, 47, 30);
  video.add_frame(plain_frame(63, 47, 0, 255, 0));
  video.finish();
  EXPECT_EQ(decode(directory_ / "odd.mp4", directory_ / "frames").size(), kRgbBytes);
}

TEST_F(VideoWithFfmpeg, IsTheSameFileForTheSameFrames) {
  for (const char* name : {"a.mp4", "b.mp4"}) {
    VideoWriter video(directory_ / name, kWidth, kHeight, 60);
    for (int i = 0; i < 5; ++i) {
      video.add_frame(plain_frame(kWidth, kHeight, static_cast<std::uint8_t>(50 * i), 90, 10));
    }
    video.finish();
  }
  EXPECT_FALSE(bytes_of(directory_ / "a.mp4").empty());
  EXPECT_EQ(bytes_of(directory_ / "a.mp4"), bytes_of(directory_ / "b.mp4"));
}

TEST_F(VideoWithFfmpeg, LeavesNothingWhenItIsAbandoned) {
  {
    VideoWriter video(directory_ / "demo.mp4", kWidth, kHeight, 30);
    video.add_frame(plain_frame(kWidth, kHeight, 1, 2, 3));
  }
  EXPECT_TRUE(directory_.entries().empty());
}

class VideoFormats : public VideoWithFfmpeg, public testing::WithParamInterface<const char*> {};

TEST_P(VideoFormats, HoldEveryFrameInItsColourAndAreTheSameEachTime) {
  constexpr int kFrames = 6;
  const std::string name = std::string("film") + GetParam(), again = std::string("again") + GetParam();
  for (const std::string& file : {name, again}) {
    VideoWriter video(directory_ / file, kWidth, kHeight, 20);
    for (int i = 0; i < kFrames; ++i)
      video.add_frame(plain_frame(kWidth, kHeight, static_cast<std::uint8_t>(40 * i), 60, 130));
    video.finish();
  }
  EXPECT_EQ(bytes_of(directory_ / name), bytes_of(directory_ / again));
  const std::vector<char> frames = decode(directory_ / name, directory_ / "frames");
  ASSERT_EQ(frames.size(), kFrames * kRgbBytes);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const std::size_t middle = i * kRgbBytes + kRgbBytes / 2 + std::size_t{3} * kWidth / 2;
    EXPECT_NEAR(static_cast<std::uint8_t>(frames[middle]), 40 * static_cast<int>(i), 6) << "frame " << i;
    EXPECT_NEAR(static_cast<std::uint8_t>(frames[middle + 1]), 60, 6);
    EXPECT_NEAR(static_cast<std::uint8_t>(frames[middle + 2]), 130, 6);
  }
}

INSTANTIATE_TEST_SUITE_P(Endings, VideoFormats, testing::Values(".mp4", ".webm", ".gif", ".apng", ".GIF"));

// Each frame of a GIF has its own palette: what stands still must keep its colours all the same.
TEST_F(VideoWithFfmpeg, AGifKeepsWhatStandsStill) {
  const auto frame = [](int number) {
    Image image = plain_frame(kWidth, kHeight, 0, 0, 0);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        std::uint8_t* const pixel = image.pixel(x, y);
        const bool box = x >= 4 * number && x < 4 * number + 8 && y < 8;
        pixel[0] = static_cast<std::uint8_t>(box ? 60 * number : 4 * x);
        pixel[1] = static_cast<std::uint8_t>(box ? 250 - 60 * number : 5 * y);
        pixel[2] = static_cast<std::uint8_t>(box ? 30 * number : 255 - 4 * x);
      }
    }
    return image;
  };
  VideoWriter video(directory_ / "still.gif", kWidth, kHeight, 20);
  for (int i = 0; i < 4; ++i) video.add_frame(frame(i));
  video.finish();
  const std::vector<char> frames = decode(directory_ / "still.gif", directory_ / "frames");
  ASSERT_EQ(frames.size(), 4 * kRgbBytes);
  const Image last = frame(3);
  double squares = 0;
  for (std::size_t i = 3 * kRgbBytes; i < 4 * kRgbBytes; ++i) {
    const std::size_t at = i - 3 * kRgbBytes;
    const double difference = static_cast<double>(static_cast<std::uint8_t>(frames[i])) -
                              static_cast<double>(last.rgba[at / 3 * 4 + at % 3]);
    squares += difference * difference;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(kRgbBytes)), 12) << "root mean square of the last frame";
}

TEST_F(VideoWithFfmpeg, SaysWhatFfmpegCannotDo) {
  // One that has been built without an encoder.
  make_fake_ffmpeg(directory_, "echo \"Unknown encoder 'libvpx-vp9'\" >&2; exit 1\n");
  const PathOverride fake(directory_.string());
  VideoWriter video(directory_ / "demo.webm", kWidth, kHeight, 30);
  EXPECT_NE(error_of([&] { video.finish(); }).find("demo.webm: ffmpeg: Unknown encoder 'libvpx-vp9'"),
            std::string::npos);
}

TEST(Video, KnowsFormatsByTheirEndings) {
  EXPECT_EQ(video_format("a/b.mp4"), VideoFormat::kMp4);
  EXPECT_EQ(video_format("b.MP4"), VideoFormat::kMp4);
  EXPECT_EQ(video_format("b.webm"), VideoFormat::kWebm);
  EXPECT_EQ(video_format("b.gif"), VideoFormat::kGif);
  EXPECT_EQ(video_format("b.apng"), VideoFormat::kApng);
  for (const char* const other : {"b.avi", "b", ".mp4", "gif", ""})
    EXPECT_FALSE(video_format(other)) << other;
  const TemporaryDirectory directory;
  EXPECT_EQ(error_of([&] { VideoWriter video(directory / "v.avi", kWidth, kHeight, 30); }),
            "cannot write the video " + directory.string() +
                "/v.avi: give a file name that ends in .mp4, .webm, .gif or .apng");
  EXPECT_TRUE(directory.entries().empty());
}

TEST_F(VideoWithFfmpeg, TellsWhenTheDirectoryIsMissing) {
  const std::string error = error_of([&] {
    VideoWriter video(directory_ / "none/demo.mp4", kWidth, kHeight, 30);
    video.finish();
  });
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
}

TEST(Video, NamesThePackageWhenFfmpegIsNotInstalled) {
  const TemporaryDirectory directory;
  const PathOverride nothing(directory.string());
  EXPECT_EQ(error_of([&] { VideoWriter video(directory / "demo.mp4", kWidth, kHeight, 30); }),
            "cannot write the video " + directory.string() +
                "/demo.mp4: the program ffmpeg was not found in PATH; install the package ffmpeg");
}

TEST(Video, ReportsTheLastLineOfAnEncoderThatEndsEarly) {
  const TemporaryDirectory directory;
  make_fake_ffmpeg(directory, "echo first >&2; echo 'the last words' >&2; exit 3\n");
  const PathOverride fake(directory.string());
  // A stream that nobody reads raises no SIGPIPE, which would end this test program (were it not ignored
  // already).
  ::signal(SIGPIPE, SIG_DFL);
  const std::string error = error_of([&] {
    VideoWriter video(directory / "demo.mp4", kWidth, kHeight, 30);
    for (;;) video.add_frame(plain_frame(kWidth, kHeight, 1, 2, 3));
  });
  EXPECT_EQ(error, "cannot write the video " + directory.string() + "/demo.mp4: ffmpeg: the last words");
  EXPECT_EQ(directory.entries(), std::vector<std::string>{"ffmpeg"});
}

TEST(Video, ReportsTheLineWithTheReasonAndTheNameThatTheUserGave) {
  const TemporaryDirectory directory;
  make_fake_ffmpeg(
      directory,
      "for name; do :; done\n"
      "echo \"cannot write $name: it is full\" >&2; echo 'Error with stream 0:0 -- ' >&2; exit 1\n");
  const PathOverride fake(directory.string());
  VideoWriter video(directory / "demo.mp4", kWidth, kHeight, 30);
  const std::string name = directory.string() + "/demo.mp4";
  EXPECT_EQ(error_of([&] { video.finish(); }),
            "cannot write the video " + name + ": ffmpeg: cannot write " + name + ": it is full");
}

TEST(Video, ReportsTheStatusOfAnEncoderThatFailsInSilence) {
  const TemporaryDirectory directory;
  make_fake_ffmpeg(directory, "while read -r line; do :; done; exit 5\n");
  const PathOverride fake(directory.string());
  VideoWriter video(directory / "demo.mp4", kWidth, kHeight, 30);
  video.add_frame(plain_frame(kWidth, kHeight, 1, 2, 3));
  EXPECT_NE(error_of([&] { video.finish(); }).find("ended with status 5"), std::string::npos);
}

TEST(Video, RefusesSizesThatDoNotFit) {
  const TemporaryDirectory directory;
  make_fake_ffmpeg(directory, "while read -r line; do :; done\n");
  const PathOverride fake(directory.string());
  EXPECT_NE(error_of([&] { VideoWriter video(directory / "v.mp4", 0, 10, 30); }).find("above 0"),
            std::string::npos);
  EXPECT_NE(error_of([&] { VideoWriter video(directory / "v.mp4", 10, 10, 0); }).find("above 0"),
            std::string::npos);
  VideoWriter video(directory / "v.mp4", kWidth, kHeight, 30);
  EXPECT_NE(error_of([&] { video.add_frame(Image(8, 8)); }).find("a frame of 8 by 8"), std::string::npos);
}

}  // namespace
}  // namespace softcell::render
