// SPDX-License-Identifier: MIT
#include "apps/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "core/file.h"
#include "core/text.h"
#include "image/input_space.h"
#include "image/srgb.h"
#include "image/writer.h"

namespace afterglow {
namespace {

constexpr Chromaticities kAp1{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};

std::string reason_against(const Look& look, const Pass& pass) {
  if (pass.kind != PassKind::pixel) return "reads around";
  const auto shader = look.shaders->find(pass.shader);
  if (shader && (*shader)->interface.at_pixel) return "looks at the place of a pixel";
  for (const auto& input : pass.inputs) {
    const auto& image = look.build.graph.images[static_cast<std::size_t>(input.image)];
    const bool picture = input.image == look.build.graph.source || image.producer >= 0;
    if (!input.pixelwise && input.name != "source" && !image.data) return "reads around";
    if (!picture && !image.data) return "reads another layer or frame";
  }
  return {};
}

/// Scene-linear light of what the table is asked for.
std::array<float, 3> light_of(const Cube& cube, const std::array<double, 3>& v) {
  std::array<float, 3> out{};
  if (cube.shaper == Shaper::none) {
    for (std::size_t i = 0; i < 3; ++i) out[i] = static_cast<float>(srgb_to_linear(v[i]));
    return out;
  }
  static const Matrix3 matrix = to_rec709(kAp1);
  static const auto curve = (*find_input_space("acescct"))->to_linear;
  const std::array<double, 3> ap1{curve(v[0]), curve(v[1]), curve(v[2])};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = static_cast<float>(std::max(cube.keeps_negative ? -1e30 : 0.0,
                                         matrix[i][0] * ap1[0] + matrix[i][1] * ap1[1] + matrix[i][2] * ap1[2]));
  return out;
}

/// Display codes of these inputs of the table.
Result<std::vector<std::array<float, 3>>> codes_of(const Cube& cube, const std::vector<std::array<double, 3>>& inputs,
                                                   const Through& through) {
  constexpr int kWidth = 1024;
  const int height = (static_cast<int>(inputs.size()) + kWidth - 1) / kWidth;
  Picture picture;
  picture.color = Image(kWidth, height, 4);
  picture.data_window = picture.display_window = {0, 0, kWidth, height};
  for (std::size_t i = 0; i < static_cast<std::size_t>(kWidth) * static_cast<std::size_t>(height); ++i) {
    const auto light = light_of(cube, inputs[std::min(i, inputs.size() - 1)]);
    std::copy(light.begin(), light.end(), &picture.color.pixels[i * 4]);
    picture.color.pixels[i * 4 + 3] = 1;
  }
  AFTERGLOW_CHECK(through(picture));
  std::vector<std::array<float, 3>> codes(inputs.size());
  for (std::size_t i = 0; i < codes.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      codes[i][c] = static_cast<float>(linear_to_srgb(std::clamp(double(picture.color.pixels[i * 4 + c]), 0.0, 1.0)));
  return codes;
}

std::array<double, 3> tetrahedral(const Cube& cube, const std::array<double, 3>& v) {
  std::array<int, 3> corner{};
  std::array<std::size_t, 3> order{0, 1, 2};
  std::array<double, 3> f{}, sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double p = std::clamp(v[i], 0.0, 1.0) * (cube.size - 1);
    corner[i] = std::min(static_cast<int>(p), cube.size - 2);
    f[i] = p - corner[i];
  }
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return f[a] > f[b]; });
  double before = 1;
  for (std::size_t step = 0; step <= 3; ++step) {
    const double next = step < 3 ? f[order[step]] : 0;
    const auto& value =
        cube.codes[static_cast<std::size_t>((corner[2] * cube.size + corner[1]) * cube.size + corner[0])];
    for (std::size_t i = 0; i < 3; ++i) sum[i] += (before - next) * double(value[i]);
    if (step < 3) ++corner[order[step]];
    before = next;
  }
  return sum;
}

// The format has no quotation marks inside of its texts.
std::string cube_text(const Cube& cube, std::string title) {
  std::ranges::replace(title, '"', '\'');
  std::string out =
      fmt::format("# {} to {}\nTITLE \"{}\"\nLUT_3D_SIZE {}\n", cube.shaper == Shaper::log ? "ACEScct" : "sRGB codes",
                  cube.of_view ? "the codes of the look's view" : "sRGB codes of a display", title, cube.size);
  for (const auto& c : cube.codes) out += fmt::format("{:.7f} {:.7f} {:.7f}\n", c[0], c[1], c[2]);
  return out;
}

