#pragma once
// The pictures of a headless run: numbered files, a video, or one for its hash alone.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "demo.h"
#include "page.h"
#include "softcell/render/gl_context.h"
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
  PictureSize size;
  bool statistics = false;  ///< of each frame, over its picture
  /// In three dimensions, seconds in which the camera goes about the scene once; none: it stays.
  std::optional<double> turntable = {};
};

/// Makes the folders that pictures and videos go to. @throws std::runtime_error  --out is no folder and
/// cannot be made one.
void make_picture_folders(const PictureOptions& options);

/// The folder of numbered frames. Removes those of an earlier run, so that all frames in it belong to one run.
class FrameFolder {
 public:
  /// @pre the folder is there
  explicit FrameFolder(std::filesystem::path folder);

  void write(int frame, const render::Image& image) const;

 private:
  std::filesystem::path folder_;
};

/// Draws a demo offscreen. Used by one thread, the one that made it.
class Pictures {
 public:
  /// @throws std::runtime_error  a folder, the video or the GL context cannot be made.
  Pictures(const PictureOptions& options, Demo& demo);

  bool every_frame() const { return folder_ || video_; }

  /// Call it after each frame: updates the statistics that stand over the pictures.
  void follow(const FrameTimes& times);

  void add(int frame);
  /// Completes the video.
  void finish();

  std::uint64_t last_hash() const { return hash_; }
  std::uint64_t upload_bytes() const { return renderer_->uploaded_bytes(); }
  const std::vector<double>& milliseconds() const { return milliseconds_; }  ///< of each picture

 private:
  /// Figures over the pictures.
  struct Statistics {
    render::Overlay overlay{kTextScale};
    DemoPages pages;
    Page page;
  };

  const render::Image& draw(int frame);

  Demo& demo_;
  std::optional<double> turntable_;
  std::optional<FrameFolder> folder_;
  std::unique_ptr<render::VideoWriter> video_;
  std::unique_ptr<render::GlContext> context_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<Statistics> statistics_;  // where they are asked for
  std::uint64_t hash_ = 0;
  std::vector<double> milliseconds_;
};

}  // namespace softcell::demos
