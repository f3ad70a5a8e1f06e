// SPDX-License-Identifier: MIT
#include "batch/non_finite_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace afterglow {
namespace {

using Json = nlohmann::ordered_json;

/// A value that JSON may have no number for.
Json value_json(float value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

Json counts_json(const NonFinite& found) {
  Json value = Json::array();
  for (int c = 0; c < found.first->channels; ++c)
    value.push_back(value_json(found.first->values[static_cast<std::size_t>(c)]));
  return {{"nan", found.nan},
          {"plus_infinity", found.plus_infinity},
          {"minus_infinity", found.minus_infinity},
          {"first", Json{{"x", found.first->x}, {"y", found.first->y}, {"value", value}}}};
}

}  // namespace

nlohmann::ordered_json overflows_json(const FrameNonFinite& found) {
  Json out = Json::array();
  for (const auto& pass : found.overflows)
    out.push_back(
        {{"pass", pass.pass}, {"effect", pass.effect}, {"samples", pass.samples}, {"first", pass.first.text()}});
  return out;
}

nlohmann::ordered_json non_finite_json(const FrameNonFinite& found) {
  Json out = Json::object();
  for (const auto& [layer, counts] : found.input) {
    Json one{{"layer", layer}};
    one.update(counts_json(counts));
    out["input"].push_back(std::move(one));
  }
  for (const auto& pass : found.passes) {
    Json one{{"pass", pass.pass}, {"effect", pass.effect}};
    if (!pass.file.empty()) one["file"] = pass.file, one["line"] = pass.line;
    if (!pass.shader.empty()) one["shader"] = pass.shader;
    one["width"] = pass.size.width;
    one["height"] = pass.size.height;
    one.update(counts_json(pass.found));
    out["passes"].push_back(std::move(one));
  }
  if (found.untraced) out["untraced"] = true;
  return out;
}

}  // namespace afterglow
