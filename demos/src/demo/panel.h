#pragma once
// The menu at the side of a window: scenes, time, gravity, materials, and where the time goes. By Dear ImGui, with the mouse or by keyboard
// alone.

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

/// A scene to choose.
struct SceneTitle {
  std::string name, title;
};

/// Used by one thread. What the user does there becomes commands and events of the input.
class Panel {
 public:
  /// @param scenes    none: this run has one scene  @param pictures  of them; outlive this
  Panel(std::vector<SceneTitle> scenes, const ScenePictures& pictures)
      : scenes_(std::move(scenes)), pictures_(pictures) {}

  /// Call it once for each frame, drawn or not: the graph shows all of them.
  void follow(const Page& page);

  /// Between begin() and end() of an overlay. Draws nothing while Look::menu is off.
  /// @param scale  of text and sizes  @param width,height  of the window, pixels
  void draw(const Demo& demo, float scale, int width, int height, WindowInput& input);

  /// A point of the window, pixels, is on the panel as it was drawn last.
  bool contains(float x, float y) const;

  /// Whether Escape ends something on the panel, as it was drawn last: a slider that is being changed, or an open list.
  bool edits() const { return edits_; }

  /// The number of the scene that the user has chosen; asking forgets it.
  std::optional<std::size_t> take_choice() { return std::exchange(choice_, std::nullopt); }

  /// The scene file of the user's that is chosen; asking forgets it.
  std::optional<std::filesystem::path> take_file() { return std::exchange(file_, std::nullopt); }

  /// What the user wants added, removed or made heavier, without its point of the window; asking forgets it.
  std::optional<SceneChange> take_change() { return std::exchange(change_, std::nullopt); }

 private:
  static constexpr std::size_t kFrames = 180;  // of the graph
  static constexpr std::size_t kParts = 5;

  /// Of a value that an event changes. @param format  as printf's
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
  int shape_ = 0;                 // of a body to be added
  float alpha_ = 0.5f;            // likewise
  bool was_open_ = false, edits_ = false;
  std::array<float, 4> area_{};  // left, top, right, bottom
  int body_ = -1;                // whose material is shown; -1: all bodies'
  int stiffness_by_ = 0;         // alpha, frequency, modulus
  std::array<std::array<float, kParts>, kFrames> milliseconds_{};
  std::size_t next_ = 0;
  std::vector<double> spe_ms_;
};

}  // namespace softcell::demos
