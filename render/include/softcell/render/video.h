#pragma once
// Video files, made by an `ffmpeg` child process when it is installed.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "softcell/render/image.h"

namespace softcell::render {

enum class VideoFormat : std::uint8_t {
  kMp4,   ///< H.264 in yuv420p, which every player supports
  kWebm,  ///< VP9 in yuv420p
  kGif,   ///< 256 colours per frame; each frame lasts a whole number of hundredths of a second
  kApng,  ///< a moving PNG: every colour, large
};

/// The format for the file's extension, in small or capital letters; none: the extension is unknown.
std::optional<VideoFormat> video_format(const std::filesystem::path& path);

/// The extensions of all formats, for messages: ".mp4, .webm, .gif or .apng".
inline constexpr const char* kVideoEndings = ".mp4, .webm, .gif or .apng";

/// The highest frame rate that players show correctly.
int highest_frame_rate(VideoFormat format);

/// Encodes frames as they are added, in the format that the file's extension names. With the same ffmpeg, the same frames give the same
/// file. The file is an atomic one (see base/whole_file.h): it appears when finish() succeeds. In MP4 and WebM, odd sizes get one more
/// black row or column.
///
///     VideoWriter video("demo3d.mp4", 960, 540, 60);
///     while (...) video.add_frame(renderer.pixels());
///     video.finish();
///
/// Use it from one thread. Ctrl-C on the terminal does not reach ffmpeg: the program itself decides what to keep.
class VideoWriter {
 public:
  /// @throws std::runtime_error  ffmpeg is not installed, the extension is unknown, or the size or rate is not positive.
  VideoWriter(const std::filesystem::path& path, int width, int height, int frames_per_second);
  /// Without finish(): stops the child and removes the partial file.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// @throws std::runtime_error  the frame has another size, or ffmpeg has ended (with the last line it
  /// printed).
  /// @pre  the frame is whole
  void add_frame(const Image& frame);

  /// Waits for the encoder and commits the file. Call it once, after the last frame.
  /// @throws std::runtime_error  ffmpeg failed, with the last line it printed; or the file cannot be renamed.
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace softcell::render
