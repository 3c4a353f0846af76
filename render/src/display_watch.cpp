#include "display_watch.h"

#include <SDL.h>
#include <SDL_syswm.h>
#include <dlfcn.h>
#include <poll.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace softcell::render {
namespace {

std::atomic<bool> display_lost{false};
std::thread::id polling_thread;
XIOErrorHandler usual_handler = nullptr;

bool is_polling_thread() { return std::this_thread::get_id() == polling_thread; }

int note_error(Display* display) {
  display_lost = true;
  return is_polling_thread() ? usual_handler(display) : 0;  // the usual one prints a line
}

/// In place of Xlib's own, which calls exit() at once. The polling thread gets the time to save what it has.
void end_later(Display* /*display*/, void* /*data*/) {
  constexpr std::chrono::seconds kToSave{10};
  if (!is_polling_thread()) std::this_thread::sleep_for(kToSave);
  std::exit(1);
}

}  // namespace

DisplayWatch::DisplayWatch(SDL_Window* window) {
  display_lost = false;
  polling_thread = std::this_thread::get_id();
  SDL_SysWMinfo info;
  SDL_VERSION(&info.version);
  if (SDL_GetWindowWMInfo(window, &info) != SDL_TRUE || info.subsystem != SDL_SYSWM_X11) return;
  connection_ = ConnectionNumber(info.info.x11.display);
  // SDL has loaded the library; softcell is not linked with it. Its versions before 1.7 lack the second function.
  void* const library = dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
  if (library == nullptr) return;
  const auto set_handler =
      reinterpret_cast<decltype(&XSetIOErrorHandler)>(dlsym(library, "XSetIOErrorHandler"));
  const auto set_exit_handler =
      reinterpret_cast<decltype(&XSetIOErrorExitHandler)>(dlsym(library, "XSetIOErrorExitHandler"));
  if (set_handler != nullptr && set_exit_handler != nullptr) {
    if (const XIOErrorHandler before = set_handler(note_error); before != note_error) usual_handler = before;
    set_exit_handler(info.info.x11.display, end_later, nullptr);
  }
  dlclose(library);
}

bool DisplayWatch::lost() const {
  if (display_lost) return true;
  if (connection_ < 0) return false;
  pollfd connection{connection_, 0, 0};
  return poll(&connection, 1, 0) > 0 && (connection.revents & (POLLHUP | POLLERR)) != 0;
}

}  // namespace softcell::render
