#pragma once
// Video files, made by an `ffmpeg` child process when it is installed.

#include <filesystem>
#include <memory>

#include "softcell/render/image.h"

namespace softcell::render {

/// Encodes frames as they come (H.264 in yuv420p, which everything plays). The same frames give the same file
/// with the same ffmpeg. The file appears under its name when finish() succeeds; until then it is a temporary
/// one in the same directory, removed when anything fails or the writer goes away unfinished. Odd sizes get
/// one more black row or column.
///
///     VideoWriter video("demo3d.mp4", 960, 540, 60);
///     while (...) video.add_frame(renderer.pixels());
///     video.finish();
///
/// Use it from one thread. Ctrl-C on the terminal does not reach the child: the program itself decides what
/// is kept.
class VideoWriter {
 public:
  /// @throws std::runtime_error  ffmpeg is not installed, or the size or rate is not positive.
  VideoWriter(const std::filesystem::path& path, int width, int height, int frames_per_second);
  /// Without finish(): stops the child and removes the partial file.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// @throws std::runtime_error  the frame's size is another one, or ffmpeg has ended (with the last line it
  /// printed).
  void add_frame(const Image& frame);

  /// Waits for the encoder and puts the file in its place. Call once, after the last frame.
  /// @throws std::runtime_error  ffmpeg failed, with the last line it printed; or the file cannot be renamed.
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace softcell::render
