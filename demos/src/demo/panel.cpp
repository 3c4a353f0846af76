#include "panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "scene/frame_time.h"
#include "softcell/base/assert.h"
#include "softcell/render/overlay.h"

namespace softcell::demos {
namespace {

constexpr float kPictureHeight = 50;  // of a scene in the list, at scale 1, pixels
constexpr float kSceneRows = 3.5f;    // rows that are visible at a time
constexpr float kFrameMs = 1000.0f / 60;
constexpr float kGraphMs = 2 * kFrameMs;  // the height of the graph

struct Part {
  const char* name;
  ImU32 colour;
};
// The same parts as in the figures of a run; docs/guide/playing.md.
constexpr std::array<Part, 5> kDrawnParts{{{"rigid bodies", IM_COL32(230, 150, 60, 255)},
                                           {"contacts", IM_COL32(210, 80, 80, 255)},
                                           {"shape matching", IM_COL32(90, 160, 230, 255)},
                                           {"copying, skinning", IM_COL32(120, 200, 120, 255)},
                                           {"waiting for SPEs", IM_COL32(150, 150, 160, 255)}}};

}  // namespace

void Panel::follow(const Page& page) {
  const FrameTimes& times = page.times;
  const std::array<double, kParts> parts{times.physics_ms, times.contacts_ms, times.solve_ms,
                                         times.gather_ms + times.apply_ms + times.skin_ms,
                                         times.solver_wait_ms + times.skin_wait_ms};
  static_assert(kDrawnParts.size() == kParts);
  std::ranges::transform(parts, milliseconds_[next_].begin(),
                         [](double ms) { return static_cast<float>(ms); });
  next_ = (next_ + 1) % kFrames;
  spe_ms_ = page.each_spe_ms;
}

void Panel::draw(const Demo& demo, float scale, int width, int height, WindowInput& input) {
  SC_ASSERT(scale > 0, "a panel scaled by {}", scale);
  const bool opens = input.look().menu && !was_open_;
  was_open_ = input.look().menu;
  edits_ = false;
  if (!was_open_) {
    area_ = {};
    return;
  }
  const float margin = 10 * scale, wanted = kMenuWidth * scale - margin;
  const float given = std::clamp(static_cast<float>(width) - 2 * margin, 1.0f, wanted);
  ImGui::SetNextWindowPos({margin, margin}, ImGuiCond_Always);
  ImGui::SetNextWindowSize({given, std::max(static_cast<float>(height) - 2 * margin, 1.0f)});
  // In a window that is too narrow, letters are smaller; the space between them is not.
  const float smaller = given < wanted ? std::max(0.85f * given / wanted, 0.2f) : 1;
  if (opens) ImGui::SetNextWindowFocus();
  bool open = true;
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("Menu (M)", &open, kFixed)) {
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    area_ = {at.x, at.y, at.x + size.x, at.y + size.y};
    ImGui::SetWindowFontScale(smaller);
    ImGui::PushItemWidth(130 * scale * smaller);
    if (!scenes_.empty()) draw_scenes(demo, scale * smaller, opens);
    draw_time(demo, input);
    draw_material(demo, input);
    draw_bodies(demo, input);
    draw_graph(scale * smaller);
    ImGui::PopItemWidth();
    edits_ = edits_ || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
  }
  ImGui::End();
  if (!open) input.do_now(Command::kMenu);
}

bool Panel::contains(float x, float y) const {
  return x >= area_[0] && y >= area_[1] && x < area_[2] && y < area_[3];
}

