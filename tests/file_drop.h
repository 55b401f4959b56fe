// A file manager's half of drag and drop on X11 (the XDND protocol, version 5): drops files on a window as a user does;
// and a window manager's half of closing one.
#pragma once

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#undef None  // a macro of X.h, an enumerator of ours

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/virtual_screen.h"

namespace irad::test {

/// "file:///a%20b": every byte but letters, digits and /-._~ escaped (RFC 3986).
inline std::string fileUri(const std::filesystem::path& path) {
  std::string uri = "file://";
  for (const char c : path.string())
    uri += std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/-._~").find(c) != std::string_view::npos
               ? std::string(1, c)
               : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return uri;
}

/// The first visible window whose title holds `title`, a child of the root: there is no window manager. 0: none.
inline Window windowTitled(Display* x, const std::string& title) {
  Window found = 0, parent = 0, ignored = 0, *children = nullptr;
  unsigned count = 0;
  XQueryTree(x, DefaultRootWindow(x), &ignored, &parent, &children, &count);
  for (unsigned i = 0; i < count && !found; ++i) {
    XTextProperty name{};
    if (!XGetTextProperty(x, children[i], &name, XA_WM_NAME) || !name.value) continue;
    if (std::string_view(reinterpret_cast<char*>(name.value), name.nitems).find(title) != std::string_view::npos)
      found = children[i];
    XFree(name.value);
  }
  if (children) XFree(children);
  return found;
}

/// What a window manager sends when the window's button for closing it is pressed (ICCCM 4.2.8.1).
inline bool closeWindow(const std::string& display, const std::string& title) {
  const std::unique_ptr<Display, int (*)(Display*)> x(XOpenDisplay(display.c_str()), XCloseDisplay);
  const Window target = x ? windowTitled(x.get(), title) : 0;
  if (!target) return false;
  XEvent event{};
  event.xclient = {ClientMessage, 0, True, x.get(), target, XInternAtom(x.get(), "WM_PROTOCOLS", False), 32, {}};
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(x.get(), "WM_DELETE_WINDOW", False));
  event.xclient.data.l[1] = CurrentTime;
  return XSendEvent(x.get(), target, False, NoEventMask, &event) != 0;
}

/// Drops `files` on the middle of the first visible window whose title holds `title`. False: no such window, or it does
/// not take them within 10 s.
inline bool dropFiles(const std::string& display, const std::string& title,
                      const std::vector<std::filesystem::path>& files) {
  const std::unique_ptr<Display, int (*)(Display*)> x(XOpenDisplay(display.c_str()), XCloseDisplay);
  if (!x) return false;
  const Window root = DefaultRootWindow(x.get());
  const auto atom = [&](const char* name) { return XInternAtom(x.get(), name, False); };

  const Window target = windowTitled(x.get(), title);
  if (!target) return false;
  XWindowAttributes where;
  XGetWindowAttributes(x.get(), target, &where);

  const Window source = XCreateSimpleWindow(x.get(), root, 0, 0, 1, 1, 0, 0, 0);
  const Atom selection = atom("XdndSelection"), list = atom("text/uri-list");
  XSetSelectionOwner(x.get(), selection, source, CurrentTime);
  const auto send = [&](const char* type, long l1, long l2, long l3, long l4) {
    XEvent event{};
    event.xclient = {ClientMessage, 0, True, x.get(), target, atom(type), 32, {}};
    const long words[] = {static_cast<long>(source), l1, l2, l3, l4};
    std::copy(std::begin(words), std::end(words), event.xclient.data.l);
    XSendEvent(x.get(), target, False, NoEventMask, &event);
  };
  const long middle = long{where.x + where.width / 2} << 16 | (where.y + where.height / 2);
  send("XdndEnter", 5L << 24, static_cast<long>(list), 0, 0);
  send("XdndPosition", 0, middle, CurrentTime, static_cast<long>(atom("XdndActionCopy")));

  std::string uris;
  for (const std::filesystem::path& file : files) uris += fileUri(file) + "\r\n";
  for (const auto end = Clock::now() + std::chrono::seconds(10); Clock::now() < end; pause(0.01))
    while (XPending(x.get())) {
      XEvent event;
      XNextEvent(x.get(), &event);
      if (event.type == ClientMessage && event.xclient.message_type == atom("XdndStatus")) {
        if (!(event.xclient.data.l[1] & 1)) return false;  // not wanted here
        send("XdndDrop", 0, CurrentTime, 0, 0);
      } else if (event.type == SelectionRequest) {
        const XSelectionRequestEvent& r = event.xselectionrequest;
        XChangeProperty(x.get(), r.requestor, r.property, r.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(uris.data()), static_cast<int>(uris.size()));
        XEvent reply{};
        reply.xselection = {SelectionNotify, 0, True, x.get(), r.requestor, r.selection, r.target, r.property, r.time};
        XSendEvent(x.get(), r.requestor, False, NoEventMask, &reply);
      } else if (event.type == ClientMessage && event.xclient.message_type == atom("XdndFinished")) {
        return event.xclient.data.l[1] != 0;  // bit 0 by the protocol; GLFW 3.3 gives a count of bytes
      }
    }
  return false;
}

}  // namespace irad::test
