#include "play.h"

#include <SDL.h>
#include <imgui.h>

#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "controllers.h"
#include "demo/frame_clock.h"
#include "demo/page.h"
#include "demo/panel.h"
#include "drawing_thread.h"
#include "input/user_input.h"
#include "panel_input.h"
#include "softcell/base/assert.h"
#include "softcell/render/overlay.h"

namespace softcell::demos {
namespace {

/// What stands over all scenes of a window.
struct Overlays {
  Overlays(float scale, std::vector<SceneTitle> scenes) : overlay(scale), panel(std::move(scenes)) {}

  /// @return true: the event is the panel's
  bool take(const SDL_Event& event, float density, WindowInput& scene) {
    if (!scene.look().menu) {  // what went down on it comes up, though
      if (event.type == SDL_KEYUP || event.type == SDL_MOUSEBUTTONUP) input.handle(event, density, panel);
      return false;
    }
    const bool closes = event.type == SDL_KEYDOWN && event.key.repeat == 0 && !ImGui::IsAnyItemActive() &&
                        (event.key.keysym.sym == SDLK_ESCAPE || event.key.keysym.sym == SDLK_m);
    if (closes) {
      scene.do_now(Command::kMenu);
      return true;
    }
    return input.handle(event, density, panel);
  }

  render::Overlay overlay;
  PanelInput input;  // of the overlay's context, which is current
  Panel panel;
};

/// One scene in the window.
class PlayedScene {
 public:
  /// @param frames  to be played; without, a replay's, or until the user ends it
  PlayedScene(render::Window& window, Demo& demo, const std::optional<int>& frames, Overlays& overlays)
      : window_(window), demo_(demo), overlays_(overlays), drawing_(window, demo, overlays.overlay.font()) {
    SC_ASSERT(!frames || *frames >= 0, "{} frames are to be played", frames.value_or(0));
    record_.asked_frames = frames;
    if (!frames && demo.replays()) record_.asked_frames = demo.frames();
  }

  void handle(const SDL_Event& event) {
    if (!overlays_.take(event, window_.density(), demo_.input())) demo_.input().handle(event);
  }

  void step() {
    const FrameTimes times = demo_.step();
    record_.add(times);
    demo_.publish();
    draw_overlay(pages_.next(demo_, times, demo_.input().look(), window_.width(), window_.height()));
    drawing_.show();
  }

  /// Here and not where pictures are drawn, however few these are: no click is lost.
  void draw_overlay(const Page& page) {
    const float scale = kTextScale * window_.density();
    overlays_.panel.follow(page);
    overlays_.overlay.make_current();
    overlays_.input.begin_frame();
    overlays_.overlay.begin(page.width, page.height, 1.0f / 60);
    draw_page(page, scale, drawing_.shown_per_second());
    overlays_.panel.draw(demo_, scale, page.height, demo_.input());
    WindowPage& next = drawing_.next_page();
    next.overlay = overlays_.overlay.end();
    next.look = page.look;
    next.width = page.width;
    next.height = page.height;
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
  Overlays& overlays_;
  DrawingThread drawing_;
  DemoPages pages_;
  RunRecord record_;
  FrameClock::Clock::time_point begin_ = FrameClock::Clock::now();
};

}  // namespace

Run play(const WindowOptions& options, const std::vector<NamedDemo>& scenes, const SimulationOptions& how,
         const std::function<bool()>& interrupted) {
  SC_ASSERT(!scenes.empty(), "no scene for the window '{}'", options.title);
  SC_ASSERT(static_cast<bool>(interrupted), "nobody can interrupt the {} scenes of '{}'", scenes.size(),
            options.title);
  SC_ASSERT(options.width > 0 && options.height > 0, "a window of {} by {} pixels", options.width,
            options.height);
  render::Window window({.title = options.title, .width = options.width, .height = options.height});
  std::vector<SceneTitle> titles;
  for (const NamedDemo& scene : scenes) titles.push_back({scene.name, scene.title});
  if (titles.size() == 1) titles.clear();
  Overlays overlays(kTextScale * window.density(), std::move(titles));
  Controllers controllers;
  FrameClock clock;
  std::optional<Look> look;
  for (std::size_t number = 0;;) {
    Run run{.demo = scenes[number].make(how), .record = {}};
    run.record.interrupted = interrupted();
    if (run.record.interrupted) return run;
    if (look) run.demo->input().set_look(*look);
    PlayedScene scene(window, *run.demo, options.frames, overlays);
    bool next = false;
    std::size_t chosen = (number + 1) % scenes.size();
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
        if (const auto choice = overlays.panel.take_choice()) {
          next = true;
          chosen = *choice;
        }
      }
      run.record = scene.finish();
    });
    run.record.interrupted = interrupted();
    if (!next) return run;
    number = chosen;
    look = run.demo->input().look().with_scenes_camera();
  }
}

}  // namespace softcell::demos
