#include "drawing_thread.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

namespace softcell::demos {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Pictures per second, averaged over half a second.
class Rate {
 public:
  void count(Clock::time_point now) {
    ++pictures_;
    const double seconds = Seconds(now - since_).count();
    if (seconds < 0.5) return;
    rate_ = pictures_ / seconds;
    since_ = now;
    pictures_ = 0;
  }
  double per_second() const { return rate_; }

 private:
  Clock::time_point since_ = Clock::now();
  int pictures_ = 0;
  double rate_ = 0;
};

/// Without a GPU, several samples per pixel, fine shadows and triangles of a pixel or two take more than half of a picture's time; a window
/// uses that time better for more pictures.
bool draws_in_software(const render::Renderer& renderer) {
  const std::string_view description = renderer.description();
  return description.find("llvmpipe") != std::string_view::npos ||
         description.find("softpipe") != std::string_view::npos;
}

}  // namespace

DrawingThread::DrawingThread(render::Window& window, Demo& demo, const render::OverlayFont& font,
                             const render::Image& sheet)
    : window_(window), demo_(demo), font_(font), sheet_(sheet) {
  pages_.next().width = window.width();
  pages_.next().height = window.height();
  window_.release();
  std::promise<void> promise;
  std::future<void> ready = promise.get_future();
  thread_ = std::thread([this, p = std::move(promise)]() mutable { run(std::move(p)); });
  try {
    ready.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

DrawingThread::~DrawingThread() {
  pages_.close();
  if (thread_.joinable()) thread_.join();
}

const Drawn& DrawingThread::finish() {
  pages_.close();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  return drawn_;
}

void DrawingThread::run(std::promise<void> ready) {
  bool is_ready = false;
  try {
    render::GlContext& context = window_.context();
    context.make_current();
    const WindowPage& first = pages_.next();  // the other thread waits
    render::RendererSettings settings{.width = first.width, .height = first.height};
    std::optional<render::Renderer> renderer(std::in_place, context, settings);
    if (draws_in_software(*renderer)) {
      settings.samples = 1;
      settings.occlusion_pixels = 4;
      settings.shadow_map_size /= 2;
      settings.soft_shadows = false;
      settings.coarse_pixels = 12;
      renderer.emplace(context, settings);
    }
    demo_.make_view(*renderer);
    is_ready = true;
    ready.set_value();
    draw_all(*renderer);
  } catch (...) {
    if (is_ready) {
      failure_ = std::current_exception();
      failed_ = true;
    } else {
      ready.set_exception(std::current_exception());
    }
  }
  window_.release();
}

void DrawingThread::draw_all(render::Renderer& renderer) {
  Rate rate;
  while (pages_.wait()) {
    const auto begin = Clock::now();
    const WindowPage& page = pages_.current();
    if (page.width != renderer.width() || page.height != renderer.height())
      renderer.resize(std::max(page.width, 1), std::max(page.height, 1));
    demo_.draw_published(page.look);
    renderer.draw_overlay(font_, page.overlay, &sheet_);
    window_.show(renderer);
    const auto end = Clock::now();
    rate.count(end);
    shown_per_second_ = rate.per_second();
    drawn_.picture_ms.push_back(Seconds(end - begin).count() * 1e3);
  }
  drawn_.upload_bytes = renderer.uploaded_bytes();
}

}  // namespace softcell::demos
