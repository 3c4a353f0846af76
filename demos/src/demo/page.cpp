#include "page.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frame_clock.h"
#include "input/key_bindings.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoNav;

/// Rows of a name and a text. Makes the letters smaller if the box would not fit into the window otherwise.
class Rows {
 public:
  void add(std::string name, std::string text) { rows_.emplace_back(std::move(name), std::move(text)); }

  /// @param room  for the box that it fills, pixels
  void draw(const char* id, const ImVec2& room) const {
    const ImGuiStyle& style = ImGui::GetStyle();
    ImGui::SetWindowFontScale(1);  // undoes the scale of the previous frame
    float names = 0, texts = 0;
    for (const auto& [name, text] : rows_) {
      names = std::max(names, ImGui::CalcTextSize(name.c_str()).x);
      texts = std::max(texts, ImGui::CalcTextSize(text.c_str()).x);
    }
    const ImVec2 padding = style.CellPadding;
    const float across = room.x - 2 * style.WindowPadding.x;
    const float row = (room.y - 2 * style.WindowPadding.y) / static_cast<float>(rows_.size());
    const float size = std::max(std::min({1.0f, across / (names + texts + 6 * padding.x),
                                          row / (ImGui::GetTextLineHeight() + 2 * padding.y)}),
                                kSmallest);
    ImGui::SetWindowFontScale(size);
    // Scales the space between rows as well: where there is little room, the letters matter most.
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(size * padding.x, size * padding.y));
    const bool is_open = ImGui::BeginTable(id, 2);
    ImGui::PopStyleVar();
    if (!is_open) return;
    for (const auto& [name, text] : rows_) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(name.c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(text.c_str());
    }
    ImGui::EndTable();
  }

 private:
  static constexpr float kSmallest = 0.2f;  // nobody could read smaller letters

  std::vector<std::pair<std::string, std::string>> rows_;
};

/// @param shown_per_second  none: no window shows it
Rows figures(const Page& page, const std::optional<double>& shown_per_second) {
  const double frame_ms = std::chrono::duration<double, std::milli>(FrameClock::kFrame).count();
  const double used_ms = page.times.physics_ms + page.times.ppu_ms;
  Rows rows;
  rows.add("scene", page.scene + (page.paused ? ", paused" : page.replays ? ", a replay" : ""));
  rows.add("particles", fmt::format("{} in {} {}", page.counts.particles, page.counts.soft_bodies,
                                    page.counts.soft_bodies == 1 ? "body" : "bodies"));
  rows.add("PPU", fmt::format("{:.2f} ms", page.times.ppu_ms));
  rows.add("physics", fmt::format("{:.2f} ms", page.times.physics_ms));
  rows.add("of a frame", fmt::format("{:.1f} %", 100 * used_ms / frame_ms));
  if (page.spes > 0) {
    rows.add("busiest SPE", fmt::format("{:.2f} ms", page.spe_ms));
    rows.add("DMA", fmt::format("{:.1f} KB a frame", static_cast<double>(page.dma_bytes) / 1000));
  }
  if (shown_per_second) rows.add("shown", fmt::format("{:.0f} pictures a second", *shown_per_second));
  return rows;
}

Rows help(int dimension) {
  Rows rows;
  for (const KeyBinding& binding : key_bindings()) {
    if ((binding.only_in_2d && dimension != 2) || (binding.only_in_3d && dimension != 3)) continue;
    const char* const button = button_name(binding.button);
    rows.add(binding.key_name, button != nullptr ? fmt::format("{} (controller: {})", binding.does, button)
                                                 : std::string(binding.does));
  }
  if (dimension == 2) {
    rows.add("mouse", "drag a body, and throw it; as a knife: cut along a line");
  } else {
    rows.add("mouse",
             "drag a body, and throw it; wheel meanwhile: farther, nearer; as a knife: cut along a line");
    rows.add("",
             "drag anything else: camera about the scene; middle button, or Shift: sideways; wheel: nearer");
    rows.add("right button", "look around; with W A S D Q E: fly");
    rows.add("arrows", "tilt the ground (controller: left stick, motion sensor)");
  }
  rows.add("controller", dimension == 2
                             ? "LT, RT / L2, R2: two hands, which its sticks move"
                             : "LT, RT / L2, R2: two hands, which its sticks move, D-pad: farther, nearer");
  return rows;
}

constexpr float kMargin = 10;  // at scale 1, pixels

template <class Draw>
void draw_box(const char* name, const ImVec2& position, const ImVec2& pivot, const Draw& draw) {
  ImGui::SetNextWindowPos(position, ImGuiCond_Always, pivot);
  ImGui::SetNextWindowBgAlpha(0.7f);
  if (ImGui::Begin(name, nullptr, kPlain)) draw();
  ImGui::End();
}

/// Draws the stroke that the knife is about to cut.
void draw_stroke(const Page& page, float scale) {
  const auto at = [&](const Eigen::Vector2f& share) {
    return ImVec2(share.x() * static_cast<float>(page.width), share.y() * static_cast<float>(page.height));
  };
  const ImVec2 from = at((*page.look.stroke)[0]), to = at((*page.look.stroke)[1]);
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.AddLine(from, to, IM_COL32(0, 0, 0, 140), 4 * scale);
  list.AddLine(from, to, IM_COL32(255, 255, 255, 255), 2 * scale);
}

