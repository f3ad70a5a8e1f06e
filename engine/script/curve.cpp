// SPDX-License-Identifier: MIT
#include "script/curve.h"

#include <algorithm>
#include <cmath>

namespace afterglow::script {

SettingValue interpolate(const SettingValue& a, const SettingValue& b, double factor, double snap_at) {
  if (factor <= 0) return a;
  if (b.type == SettingType::boolean || b.type == SettingType::enumeration || b.type == SettingType::file ||
      b.type == SettingType::text)
    return factor >= snap_at ? b : a;
  if (factor >= 1) return b;
  SettingValue mixed = a;
  for (std::size_t i = 0; i < mixed.number.size(); ++i)
    mixed.number[i] = a.number[i] + (b.number[i] - a.number[i]) * factor;
  if (b.type == SettingType::integer) mixed.number[0] = std::round(mixed.number[0]);
  return mixed;
}

SettingValue Curve::value(double at) const {
  const auto next = std::find_if(keys.begin(), keys.end(), [&](const CurveKey& key) { return key.at > at; });
  if (next == keys.begin()) return next->value;
  const auto last = std::prev(next);
  if (next == keys.end() || ease == Ease::step) return last->value;
  const double u = (at - last->at) / (next->at - last->at);
  return interpolate(last->value, next->value, ease == Ease::smooth ? u * u * (3 - 2 * u) : u, 1);
}

}  // namespace afterglow::script
