// SPDX-License-Identifier: MIT
// How a picture is looked at: zoom, pan, exposure, channels, comparison. Plain data and its arithmetic; nothing is
// drawn here, and nothing changes what is rendered.
//
// Picture coordinates count pixels of the picture: pixel (x, y) covers [x, x+1) × [y, y+1). Screen coordinates count
// pixels of the frame buffer from its upper left corner.
#pragma once

#include <optional>
#include <string>

#include "core/geometry.h"
#include "core/result.h"
#include "play/scopes.h"

namespace afterglow {

struct Point {
  double x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

enum class ViewChannel { color, red, green, blue, alpha, luminance };
/// none: the result alone. source: with what went in. other: with the result of the second preset.
enum class Compare { none, source, other };
/// How. wipe: what it is compared with lies left of a border (above it). flip: it takes the result's place.
/// side_by_side: it lies at the left, the result at the right, both placed alike. difference: how far they are apart,
/// by channel.
enum class CompareBy { wipe, flip, side_by_side, difference };

/// Lines over the picture. thirds: of its width and height, and its middle. safe_areas: 93 % and 90 % of both (SMPTE ST
/// 2046-1: action, titles).
enum class Guides { none, thirds, safe_areas, both };

/// What is painted over colours, so that values can be read. range: what is below 0, above 1 or not finite. stops:
/// zones of a stop each, of the luminance from middle grey (kZones).
enum class Marks { none, range, stops };
/// Which scopes lie over the picture.
enum class ScopeKind { none, histogram, waveform, parade, vectorscope, all };

/// "color", "red", …
std::string view_channel_name(ViewChannel channel);
/// "none", "source", "other".
std::string compare_name(Compare compare);
/// "wipe", "flip", "side by side", "difference".
std::string compare_by_name(CompareBy by);
/// "none", "thirds", "safe areas", "thirds and safe areas".
std::string guides_name(Guides guides);
/// "none", "out of range", "stops".
std::string marks_name(Marks marks);
/// "none", "histogram", "waveform", "RGB parade", "vectorscope", "all".
std::string scope_kind_name(ScopeKind kind);

/// A form that a picture is delivered in; 0: its own.
struct Aspect {
  double ratio = 0;  ///< width / height
  const char* name = "none";
};
inline constexpr Aspect kAspects[] = {
    {}, {2.39, "2.39:1"}, {1.85, "1.85:1"}, {16.0 / 9, "16:9"}, {4.0 / 3, "4:3"}, {1, "1:1"}, {9.0 / 16, "9:16"}};

struct View {
  bool fit = true;      ///< the whole picture, as large as the window allows; `zoom` and `center` rest meanwhile
  double zoom = 1;      ///< screen pixels for each pixel of the picture
  Point center;         ///< of the picture, in the middle of the window
  double exposure = 0;  ///< EV, ±kMostExposure, in scene-linear light before encoding for the screen
  double gamma = 1;     ///< light behind the exposure, to the power of 1/gamma; kLeastGamma…kMostGamma
  ViewChannel channel = ViewChannel::color;
  bool as_display = true;  ///< where a display is named, light is shown as its table says; else as sRGB
  bool smooth = false;     ///< magnified, pixels go over into each other; else each is a square
  Marks marks = Marks::none;
  Compare compare = Compare::none;
  CompareBy by = CompareBy::wipe;
  double wipe = 0.5;           ///< where the border lies, 0…1 over the picture's width (or height)
  bool wipe_vertical = false;  ///< the border is horizontal: the compared picture lies above it
  Guides guides = Guides::none;
  std::size_t aspect = 0;  ///< of kAspects: what does not belong to it is darkened, and guides are its own
  ScopeKind scope = ScopeKind::none;
  ScopeScale scope_scale = ScopeScale::code;
  std::optional<Rect> region;  ///< of the picture: what scopes and means are about; none: all of it, and no means
  friend bool operator==(const View&, const View&) = default;
};

inline constexpr double kMostExposure = 16, kLeastGamma = 0.1, kMostGamma = 10;

/// Of a picture, in its coordinates.
struct PictureArea {
  Point from, to;
};
/// The largest area of that form in the middle of the picture. `ratio` 0: all of it.
PictureArea area_of_aspect(Size picture, double ratio);
/// `part` of an area's width and height, in its middle.
PictureArea middle_part(const PictureArea& area, double part);

/// Whether the border of a wipe is shown.
bool wipes(const View& view);
/// The window that one picture has, of the whole one: its half where two lie side by side.
Size picture_window(const View& view, Size window);

inline constexpr double kLeastZoom = 1.0 / 64, kMostZoom = 128;

/// Where the picture lies: screen = origin + scale · picture.
struct ViewPlacement {
  Point origin;
  double scale = 1;
};
/// At whole scales the origin is a whole number too, so that pixels stay sharp.
ViewPlacement placement(const View& view, Size picture, Size window);
Point to_screen(const ViewPlacement& placement, Point picture);
Point to_picture(const ViewPlacement& placement, Point screen);
/// The pixel under a point of the screen; none outside of the picture.
struct Pixel {
  int x = 0, y = 0;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};
std::optional<Pixel> pixel_at(const View& view, Size picture, Size window, Point screen);
/// Scale at which the whole picture fits into the window.
double fitting_zoom(Size picture, Size window);

void fit(View& view);
/// One pixel for one pixel, with the point of the picture that was in the middle.
void one_to_one(View& view, Size picture, Size window);
/// Multiplies the zoom; the picture's point under `screen` stays there. Held within kLeastZoom…kMostZoom.
void zoom_at(View& view, Size picture, Size window, Point screen, double factor);
/// Moves the picture by so many pixels of the screen; its middle stays over the picture.
void pan(View& view, Size picture, Size window, Point by);
/// The pixels between two points of the screen, both included, within the picture; none: nothing of it lies there.
std::optional<Rect> region_between(const View& view, Size picture, Size window, Point a, Point b);
/// Puts the border of the comparison under a point of the screen.
void wipe_to(View& view, Size picture, Size window, Point screen);

}  // namespace afterglow
