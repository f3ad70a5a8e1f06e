// SPDX-License-Identifier: MIT
// Oracles by name, with their settings as the effects declare them: light in lenses, film and air, and screens.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/air.h"
#include "reference/burn_in.h"
#include "reference/cut.h"
#include "reference/glow.h"
#include "reference/occlusion.h"
#include "reference/screen.h"
#include "reference/settings.h"
#include "reference/smaa.h"

namespace afterglow::reference {
namespace {

/// A depth input in metres along the viewing axis, as an effect's settings describe it.
DoubleImage metres(DoubleImage depth, const Settings& s) {
  if (s.is("depth_space", "linear")) return depth;
  const double n = 1 / s.number("near"), f = 1 / s.number("far");
  for (auto& p : depth.pixels) {
    const double d = std::clamp(p.r, 0.0, 1.0), share = s.flag("reversed_z") ? d : 1 - d;
    p.r = 1 / (share * n + (1 - share) * f);
  }
  return depth;
}

DoubleImage run_halation(const DoubleImage& source, const Inputs&, const Settings& s) {
  return halation(source, {.intensity = s.number("intensity"),
                           .radius = s.number("radius"),
                           .threshold = s.number("threshold"),
                           .clamp = s.number("clamp"),
                           .color = s.color("color"),
                           .source_color = s.number("source_color")});
}

DoubleImage run_glare(const DoubleImage& source, const Inputs&, const Settings& s) {
  return glare(
      source,
      {.kind = s.choice<GlareKind>(
           "kind", {{"star", GlareKind::star}, {"streaks", GlareKind::streaks}, {"fog_glow", GlareKind::fog_glow}}),
       .intensity = s.number("intensity"),
       .threshold = s.number("threshold"),
       .clamp = s.number("clamp"),
       .points = s.integer("points"),
       .angle = s.number("angle"),
       .size = s.number("size"),
       .dispersion = s.number("dispersion"),
       .tint = s.color("tint")});
}

DoubleImage run_lens_flare(const DoubleImage& source, const Inputs&, const Settings& s) {
  return lens_flare(source, {.ghosts = s.number("ghosts"),
                             .halo = s.number("halo"),
                             .starburst = s.number("starburst"),
                             .threshold = s.number("threshold"),
                             .clamp = s.number("clamp"),
                             .count = s.integer("count"),
                             .spacing = s.number("spacing"),
                             .blades = s.integer("blades"),
                             .rotation = s.number("rotation"),
                             .iris = s.number("iris"),
                             .halo_radius = s.number("halo_radius"),
                             .ray_length = s.number("ray_length"),
                             .dispersion = s.number("dispersion"),
                             .tint = s.color("tint")});
}

DoubleImage run_depth_fog(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  const auto [sun_x, sun_y] = s.pair("sun");
  return depth_fog(source, metres(*inputs.depth, s),
                   {.density = s.number("density"),
                    .start = s.number("start"),
                    .color = s.color("color"),
                    .ambient = s.number("ambient"),
                    .max_opacity = s.number("max_opacity"),
                    .sky = s.number("sky"),
                    .scattering = s.number("scattering"),
                    .scattering_radius = s.number("scattering_radius"),
                    .height_falloff = s.number("height_falloff"),
                    .camera_height = s.number("camera_height"),
                    .camera_pitch = s.number("camera_pitch"),
                    .field_of_view = s.number("field_of_view"),
                    .sun_color = s.color("sun_color"),
                    .sun_x = sun_x,
                    .sun_y = sun_y,
                    .sun_focus = s.number("sun_focus")});
}

DoubleImage run_letterbox(const DoubleImage& source, const Inputs&, const Settings& s) {
  return letterbox(source, {s.number("aspect"), s.color("color"), s.number("offset")});
}

DoubleImage run_crt(const DoubleImage& source, const Inputs&, const Settings& s) {
  return crt(source, {.lines = s.integer("lines"),
                      .softness = s.number("softness"),
                      .scan_lines = s.number("scan_lines"),
                      .phosphor = s.number("phosphor"),
                      .phosphor_size = s.number("phosphor_size"),
                      .curvature = s.number("curvature"),
                      .corner = s.number("corner"),
                      .vignette = s.number("vignette"),
                      .glow = s.number("glow"),
                      .convergence = s.number("convergence"),
                      .brightness = s.number("brightness"),
                      .intensity = s.number("intensity")});
}

DoubleImage run_ssao(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  return ssao(source, metres(*inputs.depth, s), inputs.normal,
              {.intensity = s.number("intensity"),
               .radius = s.number("radius"),
               .max_radius = s.number("max_radius"),
               .samples = s.integer("samples"),
               .bias = s.number("bias"),
               .spare = s.number("spare"),
               .color = s.color("color"),
               .field_of_view = s.number("field_of_view"),
               .normals = s.choice<SurfaceNormals>("normals", {{"from_depth", SurfaceNormals::from_depth},
                                                               {"view", SurfaceNormals::view},
                                                               {"world", SurfaceNormals::world}}),
               .camera_forward = s.color("camera_forward"),
               .camera_up = s.color("camera_up")});
}

DoubleImage run_smaa(const DoubleImage& source, const Inputs&, const Settings& s) {
  return smaa(source, {s.number("threshold"), s.integer("search"), s.number("corner_rounding")});
}

DoubleImage run_transition(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  const auto [x, y] = s.pair("center");
  const auto layer = inputs.layers.find(s.text("layer"));
  return transition(source, layer == inputs.layers.end() ? nullptr : layer->second,
                    {.progress = s.number("progress"),
                     .kind = s.choice<CutKind>("kind", {{"dissolve", CutKind::dissolve},
                                                        {"fade", CutKind::fade},
                                                        {"wipe", CutKind::wipe},
                                                        {"iris", CutKind::iris},
                                                        {"clock", CutKind::clock},
                                                        {"blinds", CutKind::blinds},
                                                        {"scatter", CutKind::scatter},
                                                        {"push", CutKind::push}}),
                     .color = s.color("color"),
                     .angle = s.number("angle"),
                     .softness = s.number("softness"),
                     .center_x = x,
                     .center_y = y,
                     .count = s.integer("count"),
                     .grain = s.number("grain"),
                     .seed = static_cast<std::uint32_t>(s.integer("seed"))});
}

DoubleImage run_posterize(const DoubleImage& source, const Inputs&, const Settings& s) {
  return posterize(source, {s.integer("levels"), s.number("softness"), s.number("intensity"), s.number("shadows")});
}

/// ASCII, with {frame} alone to be filled in.
bool knows_text(const Settings& s) {
  const std::string text = s.text("text");
  for (auto at = text.find('{'); at != std::string::npos; at = text.find('{', at + 1))
    if (!std::string_view(text).substr(at).starts_with("{frame}")) return false;
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

DoubleImage run_burn_in(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  std::string text = s.text("text");
  constexpr std::string_view kFrame = "{frame}";
  for (auto at = text.find(kFrame); at != std::string::npos; at = text.find(kFrame, at))
    text.replace(at, kFrame.size(), fmt::format("{:04}", static_cast<long long>(std::floor(inputs.frame))));
  const auto [x, y] = s.pair("position");
  return burn_in(source, {.text = std::u32string(text.begin(), text.end()),
                          .x = x,
                          .y = y,
                          .size = s.number("size"),
                          .margin = s.number("margin"),
                          .color = s.color("color"),
                          .background = s.color("background"),
                          .box = s.number("box"),
                          .outline = s.number("outline")});
}

constexpr Oracle kOpticOracles[] = {
    {"burn_in", run_burn_in, knows_text},
    {"crt", run_crt},
    {"depth_fog", run_depth_fog},
    {"glare", run_glare},
    {"halation", run_halation},
    {"lens_flare", run_lens_flare},
    {"letterbox", run_letterbox},
    {"posterize", run_posterize},
    {"smaa", run_smaa},
    {"ssao", run_ssao},
    {"transition", run_transition},
};

}  // namespace

std::span<const Oracle> optic_oracles() { return kOpticOracles; }

}  // namespace afterglow::reference
