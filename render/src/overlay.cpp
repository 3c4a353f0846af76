#include "softcell/render/overlay.h"

#include <imgui.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

/// Where distributions have a font without serifs. Without one of them, text is in Dear ImGui's own letters, which are bitmaps.
constexpr std::array kFonts{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                            "/usr/share/fonts/TTF/DejaVuSans.ttf",
                            "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"};

void add_font(ImFontAtlas& atlas, float scale) {
  for (const char* const file : kFonts) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) continue;
    if (atlas.AddFontFromFileTTF(file, std::floor(14 * scale)) != nullptr) return;
  }
  ImFontConfig own;
  own.SizePixels = std::floor(13 * scale);
  atlas.AddFontDefault(&own);
}

}  // namespace

Overlay::Overlay(float scale) : context_(ImGui::CreateContext()) {
  SC_ASSERT(scale > 0, "a font scaled by {}", scale);
  make_current();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // windows stand where the program puts them
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  add_font(*io.Fonts, scale);
  unsigned char* coverage = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsAlpha8(&coverage, &width, &height);
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 6;
  style.WindowBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg] = {0.07f, 0.08f, 0.10f, 0.78f};
  style.ScaleAllSizes(scale);
}

Overlay::~Overlay() { ImGui::DestroyContext(context_); }

void* Overlay::sheet() {
  static char its_address;
  return &its_address;
}

void Overlay::make_current() { ImGui::SetCurrentContext(context_); }

OverlayFont Overlay::font() const {
  SC_ASSERT(ImGui::GetCurrentContext() == context_,
            "the font of the overlay at {}, which is not the current one", static_cast<const void*>(this));
  const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const auto size = static_cast<std::size_t>(atlas.TexWidth) * static_cast<std::size_t>(atlas.TexHeight);
  return {atlas.TexWidth, atlas.TexHeight, {atlas.TexPixelsAlpha8, size}};
}

void Overlay::begin(int width, int height, float seconds) {
  make_current();
  ImGuiIO& io = ImGui::GetIO();
  SC_ASSERT(width >= 0 && height >= 0 && seconds > 0, "{} by {} pixels, {} seconds since the last frame",
            width, height, seconds);
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = seconds;
  ImGui::NewFrame();
}

const OverlayMesh& Overlay::end() {
  ImGui::Render();
  const ImDrawData& data = *ImGui::GetDrawData();
  mesh_.vertices.clear();
  mesh_.indices.clear();
  mesh_.commands.clear();
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    const auto first_vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto first_index = static_cast<std::uint32_t>(mesh_.indices.size());
    for (const ImDrawVert& v : list.VtxBuffer)
      mesh_.vertices.push_back({v.pos.x, v.pos.y, v.uv.x, v.uv.y, v.col});
    for (const ImDrawIdx index : list.IdxBuffer) mesh_.indices.push_back(index);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const std::uint32_t begin = first_index + command.IdxOffset;
      for (std::uint32_t i = begin; i < begin + command.ElemCount; ++i) {
        mesh_.indices[i] += first_vertex + command.VtxOffset;
      }
      mesh_.commands.push_back({.left = static_cast<int>(command.ClipRect.x),
                                .top = static_cast<int>(command.ClipRect.y),
                                .right = static_cast<int>(command.ClipRect.z),
                                .bottom = static_cast<int>(command.ClipRect.w),
                                .first_index = begin,
                                .index_count = command.ElemCount,
                                .of_sheet = command.GetTexID() == sheet()});
    }
  }
  return mesh_;
}

}  // namespace softcell::render
