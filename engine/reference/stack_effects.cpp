// SPDX-License-Identifier: MIT
// Oracles by name, with their settings as the effects declare them: grading, lens, film, blurs, edges.
#include <array>
#include <cmath>

#include "reference/blurs.h"
#include "reference/color.h"
#include "reference/depth_of_field.h"
#include "reference/detail.h"
#include "reference/glare.h"
#include "reference/glitch.h"
#include "reference/grading.h"
#include "reference/grain.h"
#include "reference/lens.h"
#include "reference/motion_blur.h"
#include "reference/settings.h"

namespace afterglow::reference {
namespace {

Point point(const Settings& s, const char* name) {
  const auto [x, y] = s.pair(name);
  return {x, y};
}

std::uint32_t word(const Settings& s, const char* name) { return static_cast<std::uint32_t>(s.integer(name)); }
std::uint32_t frame_of(const Inputs& inputs) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(inputs.frame)) & 0x7fffffff);
}

// ---- grading

DoubleImage run_white_balance(const DoubleImage& source, const Inputs&, const Settings& s) {
  return white_balance(
      source, {.kelvin = s.number("kelvin"), .temperature = s.number("temperature"), .tint = s.number("tint")});
}

DoubleImage run_channel_mixer(const DoubleImage& source, const Inputs&, const Settings& s) {
  static constexpr std::array kNames{"red", "green", "blue"};
  ChannelMix mix{};
  for (std::size_t out = 0; out < 3; ++out)
    for (std::size_t in = 0; in < 3; ++in)
      mix[out][in] = s.number((std::string(kNames[out]) + "_out_" + kNames[in] + "_in").c_str());
  return channel_mixer(source, mix);
}

/// Display values; 128 of 255 stands for the middle.
Rgb encoded(const Rgb& c) {
  Rgb out;
  for (int i = 0; i < 3; ++i) {
    out[i] = linear_to_srgb(glm::clamp(c[i], 0.0, 1.0));
    if (std::abs(out[i] - 0.5) < 1e-6 || std::abs(out[i] - 128.0 / 255) < 1e-6) out[i] = 0.5;
  }
  return out;
}

DoubleImage run_split_toning(const DoubleImage& source, const Inputs&, const Settings& s) {
  return split_toning(source, {.shadows = encoded(s.color("shadows")),
                               .highlights = encoded(s.color("highlights")),
                               .balance = s.number("balance")});
}

DoubleImage run_shadows_midtones_highlights(const DoubleImage& source, const Inputs&, const Settings& s) {
  return shadows_midtones_highlights(source, {.shadows = s.color("shadows"),
                                              .midtones = s.color("midtones"),
                                              .highlights = s.color("highlights"),
                                              .shadows_offset = s.number("shadows_offset"),
                                              .midtones_offset = s.number("midtones_offset"),
                                              .highlights_offset = s.number("highlights_offset"),
                                              .shadows_start = s.number("shadows_start"),
                                              .shadows_end = s.number("shadows_end"),
                                              .highlights_start = s.number("highlights_start"),
                                              .highlights_end = s.number("highlights_end")});
}

DoubleImage run_lift_gamma_gain(const DoubleImage& source, const Inputs&, const Settings& s) {
  return lift_gamma_gain(source, {.lift = s.color("lift"),
                                  .gamma = s.color("gamma"),
                                  .gain = s.color("gain"),
                                  .lift_offset = s.number("lift_offset"),
                                  .gamma_offset = s.number("gamma_offset"),
                                  .gain_offset = s.number("gain_offset")});
}

DoubleImage run_exposure(const DoubleImage& source, const Inputs&, const Settings& s) {
  return exposure(source, s.number("ev"));
}

DoubleImage run_cdl(const DoubleImage& source, const Inputs&, const Settings& s) {
  return cdl(source, {.slope = s.color("slope"),
                      .offset = s.color("offset"),
                      .power = s.color("power"),
                      .saturation = s.number("saturation")});
}

