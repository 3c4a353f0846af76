#include "play.h"

#include <SDL.h>
#include <imgui.h>

#include <Eigen/Core>
#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "controllers.h"
#include "demo/frame_clock.h"
#include "demo/page.h"
#include "demo/panel.h"
#include "demo/scene_pictures.h"
#include "drawing_thread.h"
#include "input/user_input.h"
#include "notice.h"
#include "panel_input.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/render/overlay.h"

namespace softcell::demos {
namespace {

/// The overlays of a window, which all its scenes share.
struct Overlays {
  Overlays(float text_scale, std::vector<SceneTitle> scenes)
      : scale(text_scale), overlay(text_scale), panel(std::move(scenes), pictures) {}

  /// @return true: the event is for the panel
  bool handle(const SDL_Event& event, float density, WindowInput& scene) {
    if (!scene.look().menu) {  // except for the release of what went down on it
      if (event.type == SDL_KEYUP || event.type == SDL_MOUSEBUTTONUP) input.handle(event, density, panel);
      return false;
    }
    const bool closes = event.type == SDL_KEYDOWN && event.key.repeat == 0 && !panel.edits() &&
                        (event.key.keysym.sym == SDLK_ESCAPE || event.key.keysym.sym == SDLK_m);
    if (closes) {
      scene.do_now(Command::kMenu);
      return true;
    }
    if (event.type == SDL_KEYDOWN && event.key.repeat == 0 && event.key.keysym.sym == SDLK_F5) {
      scene.do_now(Command::kSaveScene);
      return true;
    }
    return input.handle(event, density, panel);
  }

  float scale;  // of text and sizes
  render::Overlay overlay;
  PanelInput input;  // for the overlay's context, which is current
  ScenePictures pictures;
  Panel panel;
  Notice notice;
};

bool is_scene_file(const std::filesystem::path& file) {
  return file.extension() == ".toml" || file.extension() == ".lua";
}

/// The file that was dropped onto the window. None: it is another event
std::optional<std::filesystem::path> dropped_file(const SDL_Event& event) {
  if (event.type != SDL_DROPFILE && event.type != SDL_DROPTEXT) return std::nullopt;
  const std::unique_ptr<char, decltype(&SDL_free)> name(event.drop.file, SDL_free);
  if (event.type == SDL_DROPTEXT || !name) return std::nullopt;
  return std::filesystem::path(name.get());
}

/// A window and what all its scenes share.
struct Stage {
  Stage(const WindowOptions& options, std::vector<SceneTitle> titles)
      : window({.title = options.title, .width = options.width, .height = options.height}),
        overlays(kTextScale * options.ui_scale.value_or(window.density()), std::move(titles)) {}

  render::Window window;
  Overlays overlays;
};

/// One scene in the window.
class PlayedScene {
 public:
  /// @param frames  after which the scene ends; none: after a replay's frames, or when the user ends it
  PlayedScene(render::Window& window, Demo& demo, const std::optional<int>& frames, Overlays& overlays)
      : window_(window),
        demo_(demo),
        overlays_(overlays),
        drawing_(window, demo, overlays.overlay.font(), overlays.pictures.sheet()) {
    SC_ASSERT(!frames || *frames >= 0, "{} frames are to be played", frames.value_or(0));
    record_.asked_frames = frames;
    if (!frames && demo.replays()) record_.asked_frames = demo.frames();
    // The user may have changed the window's size since it was opened.
    const Eigen::Vector2i size = window_size();
    SDL_Event resized{};
    resized.type = SDL_WINDOWEVENT;
    resized.window.event = SDL_WINDOWEVENT_SIZE_CHANGED;
    resized.window.data1 = size.x();
    resized.window.data2 = size.y();
    demo.input().handle(resized);
  }

  void handle(const SDL_Event& event) {
    if (!overlays_.handle(event, window_.density(), demo_.input())) demo_.input().handle(event);
  }

  void step() {
    if (demo_.input().poll_save()) save();
    if (demo_.input().look().knife && demo_.dimension() == 3 &&
        demo_.contacts() == ppu::ContactMethod::kSpheres) {
      demo_.input().do_now(Command::kKnife);
      overlays_.notice.show("bodies that touch with spheres cannot be cut; start with --contacts surface");
    }
    if (demo_.input().poll_pinned() && demo_.dimension() == 3 &&
        demo_.contacts() == ppu::ContactMethod::kSpheres)
      overlays_.notice.show("bodies that touch with spheres cannot be pinned; start with --contacts surface");
    const FrameTimes times = demo_.step();
    record_.add(times);
    demo_.publish();
    Page page = pages_.next(demo_, times, demo_.input().look(), window_.width(), window_.height());
    page.notice = overlays_.notice.next_frame();
    draw_overlay(page);
    drawing_.show();
  }