bool Panel::slider(const char* name, float& value, float low, float high, const char* format,
                   bool logarithmic) {
  const bool changed =
      ImGui::SliderFloat(name, &value, low, high, format,
                         ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
  edits_ = edits_ || ImGui::IsItemActive();
  return changed;
}

void Panel::draw_scenes(const Demo& demo, float scale, bool opens) {
  if (opens) own_scenes_ = demo.own_scenes();
  if (!ImGui::CollapsingHeader("Scenes", ImGuiTreeNodeFlags_DefaultOpen)) return;
  // Flattened, so that the arrow keys go on from the widgets around it.
  const float row = kPictureHeight * scale + ImGui::GetStyle().ItemSpacing.y;
  if (ImGui::BeginChild("scenes", {0, kSceneRows * row}, true, ImGuiWindowFlags_NavFlattened)) {
    if (!own_scenes_.empty()) ImGui::TextUnformatted("Scene files here");
    for (const OwnScene& own : own_scenes_)
      if (draw_scene({own.file.filename().string(), own.title}, false, scale)) file_ = own.file;
    if (!own_scenes_.empty()) ImGui::TextUnformatted("Scenes of softcell");
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
      const bool is_current = scenes_[i].name == demo.scene_name();
      if (draw_scene(scenes_[i], is_current, scale)) choice_ = i;
      if (is_current && opens && own_scenes_.empty()) ImGui::SetScrollHereY(0);
    }
  }
  ImGui::EndChild();
}

/// A row with the scene's picture, name and title. @return  whether the user chooses it
bool Panel::draw_scene(const SceneTitle& scene, bool is_current, float scale) const {
  const ImVec2 picture{kPictureHeight * scale * ScenePictures::kWidth / ScenePictures::kHeight,
                       kPictureHeight * scale};
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const bool chosen = ImGui::Selectable(("##" + scene.name).c_str(), is_current, 0, {0, picture.y});
  if (!ImGui::IsItemVisible()) return chosen;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end{at.x + picture.x, at.y + picture.y};
  if (const auto rectangle = pictures_.rectangle(scene.name)) {
    const auto& [left, top, right, bottom] = *rectangle;
    list.AddImage(render::Overlay::sheet(), at, end, {left, top}, {right, bottom});
  } else {
    list.AddRectFilled(at, end, IM_COL32(40, 48, 58, 255));
  }
  const float gap = ImGui::GetStyle().ItemSpacing.x, size = ImGui::GetFontSize();
  const ImVec2 text{end.x + gap, at.y};
  const ImVec4 clip{text.x, at.y, at.x + width, end.y};
  list.AddText(nullptr, size, text, ImGui::GetColorU32(ImGuiCol_Text), scene.name.c_str(), nullptr, 0, &clip);
  list.AddText(nullptr, 0.8f * size, {text.x, text.y + 1.1f * size}, ImGui::GetColorU32(ImGuiCol_Text, 0.7f),
               scene.title.c_str(), nullptr, std::max(clip.z - text.x, 1.0f), &clip);
  return chosen;
}

