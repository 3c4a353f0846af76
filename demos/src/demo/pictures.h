#pragma once
// The pictures of a headless run: numbered files, a video, or a single one for its hash.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <vector>

#include "demo.h"
#include "page.h"
#include "softcell/render/gl_context.h"
#include "softcell/render/png_io.h"
#include "softcell/render/renderer.h"
#include "softcell/render/video.h"

namespace softcell::demos {

struct PictureSize {
  int width = 1280;
  int height = 720;
};

/// Which pictures a run makes.
struct PictureOptions {
  std::optional<std::filesystem::path> out;  ///< folder for numbered frames
  std::optional<std::filesystem::path> video;
  std::optional<int> fps;  ///< frames a second of the video, 1..60; none: as many as the format shows well
  PictureSize size;
  int supersample = 1;      ///< factor by which pictures are drawn larger, then scaled down; above 0
  bool statistics = false;  ///< drawn over each picture
  /// In three dimensions, the seconds in which the camera goes once around the scene; none: it does not move.
  std::optional<double> turntable = {};
  std::vector<render::PngText> texts = {};  ///< written into each numbered frame: how it was made
};

/// Decides which frames of 1/60 s a video shows.
class FilmRate {
 public:
  static constexpr int kFramesPerSecond = 60;
  /// @param per_second  1..60
  explicit FilmRate(int per_second);
  /// Sixty frames a second, or twenty for a GIF, whose frames then all last equally long.
  static FilmRate usual(const std::filesystem::path& video);

  int per_second() const { return per_second_; }
  /// Whether the video shows this frame: it shows the first, then per_second() in each second.
  bool shows(int frame) const;

 private:
  int per_second_;
};

/// Makes the folders that pictures and videos go to, where they do not exist. The destructor removes those that are still empty, so that a
/// run that fails leaves none behind.
class PictureFolders {
 public:
  /// @throws std::runtime_error  --out is no folder and cannot be made one.
  explicit PictureFolders(const PictureOptions& options);
  ~PictureFolders();
  PictureFolders(const PictureFolders&) = delete;
  PictureFolders& operator=(const PictureFolders&) = delete;

 private:
  PictureFolders() = default;
  std::error_code make(const std::filesystem::path& folder);

  std::vector<std::filesystem::path> made_;  // outer ones first
};

/// The folder of numbered frames. Removes the frames of an earlier run, so that all frames in it belong to one run.
class FrameFolder {
 public:
  /// @pre the folder is there
  explicit FrameFolder(std::filesystem::path folder);

  /// @param texts  are written into the file, together with the frame's number
  void write(int frame, const render::Image& image, std::span<const render::PngText> texts) const;

 private:
  std::filesystem::path folder_;
};

/// Draws a demo offscreen. Used by one thread, the one that made it.
class Pictures {
 public:
  /// @throws std::runtime_error  a folder, the video or the GL context cannot be made.
  Pictures(const PictureOptions& options, Demo& demo);

  bool every_frame() const { return folder_ || video_; }

  /// Call it after each frame: it updates the statistics that are drawn over the pictures.
  void follow(const FrameTimes& times);

  /// Draws the frame, unless only a video needs it and the video does not show this frame.
  void add(int frame);
  /// Completes the video.
  void finish();

  std::uint64_t last_hash() const { return hash_; }
  std::uint64_t upload_bytes() const { return renderer_->uploaded_bytes(); }
  const std::vector<double>& milliseconds() const { return milliseconds_; }  ///< of each picture

 private:
  /// The figures over the pictures.
  struct Statistics {
    explicit Statistics(float text_scale) : scale(text_scale), overlay(text_scale) {}
    float scale;
    render::Overlay overlay;
    DemoPages pages;
    Page page;
  };

  const render::Image& draw(int frame);

  Demo& demo_;
  std::optional<double> turntable_;
  int supersample_;
  std::vector<render::PngText> texts_;
  FilmRate film_rate_;
  std::optional<FrameFolder> folder_;
  std::unique_ptr<render::VideoWriter> video_;
  std::unique_ptr<render::GlContext> context_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<Statistics> statistics_;  // null: not asked for
  render::Image smaller_;
  std::uint64_t hash_ = 0;
  std::vector<double> milliseconds_;
};

}  // namespace softcell::demos
