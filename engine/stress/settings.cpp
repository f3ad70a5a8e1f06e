// SPDX-License-Identifier: MIT
#include "stress/settings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/inside.h"

namespace afterglow::stress {
namespace {

namespace fs = std::filesystem;

constexpr double kOpenNumber = 1e12, kOpenInteger = 1e4;
constexpr double kSmallest = 1e-4;  // of what is drawn by powers of ten

double low_of(const SettingSchema& s) {
  return s.min.value_or(s.type == SettingType::integer ? -kOpenInteger : -kOpenNumber);
}
double high_of(const SettingSchema& s) {
  return s.max.value_or(s.type == SettingType::integer ? kOpenInteger : kOpenNumber);
}

SettingValue with_number(const SettingSchema& setting, double value) {
  SettingValue out{.type = setting.type};
  out.number = {value, value, value};
  if (setting.type == SettingType::integer || setting.type == SettingType::number ||
      setting.type == SettingType::boolean)
    out.number[1] = out.number[2] = 0;
  if (setting.type == SettingType::vec2) out.number[2] = 0;
  return out;
}

SettingValue with_choice(const SettingSchema& setting, const std::string& choice) {
  return {.type = setting.type, .number = {}, .choice = choice};
}

double next_inside(double limit, double towards) {
  return static_cast<double>(std::nextafter(static_cast<float>(limit), static_cast<float>(towards)));
}

std::vector<double> ends_of(const SettingSchema& s) {
  if (s.type == SettingType::boolean) return {0, 1};
  if (s.type == SettingType::color) return {0, 1e30};
  const double low = low_of(s), high = high_of(s);
  if (s.type == SettingType::integer)
    return low + 1 < high ? std::vector{low, low + 1, high - 1, high} : std::vector{low, high};
  return {low, next_inside(low, high), next_inside(high, low), high};
}

double random_number(const SettingSchema& s, Random& random) {
  const double low = low_of(s), high = high_of(s);
  if (random.chance(0.15)) return random.pick(ends_of(s));
  if (random.chance(0.15)) return low;  // where much promises more: no threshold, no blur
  // Counts: of levels, samples, rounds. Few are quick, and let light stay away from the edges.
  if (s.type == SettingType::integer && random.chance(0.4)) return random.between(low, std::min(low + 4, high));
  // Where the range is wide, every power of ten is alike; it may lie on both sides of 0.
  double value = random.between(low, high);
  if (high - low > 100) {
    const double reach = std::max(std::abs(low), std::abs(high));
    value = random.log_between(kSmallest, std::min(reach, 1e6));
    if (low < 0 && random.chance(0.5)) value = -value;
  }
  return std::clamp(static_cast<double>(static_cast<float>(value)), low, high);
}

/// A file that the setting allows, from the assets along the path; empty when there is none.
std::string sample_file(const SettingSchema& setting, const SearchPath& path) {
  std::vector<fs::path> folders(path.user.begin(), path.user.end());
  folders.push_back(path.installation / "assets");
  std::vector<std::string> found;
  for (const auto& folder : folders) {
    std::error_code ec;
    for (fs::recursive_directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
      std::string extension = it->path().extension().string();
      if (!extension.empty()) extension.erase(0, 1);
      const bool fits = std::ranges::find(setting.choices, extension) != setting.choices.end();
      if (fits && it->is_regular_file(ec) && lies_in(it->path(), folder))  // links that lead out may not be named
        found.push_back(it->path().lexically_relative(folder).string());
    }
  }
  std::ranges::sort(found);
  return found.empty() ? std::string() : found.front();
}

LookEntry with_files(const EffectSchema& effect, const SearchPath& path) {
  LookEntry entry{.effect = effect.name, .settings = {}, .at = {}};
  for (const auto& setting : effect.settings)
    if (setting.type == SettingType::file)
      if (const auto file = sample_file(setting, path); !file.empty())
        entry.set(setting.name, with_choice(setting, file));
  return entry;
}

}  // namespace

std::vector<SettingValue> hard_values(const SettingSchema& setting) {
  std::vector<SettingValue> out;
  const auto add = [&](const SettingValue& value) {
    if (!(value == setting.default_value) && std::ranges::find(out, value) == out.end()) out.push_back(value);
  };
  if (setting.type == SettingType::file || setting.type == SettingType::text) return out;
  if (setting.type == SettingType::enumeration) {
    for (const auto& choice : setting.choices) add(with_choice(setting, choice));
    return out;
  }
  for (const double end : ends_of(setting)) add(with_number(setting, end));
  return out;
}

SettingValue random_value(const SettingSchema& setting, Random& random) {
  switch (setting.type) {
    case SettingType::enumeration:
      return with_choice(setting, random.pick(setting.choices));
    case SettingType::file:
    case SettingType::text:
      return setting.default_value;
    case SettingType::boolean:
      return with_number(setting, random.chance(0.5) ? 1 : 0);
    case SettingType::integer:
      return with_number(setting, std::round(random_number(setting, random)));
    default:
      break;
  }
  SettingValue out = with_number(setting, random_number(setting, random));
  if (setting.type == SettingType::color) {
    for (double& v : out.number)
      v = random.chance(0.2) ? random.pick(ends_of(setting))
                             : static_cast<double>(static_cast<float>(random.log_between(0.01, 10)));
  } else if (setting.type != SettingType::number) {
    for (std::size_t i = 0; i < (setting.type == SettingType::vec2 ? 2u : 3u); ++i)
      out.number[i] = random_number(setting, random);
  }
  return out;
}

std::vector<LookEntry> hard_entries(const EffectSchema& effect, const SearchPath& path) {
  const LookEntry plain = with_files(effect, path);
  std::vector<LookEntry> out{plain};
  LookEntry low = plain, high = plain;
  for (const auto& setting : effect.settings) {
    const auto values = hard_values(setting);
    for (const auto& value : values) {
      out.push_back(plain);
      out.back().set(setting.name, value);
    }
    if (values.empty()) continue;
    low.set(setting.name, values.front());
    high.set(setting.name, values.back());
  }
  out.push_back(low);
  out.push_back(high);
  return out;
}

LookEntry random_entry(const EffectSchema& effect, const SearchPath& path, Random& random) {
  LookEntry entry = with_files(effect, path);
  const double share = random.between(0.2, 1.0);
  for (const auto& setting : effect.settings)
    if (setting.type != SettingType::file && random.chance(share))
      entry.set(setting.name, random_value(setting, random));
  return entry;
}

}  // namespace afterglow::stress
