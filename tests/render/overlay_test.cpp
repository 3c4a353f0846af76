#include "softcell/render/overlay.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <imgui.h>

#include "pinned_context.h"
#include "support/golden.h"
#include "test_scene.h"

namespace softcell::render {
namespace {

/// A window with text, a table and a plot, at fixed places.
const OverlayMesh& example(Overlay& overlay, int width, int height) {
  overlay.begin(width, height, 1.0f / 60);
  ImGui::SetNextWindowPos({8, 8});
  ImGui::SetNextWindowSize({150, 96});
  ImGui::Begin("Statistics", nullptr, ImGuiWindowFlags_NoDecoration);
  ImGui::TextUnformatted("132 particles");
  if (ImGui::BeginTable("times", 2)) {
    for (const char* cell : {"PPU", "0.42 ms", "SPE", "0.17 ms"}) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(cell);
    }
    ImGui::EndTable();
  }
  constexpr float kValues[] = {1, 3, 2, 4, 2, 5};
  ImGui::PlotHistogram("##frames", kValues, 6, 0, nullptr, 0, 6, {130, 24});
  ImGui::End();
  return overlay.end();
}

TEST(Overlay, LooksAsItDidWhenSomebodyLookedAtIt) {
  Renderer renderer(test::pinned_context(), {.width = 320, .height = 180});
  const test::TestScene scene(renderer, 1);
  renderer.render(scene.frame());
  Overlay overlay;
  const OverlayMesh& mesh = example(overlay, renderer.width(), renderer.height());
  renderer.draw_overlay(overlay.font(), mesh);
  EXPECT_TRUE(softcell::test::compare_with_golden(renderer.pixels(), "overlay"));
}

TEST(Overlay, LeavesTheNextFrameAsItWouldBeWithoutIt) {
  Renderer renderer(test::pinned_context(), {.width = 320, .height = 180});
  const test::TestScene scene(renderer, 1);
  renderer.render(scene.frame());
  const Image before = renderer.pixels();
  Overlay overlay;
  renderer.draw_overlay(overlay.font(), example(overlay, 320, 180));
  EXPECT_NE(renderer.pixels().rgba, before.rgba);
  renderer.render(scene.frame());
  EXPECT_EQ(renderer.pixels().rgba, before.rgba);
}

TEST(Overlay, ShowsPartsOfTheSheetOfPictures) {
  Renderer renderer(test::pinned_context(), {.width = 64, .height = 64});
  const test::TestScene scene(renderer, 1);
  Image sheet(2, 4);  // red above green
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 2; ++x) {
      sheet.pixel(x, y)[y < 2 ? 0 : 1] = 200;
      sheet.pixel(x, y)[3] = 255;
    }
  }
  Overlay overlay;
  overlay.begin(64, 64, 0.1f);
  ImGui::GetForegroundDrawList()->AddImage(Overlay::sheet(), {8, 8}, {24, 24}, {0, 0}, {1, 0.5f});
  ImGui::GetForegroundDrawList()->AddText({8, 30}, IM_COL32_WHITE, "x");
  ImGui::GetForegroundDrawList()->AddImage(Overlay::sheet(), {40, 8}, {56, 24}, {0, 0.6f}, {1, 1});
  const OverlayMesh& mesh = overlay.end();
  renderer.render(scene.frame());
  const Image before = renderer.pixels();
  renderer.draw_overlay(overlay.font(), mesh, &sheet);
  const Image with = renderer.pixels();
  const auto is = [](const std::uint8_t* p, int red, int green) {
    return p[0] == red && p[1] == green && p[2] == 0;
  };
  EXPECT_TRUE(is(with.pixel(16, 12), 200, 0));
  EXPECT_TRUE(is(with.pixel(48, 20), 0, 200));
  EXPECT_NE(with.rgba, before.rgba);
  renderer.render(scene.frame());
  renderer.draw_overlay(overlay.font(), mesh);
  const Image without = renderer.pixels();
  for (const int x : {16, 48}) {
    for (int c = 0; c < 4; ++c)
      EXPECT_EQ(without.pixel(x, 16)[c], before.pixel(x, 16)[c]) << "no sheet, no picture";
  }
}

TEST(Overlay, DrawsNothingWithoutWidgets) {
  Renderer renderer(test::pinned_context(), {.width = 64, .height = 64});
  const test::TestScene scene(renderer, 1);
  renderer.render(scene.frame());
  const Image before = renderer.pixels();
  Overlay overlay(2);
  overlay.begin(64, 64, 0.1f);
  renderer.draw_overlay(overlay.font(), overlay.end());
  EXPECT_EQ(renderer.pixels().rgba, before.rgba);
}

TEST(Renderer, ResizesItsPictures) {
  Renderer renderer(test::pinned_context(), {.width = 320, .height = 180});
  const test::TestScene scene(renderer, 1);
  renderer.render(scene.frame());
  const Image first = renderer.pixels();
  renderer.resize(200, 100);
  renderer.render(scene.frame());
  EXPECT_EQ(renderer.pixels().width, 200);
  EXPECT_EQ(renderer.pixels().height, 100);
  renderer.resize(320, 180);
  renderer.render(scene.frame());
  EXPECT_EQ(renderer.pixels().rgba, first.rgba);
  EXPECT_THROW(renderer.resize(0, 100), std::runtime_error);
  EXPECT_EQ(renderer.width(), 320);
}

}  // namespace
}  // namespace softcell::render
