// Opens a window, shows the test scene in it until it has been asked to close or some seconds have passed,
// and says what it saw: for window_test.

#include <SDL.h>

#include <cstdio>
#include <cstring>
#include <exception>

#include "softcell/render/offscreen_context.h"
#include "softcell/render/window.h"
#include "test_scene.h"

int main(int argc, char** argv) {
  using namespace softcell::render;
  const bool once = argc > 1 && std::strcmp(argv[1], "once") == 0;
  try {
    pin_software_rasterizer();
    Window window({.title = "window probe", .width = 320, .height = 180});
    Renderer renderer(window.context(), {.width = window.width(), .height = window.height()});
    const test::TestScene scene(renderer, 1);
    std::printf("backend %s\n", renderer.description());
    const Uint32 begin = SDL_GetTicks();
    for (bool open = true; open && SDL_GetTicks() - begin < 45'000; open = !once) {
      renderer.render(scene.frame());
      window.show(renderer);
      std::printf("shown %d x %d\n", window.width(), window.height());
      std::fflush(stdout);
      SDL_Event event;
      bool closed = false;
      while (SDL_PollEvent(&event) != 0) {
        if (event.type == SDL_KEYDOWN) std::printf("key %s\n", SDL_GetKeyName(event.key.keysym.sym));
        if (event.type == SDL_MOUSEBUTTONDOWN) std::printf("click %d %d\n", event.button.x, event.button.y);
        closed |=
            event.type == SDL_QUIT || (event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE);
      }
      std::fflush(stdout);
      if (closed) break;
      renderer.resize(window.width(), window.height());
      SDL_Delay(10);
    }
    std::puts("closed");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
