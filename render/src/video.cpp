#include "softcell/render/video.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/base/whole_file.h"

extern char** environ;

namespace softcell::render {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error("cannot write the video " + path.string() + ": " + why);
}

/// A file descriptor, closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    close();
    value_ = std::exchange(other.value_, -1);
    return *this;
  }
  int get() const { return value_; }
  void close() {
    if (value_ >= 0) ::close(value_);
    value_ = -1;
  }

 private:
  int value_ = -1;
};

/// The last that gives a reason: "Error initializing output stream 0:0 -- " stands below one that does.
std::string last_line(int descriptor) {
  std::array<char, 4096> tail{};
  const off_t size = ::lseek(descriptor, 0, SEEK_END);
  const off_t start = size > static_cast<off_t>(tail.size()) ? size - static_cast<off_t>(tail.size()) : 0;
  const ssize_t count = ::pread(descriptor, tail.data(), tail.size(), start);
  std::string text(tail.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  for (;;) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    const std::size_t before = text.find_last_of("\r\n");
    if (before == std::string::npos) return text;
    if (!text.ends_with("-- ")) return text.substr(before + 1);
    text.resize(before);
  }
}

/// What ffmpeg makes of the frames.
std::vector<std::string> encoding(VideoFormat format) {
  // Chroma is stored for squares of two by two pixels, so sizes must be even; the colours are named, or players guess.
  const char* const kEven =
      "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";
  const auto in_bt709 = [&](std::vector<std::string> words) {
    for (const char* const word : {"-vf", kEven, "-colorspace", "bt709", "-color_primaries", "bt709",
                                   "-color_trc", "bt709", "-color_range", "tv"}) {
      words.emplace_back(word);
    }
    return words;
  };
  switch (format) {
    case VideoFormat::kMp4:
      // The index at the front: a browser plays it while it loads.
      return in_bt709(
          {"-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"});
    case VideoFormat::kWebm:
      return in_bt709({"-c:v", "libvpx-vp9", "-crf", "22", "-b:v", "0", "-deadline", "good", "-cpu-used", "5",
                       "-f", "webm"});
    case VideoFormat::kGif:
      // A palette for each frame, because one for all would need all frames in memory. Ordered dither, so that parts that do not
      // move do not flicker. No differences between frames: they would compare numbers of colours in different palettes.
      return {"-filter_complex",
              "format=rgb24,split[frames][same];[frames]palettegen=stats_mode=single[palettes];"
              "[same][palettes]paletteuse=new=1:dither=bayer:bayer_scale=4",
              "-loop",
              "0",
              "-f",
              "gif"};
    case VideoFormat::kApng:
      return {"-vf", "format=rgb24", "-c:v", "apng", "-pred", "mixed", "-plays", "0", "-f", "apng"};
  }
  return {};
}

std::vector<std::string> arguments(const std::filesystem::path& output, VideoFormat format, int width,
                                   int height, int rate) {
  std::vector<std::string> words{
      "ffmpeg", "-y", "-nostdin", "-hide_banner", "-loglevel", "error",
      // A full disk is an error also when the file's end is written: without it the status is 0 then.
      "-xerror",
      // In: the frames as they are in memory.
      "-f", "rawvideo", "-pix_fmt", "rgba", "-s", std::to_string(width) + "x" + std::to_string(height), "-r",
      std::to_string(rate), "-i", "pipe:0"};
  for (const std::string& word : encoding(format)) words.push_back(word);
  // One thread and no dates or versions: the same file from the same frames.
  for (const char* const word :
       {"-threads", "1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1"})
    words.emplace_back(word);
  // A path that begins with a dash, or looks like a protocol, is still a file.
  words.push_back("file:" + output.string());
  return words;
}

VideoFormat format_of(const std::filesystem::path& path) {
  const std::optional<VideoFormat> format = video_format(path);
  if (!format) fail(path, std::string("give a file name that ends in ") + kVideoEndings);
  return *format;
}

}  // namespace

std::optional<VideoFormat> video_format(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  for (const auto& [name, format] : {std::pair(".mp4", VideoFormat::kMp4),
                                     {".webm", VideoFormat::kWebm},
                                     {".gif", VideoFormat::kGif},
                                     {".apng", VideoFormat::kApng}}) {
    if (ending == name) return format;
  }
  return std::nullopt;
}

int highest_frame_rate(VideoFormat format) { return format == VideoFormat::kGif ? 50 : 60; }