void Panel::draw_time(const Demo& demo, WindowInput& input) {
  if (!ImGui::CollapsingHeader("Time and gravity", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (ImGui::Button(demo.paused() ? "Continue" : "Pause")) input.do_now(Command::kPause);
  ImGui::SameLine();
  if (ImGui::Button("Step")) {
    if (!demo.paused()) input.do_now(Command::kPause);
    input.do_now(Command::kSingleStep);
  }
  ImGui::SameLine();
  if (ImGui::Button("Reset")) input.do_now(Command::kReset);
  ImGui::SameLine();
  if (ImGui::Button("Save scene")) input.do_now(Command::kSaveScene);
  const DemoSettings settings = demo.settings();
  float time_scale = settings.time_scale, gravity = settings.gravity;
  int substeps = settings.substeps;
  if (slider("time scale", time_scale, 0.05f, 2, "%.2f", true))
    input.change(Action::kTimeScale, 0, time_scale);
  if (ImGui::SliderInt("substeps", &substeps, 1, kMaxSubsteps, "%d", ImGuiSliderFlags_AlwaysClamp))
    input.change(Action::kSubsteps, 0, static_cast<float>(substeps));
  edits_ = edits_ || ImGui::IsItemActive();
  if (slider("gravity", gravity, 0, 30, "%.1f m/s\xC2\xB2")) input.set_strength_of_gravity(gravity);
}

void Panel::draw_material(const Demo& demo, WindowInput& input) {
  const std::vector<BodyMaterial> bodies = demo.materials();
  if (bodies.empty() || !ImGui::CollapsingHeader("Material", ImGuiTreeNodeFlags_DefaultOpen)) return;
  body_ = std::min(body_, static_cast<int>(bodies.size()) - 1);
  if (ImGui::BeginCombo("body", body_ < 0 ? "all" : bodies[static_cast<std::size_t>(body_)].name.c_str())) {
    if (ImGui::Selectable("all", body_ < 0)) body_ = -1;
    for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
      ImGui::PushID(b);
      if (ImGui::Selectable(bodies[static_cast<std::size_t>(b)].name.c_str(), body_ == b)) body_ = b;
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  const std::uint32_t changed = body_ < 0 ? kEveryBody : static_cast<std::uint32_t>(body_);
  const BodyMaterial& shown = bodies[static_cast<std::size_t>(std::max(body_, 0))];
  const float step = demo.settings().substep;
  ImGui::Combo("stiffness by", &stiffness_by_, "alpha\0frequency\0modulus\0");
  if (stiffness_by_ == 0) {
    float value = shown.alpha;
    if (slider("alpha", value, 0, 1, "%.3f")) input.change(Action::kAlpha, changed, value);
  } else if (stiffness_by_ == 1) {
    // No frequency exceeds that of alpha 1, which is a sixth of the rate of steps.
    float value = shown.frequency.value_or(0);
    if (slider("frequency", value, 0, 1 / (6 * step), shown.frequency ? "%.1f Hz" : "not set"))
      input.change(Action::kFrequency, changed, value);
  } else {
    float value = shown.modulus;
    if (slider("modulus", value, 0.001f * shown.most_modulus, shown.most_modulus, "%.0f m\xC2\xB2/s\xC2\xB2",
               true))
      input.change(Action::kModulus, changed, value);
  }
  float damping = shown.damping, friction = shown.friction;
  if (slider("damping", damping, 0, 1, "%.3f")) input.change(Action::kDamping, changed, damping);
  if (slider("friction", friction, 0, 2, "%.2f")) input.change(Action::kFriction, changed, friction);
  draw_density(shown, changed, demo.dimension());
  if (shown.can_be_plastic) draw_plasticity(shown, changed, input);
}

void Panel::draw_plasticity(const BodyMaterial& shown, std::uint32_t changed, WindowInput& input) {
  bool plastic = shown.plasticity.has_value();
  if (ImGui::Checkbox("plastic", &plastic))
    input.change(Action::kYield, changed, plastic ? ppu::Plasticity{}.yield : 0);
  if (!shown.plasticity) return;
  float yield = shown.plasticity->yield, creep = shown.plasticity->creep;
  if (slider("yield", yield, 0.001f, 1, "%.3f", true)) input.change(Action::kYield, changed, yield);
  if (slider("creep", creep, 0.1f, 1000, "%.1f 1/s", true)) input.change(Action::kCreep, changed, creep);
}

void Panel::draw_density(const BodyMaterial& shown, std::uint32_t changed, int dimension) {
  // Another density needs another model, so it is set once, when the user lets the slider go.
  float density = density_.value_or(shown.density);
  if (slider("density", density, 1, 5000, dimension == 3 ? "%.0f kg/m\xC2\xB3" : "%.0f kg/m\xC2\xB2", true))
    density_ = density;
  if (!ImGui::IsItemDeactivatedAfterEdit()) return;
  change_ = {.kind = SceneChange::Kind::kDensity, .body = changed, .number = density};
  density_.reset();
}

void Panel::draw_bodies(const Demo& demo, WindowInput& input) {
  if (!ImGui::CollapsingHeader("Bodies", ImGuiTreeNodeFlags_DefaultOpen)) return;
  bool knife = input.look().knife;
  if (ImGui::Checkbox("the mouse is a knife (K)", &knife)) input.do_now(Command::kKnife);
  const std::span<const std::string_view> shapes = demo.shapes();
  if (shapes.empty()) return;
  shape_ = std::min(shape_, static_cast<int>(shapes.size()) - 1);
  const std::string shown(shapes[static_cast<std::size_t>(shape_)]);
  if (ImGui::BeginCombo("shape", shown.c_str())) {
    for (int i = 0; i < static_cast<int>(shapes.size()); ++i) {
      const std::string name(shapes[static_cast<std::size_t>(i)]);
      if (ImGui::Selectable(name.c_str(), shape_ == i)) shape_ = i;
    }
    ImGui::EndCombo();
  }
  slider("its alpha", alpha_, 0, 1, "%.2f");
  if (ImGui::Button("Add")) change_ = {.kind = SceneChange::Kind::kShape, .name = shown, .number = alpha_};
  const std::optional<PickedParticle> picked = demo.picked();
  if (picked) {
    ImGui::SameLine();
    if (ImGui::Button("Remove")) change_ = {.kind = SceneChange::Kind::kRemove, .body = picked->body};
  }
  draw_picked(demo);
}

void Panel::draw_picked(const Demo& demo) {
  const auto vector = [&](const char* name, const Eigen::Vector3f& v) {
    if (demo.dimension() == 3) {
      ImGui::Text("%s %.3f %.3f %.3f", name, double{v.x()}, double{v.y()}, double{v.z()});
    } else {
      ImGui::Text("%s %.3f %.3f", name, double{v.x()}, double{v.y()});
    }
  };
  if (const std::optional<PickedContact> contact = demo.picked_contact()) {
    ImGui::TextWrapped("contact of %s with %s", contact->first.c_str(), contact->second.c_str());
    vector("at, m:", contact->position);
    vector("normal:", contact->normal);
    if (contact->impulse > 0)
      ImGui::Text("%.4g kg m/s a substep, %.4g N", double{contact->impulse}, double{contact->force});
    else
      ImGui::TextUnformatted("they do not press on each other now");
    return;
  }
  const std::optional<PickedParticle> picked = demo.picked();
  if (!picked) {
    ImGui::TextWrapped("Take hold of a soft body to see a particle's values.");
    return;
  }
  const std::vector<BodyMaterial> bodies = demo.materials();
  ImGui::Text("%s, particle %u, %.4g kg", bodies[picked->body].name.c_str(), picked->particle,
              double{picked->mass});
  vector("at, m:", picked->position);
  vector("speed, m/s:", picked->velocity);
  ImGui::Text("region: %zu particles, %.4g kg", picked->region, double{picked->region_mass});
  vector("speed, m/s:", picked->region_velocity);
}

void Panel::draw_graph(float scale) const {
  if (!ImGui::CollapsingHeader("Milliseconds", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = 80 * scale;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(20, 24, 30, 255));
  const float column = width / static_cast<float>(kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const auto& parts = milliseconds_[(next_ + i) % kFrames];
    float below = 0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const float low = height * std::min(below / kGraphMs, 1.0f);
      below += parts[part];
      const float high = height * std::min(below / kGraphMs, 1.0f);
      const float x = at.x + column * static_cast<float>(i);
      if (high > low)
        list.AddRectFilled({x, at.y + height - high}, {x + column, at.y + height - low},
                           kDrawnParts[part].colour);
    }
  }
  const float frame = at.y + height * (1 - kFrameMs / kGraphMs);
  list.AddLine({at.x, frame}, {at.x + width, frame}, IM_COL32(255, 255, 255, 120));
  ImGui::Dummy({width, height});
  const auto& last = milliseconds_[(next_ + kFrames - 1) % kFrames];
  for (std::size_t part = 0; part < last.size(); ++part) {
    ImGui::PushStyleColor(ImGuiCol_Text, kDrawnParts[part].colour);
    ImGui::Text("%5.2f  %s", static_cast<double>(last[part]), kDrawnParts[part].name);
    ImGui::PopStyleColor();
  }
  for (std::size_t spe = 0; spe < spe_ms_.size(); ++spe) {
    const auto busy = static_cast<float>(spe_ms_[spe]) / kFrameMs;
    ImGui::ProgressBar(std::min(busy, 1.0f), {-1, ImGui::GetTextLineHeight()},
                       fmt::format("SPE {}: {:.0f} %", spe, 100 * busy).c_str());
  }
}

}  // namespace softcell::demos