  void save() {
    try {
      overlays_.notice.show("saved as " + base::one_line(demo_.save_scene(std::nullopt).string()));
    } catch (const std::runtime_error& error) {
      overlays_.notice.show(base::one_line(error.what()));
    }
  }

  /// The overlay is made here and not where pictures are drawn, so that no click is lost however few pictures there are.
  void draw_overlay(const Page& page) {
    const float scale = overlays_.scale;
    overlays_.panel.follow(page);
    overlays_.overlay.make_current();
    overlays_.input.begin_frame();
    overlays_.overlay.begin(page.width, page.height, 1.0f / 60);
    draw_page(page, scale, drawing_.shown_per_second());
    overlays_.panel.draw(demo_, scale, page.width, page.height, demo_.input());
    WindowPage& next = drawing_.next_page();
    next.overlay = overlays_.overlay.end();
    next.look = page.look;
    next.width = page.width;
    next.height = page.height;
  }

  // The demos that replace this scene. Null: nothing replaces it; if that failed, the window says why.

  /// The demo of a scene file, or this scene with a body made of a model or a picture at the mouse.
  std::unique_ptr<Demo> with_file(const std::filesystem::path& file, const SimulationOptions& how) {
    if (is_scene_file(file)) return made([&] { return demo_.opened(file, how); });
    return changed({.kind = SceneChange::Kind::kFile, .file = file}, mouse(), how);
  }
  /// This scene with the change that the user has asked for in the menu or by keys.
  std::unique_ptr<Demo> with_change(const SimulationOptions& how) {
    std::optional<SceneChange> change = overlays_.panel.poll_change();
    if (demo_.input().poll_remove()) {
      const auto picked = demo_.picked();
      if (!picked) overlays_.notice.show("take hold of the soft body that is to be removed");
      if (picked) change = {.kind = SceneChange::Kind::kRemove, .body = picked->body};
    }
    if (!change) return nullptr;
    const Eigen::Vector2i size = window_size();
    return changed(*change, size / 2, how);
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
  Eigen::Vector2i window_size() const {
    Eigen::Vector2i size;
    SDL_GetWindowSize(window_.sdl(), &size.x(), &size.y());
    return size.cwiseMax(1);
  }
  /// The position of the mouse in the window, also while the user drags something from another window, of which SDL reports no motion.
  Eigen::Vector2i mouse() const {
    Eigen::Vector2i at, window;
    SDL_GetGlobalMouseState(&at.x(), &at.y());
    SDL_GetWindowPosition(window_.sdl(), &window.x(), &window.y());
    return (at - window).cwiseMax(0).cwiseMin(window_size());
  }
  std::unique_ptr<Demo> changed(SceneChange change, const Eigen::Vector2i& at, const SimulationOptions& how) {
    const Eigen::Vector2i size = window_size();
    change.x = at.x(), change.y = at.y();
    change.width = size.x(), change.height = size.y();
    return made([&] { return demo_.changed(change, how); });
  }
  template <class Make>
  std::unique_ptr<Demo> made(const Make& make) {
    try {
      return make();
    } catch (const std::exception& error) {
      overlays_.notice.show(base::one_line(error.what()));
      return nullptr;
    }
  }

  render::Window& window_;
  Demo& demo_;
  Overlays& overlays_;
  DrawingThread drawing_;
  DemoPages pages_;
  RunRecord record_;
  FrameClock::Clock::time_point begin_ = FrameClock::Clock::now();
};

/// What the user has chosen to see after a scene.
struct Next {
  std::unique_ptr<Demo> demo;         ///< none of the list of scenes; null: none
  std::optional<std::size_t> number;  ///< in the list of scenes: goes before `demo`
  bool same_scene = false;            ///< `demo` is of the scene that was played
  explicit operator bool() const { return demo || number; }
};

std::vector<SceneTitle> titles_of(const std::vector<NamedDemo>& scenes) {
  std::vector<SceneTitle> titles;
  for (const NamedDemo& scene : scenes) titles.push_back({scene.name, scene.title});
  if (titles.size() == 1) titles.clear();
  return titles;
}

/// Plays scenes in a window, one after the other.
class Player {
 public:
  /// All of these must outlive it.
  Player(const WindowOptions& options, const std::vector<NamedDemo>& scenes, const SimulationOptions& how,
         const std::function<bool()>& interrupted)
      : options_(options),
        scenes_(scenes),
        how_(how),
        interrupted_(interrupted),
        stage_(std::make_unique<Stage>(options, titles_of(scenes))) {}

