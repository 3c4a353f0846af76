#pragma once
// Draws a demo into a window on a thread of its own, so that the simulation and the user's input wait for no
// picture.

#include <atomic>
#include <cstdint>
#include <exception>
#include <future>
#include <thread>
#include <vector>

#include "demo/demo.h"
#include "demo/latest.h"
#include "demo/page.h"
#include "softcell/render/window.h"

namespace softcell::demos {

/// What drawing has come to.
struct Drawn {
  std::vector<double> picture_ms;  ///< of each picture
  std::uint64_t upload_bytes = 0;  ///< see render::Renderer::uploaded_bytes()
};

/// Made, used and destroyed by the thread that steps the demo and polls the window's events. While it lives,
/// the window's context is this thread's.
class DrawingThread {
 public:
  /// Returns when the demo's view is made.
  /// @throws std::runtime_error  the window cannot draw.
  DrawingThread(render::Window& window, Demo& demo);
  /// Ends after the picture in work.
  ~DrawingThread();
  DrawingThread(const DrawingThread&) = delete;
  DrawingThread& operator=(const DrawingThread&) = delete;

  /// To be filled: what stands over the next picture.
  Page& next_page() { return pages_.next(); }
  /// Has the newest published frame of the demo drawn, under next_page(), unless a newer one comes first.
  void show() { pages_.publish(); }

  /// Waits for the picture in work. @throws what went wrong with one
  const Drawn& finish();
  bool failed() const { return failed_; }

 private:
  void run(std::promise<void> ready);
  void draw_all(render::Renderer& renderer, float scale);

  render::Window& window_;
  Demo& demo_;
  Latest<Page> pages_;
  float scale_;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  Drawn drawn_;
  std::thread thread_;
};

}  // namespace softcell::demos
