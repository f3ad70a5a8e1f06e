// SPDX-License-Identifier: MIT
#include "bench/shots.h"

#include <fmt/format.h>

#include "image/reader.h"
#include "image/sequence.h"

namespace afterglow::bench {
namespace {

constexpr double kRadii[] = {0.25, 0.5, 1, 2, 4, 8};  ///< pixels
constexpr Size kSize{640, 360}, kQuickSize{160, 90};
constexpr int kFrames = 34, kQuickFrames = 6;  ///< 32 that count: a way of four pixels

struct Shot {
  std::string scene;
  double radius = 0;
  std::vector<Picture> frames;
};

Result<Shot> read_shot(const std::string& pattern, Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Pattern parsed, parse_pattern(pattern));
  AFTERGLOW_TRY(const auto files, find_frames(parsed, {}));
  Shot shot{.scene = std::filesystem::path(pattern).filename().string(), .frames = {}};
  for (const auto& file : files) {
    AFTERGLOW_TRY(Picture picture, read_picture(file.file, {}, diagnostics));
    if (!shot.frames.empty() && picture.color.size() != shot.frames.front().color.size())
      return Error{ErrorKind::io, "is of another size than the frames before it", file.file.string()};
    shot.frames.push_back(std::move(picture));
  }
  if (shot.frames.size() < 5) return Error{ErrorKind::io, "a shot needs 5 frames or more", pattern};
  return shot;
}

Result<std::vector<Shot>> shots_of(const StabilityRequest& request, Diagnostics& diagnostics) {
  std::vector<Shot> out;
  if (!request.shot.empty()) {
    AFTERGLOW_TRY(Shot shot, read_shot(request.shot, diagnostics));
    out.push_back(std::move(shot));
    return out;
  }
  for (const double radius : kRadii)
    out.push_back(
        {fmt::format("highlight of {:g} px", radius), radius,
         drifting_highlight(request.quick ? kQuickSize : kSize, radius, request.quick ? kQuickFrames : kFrames)});
  return out;
}

}  // namespace

std::size_t steps_of(const StabilityRequest& request) {
  const std::size_t frames = request.quick ? kQuickFrames : kFrames;
  const std::size_t shots = request.shot.empty() ? std::size(kRadii) : 1;
  return request.presets.size() * request.variants.size() * (shots * frames + request.sizes.size());
}

Result<void> measure_stability(const StabilityRequest& request, Report& report, Diagnostics& diagnostics,
                               const Step& step) {
  AFTERGLOW_TRY(const auto shots, shots_of(request, diagnostics));
  for (const auto& preset : request.presets)
    for (const auto& variant : request.variants) {
      for (const auto& shot : shots) {
        AFTERGLOW_TRY(auto curve, measure_shot({.preset = preset,
                                                .options = request.options,
                                                .variant = variant,
                                                .scene = shot.scene,
                                                .radius = shot.radius},
                                               shot.frames, diagnostics, step));
        report.temporal.push_back(std::move(curve));
      }
      AFTERGLOW_TRY(const auto points,
                    measure_resolutions(preset, request.options, variant, request.sizes, diagnostics, step));
      report.resolutions.insert(report.resolutions.end(), points.begin(), points.end());
    }
  return {};
}

}  // namespace afterglow::bench
