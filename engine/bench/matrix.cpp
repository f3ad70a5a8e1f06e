// SPDX-License-Identifier: MIT
#include "bench/matrix.h"

#include <fmt/format.h>

#include "bench/picture.h"
#include "core/text.h"
#include "image/reader.h"
#include "image/scale.h"

namespace afterglow::bench {
namespace {

constexpr int kLeastSquare = 256;

std::vector<Size> scaling_sizes(int most) {
  std::vector<Size> out;
  for (int side = kLeastSquare; side <= most; side *= 2) out.push_back({side, side});
  return out;
}

Result<Picture> picture_of(const MatrixRequest& request, Size size, Diagnostics& diagnostics) {
  if (request.picture.empty()) return make_picture(size);
  ReadOptions options;
  options.auxiliary = {"depth", "normal", "motion"};
  AFTERGLOW_TRY(Picture picture, read_picture(request.picture, options, diagnostics));
  scale_picture(picture, {size});
  return picture;
}

}  // namespace

Result<std::vector<Variant>> parse_variants(const std::string& text) {
  std::vector<Variant> out;
  for (const auto& part : split(text, ',')) {
    Variant variant{.label = trim(part), .choice = {}, .settings = {}, .overrides = {}};
    variant.check_finite = variant.label == kChecked;
    if (variant.label != kChosen && !variant.check_finite) {
      auto choice = parse_execution(variant.label);
      if (!choice) {
        Error error = std::move(choice).error();
        error.file = "--variants";
        error.allowed += fmt::format(", {}, {}", kChosen, kChecked);
        return error;
      }
      variant.choice = *choice;
    }
    out.push_back(std::move(variant));
  }
  return out;
}

Result<std::vector<Variant>> vary_settings(const std::vector<Variant>& variants, const std::vector<std::string>& vary) {
  std::vector<Variant> out = variants;
  for (const auto& text : vary) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      return Error{ErrorKind::usage, fmt::format("'{}' varies nothing", text), "--vary", 0,
                   "EFFECT.SETTING=VALUE,VALUE,…"};
    std::vector<Variant> next;
    for (const auto& variant : out)
      for (const auto& value : split(std::string_view(text).substr(equals + 1), ',')) {
        const std::string one = text.substr(0, equals + 1) + value;
        AFTERGLOW_TRY(Override parsed, parse_override(one));
        Variant varied = variant;
        varied.settings += (varied.settings.empty() ? "" : " ") + one;
        varied.overrides.push_back(std::move(parsed));
        next.push_back(std::move(varied));
      }
    out = std::move(next);
  }
  return out;
}

std::size_t MatrixRequest::cells() const { return presets.size() * (sizes.size() + scaling_sizes(scaling).size()); }

Result<void> measure_matrix(Device& device, const MatrixRequest& request, Report& report, Diagnostics& diagnostics,
                            const Step& step) {
  const auto measure = [&](Size size, const std::vector<Variant>& variants, bool details) -> Result<void> {
    AFTERGLOW_TRY(const Picture picture, picture_of(request, size, diagnostics));
    for (const auto& preset : request.presets) {
      const CellRequest cell{.preset = preset,
                             .base = request.base,
                             .variants = variants,
                             .picture = &picture,
                             .repeat = request.repeat,
                             .quality = details,
                             .passes = details};
      AFTERGLOW_TRY(Cell measured, measure_cell(device, cell, diagnostics, step));
      report.cells.push_back(std::move(measured));
    }
    return {};
  };
  for (const Size size : request.sizes) AFTERGLOW_CHECK(measure(size, request.variants, true));
  AFTERGLOW_TRY(const auto chosen, parse_variants(kChosen));
  for (const Size size : scaling_sizes(request.scaling)) AFTERGLOW_CHECK(measure(size, chosen, false));
  return {};
}

}  // namespace afterglow::bench