DoubleImage run_curves(const DoubleImage& source, const Inputs&, const Settings& s) {
  Curves curves{.by_luminance = s.text("by") == "luminance",
                .master = {s.number("blacks"), s.number("shadows"), s.number("midtones"), s.number("highlights"),
                           s.number("whites")}};
  const char* const channels[] = {"red", "green", "blue"};
  for (int i = 0; i < 3; ++i) {
    const Rgb points = s.color(channels[i]);
    curves.channels[i] = {points.x, points.y, points.z};
  }
  const char* const hues[] = {"reds", "yellows", "greens", "cyans", "blues", "magentas"};
  for (int i = 0; i < 6; ++i) curves.hues[i] = s.color(hues[i]);
  return reference::curves(source, curves);
}

// ---- lens and film

DoubleImage run_vignette(const DoubleImage& source, const Inputs&, const Settings& s) {
  return vignette(source, {.intensity = s.number("intensity"),
                           .smoothness = s.number("smoothness"),
                           .color = s.color("color"),
                           .center = point(s, "center"),
                           .rounded = s.flag("rounded")});
}

DoubleImage run_chromatic_aberration(const DoubleImage& source, const Inputs&, const Settings& s) {
  return chromatic_aberration(source, s.number("intensity"), s.integer("samples"));
}

DoubleImage run_lens_distortion(const DoubleImage& source, const Inputs&, const Settings& s) {
  return lens_distortion(
      source,
      {.intensity = s.number("intensity"),
       .x_multiplier = s.number("x_multiplier"),
       .y_multiplier = s.number("y_multiplier"),
       .center = point(s, "center"),
       .scale = s.number("scale"),
       .edges = s.choice<LensEdges>(
           "edges", {{"stretch", LensEdges::stretch}, {"mirror", LensEdges::mirror}, {"black", LensEdges::black}})});
}

DoubleImage run_film_grain(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  return film_grain(source, {.intensity = s.number("intensity"),
                             .response = s.number("response"),
                             .size = s.number("size"),
                             .colored = s.number("colored"),
                             .seed = word(s, "seed"),
                             .frame = frame_of(inputs)});
}

DoubleImage run_anamorphic_streaks(const DoubleImage& source, const Inputs&, const Settings& s) {
  return anamorphic_streaks(source, {.threshold = s.number("threshold"),
                                     .stretch = s.number("stretch"),
                                     .intensity = s.number("intensity"),
                                     .tint = s.color("tint")});
}

DoubleImage run_lens_dirt(const DoubleImage& source, const Inputs&, const Settings& s) {
  return lens_dirt(source, {.intensity = s.number("intensity"),
                            .threshold = s.number("threshold"),
                            .density = s.number("density"),
                            .size = s.number("size"),
                            .seed = word(s, "seed")});
}

DoubleImage run_glitch(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  return glitch(source, {.scan_line_jitter = s.number("scan_line_jitter"),
                         .line_height = s.number("line_height"),
                         .horizontal_shake = s.number("horizontal_shake"),
                         .rgb_split = s.number("rgb_split"),
                         .vertical_roll = s.number("vertical_roll"),
                         .stretch = s.text("edges") == "stretch",
                         .seed = word(s, "seed"),
                         .frame = frame_of(inputs),
                         .time = inputs.time});
}

// ---- blurs

DoubleImage run_dual_kawase(const DoubleImage& source, const Inputs&, const Settings& s) {
  return dual_kawase(source, s.integer("iterations"), s.number("offset"));
}

DoubleImage run_radial_blur(const DoubleImage& source, const Inputs&, const Settings& s) {
  return radial_blur(source, s.number("intensity"), s.integer("samples"), point(s, "center"));
}

DoubleImage run_directional_blur(const DoubleImage& source, const Inputs&, const Settings& s) {
  return directional_blur(source, s.number("distance"), s.number("angle"));
}

DoubleImage run_bokeh_blur(const DoubleImage& source, const Inputs&, const Settings& s) {
  return bokeh_blur(source, {.radius = s.number("radius"),
                             .blades = s.integer("blades"),
                             .rotation = s.number("rotation"),
                             .highlights = s.number("highlights")});
}

/// Device depth made linear (math.md §10).
DoubleImage linear_depth(DoubleImage depth, double near, double far, bool reversed) {
  const double n = 1 / near, f = 1 / far;
  for (auto& p : depth.pixels) p.r = 1 / (reversed ? (n - f) * p.r + f : (f - n) * p.r + n);
  return depth;
}

