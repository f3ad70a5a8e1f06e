// SPDX-License-Identifier: MIT
#include "x_client.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <poll.h>

#include <cstring>
#include <memory>

namespace afterglow {

namespace {

struct Closer {
  void operator()(Display* display) const { XCloseDisplay(display); }
};
using DisplayPtr = std::unique_ptr<Display, Closer>;

/// The top-level window of class "afterglow"; 0: none.
Window find_window(Display* display) {
  Window root = 0, parent = 0, *children = nullptr, found = 0;
  unsigned count = 0;
  if (!XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count)) return 0;
  for (unsigned i = 0; i < count; ++i) {
    XClassHint hint{};
    if (!XGetClassHint(display, children[i], &hint)) continue;
    if (hint.res_class && std::strcmp(hint.res_class, "afterglow") == 0) found = children[i];
    XFree(hint.res_name);
    XFree(hint.res_class);
  }
  XFree(children);
  return found;
}

Atom atom(Display* display, const char* name) { return XInternAtom(display, name, False); }

void send(Display* display, Window to, Atom type, std::initializer_list<long> data) {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = to;
  event.xclient.message_type = type;
  event.xclient.format = 32;
  int i = 0;
  for (const long value : data) event.xclient.data.l[i++] = value;
  XSendEvent(display, to, False, NoEventMask, &event);
  XFlush(display);
}

/// Waits for the next event of a type, up to 30 s; answers requests for the selection meanwhile.
bool await(Display* display, Atom message, const std::string& uri) {
  for (;;) {
    while (XPending(display) == 0) {
      pollfd fd{ConnectionNumber(display), POLLIN, 0};
      if (poll(&fd, 1, 30'000) <= 0) return false;
    }
    XEvent event;
    XNextEvent(display, &event);
    if (event.type == SelectionRequest) {
      const XSelectionRequestEvent& request = event.xselectionrequest;
      XChangeProperty(display, request.requestor, request.property, request.target, 8, PropModeReplace,
                      reinterpret_cast<const unsigned char*>(uri.data()), static_cast<int>(uri.size()));
      XEvent answer{};
      answer.xselection.type = SelectionNotify;
      answer.xselection.requestor = request.requestor;
      answer.xselection.selection = request.selection;
      answer.xselection.target = request.target;
      answer.xselection.property = request.property;
      answer.xselection.time = request.time;
      XSendEvent(display, request.requestor, False, NoEventMask, &answer);
      XFlush(display);
    }
    if (event.type == ClientMessage && event.xclient.message_type == message) return event.xclient.data.l[1] != 0;
  }
}

}  // namespace

bool ask_to_close(const std::string& name) {
  const DisplayPtr display(XOpenDisplay(name.c_str()));
  if (!display) return false;
  const Window window = find_window(display.get());
  if (!window) return false;
  send(display.get(), window, atom(display.get(), "WM_PROTOCOLS"),
       {static_cast<long>(atom(display.get(), "WM_DELETE_WINDOW")), CurrentTime});
  XSync(display.get(), False);
  return true;
}

bool drop_file(const std::string& name, const std::filesystem::path& file) {
  const DisplayPtr open(XOpenDisplay(name.c_str()));
  Display* display = open.get();
  if (!display) return false;
  const Window target = find_window(display);
  if (!target) return false;
  XWindowAttributes shape{};
  XGetWindowAttributes(display, target, &shape);
  const Window self = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0);
  const Atom list = atom(display, "text/uri-list"), copy = atom(display, "XdndActionCopy");
  XSetSelectionOwner(display, atom(display, "XdndSelection"), self, CurrentTime);
  const std::string uri = "file://" + file.string() + "\r\n";
  const long me = static_cast<long>(self);
  const long at = (static_cast<long>(shape.x + shape.width / 2) << 16) | (shape.y + shape.height / 2);
  send(display, target, atom(display, "XdndEnter"), {me, 5L << 24, static_cast<long>(list), 0, 0});
  send(display, target, atom(display, "XdndPosition"), {me, 0, at, CurrentTime, static_cast<long>(copy)});
  if (!await(display, atom(display, "XdndStatus"), uri)) return false;
  send(display, target, atom(display, "XdndDrop"), {me, 0, CurrentTime, 0, 0});
  return await(display, atom(display, "XdndFinished"), uri);
}

std::string window_title(const std::string& name) {
  const DisplayPtr display(XOpenDisplay(name.c_str()));
  if (!display) return {};
  const Window window = find_window(display.get());
  if (!window) return {};
  Atom type = 0;
  int format = 0;
  unsigned long count = 0, rest = 0;
  unsigned char* text = nullptr;
  XGetWindowProperty(display.get(), window, atom(display.get(), "_NET_WM_NAME"), 0, 1024, False,
                     atom(display.get(), "UTF8_STRING"), &type, &format, &count, &rest, &text);
  std::string out = text ? reinterpret_cast<const char*>(text) : "";
  if (text) XFree(text);
  return out;
}

Rect window_place(const std::string& name) {
  const DisplayPtr display(XOpenDisplay(name.c_str()));
  if (!display) return {};
  const Window window = find_window(display.get());
  XWindowAttributes attributes;
  Window child = 0;
  Rect out;
  if (!window || !XGetWindowAttributes(display.get(), window, &attributes)) return {};
  XTranslateCoordinates(display.get(), window, attributes.root, 0, 0, &out.x, &out.y, &child);
  out.width = attributes.width;
  out.height = attributes.height;
  return out;
}

bool set_dots_per_inch(const std::string& name, int dots) {
  const DisplayPtr display(XOpenDisplay(name.c_str()));
  if (!display) return false;
  const std::string text = "Xft.dpi:\t" + std::to_string(dots) + "\n";
  XChangeProperty(display.get(), DefaultRootWindow(display.get()), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
  XSync(display.get(), False);
  return true;
}

}  // namespace afterglow
