// SPDX-License-Identifier: MIT
// Promises about light: what stays black, of one colour, in order, within bounds, in proportion.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "image/picture.h"
#include "stress/check.h"
#include "stress/truth.h"

namespace afterglow::stress {
namespace {

Picture with_color(const Situation& s, const std::function<void(int x, int y, float* rgba)>& change) {
  Picture out = changed(s.picture);
  for (int y = 0; y < out.color.height; ++y)
    for (int x = 0; x < out.color.width; ++x) change(x, y, out.color.at(x, y));
  return out;
}

float grey_of(const float* p) { return std::max({p[0], p[1], p[2]}); }
void set_grey(float* p, float grey) { p[0] = p[1] = p[2] = grey; }

Result<Outcome> black(Harness& harness, const Situation& s, const Invariant& hold) {
  const Picture source = with_color(s, [](int, int, float* p) { set_grey(p, 0); });
  Outcome worst;
  for (const bool half : {false, true}) {
    Way way = usual_way(harness);
    if (half) way.choice.storage = Storage::fp16;
    AFTERGLOW_TRY(const Made made, harness.run(s.look, source, s.frame, way));
    for (std::size_t i = 0; i < made.image.pixels.size(); ++i) {
      if (i % 4 == 3) continue;
      const double light = std::abs(made.image.pixels[i]);
      if (!(light <= hold.numbers.at("within")))
        return within_bound(light, hold.numbers.at("within"),
                            fmt::format("black becomes {:g} at {}, {}", light, place_of(made.image, i), way.name()));
      worst.measured = std::max(worst.measured, light);
    }
  }
  return worst;
}

Result<Outcome> constant(Harness& harness, const Situation& s, const Invariant& hold) {
  const auto chosen = Random(s.seed).below(static_cast<std::size_t>(s.picture.color.size().area()));
  const float* color = &s.picture.color.pixels[4 * chosen];
  const Picture source = with_color(s, [&](int, int, float* p) {
    std::copy_n(color, 3, p);
    p[3] = 1;  // effects that see straight colour make of one light as many as there are alphas
  });
  AFTERGLOW_TRY(const Made made, harness.run(s.look, source, s.frame, usual_way(harness)));
  Image wanted = made.image;
  for (std::size_t i = 0; i < wanted.pixels.size(); i += 4)
    std::copy_n(made.image.pixels.begin(), 3, &wanted.pixels[i]);
  return compare(made.image, wanted, hold.numbers.at("within"),
                 fmt::format("of the one colour {:g} {:g} {:g}", color[0], color[1], color[2]));
}

/// Nothing but black within `margin` pixels of the edges. Nothing when that leaves no pixel.
std::optional<Picture> within_margin(const Situation& s, double margin) {
  const int m = static_cast<int>(std::ceil(std::min(margin, 1e6)));
  const int w = s.picture.color.width, h = s.picture.color.height;
  if (2 * m >= w || 2 * m >= h) return std::nullopt;
  return with_color(s, [&](int x, int y, float* p) {
    if (x < m || y < m || x >= w - m || y >= h - m) set_grey(p, 0);
  });
}

std::array<double, 3> means(const Image& image) {
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (i % 4 < 3) sum[i % 4] += static_cast<double>(image.pixels[i]);
  for (double& v : sum) v /= static_cast<double>(image.size().area());
  return sum;
}

/// How much the mean of a channel has changed, at worst, as a share of it.
double gain_of(const Image& before, const Image& after, bool growth_alone) {
  const auto a = means(before), b = means(after);
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double change = (b[c] - a[c]) / (a[c] + 1e-4);
    const double counted = growth_alone ? change : std::abs(change);
    if (!(counted <= worst)) worst = counted;  // NaN too
  }
  return worst;
}

Result<Outcome> check_mean(Harness& harness, const Situation& s, const Invariant& hold, bool growth_alone) {
  auto source = within_margin(s, hold.numbers.at("margin"));
  if (!source) return not_applicable();
  // Of colours, the light of one channel may let another channel pass a threshold.
  if (growth_alone)
    for (std::size_t i = 0; i < source->color.pixels.size(); i += 4)
      set_grey(&source->color.pixels[i], grey_of(&source->color.pixels[i]));
  AFTERGLOW_TRY(const Made made, harness.run(s.look, *source, s.frame, usual_way(harness)));
  const double gain = gain_of(source->color, made.image, growth_alone);
  return within_bound(gain, hold.numbers.at("within"), fmt::format("the mean changes by {:.3g} of itself", gain));
}

Result<Outcome> mean(Harness& harness, const Situation& s, const Invariant& hold) {
  return check_mean(harness, s, hold, false);
}
Result<Outcome> no_added_light(Harness& harness, const Situation& s, const Invariant& hold) {
  return check_mean(harness, s, hold, true);
}

/// A brighter picture in some places: everywhere by as much as another pixel has, or in one pixel alone.
Picture brighter(const Situation& s, const Picture& greys) {
  Random random(s.seed);
  const auto& values = greys.color.pixels;
  const std::size_t pixels = values.size() / 4, offset = random.below(pixels), one = random.below(pixels);
  const bool everywhere = random.chance(0.5);
  const auto amount = static_cast<float>(random.log_between(1e-3, 10));
  Picture out = changed(greys);
  for (std::size_t i = 0; i < pixels; ++i)
    if (everywhere || i == one)
      set_grey(&out.color.pixels[4 * i],
               values[4 * i] + (everywhere ? values[4 * ((i + offset) % pixels)] * amount : amount));
  return out;
}

Result<Outcome> monotone(Harness& harness, const Situation& s, const Invariant& hold) {
  Situation grey = s;
  grey.picture = greys_of(s);
  const Picture more = brighter(s, grey.picture);
  AFTERGLOW_TRY(const Made low, harness.run(s.look, grey.picture, s.frame, usual_way(harness)));
  AFTERGLOW_TRY(const Made high, harness.run(s.look, more, s.frame, usual_way(harness)));
  double worst = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < low.image.pixels.size(); ++i) {
    const double a = low.image.pixels[i], b = high.image.pixels[i];
    const double lost = i % 4 == 3 ? 0 : (a - b) / (std::abs(a) + 0.01);
    if (!(lost <= worst)) {
      worst = lost;
      at = i;
    }
  }
  return within_bound(worst, hold.numbers.at("within"),
                      fmt::format("a brighter grey picture is darker by {:.3g} at {}: {:.9g}, before {:.9g}", worst,
                                  place_of(low.image, at), high.image.pixels[at], low.image.pixels[at]));
}

