#include "pictures.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <regex>
#include <stdexcept>

#include "softcell/base/assert.h"
#include "softcell/render/offscreen_context.h"
#include "softcell/render/png_io.h"

namespace softcell::demos {
namespace {

constexpr int kFramesPerSecond = 60;

}  // namespace

void make_picture_folders(const PictureOptions& options) {
  std::error_code error;
  if (options.out) {
    std::filesystem::create_directories(*options.out, error);
    if (!std::filesystem::is_directory(*options.out)) {
      throw std::runtime_error("--out " + options.out->string() +
                               " is not a folder and cannot be created: " + error.message());
    }
  }
  if (options.video) {
    // What is wrong with the folder, the writer will say.
    if (const auto parent = options.video->parent_path(); !parent.empty())
      std::filesystem::create_directories(parent, error);
  }
}

FrameFolder::FrameFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  SC_ASSERT(std::filesystem::is_directory(folder_), "{} is no folder", folder_);
  static const std::regex numbered("frame_[0-9]{5,}\\.png");
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (std::regex_match(entry.path().filename().string(), numbered)) std::filesystem::remove(entry.path());
  }
}

void FrameFolder::write(int frame, const render::Image& image) const {
  SC_ASSERT(frame >= 0, "the picture of frame {} has no name", frame);
  render::write_png(folder_ / fmt::format("frame_{:05}.png", frame), image, render::PngEffort::fast);
}

Pictures::Pictures(const PictureOptions& options, Demo& demo) : demo_(demo), turntable_(options.turntable) {
  SC_ASSERT(!turntable_ || *turntable_ > 0, "a camera that turns in {} s", turntable_.value_or(0));
  SC_ASSERT(options.size.width > 0 && options.size.height > 0, "pictures of {} by {} pixels",
            options.size.width, options.size.height);
  if (options.out) folder_.emplace(*options.out);
  if (options.video) {
    video_ = std::make_unique<render::VideoWriter>(*options.video, options.size.width, options.size.height,
                                                   kFramesPerSecond);
  }
  context_ = render::create_offscreen_context();
  renderer_ = std::make_unique<render::Renderer>(
      *context_, render::RendererSettings{.width = options.size.width, .height = options.size.height});
  demo_.make_view(*renderer_);
  if (options.statistics) statistics_ = std::make_unique<Statistics>();
}

void Pictures::follow(const FrameTimes& times) {
  if (statistics_)
    statistics_->page = statistics_->pages.next(demo_, times, {}, renderer_->width(), renderer_->height());
}

const render::Image& Pictures::draw(int frame) {
  const double turns = turntable_ ? frame / (kFramesPerSecond * *turntable_) : 0;
  const render::Image& image =
      demo_.draw(static_cast<float>(2 * std::numbers::pi * (turns - std::floor(turns))));
  if (!statistics_) return image;
  draw_statistics(statistics_->page, kTextScale, statistics_->overlay, *renderer_);
  return renderer_->pixels();
}

void Pictures::add(int frame) {
  SC_ASSERT(frame >= 0, "a picture of frame {}", frame);
  const auto begin = std::chrono::steady_clock::now();
  const render::Image& image = draw(frame);
  if (folder_) folder_->write(frame, image);
  if (video_) video_->add_frame(image);
  hash_ = render::image_hash(image);
  milliseconds_.push_back(
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
}

void Pictures::finish() {
  if (video_) video_->finish();
}

}  // namespace softcell::demos
