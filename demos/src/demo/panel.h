#pragma once
// The menu at the side of a window: scenes, time, gravity, materials, and a graph of the times of each frame. It is made with Dear ImGui
// and works with the mouse or with the keyboard alone.

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "demo.h"
#include "input/user_input.h"
#include "page.h"
#include "scene_pictures.h"

namespace softcell::demos {

/// A scene that the user may choose.
struct SceneTitle {
  std::string name, title;
};

/// The menu turns what the user does in it into commands and events of the input. Used by one thread.
class Panel {
 public:
  /// @param scenes    none: this run has one scene  @param pictures  of the scenes; must outlive this object
  Panel(std::vector<SceneTitle> scenes, const ScenePictures& pictures)
      : scenes_(std::move(scenes)), pictures_(pictures) {}

  /// Call it once per frame, whether or not the panel is drawn: the graph shows all frames.
  void follow(const Page& page);

  /// Draws the panel; call it between begin() and end() of an overlay. Draws nothing while Look::menu is off.
  /// @param scale  of text and sizes  @param width,height  of the window, pixels
  void draw(const Demo& demo, float scale, int width, int height, WindowInput& input);

  /// Whether a point of the window, in pixels, is on the panel as it was last drawn.
  bool contains(float x, float y) const;

  /// Whether Escape ends something on the panel as it was last drawn: a slider that is being changed, or an open list.
  bool edits() const { return edits_; }

  /// The number of the scene that the user has chosen. Reading it clears the choice.
  std::optional<std::size_t> poll_choice() { return std::exchange(choice_, std::nullopt); }

  /// The scene file that the user has chosen. Reading it clears the choice.
  std::optional<std::filesystem::path> poll_file() { return std::exchange(file_, std::nullopt); }

  /// The change of the scene that the user has asked for, without its point of the window. Reading it clears the request.
  std::optional<SceneChange> poll_change() { return std::exchange(change_, std::nullopt); }

 private:
  static constexpr std::size_t kFrames = 180;  // of the graph
  static constexpr std::size_t kParts = 5;

  /// A slider for a value that an event changes. @param format  as for printf
  bool slider(const char* name, float& value, float low, float high, const char* format,
              bool logarithmic = false);
  void draw_scenes(const Demo& demo, float scale, bool opens);
  bool draw_scene(const SceneTitle& scene, bool is_current, float scale) const;
  void draw_time(const Demo& demo, WindowInput& input);
  void draw_material(const Demo& demo, WindowInput& input);
  void draw_density(const BodyMaterial& shown, std::uint32_t changed, int dimension);
  void draw_plasticity(const BodyMaterial& shown, std::uint32_t changed, WindowInput& input);
  void draw_bodies(const Demo& demo, WindowInput& input);
  void draw_picked(const Demo& demo);
  void draw_graph(float scale) const;

  std::vector<SceneTitle> scenes_;
  const ScenePictures& pictures_;
  std::vector<OwnScene> own_scenes_;  // as they were when the menu was opened
  std::optional<std::size_t> choice_;
  std::optional<std::filesystem::path> file_;
  std::optional<SceneChange> change_;
  std::optional<float> density_;  // while its slider is dragged
  int shape_ = 0;                 // of a body to add
  float alpha_ = 0.5f;            // of a body to add
  bool was_open_ = false, edits_ = false;
  std::array<float, 4> area_{};  // left, top, right, bottom
  int body_ = -1;                // the body whose material is shown; -1: all bodies
  int stiffness_by_ = 0;         // alpha, frequency, modulus
  std::array<std::array<float, kParts>, kFrames> milliseconds_{};
  std::size_t next_ = 0;
  std::vector<double> spe_ms_;
};

}  // namespace softcell::demos