Result<Outcome> bounded(Harness& harness, const Situation& s, const Invariant& hold) {
  const Picture source = greys_of(s);
  double from = hold.numbers.at("from"), to = hold.numbers.at("to");
  double least = 1e30, largest = 0;
  for (std::size_t i = 0; i < source.color.pixels.size(); i += 4) {
    least = std::min(least, static_cast<double>(source.color.pixels[i]));
    largest = std::max(largest, static_cast<double>(source.color.pixels[i]));
  }
  if (std::isnan(from)) from = std::isnan(to) ? least : 0;
  if (std::isnan(to)) to = largest;
  AFTERGLOW_TRY(const Made made, harness.run(s.look, source, s.frame, usual_way(harness)));
  double worst = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < made.image.pixels.size(); ++i) {
    const double v = made.image.pixels[i];
    const double beyond =
        i % 4 == 3 ? 0 : std::max((from - v) / (std::abs(from) + 0.01), (v - to) / (std::abs(to) + 0.01));
    if (!(beyond <= worst)) {
      worst = beyond;
      at = i;
    }
  }
  return within_bound(worst, hold.numbers.at("within"),
                      fmt::format("{:.9g} at {} is not within {:.9g} and {:.9g}", made.image.pixels[at],
                                  place_of(made.image, at), from, to));
}

