#include "page.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cstdarg>
#include <optional>
#include <utility>

#include "frame_clock.h"
#include "input/key_bindings.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoNav;

/// @param format  as printf's
IM_FMTARGS(2) void row(const char* name, const char* format, ...) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name);
  ImGui::TableNextColumn();
  std::va_list values;
  va_start(values, format);
  ImGui::TextV(format, values);
  va_end(values);
}

/// @param shown_per_second  none: no window shows it
void draw_figures(const Page& page, const std::optional<double>& shown_per_second) {
  const double frame_ms = std::chrono::duration<double, std::milli>(FrameClock::kFrame).count();
  const double used_ms = page.times.physics_ms + page.times.ppu_ms;
  if (!ImGui::BeginTable("figures", 2)) return;
  row("scene", "%s%s", page.scene.c_str(), page.paused ? ", paused" : page.replays ? ", a replay" : "");
  row("particles", "%zu in %zu %s", page.counts.particles, page.counts.soft_bodies,
      page.counts.soft_bodies == 1 ? "body" : "bodies");
  row("PPU", "%.2f ms", page.times.ppu_ms);
  row("physics", "%.2f ms", page.times.physics_ms);
  row("of a frame", "%.1f %%", 100 * used_ms / frame_ms);
  if (page.spes > 0) {
    row("busiest SPE", "%.2f ms", page.spe_ms);
    row("DMA", "%.1f KB a frame", static_cast<double>(page.dma_bytes) / 1000);
  }
  if (shown_per_second) row("shown", "%.0f pictures a second", *shown_per_second);
  ImGui::EndTable();
}

void draw_help(int dimension) {
  if (!ImGui::BeginTable("help", 2)) return;
  for (const KeyBinding& binding : key_bindings()) {
    if ((binding.only_in_2d && dimension != 2) || (binding.only_in_3d && dimension != 3)) continue;
    const char* const button = button_name(binding.button);
    if (button != nullptr) {
      row(binding.key_name, "%s (controller: %s)", binding.does, button);
    } else {
      row(binding.key_name, "%s", binding.does);
    }
  }
  if (dimension == 2) {
    row("mouse", "drag a body, and throw it");
  } else {
    row("mouse", "drag a body, and throw it; wheel meanwhile: farther, nearer");
    row("", "drag anything else: camera about the scene; middle button, or Shift: sideways; wheel: nearer");
    row("right button", "look around; with W A S D Q E: fly");
    row("arrows", "tilt the ground (controller: left stick, motion sensor)");
  }
  ImGui::EndTable();
}

constexpr float kMargin = 10;  // at scale 1, pixels

template <class Draw>
void draw_box(const char* name, const ImVec2& position, const ImVec2& pivot, const Draw& draw) {
  ImGui::SetNextWindowPos(position, ImGuiCond_Always, pivot);
  ImGui::SetNextWindowBgAlpha(0.7f);
  if (ImGui::Begin(name, nullptr, kPlain)) draw();
  ImGui::End();
}

void draw_statistics_box(const Page& page, float scale, const std::optional<double>& shown_per_second) {
  draw_box("statistics", {kMargin * scale, kMargin * scale}, {0, 0},
           [&] { draw_figures(page, shown_per_second); });
}

}  // namespace

void draw_statistics(const Page& page, float scale, render::Overlay& overlay, render::Renderer& renderer) {
  SC_ASSERT(scale > 0, "the figures of scene '{}' are scaled by {}", page.scene, scale);
  // Dear ImGui makes a box as large as what was in it the time before, and hides it the first time.
  for (const bool for_size : {true, false}) {
    overlay.begin(renderer.width(), renderer.height(), 1.0f / 60);
    draw_statistics_box(page, scale, std::nullopt);
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
    draw_statistics_box(page, scale, shown_per_second);
  if (!page.notice.empty()) {
    // Beside the menu, if that is open.
    const float left = page.look.menu ? kMenuWidth * scale : 0;
    draw_box("notice", {(left + width) / 2, height - margin}, {0.5f, 1}, [&] {
      ImGui::PushTextWrapPos(std::max(0.8f * (width - left) - 2 * margin, 20 * margin));
      ImGui::TextUnformatted(page.notice.c_str());
      ImGui::PopTextWrapPos();
    });
  }
  if (page.look.help) {
    draw_box("help", {width / 2, height / 2}, {0.5f, 0.5f}, [&] { draw_help(page.dimension); });
  } else {
    if (!page.look.menu)
      draw_box("hint", {margin, height - margin}, {0, 1},
               [] { ImGui::TextUnformatted("M: menu   F1: help"); });
  }
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
