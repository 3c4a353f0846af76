#include "pictures.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <regex>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"
#include "softcell/render/offscreen_context.h"

namespace softcell::demos {

FilmRate::FilmRate(int per_second) : per_second_(per_second) {
  SC_ASSERT(per_second >= 1 && per_second <= kFramesPerSecond, "{} frames a second of {}", per_second,
            kFramesPerSecond);
}

FilmRate FilmRate::usual(const std::filesystem::path& video) {
  constexpr int kOfGif = 20;
  return FilmRate(render::video_format(video) == render::VideoFormat::kGif ? kOfGif : kFramesPerSecond);
}

bool FilmRate::shows(int frame) const {
  SC_ASSERT(frame >= 0, "frame {}", frame);
  return std::int64_t{frame} * per_second_ % kFramesPerSecond < per_second_;
}

PictureFolders::PictureFolders(const PictureOptions& options) : PictureFolders() {
  if (options.out) {
    const std::error_code error = make(*options.out);
    if (!std::filesystem::is_directory(*options.out)) {
      throw std::runtime_error("--out " + options.out->string() +
                               " is not a folder and cannot be created: " + error.message());
    }
  }
  if (options.video) make(options.video->parent_path());  // the writer reports what is wrong with it
}

PictureFolders::~PictureFolders() {
  std::error_code ignored;
  for (std::size_t i = made_.size(); i-- > 0;) std::filesystem::remove(made_[i], ignored);  // only empty ones
}

std::error_code PictureFolders::make(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path outer;
  for (const auto& part : folder) {
    outer /= part;
    if (std::filesystem::create_directory(outer, error)) made_.push_back(outer);
    if (error) break;
  }
  return error;
}

FrameFolder::FrameFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  SC_ASSERT(std::filesystem::is_directory(folder_), "{} is no folder", folder_);
  static const std::regex numbered("frame_[0-9]{5,}\\.png");
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (std::regex_match(entry.path().filename().string(), numbered)) std::filesystem::remove(entry.path());
  }
}

void FrameFolder::write(int frame, const render::Image& image, std::span<const render::PngText> texts) const {
  SC_ASSERT(frame >= 0, "the picture of frame {} has no name", frame);
  std::vector<render::PngText> all(texts.begin(), texts.end());
  all.push_back({"Frame", std::to_string(frame)});
  render::write_png(folder_ / fmt::format("frame_{:05}.png", frame), image, render::PngEffort::kFast, all);
}

Pictures::Pictures(const PictureOptions& options, Demo& demo)
    : demo_(demo),
      turntable_(options.turntable),
      supersample_(options.supersample),
      texts_(options.texts),
      film_rate_(options.fps     ? FilmRate(*options.fps)
                 : options.video ? FilmRate::usual(*options.video)
                                 : FilmRate(FilmRate::kFramesPerSecond)) {
  SC_ASSERT(!turntable_ || *turntable_ > 0, "a camera that turns in {} s", turntable_.value_or(0));
  SC_ASSERT(supersample_ > 0, "pictures drawn {} times as large", supersample_);
  SC_ASSERT(options.size.width > 0 && options.size.height > 0, "pictures of {} by {} pixels",
            options.size.width, options.size.height);
  if (options.out) folder_.emplace(*options.out);
  if (options.video) {
    video_ = std::make_unique<render::VideoWriter>(*options.video, options.size.width, options.size.height,
                                                   film_rate_.per_second());
  }
  context_ = render::create_offscreen_context();
  renderer_ = std::make_unique<render::Renderer>(
      *context_, render::RendererSettings{.width = supersample_ * options.size.width,
                                          .height = supersample_ * options.size.height});
  demo_.make_view(*renderer_);
  if (options.statistics)
    statistics_ = std::make_unique<Statistics>(kTextScale * static_cast<float>(supersample_));
}

void Pictures::follow(const FrameTimes& times) {
  if (statistics_)
    statistics_->page = statistics_->pages.next(demo_, times, {}, renderer_->width(), renderer_->height());
}

const render::Image& Pictures::draw(int frame) {
  const double turns = turntable_ ? frame / (FilmRate::kFramesPerSecond * *turntable_) : 0;
  const render::Image* image =
      &demo_.draw(static_cast<float>(2 * std::numbers::pi * (turns - std::floor(turns))));
  if (statistics_) {
    draw_statistics(statistics_->page, statistics_->scale, statistics_->overlay, *renderer_);
    image = &renderer_->pixels();
  }
  if (supersample_ == 1) return *image;
  render::make_smaller(*image, supersample_, smaller_);
  return smaller_;
}

void Pictures::add(int frame) {
  SC_ASSERT(frame >= 0, "a picture of frame {}", frame);
  const bool in_video = video_ && film_rate_.shows(frame);
  if (video_ && !in_video && !folder_) return;
  const auto begin = std::chrono::steady_clock::now();
  const render::Image& image = draw(frame);
  if (folder_) folder_->write(frame, image, texts_);
  if (in_video) video_->add_frame(image);
  hash_ = render::image_hash(image);
  milliseconds_.push_back(
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
}

void Pictures::finish() {
  if (video_) video_->finish();
}

}  // namespace softcell::demos