/// Of pictures A and B: the sum of their results is the result of their sum.
Result<Outcome> linear(Harness& harness, const Situation& s, const Invariant& hold) {
  const double up_to = hold.numbers.at("up_to");
  Random random(s.seed);
  const double part = random.between(0.1, 0.9);
  const auto limit = static_cast<float>(std::min(up_to, 1e6));
  const std::size_t pixels = static_cast<std::size_t>(s.picture.color.size().area()), offset = random.below(pixels);
  Picture a = changed(s.picture), b = a, sum = a;
  for (std::size_t i = 0; i < 4 * pixels; ++i) {
    if (i % 4 == 3) continue;
    const float x = std::min(s.picture.color.pixels[i], limit),
                y = std::min(s.picture.color.pixels[(i + 4 * offset) % (4 * pixels)], limit);
    a.color.pixels[i] = static_cast<float>(part) * x;
    b.color.pixels[i] = static_cast<float>(1 - part) * y;
    sum.color.pixels[i] = a.color.pixels[i] + b.color.pixels[i];
  }
  AFTERGLOW_TRY(const Made of_a, harness.run(s.look, a, s.frame, usual_way(harness)));
  AFTERGLOW_TRY(const Made of_b, harness.run(s.look, b, s.frame, usual_way(harness)));
  AFTERGLOW_TRY(const Made of_sum, harness.run(s.look, sum, s.frame, usual_way(harness)));
  Image wanted = of_a.image;
  for (std::size_t i = 0; i < wanted.pixels.size(); ++i)
    wanted.pixels[i] = std::min(wanted.pixels[i] + of_b.image.pixels[i], kLargestColor);
  return compare(of_sum.image, wanted, hold.numbers.at("within"), "the result of a sum against the sum of results");
}

/// Twice as much of the setting adds twice as much.
Result<Outcome> proportional(Harness& harness, const Situation& s, const Invariant& hold) {
  const std::string& setting = hold.settings.at("setting");
  const double up_to = hold.numbers.at("up_to");
  Random random(s.seed);
  const double high = static_cast<float>(up_to * random.between(0.3, 1.0)),
               low = static_cast<float>(high * random.between(0.1, 0.8));
  const auto with = [&](double amount) {
    Look look = s.look;
    look.entries.front().set(setting, {.type = SettingType::number, .number = {amount, 0, 0}});
    return look;
  };
  for (const double amount : {high, low})  // at 0 an effect may be idle, and take settings that it refuses otherwise
    if (!harness.facts(with(amount), s.picture.color.size(), s.frame)) return not_applicable();
  const auto added = [&](double amount) -> Result<Image> {
    AFTERGLOW_TRY(Made made, harness.run(with(amount), s.picture, s.frame, usual_way(harness)));
    return std::move(made.image);
  };
  AFTERGLOW_TRY(const Image of_high, added(high));
  AFTERGLOW_TRY(const Image of_low, added(low));
  double worst = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < of_high.pixels.size(); ++i) {
    if (i % 4 == 3) continue;
    const double source = s.picture.color.pixels[i];
    const double a = (of_high.pixels[i] - source) * (low / high), b = of_low.pixels[i] - source;
    const double error = std::abs(a - b) / (std::abs(static_cast<double>(of_high.pixels[i])) + source + 0.01);
    if (!(error <= worst)) {
      worst = error;
      at = i;
    }
  }
  return within_bound(worst, hold.numbers.at("within"),
                      fmt::format("{} from {:g} to {:g}: what is added is {:.3g} off from being in proportion, {}",
                                  setting, low, high, worst, place_of(of_high, at)));
}

constexpr Check kLightChecks[] = {
    {"black", "black", "black stays black", black},
    {"constant", "constant", "one colour stays one colour", constant},
    {"mean", "mean", "the mean stays", mean},
    {"no_added_light", "no_added_light", "the mean does not grow", no_added_light},
    {"monotone", "monotone", "brighter greys give nothing darker", monotone},
    {"bounded", "bounded", "results of greys lie within bounds", bounded},
    {"linear", "linear", "the result of a sum is the sum of results", linear},
    {"proportional", "proportional", "what is added is proportional to a setting", proportional},
};

}  // namespace

Picture greys_of(const Situation& s) {
  return with_color(s, [](int, int, float* p) { set_grey(p, grey_of(p)); });
}

std::span<const Check> light_checks() { return kLightChecks; }

}  // namespace afterglow::stress
