#include "play.h"

#include <SDL.h>

#include <chrono>
#include <limits>
#include <optional>

#include "controllers.h"
#include "demo/frame_clock.h"
#include "drawing_thread.h"
#include "input/user_input.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

/// One scene in the window.
class PlayedScene {
 public:
  /// @param frames  to be played; without, a replay's, or until the user ends it
  PlayedScene(render::Window& window, Demo& demo, const std::optional<int>& frames)
      : window_(window), demo_(demo), drawing_(window, demo) {
    SC_ASSERT(!frames || *frames >= 0, "{} frames are to be played", frames.value_or(0));
    record_.asked_frames = frames;
    if (!frames && demo.replays()) record_.asked_frames = demo.frames();
  }

  void handle(const SDL_Event& event) { demo_.input().handle(event); }

  void step() {
    const FrameTimes times = demo_.step();
    record_.add(times);
    demo_.publish();
    drawing_.next_page() = pages_.next(demo_, times, demo_.input().look(), window_.width(), window_.height());
    drawing_.show();
  }

  bool ends() const {
    const int last = record_.asked_frames.value_or(std::numeric_limits<int>::max());
    return drawing_.failed() || demo_.input().wants_to_quit() || record_.frames >= last;
  }

  RunRecord finish() {
    const Drawn& drawn = drawing_.finish();
    record_.picture_ms = drawn.picture_ms;
    record_.upload_bytes = drawn.upload_bytes;
    record_.seconds = std::chrono::duration<double>(FrameClock::Clock::now() - begin_).count();
    demo_.stop();
    return std::move(record_);
  }

 private:
  render::Window& window_;
  Demo& demo_;
  DrawingThread drawing_;
  DemoPages pages_;
  RunRecord record_;
  FrameClock::Clock::time_point begin_ = FrameClock::Clock::now();
};

}  // namespace

Run play(const WindowOptions& options, const std::vector<MakeDemo>& scenes, const SimulationOptions& how,
         const std::function<bool()>& interrupted) {
  SC_ASSERT(!scenes.empty(), "no scene for the window '{}'", options.title);
  SC_ASSERT(static_cast<bool>(interrupted), "nobody can interrupt the {} scenes of '{}'", scenes.size(),
            options.title);
  SC_ASSERT(options.width > 0 && options.height > 0, "a window of {} by {} pixels", options.width,
            options.height);
  render::Window window({.title = options.title, .width = options.width, .height = options.height});
  Controllers controllers;
  FrameClock clock;
  std::optional<Look> look;
  for (std::size_t number = 0;; number = (number + 1) % scenes.size()) {
    Run run{.demo = scenes[number](how), .record = {}};
    run.record.interrupted = interrupted();
    if (run.record.interrupted) return run;
    if (look) run.demo->input().set_look(*look);
    PlayedScene scene(window, *run.demo, options.frames);
    bool next = false;
    run_recorded(*run.demo, [&] {
      while (!next && !scene.ends() && !interrupted()) {
        clock.wait();
        SDL_Event event;
        while (SDL_PollEvent(&event) != 0) {
          controllers.handle(event);
          scene.handle(event);
        }
        scene.step();
        next = run.demo->input().wants_next_scene() && scenes.size() > 1;
      }
      run.record = scene.finish();
    });
    run.record.interrupted = interrupted();
    if (!next) return run;
    look = run.demo->input().look().with_scenes_camera();
  }
}

}  // namespace softcell::demos