DoubleImage run_depth_of_field(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  const DoubleImage depth = s.is("depth_space", "linear")
                                ? *inputs.depth
                                : linear_depth(*inputs.depth, s.number("near"), s.number("far"), s.flag("reversed_z"));
  const auto [x, y] = s.pair("focus_point");
  const bool automatic = s.is("focus_mode", "point");
  const DepthOfField settings{
      .focus_distance = automatic ? autofocus(depth, {x, y, s.number("focus_area")}) : s.number("focus_distance"),
      .aperture = s.number("aperture"),
      .focal_length = s.number("focal_length"),
      .sensor_height = s.number("sensor_height"),
      .max_radius = s.number("max_radius"),
      .samples = s.integer("samples"),
      .blades = s.integer("blades"),
      .rotation = s.number("rotation"),
      .squeeze = s.number("squeeze"),
      .cat_eye = s.number("cat_eye")};
  return depth_of_field(source, depth, settings);
}

DoubleImage run_motion_blur(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  const auto [x, y] = s.pair("motion_scale");
  return motion_blur(source, *inputs.motion, inputs.depth,
                     {.shutter_angle = s.number("shutter_angle"),
                      .samples = s.integer("samples"),
                      .max_radius = s.number("max_radius"),
                      .scale_x = x,
                      .scale_y = y,
                      .depth_softness = s.number("depth_softness")});
}

// ---- edges and detail

DoubleImage run_sharpen(const DoubleImage& source, const Inputs&, const Settings& s) {
  return sharpen(source, s.number("intensity"), s.number("contrast"));
}

DoubleImage run_pixelate(const DoubleImage& source, const Inputs&, const Settings& s) {
  return pixelate(source, s.number("size"));
}

DoubleImage run_edge_detection(const DoubleImage& source, const Inputs&, const Settings& s) {
  return edge_detection(source, {.kind = s.choice<EdgeOperator>("operator", {{"sobel", EdgeOperator::sobel},
                                                                             {"scharr", EdgeOperator::scharr},
                                                                             {"roberts", EdgeOperator::roberts}}),
                                 .intensity = s.number("intensity"),
                                 .threshold = s.number("threshold"),
                                 .color = s.color("color"),
                                 .background = s.color("background"),
                                 .background_opacity = s.number("background_opacity")});
}

DoubleImage run_fxaa(const DoubleImage& source, const Inputs&, const Settings& s) {
  return fxaa(source, {.fixed_threshold = s.number("fixed_threshold"),
                       .relative_threshold = s.number("relative_threshold"),
                       .subpixel_blending = s.number("subpixel_blending"),
                       .quality = s.choice<FxaaQuality>(
                           "quality",
                           {{"low", FxaaQuality::low}, {"medium", FxaaQuality::medium}, {"high", FxaaQuality::high}})});
}

constexpr Oracle kMoreOracles[] = {
    {"anamorphic_streaks", run_anamorphic_streaks},
    {"bokeh_blur", run_bokeh_blur},
    {"cdl", run_cdl},
    {"channel_mixer", run_channel_mixer},
    {"chromatic_aberration", run_chromatic_aberration},
    {"curves", run_curves},
    {"depth_of_field", run_depth_of_field},
    {"directional_blur", run_directional_blur},
    {"dual_kawase", run_dual_kawase},
    {"edge_detection", run_edge_detection},
    {"exposure", run_exposure},
    {"film_grain", run_film_grain},
    {"fxaa", run_fxaa},
    {"glitch", run_glitch},
    {"lens_dirt", run_lens_dirt, [](const Settings& s) { return s.text("texture").empty(); }},
    {"lens_distortion", run_lens_distortion},
    {"lift_gamma_gain", run_lift_gamma_gain},
    {"motion_blur", run_motion_blur},
    {"pixelate", run_pixelate},
    {"radial_blur", run_radial_blur},
    {"shadows_midtones_highlights", run_shadows_midtones_highlights},
    {"sharpen", run_sharpen},
    {"split_toning", run_split_toning},
    {"vignette", run_vignette},
    {"white_balance", run_white_balance},
};

}  // namespace

std::span<const Oracle> more_oracles() { return kMoreOracles; }

}  // namespace afterglow::reference
