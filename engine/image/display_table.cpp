// SPDX-License-Identifier: MIT
#include "image/display_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/file.h"
#include "core/parallel.h"
#include "image/icc_profile.h"

namespace afterglow {
namespace {

/// What a lattice covers: `cells` lie between light 0 and 1, as densely beyond up to `high`; `cells_below` between −1
/// and 0, as densely down to `low`.
struct DisplayDomain {
  double bend;
  int cells, cells_below;
  double low, high;
};
// docs/player.md tells the errors that these make.
constexpr DisplayDomain kScene{3, 32, 12, -4, 64}, kMonitor{0.25, 40, 16, -0.6, 4};

double bent(double bend, double light) { return std::log2(1 + bend * std::pow(std::abs(light), 0.375)); }

double light_at(const DisplayTable& table, int plane) {
  const double way = plane - table.zero;
  const double log = way / static_cast<double>(way < 0 ? table.cells_below : table.cells);
  const double light = std::pow((std::exp2(std::abs(log)) - 1) / static_cast<double>(table.bend), 1 / 0.375);
  return way < 0 ? -light : light;
}

DisplayTable empty_table(const DisplayDomain& domain, std::string name) {
  DisplayTable out;
  out.name = std::move(name);
  const double one = bent(domain.bend, 1);
  out.bend = static_cast<float>(domain.bend);
  out.cells = static_cast<float>(domain.cells / one);
  out.cells_below = static_cast<float>(domain.cells_below / one);
  out.zero = static_cast<int>(std::ceil(domain.cells_below * bent(domain.bend, domain.low) / one));
  out.planes = out.zero + static_cast<int>(std::ceil(domain.cells * bent(domain.bend, domain.high) / one)) + 1;
  out.size = {out.planes * kDisplayTiles, out.planes * ((out.planes + kDisplayTiles - 1) / kDisplayTiles)};
  out.codes.assign(static_cast<std::size_t>(out.size.area()) * 4, 0);
  return out;
}

std::size_t texel_of(const DisplayTable& table, int r, int g, int b) {
  const int x = r + table.planes * (b % kDisplayTiles), y = g + table.planes * (b / kDisplayTiles);
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(table.size.width) + static_cast<std::size_t>(x)) * 4;
}

void fill(DisplayTable& table, const ColorFunction& exact) {
  std::vector<float> light(static_cast<std::size_t>(table.planes));
  for (int plane = 0; plane < table.planes; ++plane)
    light[static_cast<std::size_t>(plane)] = static_cast<float>(light_at(table, plane));
  parallel_for(static_cast<std::size_t>(table.planes), [&](std::size_t slice) {
    std::vector<float> colors;
    colors.reserve(light.size() * light.size() * 3);
    for (const float g : light)
      for (const float r : light) colors.insert(colors.end(), {r, g, light[slice]});
    exact(colors.data(), colors.size() / 3);
    std::size_t from = 0;
    for (int g = 0; g < table.planes; ++g)
      for (int r = 0; r < table.planes; ++r, from += 3) {
        float* texel = &table.codes[texel_of(table, r, g, static_cast<int>(slice))];
        // Held near what can be shown, so that weights of 0 stay without effect and the fraction counts.
        for (std::size_t c = 0; c < 3; ++c)
          texel[c] = std::isnan(colors[from + c]) ? 0 : std::clamp(colors[from + c], -1.0f, 2.0f);
        texel[3] = 1;
      }
  });
}

/// Colours as pictures have them: a luminance, and red and blue up to two stops from it.
std::vector<float> usual_colors(double least_stop, double most_stop) {
  std::uint32_t state = 1;
  const auto between = [&](double low, double high) {
    state = state * 1664525 + 1013904223;
    return low + (high - low) * (state / 4294967296.0);
  };
  std::vector<float> out;
  for (int i = 0; i < 4096; ++i) {
    const double stop = between(least_stop, most_stop);
    for (const double v : {stop + between(-2, 2), stop, stop + between(-2, 2)})
      out.push_back(static_cast<float>(std::exp2(v)));
  }
  return out;
}

void measure(DisplayTable& table, const ColorFunction& exact, double most_stop) {
  const std::vector<float> light = usual_colors(-12, most_stop);
  std::vector<float> codes = light;
  exact(codes.data(), codes.size() / 3);
  double sum = 0;
  for (std::size_t i = 0; i < light.size(); i += 3) {
    const auto read = read_display_table(table, {light[i], light[i + 1], light[i + 2]});
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = 255 * std::abs(read[c] - std::clamp(static_cast<double>(codes[i + c]), 0.0, 1.0));
      table.largest_error = std::max(table.largest_error, error);
      sum += error;
    }
  }
  table.mean_error = sum / static_cast<double>(light.size());
}

}  // namespace

Result<ShownDisplay> display_of_config(const OcioRequest& request) {
  AFTERGLOW_TRY(OcioSurvey survey, survey_ocio(request));
  AFTERGLOW_TRY(const OcioFunction view, ocio_function(request));
  ShownDisplay out{.table = empty_table(kScene, view.display + ", " + view.view),
                   .display = view.display,
                   .view = view.view,
                   .choices = std::move(survey.displays),
                   .files = {request.config}};
  for (const auto& file : survey.files) out.files.push_back(file.path);
  fill(out.table, view.apply);
  measure(out.table, view.apply, 4);
  return out;
}

Result<DisplayTable> icc_display_table(const std::filesystem::path& file) {
  AFTERGLOW_TRY(const std::string bytes, read_file(file));
  auto profile = display_profile({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  if (!profile) {
    Error error = std::move(profile).error();
    error.file = file.string();
    return error;
  }
  DisplayTable out = empty_table(kMonitor, profile->name.empty() ? file.filename().string() : profile->name);
  fill(out, profile->apply);
  measure(out, profile->apply, 0);
  return out;
}

std::array<double, 3> read_display_table(const DisplayTable& table, const std::array<double, 3>& light) {
  std::array<int, 3> corner{};
  std::array<std::size_t, 3> order{0, 1, 2};
  std::array<double, 3> part{}, sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double bend = bent(static_cast<double>(table.bend), light[i]);
    const double at = table.zero + (light[i] < 0 ? -static_cast<double>(table.cells_below) * bend
                                                 : static_cast<double>(table.cells) * bend);
    const double held = std::clamp(at, 0.0, table.planes - 1.0);
    corner[i] = std::min(static_cast<int>(held), table.planes - 2);
    part[i] = held - corner[i];
  }
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return part[a] > part[b]; });
  double before = 1;
  for (std::size_t step = 0; step <= 3; ++step) {
    const double next = step < 3 ? part[order[step]] : 0;
    const float* codes = &table.codes[texel_of(table, corner[0], corner[1], corner[2])];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += (before - next) * static_cast<double>(codes[c]);
    if (step < 3) ++corner[order[step]];
    before = next;
  }
  for (double& code : sum) code = std::clamp(code, 0.0, 1.0);
  return sum;
}

}  // namespace afterglow