struct VideoWriter::Encoder {
  Encoder(const std::filesystem::path& video_path, int frame_width, int frame_height, int rate)
      : path(video_path),
        format(format_of(video_path)),
        width(frame_width),
        height(frame_height),
        file(video_path) {
    if (width <= 0 || height <= 0) fail(path, "width and height must be above 0");
    if (rate <= 0) fail(path, "the frame rate must be above 0");
    start(rate);
  }

  ~Encoder() {
    if (child > 0) {
      ::kill(child, SIGKILL);
      wait();
    }
  }

  void start(int rate);
  int wait();
  [[noreturn]] void report(int status);

  std::filesystem::path path;
  VideoFormat format;
  int width;
  int height;
  base::WholeFile file;
  Descriptor frames;    ///< our end of the stream to the child's standard input
  Descriptor messages;  ///< what the child prints
  pid_t child = 0;      ///< 0 when none is to be waited for
};

void VideoWriter::Encoder::start(int rate) {
  SC_ASSERT(child == 0, "ffmpeg {} writes {} already", child, path);
  // A socket in place of a pipe: a write to it can be told to raise no SIGPIPE, which would be the whole
  // process's affair.
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    fail(path, std::generic_category().message(errno));
  }
  frames = Descriptor(ends[0]);
  const Descriptor input(ends[1]);
  // Memory, not a pipe: nobody has to read it while the child runs.
  messages = Descriptor(::memfd_create("ffmpeg messages", MFD_CLOEXEC));
  if (messages.get() < 0) fail(path, std::generic_category().message(errno));

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.get(), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, messages.get(), STDERR_FILENO);

  // Its own process group, so that Ctrl-C is the program's to handle; signals as a fresh program expects
  // them.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::vector<std::string> words = arguments(file.written_path(), format, width, height, rate);
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int error = ::posix_spawnp(&child, "ffmpeg", &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    child = 0;
    fail(path, error == ENOENT ? "the program ffmpeg was not found in PATH; install the package ffmpeg"
                               : "ffmpeg does not start: " + std::generic_category().message(error));
  }
}

int VideoWriter::Encoder::wait() {
  SC_ASSERT(child > 0, "no ffmpeg runs for {}", path);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  child = 0;
  return status;
}

void VideoWriter::Encoder::report(int status) {
  std::string why = last_line(messages.get());
  // The user knows the file by its final name.
  const std::string temporary = "file:" + file.written_path().string();
  if (const auto at = why.find(temporary); at != std::string::npos)
    why.replace(at, temporary.size(), path.string());
  if (why.empty()) {
    why = WIFSIGNALED(status) ? "it was ended by signal " + std::to_string(WTERMSIG(status))
                              : "it ended with status " + std::to_string(WEXITSTATUS(status));
  }
  fail(path, "ffmpeg: " + why);
}

VideoWriter::VideoWriter(const std::filesystem::path& path, int width, int height, int frames_per_second)
    : encoder_(std::make_unique<Encoder>(path, width, height, frames_per_second)) {}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add_frame(const Image& frame) {
  Encoder& encoder = *encoder_;
  if (frame.width != encoder.width || frame.height != encoder.height) {
    fail(encoder.path, "a frame of " + std::to_string(frame.width) + " by " + std::to_string(frame.height) +
                           " in a video of " + std::to_string(encoder.width) + " by " +
                           std::to_string(encoder.height));
  }
  if (encoder.child == 0) fail(encoder.path, "it is finished already");
  SC_ASSERT(frame.is_whole(), "{} bytes for {} by {} pixels, to {}", frame.rgba.size(), frame.width,
            frame.height, encoder.path);
  std::size_t sent = 0;
  while (sent < frame.rgba.size()) {
    const ssize_t count =
        ::send(encoder.frames.get(), frame.rgba.data() + sent, frame.rgba.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      // The child has closed its end: it is about to end, or has, and its last words say why.
      encoder.frames.close();
      encoder.report(encoder.wait());
    }
    sent += static_cast<std::size_t>(count);
  }
}

void VideoWriter::finish() {
  Encoder& encoder = *encoder_;
  if (encoder.child == 0) fail(encoder.path, "it is finished already");
  encoder.frames.close();
  const int status = encoder.wait();
  if (status != 0) encoder.report(status);
  encoder.file.commit();
}

}  // namespace softcell::render