// Common LUT Format 3: with a logarithm it begins with scene-linear Rec.709 and does the way to ACEScct itself.
std::string clf_text(const Cube& cube, const std::string& title) {
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ProcessList id=\"afterglow\" name=\"{}\" compCLFversion=\"3.0\">\n",
      markup_text(title));
  if (cube.shaper == Shaper::log) {
    const Matrix3 m = inverse(to_rec709(kAp1));
    out += "  <Matrix inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"3 3\">\n";
    for (const auto& row : m) out += fmt::format("    {:.12f} {:.12f} {:.12f}\n", row[0], row[1], row[2]);
    out +=
        "  </Array></Matrix>\n  <Log inBitDepth=\"32f\" outBitDepth=\"32f\" style=\"cameraLinToLog\">\n"
        "    <LogParams base=\"2\" logSideSlope=\"0.0570776255707763\" logSideOffset=\"0.554794520547945\" "
        "linSideSlope=\"1\" linSideOffset=\"0\" linSideBreak=\"0.0078125\" linearSlope=\"10.5402377416545\"/>\n  "
        "</Log>\n";
  }
  out += fmt::format(
      "  <LUT3D inBitDepth=\"32f\" outBitDepth=\"32f\" interpolation=\"tetrahedral\"><Array dim=\"{0} {0} {0} 3\">\n",
      cube.size);
  for (int r = 0; r < cube.size; ++r)
    for (int g = 0; g < cube.size; ++g)
      for (int b = 0; b < cube.size; ++b) {  // blue runs fastest
        const auto& c = cube.codes[static_cast<std::size_t>((b * cube.size + g) * cube.size + r)];
        out += fmt::format("{:.7f} {:.7f} {:.7f}\n", c[0], c[1], c[2]);
      }
  return out + "  </Array></LUT3D>\n</ProcessList>\n";
}

Result<void> write_strip(const Cube& cube, const std::filesystem::path& file) {
  const int n = cube.size;
  Picture picture;
  picture.color = Image(n * n, n, 4);
  picture.data_window = picture.display_window = {0, 0, n * n, n};
  for (int b = 0; b < n; ++b)
    for (int g = 0; g < n; ++g)
      for (int r = 0; r < n; ++r) {
        const auto& c = cube.codes[static_cast<std::size_t>((b * n + g) * n + r)];
        float* pixel = picture.color.at(b * n + r, g);
        for (std::size_t i = 0; i < 3; ++i) pixel[i] = static_cast<float>(srgb_to_linear(double(c[i])));
        pixel[3] = 1;
      }
  Diagnostics quiet;
  WriteOptions options;
  options.type = SampleType::uint16;
  options.png_level = 6;
  return write_picture(picture, file, options, quiet);
}

}  // namespace

std::vector<std::string> unbakeable(const Look& look) {
  std::map<std::string, std::string> reasons;
  for (const auto& history : look.build.graph.histories) reasons.emplace(history.effect, "looks back");
  for (const auto& pass : look.build.graph.passes)
    if (const auto reason = reason_against(look, pass); !reason.empty()) reasons.emplace(pass.effect, reason);
  std::vector<std::string> out;
  for (const auto& entry : look.preset->entries())
    if (const auto found = reasons.find(entry.name); found != reasons.end())
      out.push_back(fmt::format("{} ({})", found->first, found->second));
  return out;
}

Result<Cube> bake_cube(int size, Shaper shaper, bool keeps_negative, const Through& through) {
  std::vector<std::array<double, 3>> inputs;
  const double last = size - 1;
  for (int b = 0; b < size; ++b)
    for (int g = 0; g < size; ++g)
      for (int r = 0; r < size; ++r) inputs.push_back({r / last, g / last, b / last});
  Cube cube{size, shaper, keeps_negative};
  AFTERGLOW_TRY(cube.codes, codes_of(cube, inputs, through));
  return cube;
}

Result<BakeError> bake_error(const Cube& cube, int count, const Through& through) {
  std::uint32_t state = 1;
  const auto next = [&] { return (state = state * 1664525 + 1013904223) / 4294967296.0; };
  std::vector<std::array<double, 3>> inputs;
  for (int i = 0; i < count; ++i) inputs.push_back({next(), next(), next()});
  AFTERGLOW_TRY(const auto exact, codes_of(cube, inputs, through));
  BakeError error;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto found = tetrahedral(cube, inputs[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const double difference = 255 * std::abs(found[c] - double(exact[i][c]));
      error.most = std::max(error.most, difference);
      error.mean += difference / (3.0 * count);
    }
  }
  return error;
}

Result<std::string> cube_extension(const std::filesystem::path& file) {
  const std::string extension = lower(file.extension().string());
  if (extension == ".cube" || extension == ".clf" || extension == ".png") return extension;
  return Error{ErrorKind::usage, fmt::format("'{}' is no format of tables that can be written", extension),
               file.string(), 0, ".cube, .clf, .png"};
}

Result<void> write_cube(const Cube& cube, const std::string& title, const std::filesystem::path& file) {
  AFTERGLOW_TRY(const std::string extension, cube_extension(file));
  if (extension == ".cube") return write_file_atomically(file, cube_text(cube, title));
  if (extension == ".clf") return write_file_atomically(file, clf_text(cube, title));
  return write_strip(cube, file);
}

}  // namespace afterglow
