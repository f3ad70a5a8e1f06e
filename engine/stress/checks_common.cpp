// SPDX-License-Identifier: MIT
// What every stack must stand, whatever its effects promise.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/half.h"
#include "image/picture.h"
#include "stress/check.h"
#include "stress/pictures.h"

namespace afterglow::stress {
namespace {

/// Ways that must make the same numbers; the usual one is compared with the plain one in any case.
const std::vector<ExecutionConfig>& other_choices() {
  static const std::vector<ExecutionConfig> all{
      {.fusion = Fusion::none},
      {.fusion = Fusion::filters, .share_memory = false},
      {.fusion = Fusion::all, .storage_reads = true},
      {.fusion = Fusion::all, .share_memory = false, .rows = 3},
      {.fusion = Fusion::all, .storage_reads = true, .rows = 8},
      {.fusion = Fusion::filters, .storage_reads = true, .rows = 4},
      {.fusion = Fusion::all, .compute = true},
      {.fusion = Fusion::all, .dispatched = true},
      {.fusion = Fusion::all, .storage_reads = true, .compute = true, .dispatched = true, .rows = 4},
  };
  return all;
}

constexpr double kSame = 2e-6;       // between ways of execution, of a pixel's largest channel
constexpr double kRegrouped = 2e-5;  // where workgroups add in another order

Way half_way(const Harness& harness) {
  Way way = usual_way(harness);
  way.choice.storage = Storage::fp16;
  return way;
}

Outcome all_finite(const Image& image, double largest, const std::string& what) {
  std::size_t bad = 0, first = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (!(std::abs(image.pixels[i]) <= largest) && bad++ == 0) first = i;
  if (bad == 0) return {};
  return {.holds = false,
          .measured = static_cast<double>(bad),
          .allowed = 0,
          .what = fmt::format("{}: {} samples are not finite or above {:g}, first {}: {:g}", what, bad, largest,
                              place_of(image, first), image.pixels[first])};
}

/// What reading must have made of whatever the file held.
Outcome source_is_sound(const Picture& picture) {
  for (std::size_t i = 0; i < picture.color.pixels.size(); ++i) {
    const float v = picture.color.pixels[i];
    if (!std::isfinite(v) || (i % 4 < 3 && (v < 0 || v > kLargestColor)))
      return {.holds = false,
              .measured = 1,
              .allowed = 0,
              .what = fmt::format("the source: {} is {:g}", place_of(picture.color, i), v)};
  }
  return {};
}

Result<Outcome> finite(Harness& harness, const Situation& s, const Invariant&) {
  if (auto sound = source_is_sound(s.picture); !sound.holds) return sound;
  AFTERGLOW_TRY(const auto images, harness.images(s.look, s.picture, s.frame));
  for (const auto& [name, image] : images)
    if (auto outcome = all_finite(image, std::numeric_limits<float>::max(), "image " + name); !outcome.holds)
      return outcome;
  return Outcome{};
}

/// As users run it, in full and in half floats, and one of the images in between.
Result<Outcome> finite_fused(Harness& harness, const Situation& s, const Invariant&) {
  AFTERGLOW_TRY(const LookFacts facts, harness.facts(s.look, s.picture.color.size(), s.frame));
  Random random(s.seed);
  const std::string between = facts.images.empty() ? "" : random.pick(facts.images);
  for (const bool half : {false, true})
    for (const std::string& shown : {std::string(), between}) {
      Way way = half ? half_way(harness) : usual_way(harness);
      way.show = shown;
      AFTERGLOW_TRY(const Made made, harness.run(s.look, s.picture, s.frame, way));
      // Only what is stored in half floats ends at their largest.
      const bool stored = half && facts.runs;
      const double largest = stored ? kMaxHalf : std::numeric_limits<float>::max();
      if (auto outcome = all_finite(made.image, largest, way.name()); !outcome.holds) return outcome;
      if (between.empty()) break;
    }
  return Outcome{};
}

/// What one frame hands on must not spoil the next, whatever comes: light that grows, goes out and comes again.
Result<Outcome> finite_frames(Harness& harness, const Situation& s, const Invariant&) {
  AFTERGLOW_TRY(const LookFacts facts, harness.facts(s.look, s.picture.color.size(), s.frame));
  if (!facts.looks_back || !facts.runs) return not_applicable();
  std::vector<Picture> frames;
  for (const float light : {1.0f, 3.0f, 0.0f, 1.0f, 0.25f}) {
    frames.push_back(changed(s.picture));
    Image& color = frames.back().color;
    for (std::size_t i = 0; i < color.pixels.size(); ++i)
      if (i % 4 < 3) color.pixels[i] = std::min(color.pixels[i] * light, kLargestColor);
  }
  Random random(s.seed);
  const Way way = random.chance(0.3) ? Way{.plain = true} : usual_way(harness);
  AFTERGLOW_TRY(const auto made, harness.run_sequence(s.look, frames, s.frame, way));
  for (std::size_t i = 0; i < made.size(); ++i) {
    const std::string what = fmt::format("frame {} of a sequence, {}", i + 1, way.name());
    if (auto outcome = all_finite(made[i].image, std::numeric_limits<float>::max(), what); !outcome.holds)
      return outcome;
  }
  return Outcome{};
}

Result<Outcome> alpha(Harness& harness, const Situation& s, const Invariant&) {
  for (const bool plain : {false, true}) {
    Way way = usual_way(harness);
    way.plain = plain;
    AFTERGLOW_TRY(Made made, harness.run(s.look, s.picture, s.frame, way));
    Image wanted = made.image;
    for (std::size_t i = 3; i < wanted.pixels.size(); i += 4) wanted.pixels[i] = s.picture.color.pixels[i];
    if (auto outcome = compare(made.image, wanted, 0, "alpha, " + way.name()); !outcome.holds) return outcome;
  }
  return Outcome{};
}

/// The same picture again, after another one has been through the same memory.
Result<Outcome> repeated(Harness& harness, const Situation& s, const Invariant&) {
  Random random(s.seed);
  const Way way = random.chance(0.5) ? half_way(harness) : usual_way(harness);
  const Picture picture = changed(s.picture);  // so that it does run again
  AFTERGLOW_TRY(const Made first, harness.run(s.look, picture, s.frame, way));
  Picture other = picture;
  for (float& v : other.color.pixels) v = 0.7f * (v > 0.5f ? 0.0f : 3.0f);
  AFTERGLOW_TRY(const Made between, harness.run(s.look, other, s.frame, way));
  (void)between;
  AFTERGLOW_TRY(const Made second, harness.run(s.look, picture, s.frame, way));
  return compare(second.image, first.image, 0, "the same picture again, " + way.name());
}

Result<Outcome> same_ways(Harness& harness, const Situation& s, const Invariant&) {
  Random random(s.seed);
  AFTERGLOW_TRY(const Made plain, harness.run(s.look, s.picture, s.frame, {.plain = true}));
  Outcome worst;
  for (const ExecutionConfig& choice : {harness.usual(), random.pick(other_choices())}) {
    const Way way{.choice = choice, .copied = choice.compute};  // else the last pass would be drawn in any case
    AFTERGLOW_TRY(const Made made, harness.run(s.look, s.picture, s.frame, way));
    Outcome outcome = compare(made.image, plain.image, way.choice.compute ? kRegrouped : kSame,
                              way.name() + " against plain", MeasuredBy::pixel);
    if (!outcome.holds) return outcome;
    if (outcome.measured >= worst.measured) worst = std::move(outcome);
  }
  return worst;
}

Rect random_part(Size size, Random& random) {
  Rect part;
  part.width = random.between(1, std::max(1, size.width / 2));
  part.height = random.between(1, std::max(1, size.height / 2));
  part.x = random.between(0, size.width - part.width);
  part.y = random.between(0, size.height - part.height);
  return part;
}

/// Other pixels wherever nothing is to be read.
void spoil_outside(Image& image, const Rect& read) {
  constexpr float kOther = 12.5f;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (x >= read.x && x < read.x + read.width && y >= read.y && y < read.y + read.height) continue;
      for (int c = 0; c < image.channels; ++c) image.at(x, y)[c] = c < 3 ? image.at(x, y)[c] * 0.5f + kOther : 0.5f;
    }
}

/// A region is the crop of the whole, bit for bit. What is not read of the source must not matter: what an effect reads
/// beyond the reach that it states is other pixels here.
Result<Outcome> region(Harness& harness, const Situation& s, const Invariant&) {
  Random random(s.seed);
  Way way = random.chance(0.3) ? half_way(harness) : usual_way(harness);
  AFTERGLOW_TRY(const Made whole, harness.run(s.look, s.picture, s.frame, way));
  way.region = random_part(s.picture.color.size(), random);
  AFTERGLOW_TRY(const auto read, harness.read_of_inputs(s.look, s.picture, s.frame, way));
  Picture spoiled = changed(s.picture);
  for (const auto& [name, rect] : read) {
    if (name == "source")
      spoil_outside(spoiled.color, rect);
    else if (const auto found = spoiled.auxiliary.find(name); found != spoiled.auxiliary.end())
      spoil_outside(found->second, rect);
  }
  AFTERGLOW_TRY(const Made part, harness.run(s.look, spoiled, s.frame, way));
  return compare(cropped(part.image, *way.region), cropped(whole.image, *way.region), 0, way.name());
}

bool is_opaque(const Image& rgba) {
  for (std::size_t i = 3; i < rgba.pixels.size(); i += 4)
    if (rgba.pixels[i] != 1) return false;
  return true;
}

/// Effects that the content makes idle: as if they had run. Where alpha is 1 everywhere, kernels without the division
/// by it are other code, whose sums drivers may round otherwise.
Result<Outcome> idle(Harness& harness, const Situation& s, const Invariant&) {
  Way way = usual_way(harness);
  AFTERGLOW_TRY(const Made all, harness.run(s.look, s.picture, s.frame, way));
  way.skip_idle = true;
  AFTERGLOW_TRY(const Made some, harness.run(s.look, s.picture, s.frame, way));
  AFTERGLOW_TRY(const LookFacts facts, harness.facts(s.look, s.picture.color.size(), s.frame));
  const bool other_code = facts.divides && is_opaque(s.picture.color);
  return compare(some.image, all.image, other_code ? kSame : 0, way.name(), MeasuredBy::pixel);
}

/// A frame is the same alone and within a sequence.
Result<Outcome> rebuilt(Harness& harness, const Situation& s, const Invariant&) {
  AFTERGLOW_TRY(const LookFacts facts, harness.facts(s.look, s.picture.color.size(), s.frame));
  if (facts.changing.empty()) return Outcome{};
  return Outcome{.holds = false, .measured = 1, .allowed = 0, .what = facts.changing};
}

constexpr Check kCommonChecks[] = {
    {"finite", nullptr, "nothing non-finite leaves any pass, each on its own in full floats", finite},
    {"finite_fused", nullptr, "nor as users run it, in full and half floats, nor any image in between", finite_fused},
    {"finite_frames", nullptr, "nor does what one frame hands on make a later one so", finite_frames},
    {"alpha", nullptr, "alpha is the source's, bit for bit", alpha},
    {"repeated", nullptr, "the same picture again gives the same bits", repeated},
    {"rebuilt", nullptr, "build makes the same graph again, whatever frame was built in between", rebuilt},
    {"same_ways", nullptr,
     "fused or not, whatever the layout of memory: within 2e-6 of plain passes in full floats, by a pixel's "
     "largest channel",
     same_ways},
    {"region", nullptr, "a region is the crop of the whole, bit for bit", region},
    {"idle", nullptr,
     "frames without idle effects are as if they had run, bit for bit; those without division by an alpha of 1 within "
     "2e-6",
     idle},
};

}  // namespace

std::span<const Check> common_checks() { return kCommonChecks; }

}  // namespace afterglow::stress