/// A controller's hand: a ring, which is filled when the hand holds something.
void draw_hand(const Page& page, const PointingHand& hand, float scale) {
  const ImVec2 at(hand.at.x() * static_cast<float>(page.width),
                  hand.at.y() * static_cast<float>(page.height));
  const float radius = 9 * scale;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  if (hand.holds) list.AddCircleFilled(at, 0.6f * radius, IM_COL32(255, 255, 255, 230), 24);
  list.AddCircle(at, radius, IM_COL32(0, 0, 0, 140), 32, 4.5f * scale);
  list.AddCircle(at, radius, IM_COL32(255, 255, 255, 255), 32, 2 * scale);
}

/// The size without the margins.
ImVec2 room_in(float width, float height, float scale) {
  return {width - 2 * kMargin * scale, height - 2 * kMargin * scale};
}

/// @param width, height  of the picture, pixels
void draw_statistics_box(const Page& page, float scale, const std::optional<double>& shown_per_second,
                         int width, int height) {
  constexpr float kShareOfHeight = 0.6f;  // the hint and the messages of the window are below
  const ImVec2 room = room_in(static_cast<float>(width), kShareOfHeight * static_cast<float>(height), scale);
  draw_box("statistics", {kMargin * scale, kMargin * scale}, {0, 0},
           [&] { figures(page, shown_per_second).draw("figures", room); });
}

}  // namespace

void draw_statistics(const Page& page, float scale, render::Overlay& overlay, render::Renderer& renderer) {
  SC_ASSERT(scale > 0, "the figures of scene '{}' are scaled by {}", page.scene, scale);
  // Dear ImGui gives a box the size of its contents in the previous frame, and hides it in the first frame.
  for (const bool for_size : {true, false}) {
    overlay.begin(renderer.width(), renderer.height(), 1.0f / 60);
    draw_statistics_box(page, scale, std::nullopt, renderer.width(), renderer.height());
    const render::OverlayMesh& mesh = overlay.end();
    if (!for_size) renderer.draw_overlay(overlay.font(), mesh);
  }
}

void draw_page(const Page& page, float scale, double shown_per_second) {
  SC_ASSERT(scale > 0 && shown_per_second >= 0, "text scaled by {} over {} pictures a second", scale,
            shown_per_second);
  const float margin = kMargin * scale;
  const auto width = static_cast<float>(page.width), height = static_cast<float>(page.height);
  if (page.look.statistics && !page.look.help && !page.look.menu)
    draw_statistics_box(page, scale, shown_per_second, page.width, page.height);
  const bool knife = page.look.knife, hint = !page.look.help && !page.look.menu;
  if (!page.notice.empty()) {
    // Beside the menu, if that is open, and above the hint.
    const float left = page.look.menu ? std::min(kMenuWidth * scale, 0.7f * width) : 0;
    const float above =
        hint ? (knife ? 2 : 1) * ImGui::GetTextLineHeightWithSpacing() + 2 * ImGui::GetStyle().WindowPadding.y
             : 0;
    draw_box("notice", {(left + width) / 2, height - margin - above}, {0.5f, 1}, [&] {
      ImGui::PushTextWrapPos(std::max(0.8f * (width - left) - 2 * margin, 4 * margin));
      ImGui::TextUnformatted(page.notice.c_str());
      ImGui::PopTextWrapPos();
    });
  }
  if (page.look.help) {
    draw_box("help", {width / 2, height / 2}, {0.5f, 0.5f},
             [&] { help(page.dimension).draw("help", room_in(width, height, scale)); });
  }
  if (hint) {
    draw_box("hint", {margin, height - margin}, {0, 1}, [&] {
      if (knife) ImGui::TextUnformatted("Knife: draw a line over what to cut   K: hand again");
      ImGui::TextUnformatted("M: menu   F1: help");
    });
  }
  if (page.look.stroke) draw_stroke(page, scale);
  for (const auto& hand : page.look.hands)
    if (hand) draw_hand(page, *hand, scale);
}

Page DemoPages::next(const Demo& demo, const FrameTimes& times, const Look& look, int width, int height) {
  std::vector<ls_sim::SpeStatistics> now = demo.spe_statistics();
  SC_ASSERT(before_.empty() || before_.size() == now.size(), "the pages of {} SPEs follow a demo with {}",
            before_.size(), now.size());
  SC_ASSERT(width >= 0 && height >= 0, "a page of {} by {} pixels", width, height);
  before_.resize(now.size());
  Page page{.look = look,
            .width = width,
            .height = height,
            .scene = demo.scene_name(),
            .dimension = demo.dimension(),
            .counts = demo.counts(),
            .times = times,
            .paused = demo.paused(),
            .replays = demo.replays(),
            .spes = now.size(),
            .spe_ms = 0,
            .dma_bytes = 0};
  for (std::size_t i = 0; i < now.size(); ++i) {
    const std::chrono::duration<double, std::milli> busy = now[i].busy - before_[i].busy;
    page.spe_ms = std::max(page.spe_ms, busy.count());
    page.each_spe_ms.push_back(busy.count());
    page.dma_bytes += now[i].dma.bytes() - before_[i].dma.bytes();
  }
  before_ = std::move(now);
  return page;
}

}  // namespace softcell::demos
