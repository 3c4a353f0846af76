// Drags a file onto a window of another program and drops it there, as a file manager does: the protocol XDND, version 5.
//
//   drop_file WINDOW X Y FILE
//
// (X, Y) is a point of the window, where the pointer goes, too. Status 0: the window has taken the file. 1: it did not want it. 2: a mistake.
// @source  https://freedesktop.org/wiki/Specifications/XDND

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

namespace {

struct CloseDisplay {
  void operator()(Display* display) const { XCloseDisplay(display); }
};

class Source {
 public:
  Source(Display* display, Window target, const std::string& file)
      : display_(display),
        target_(target),
        own_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)),
        uris_("file://" + file + "\r\n") {
    XSetSelectionOwner(display_, atom("XdndSelection"), own_, CurrentTime);
  }

  /// @return whether the window has taken the file
  bool drag_to(int x, int y) {
    XWarpPointer(display_, None, target_, 0, 0, 0, 0, x, y);
    int root_x = 0, root_y = 0;
    Window child = 0;
    XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), x, y, &root_x, &root_y, &child);
    send("XdndEnter", 5L << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
    send("XdndPosition", 0, (static_cast<long>(root_x) << 16) | root_y, CurrentTime,
         static_cast<long>(atom("XdndActionCopy")));
    for (;;) {
      XEvent event;
      XNextEvent(display_, &event);
      if (event.type == SelectionRequest) answer(event.xselectionrequest);
      if (event.type != ClientMessage) continue;
      const XClientMessageEvent& message = event.xclient;
      if (message.message_type == atom("XdndStatus")) {
        if ((message.data.l[1] & 1) == 0) return false;
        send("XdndDrop", 0, CurrentTime, 0, 0);
      } else if (message.message_type == atom("XdndFinished")) {
        return true;
      }
    }
  }

 private:
  Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

  void send(const char* type, long a, long b, long c, long d) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target_;
    event.xclient.message_type = atom(type);
    event.xclient.format = 32;
    const long data[5] = {static_cast<long>(own_), a, b, c, d};
    std::memcpy(event.xclient.data.l, data, sizeof data);
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }

  void answer(const XSelectionRequestEvent& request) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uris_.data()), static_cast<int>(uris_.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = request.requestor;
    event.xselection.selection = request.selection;
    event.xselection.target = request.target;
    event.xselection.property = request.property;
    event.xselection.time = request.time;
    XSendEvent(display_, request.requestor, False, NoEventMask, &event);
    XFlush(display_);
  }

  Display* display_;
  Window target_, own_;
  std::string uris_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "drop_file WINDOW X Y FILE\n");
    return 2;
  }
  const std::unique_ptr<Display, CloseDisplay> display(XOpenDisplay(nullptr));
  if (!display) {
    std::fprintf(stderr, "drop_file: there is no display\n");
    return 2;
  }
  alarm(30);  // a window that does not answer ends it
  Source source(display.get(), std::strtoul(argv[1], nullptr, 0), argv[4]);
  return source.drag_to(std::atoi(argv[2]), std::atoi(argv[3])) ? 0 : 1;
}
