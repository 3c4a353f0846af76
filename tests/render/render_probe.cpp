// Draws the test scene with one backend and prints the picture's hash: a process of its own, because a
// process can use one backend only. With a frame count it prints the time of a frame too, for measuring by
// hand.
//
//     render_probe osmesa|egl [--width N] [--height N] [--detail N] [--frames N] [--shadow N] [--samples N]
//     [--occlusion PIXELS] [--quick] [--native] [--out FILE.png]

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "softcell/render/offscreen_context.h"
#include "softcell/render/png_io.h"
#include "softcell/render/renderer.h"
#include "test_scene.h"

namespace {

using namespace softcell::render;

struct Options {
  Backend backend = Backend::kOsmesa;
  RendererSettings renderer{.width = 320, .height = 180};
  int detail = 1;
  int frames = 0;
  bool pinned = true;
  std::string out;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto number = [&] { return i + 1 < argc ? std::atoi(argv[++i]) : 0; };
    if (word == "egl") options.backend = Backend::kEgl;
    if (word == "--occlusion") options.renderer.occlusion_pixels = number();
    if (word == "--quick") options.renderer.soft_shadows = false;
    if (word == "--native") options.pinned = false;
    if (word == "--width") options.renderer.width = number();
    if (word == "--height") options.renderer.height = number();
    if (word == "--shadow") options.renderer.shadow_map_size = number();
    if (word == "--samples") options.renderer.samples = number();
    if (word == "--detail") options.detail = number();
    if (word == "--frames") options.frames = number();
    if (word == "--out" && i + 1 < argc) options.out = argv[++i];
  }
  return options;
}

double milliseconds_per_frame(Renderer& renderer, const FrameDescription& frame, int frames) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < frames; ++i) {
    renderer.render(frame);
    renderer.pixels();
  }
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / frames;
}

void run(const Options& options) {
  if (options.pinned) pin_software_rasterizer();
  const auto context = create_offscreen_context(options.backend);
  Renderer renderer(*context, options.renderer);
  const test::TestScene scene(renderer, options.detail);
  renderer.render(scene.frame());
  const Image& image = renderer.pixels();
  if (!options.out.empty()) write_png(options.out, image, PngEffort::kSmall);
  std::printf("%016llx %s\n", static_cast<unsigned long long>(image_hash(image)), renderer.description());
  if (options.frames > 0)
    std::printf("%.1f ms a frame\n", milliseconds_per_frame(renderer, scene.frame(), options.frames));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "render_probe: %s\n", error.what());
    return 1;
  }
}