  /// @return the run of the scene with which the program ends
  Run play() {
    std::optional<Look> look;
    std::unique_ptr<Demo> other;  // the next demo, if it is none of `scenes_`
    bool begins_paused = false;
    for (std::size_t number = 0;;) {
      Run run{.demo = other ? std::exchange(other, nullptr) : scenes_[number].make(how_), .record = {}};
      run.record.interrupted = interrupted_();
      if (run.record.interrupted) return run;
      if (look) run.demo->input().set_look(*look);
      if (std::exchange(begins_paused, false)) run.demo->input().do_now(Command::kPause);
      Next next = play_scene(run, number);
      run.record.interrupted = interrupted_();
      if (!next) return run;
      look = run.demo->input().look();
      look->stroke.reset();  // the next scene's knife did not begin it
      look->hands = {};
      if (next.demo && next.same_scene) {
        begins_paused = run.demo->paused();
      } else {
        look = look->with_scenes_camera();
      }
      if (next.number)
        number = *next.number;
      else
        other = std::move(next.demo);
    }
  }

 private:
  /// Plays a run and completes its record. @param number  of its scene, or of the last one that was in the list
  Next play_scene(Run& run, std::size_t number) {
    auto played = std::make_unique<PlayedScene>(stage_->window, *run.demo, options_.frames, stage_->overlays);
    Next next;
    try {
      run_recorded(*run.demo, [&] {
        play_frames(*played, *run.demo, number, next);
        run.record = played->finish();
      });
    } catch (...) {
      if (!stage_->window.lost()) throw;
      // A call for the display may never return, and what it uses stays until the program ends, which is now.
      static_cast<void>(played.release());
      static_cast<void>(stage_.release());
      run.demo.release()->stop();
      throw;
    }
    return next;
  }

  /// Plays until the scene ends, or the user has chosen what is next.
  void play_frames(PlayedScene& scene, Demo& demo, std::size_t number, Next& next) {
    Panel& panel = stage_->overlays.panel;
    while (!next && !scene.ends() && !interrupted_()) {
      clock_.wait();
      if (stage_->window.lost())
        throw std::runtime_error("the display of the window has gone; the demo ends here");
      handle_events(scene, next);
      scene.step();
      if (demo.input().wants_next_scene() && scenes_.size() > 1) next.number = (number + 1) % scenes_.size();
      if (const auto choice = panel.poll_choice()) next.number = *choice;
      if (const auto file = panel.poll_file(); file && !next)
        next = {.demo = scene.with_file(*file, how_), .number = {}, .same_scene = false};
      if (!next) next = {.demo = scene.with_change(how_), .number = {}, .same_scene = true};
    }
  }

  void handle_events(PlayedScene& scene, Next& next) {
    SDL_Event event;
    while (!next.demo && SDL_PollEvent(&event) != 0) {
      controllers_.handle(event);
      if (const auto file = dropped_file(event)) {
        next.same_scene = !is_scene_file(*file);
        next.demo = scene.with_file(*file, how_);
      } else {
        scene.handle(event);
      }
    }
  }

  const WindowOptions& options_;
  const std::vector<NamedDemo>& scenes_;
  const SimulationOptions& how_;
  const std::function<bool()>& interrupted_;
  std::unique_ptr<Stage> stage_;
  Controllers controllers_;
  FrameClock clock_;
};

}  // namespace

Run play(const WindowOptions& options, const std::vector<NamedDemo>& scenes, const SimulationOptions& how,
         const std::function<bool()>& interrupted) {
  SC_ASSERT(!scenes.empty(), "no scene for the window '{}'", options.title);
  SC_ASSERT(static_cast<bool>(interrupted), "nobody can interrupt the {} scenes of '{}'", scenes.size(),
            options.title);
  SC_ASSERT(options.width > 0 && options.height > 0, "a window of {} by {} pixels", options.width,
            options.height);
  SC_ASSERT(options.ui_scale.value_or(1) > 0, "menus scaled by {}", options.ui_scale.value_or(1));
  return Player(options, scenes, how, interrupted).play();
}

}  // namespace softcell::demos
