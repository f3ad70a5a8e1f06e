// SPDX-License-Identifier: MIT
#include "reference/stack.h"

#include "reference/bloom.h"
#include "reference/box_bloom.h"
#include "reference/color_adjustments.h"
#include "reference/color_blit.h"
#include "reference/composite.h"
#include "reference/outline.h"
#include "reference/settings.h"
#include "reference/tone_mapping.h"

namespace afterglow::reference {
namespace {

DoubleImage run_bloom(const DoubleImage& source, const Inputs&, const Settings& s) {
  return bloom(source, {.mode = s.is("mode", "additive") ? BloomMode::additive : BloomMode::scattering,
                        .max_iterations = s.integer("max_iterations"),
                        .downscale_limit = s.integer("downscale_limit"),
                        .threshold = s.number("threshold"),
                        .knee = s.number("knee"),
                        .intensity = s.number("intensity"),
                        .scatter = s.number("scatter"),
                        .bicubic_upsampling = s.flag("bicubic_upsampling"),
                        .fade_fireflies = s.flag("fade_fireflies"),
                        .reference_height = s.integer("reference_height"),
                        .clamp = s.number("clamp"),
                        .edges = s.is("edges", "mirror") ? Edges::mirror : Edges::stretch})
      .result;
}

DoubleImage run_box_bloom(const DoubleImage& source, const Inputs&, const Settings& s) {
  return box_bloom(source, {.threshold = s.number("threshold"),
                            .blur_iterations = s.integer("blur_iterations"),
                            .pattern = s.is("pattern", "plus") ? BoxPattern::plus : BoxPattern::box,
                            .brightness = s.is("brightness", "max") ? BoxBrightness::max : BoxBrightness::luma})
      .result;
}

DoubleImage run_tone_mapping(const DoubleImage& source, const Inputs&, const Settings& s) {
  return tone_mapping(source,
                      {.mode = s.choice<ToneMode>("mode", {{"none", ToneMode::none},
                                                           {"aces", ToneMode::aces},
                                                           {"neutral", ToneMode::neutral},
                                                           {"reinhard", ToneMode::reinhard},
                                                           {"reinhard_extended", ToneMode::reinhard_extended},
                                                           {"agx", ToneMode::agx},
                                                           {"khronos_neutral", ToneMode::khronos_neutral},
                                                           {"hable", ToneMode::hable},
                                                           {"gt", ToneMode::gt}}),
                       .exposure = s.number("exposure"),
                       .white = s.number("white"),
                       .full_white = s.flag("full_white"),
                       .look = s.choice<AgxLook>(
                           "look", {{"base", AgxLook::base}, {"punchy", AgxLook::punchy}, {"golden", AgxLook::golden}}),
                       .toe = s.number("toe"),
                       .toe_length = s.number("toe_length"),
                       .shoulder_length = s.number("shoulder_length"),
                       .shoulder_angle = s.number("shoulder_angle")});
}

DoubleImage run_color_adjustments(const DoubleImage& source, const Inputs&, const Settings& s) {
  return color_adjustments(source, {.post_exposure = s.number("post_exposure"),
                                    .contrast = s.number("contrast"),
                                    .color_filter = s.color("color_filter"),
                                    .hue_shift = s.number("hue_shift"),
                                    .saturation = s.number("saturation")});
}

DoubleImage run_color_blit(const DoubleImage& source, const Inputs&, const Settings& s) {
  return color_blit(source, s.number("intensity"));
}

DoubleImage run_outline(const DoubleImage& source, const Inputs& inputs, const Settings& s) {
  const OutlineSettings settings{
      .source = s.choice<OutlineSource>("source", {{"depth", OutlineSource::depth},
                                                   {"device_depth", OutlineSource::device_depth},
                                                   {"normals", OutlineSource::normals},
                                                   {"mixed", OutlineSource::mixed}}),
      .difference = s.is("difference", "offset") ? OutlineDifference::offset : OutlineDifference::derivative,
      .device_depth_input = s.is("depth_space", "device"),
      .near = s.number("near"),
      .far = s.number("far"),
      .reversed_z = s.flag("reversed_z"),
      .combine = s.is("combine", "max") ? OutlineCombine::max : OutlineCombine::weighted,
      .normal_factor = s.number("normal_factor"),
      .width = s.number("width"),
      .fade_distance = s.number("fade_distance"),
      .depth_scale = s.number("depth_scale"),
      .normal_scale = s.number("normal_scale"),
      .divide_factor = s.number("divide_factor"),
      .level_slopes = s.flag("level_slopes"),
      .contrast = s.number("contrast"),
      .smoothness = s.number("smoothness"),
      .color = s.color("color"),
      .blend = s.is("blend", "add") ? OutlineBlend::add : OutlineBlend::lerp};
  return outline(source, inputs.depth, inputs.normal, settings);
}

constexpr Oracle kOracles[] = {
    {"bloom", run_bloom},           {"box_bloom", run_box_bloom}, {"color_adjustments", run_color_adjustments},
    {"color_blit", run_color_blit}, {"outline", run_outline},     {"tone_mapping", run_tone_mapping},
};

const Oracle* oracle_of(const std::string& effect) {
  for (const std::span<const Oracle> oracles : {std::span<const Oracle>(kOracles), more_oracles(), optic_oracles()})
    for (const Oracle& oracle : oracles)
      if (effect == oracle.effect) return &oracle;
  return nullptr;
}

}  // namespace

bool has_oracle(const std::string& effect) { return oracle_of(effect) != nullptr; }

std::string effect_without_oracle(std::span<const Entry> entries) {
  for (const auto& entry : entries) {
    const bool group = entry.effect == "group" || entry.effect == "mix";
    const Oracle* oracle = group ? nullptr : oracle_of(entry.effect);
    if (!group && (!oracle || (oracle->knows && !oracle->knows(Settings(entry))))) return entry.effect;
    if (entry.mask && !is_known(*entry.mask)) return "the mask of " + entry.effect;
  }
  return {};
}

namespace {

/// The entries, one behind the other, without restoring alpha.
DoubleImage run(const DoubleImage& source, const Inputs& inputs, std::span<const Entry> entries) {
  DoubleImage image = source;
  while (!entries.empty()) {
    const Entry& entry = entries.front();
    const auto members = entries.subspan(1, static_cast<std::size_t>(entry.members));
    const auto middle = static_cast<std::size_t>(entry.middle);
    entries = entries.subspan(1 + members.size());
    DoubleImage made;
    if (entry.effect == "group")
      made = run(image, inputs, members);
    else if (entry.effect == "mix")
      made = composite(run(image, inputs, members.first(middle)), run(image, inputs, members.subspan(middle)),
                       Settings(entry).number("amount"), "normal", nullptr);
    else
      made = oracle_of(entry.effect)->run(image, inputs, Settings(entry));
    const auto mask = entry.mask ? mask_of(image, inputs, *entry.mask) : std::vector<double>();
    if (entry.mask || entry.opacity != 1 || entry.blend != "normal")
      made = composite(image, made, entry.opacity, entry.blend, entry.mask ? &mask : nullptr);
    image = std::move(made);
  }
  return image;
}

}  // namespace

DoubleImage evaluate(const DoubleImage& source, const Inputs& inputs, std::span<const Entry> entries) {
  DoubleImage image = run(source, inputs, entries);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i].a = source.pixels[i].a;
  return image;
}

}  // namespace afterglow::reference
