#pragma once
// Draws a demo into a window on a thread of its own, so that neither the simulation nor the user's input waits for a picture.

#include <atomic>
#include <cstdint>
#include <exception>
#include <future>
#include <thread>
#include <vector>

#include "demo/demo.h"
#include "demo/latest.h"
#include "scene/look.h"
#include "softcell/render/overlay_mesh.h"
#include "softcell/render/window.h"

namespace softcell::demos {

/// What is drawn over the newest published frame of a demo.
struct WindowPage {
  Look look;
  int width = 0, height = 0;  ///< of the window, pixels
  render::OverlayMesh overlay;
};

/// What was drawn.
struct Drawn {
  std::vector<double> picture_ms;  ///< of each picture
  std::uint64_t upload_bytes = 0;  ///< see render::Renderer::uploaded_bytes()
};

/// The thread that steps the demo and polls the window's events makes, uses and destroys this object. Meanwhile the window's GL context
/// belongs to the drawing thread.
class DrawingThread {
 public:
  /// Waits until the demo's view is made.
  /// @throws std::runtime_error  the window cannot draw.
  /// @param font,sheet  of the overlays; must outlive this object
  DrawingThread(render::Window& window, Demo& demo, const render::OverlayFont& font,
                const render::Image& sheet);
  /// Finishes the picture that is being drawn.
  ~DrawingThread();
  DrawingThread(const DrawingThread&) = delete;
  DrawingThread& operator=(const DrawingThread&) = delete;

  /// The page that is drawn over the next picture; the caller fills it.
  WindowPage& next_page() { return pages_.next(); }
  /// Makes the drawing thread draw the newest published frame of the demo with next_page() over it, unless a newer page is published first.
  void show() { pages_.publish(); }

  /// Waits for the picture that is being drawn. @throws  the exception of a picture that failed
  const Drawn& finish();
  bool failed() const { return failed_; }
  /// Pictures per second that the window showed recently.
  double shown_per_second() const { return shown_per_second_; }

 private:
  void run(std::promise<void> ready);
  void draw_all(render::Renderer& renderer);

  render::Window& window_;
  Demo& demo_;
  render::OverlayFont font_;
  const render::Image& sheet_;
  Latest<WindowPage> pages_;
  std::atomic<double> shown_per_second_ = 0;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  Drawn drawn_;
  std::thread thread_;
};

}  // namespace softcell::demos
