// SPDX-License-Identifier: MIT
#include "apps/bench_matrix.h"

#include <fmt/format.h>

#include "apps/options.h"
#include "core/text.h"

namespace afterglow {
namespace {

constexpr const char* kChosen = "chosen";
constexpr const char* kChecked = "checked";
constexpr int kLeastSquare = 256;

}  // namespace

Result<std::vector<Size>> parse_sizes(const std::string& text) {
  std::vector<Size> out;
  for (const auto& part : split(text, ',')) {
    AFTERGLOW_TRY(const Size size, parse_size(trim(part)));
    out.push_back(size);
  }
  return out;
}

Result<std::vector<bench::Variant>> parse_variants(const std::string& text) {
  std::vector<bench::Variant> out;
  for (const auto& part : split(text, ',')) {
    bench::Variant variant{.label = trim(part), .choice = {}, .settings = {}, .overrides = {}};
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

Result<std::vector<bench::Variant>> vary_settings(const std::vector<bench::Variant>& variants,
                                                  const std::vector<std::string>& vary) {
  std::vector<bench::Variant> out = variants;
  for (const auto& text : vary) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      return Error{ErrorKind::usage, fmt::format("'{}' varies nothing", text), "--vary", 0,
                   "EFFECT.SETTING=VALUE,VALUE,…"};
    std::vector<bench::Variant> next;
    for (const auto& variant : out)
      for (const auto& value : split(std::string_view(text).substr(equals + 1), ',')) {
        const std::string one = text.substr(0, equals + 1) + value;
        AFTERGLOW_TRY(Override parsed, parse_override(one));
        bench::Variant varied = variant;
        varied.settings += (varied.settings.empty() ? "" : " ") + one;
        varied.overrides.push_back(std::move(parsed));
        next.push_back(std::move(varied));
      }
    out = std::move(next);
  }
  return out;
}

std::vector<Size> scaling_sizes(int most) {
  std::vector<Size> out;
  for (int side = kLeastSquare; side <= most; side *= 2) out.push_back({side, side});
  return out;
}

}  // namespace afterglow
