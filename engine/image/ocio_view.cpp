#include "image/ocio_view.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/text.h"
#include "image/lut_taker.h"

namespace afterglow {
namespace {

/// What configurations call linear Rec.709.
constexpr std::array kLinearRec709{"Linear Rec.709 (sRGB)", "lin_rec709_srgb", "lin_rec709", "Utility - Linear - sRGB",
                                   "Linear Rec.709",        "lin_srgb",        "lin_709",    "Linear BT.709"};

// Linear Rec.709 to ACES2065-1, Bradford-adapted, as OpenColorIO's own configurations have it.
constexpr std::array<double, 16> kAp0FromRec709{0.439632981919,
                                                0.382988698151,
                                                0.177378319930,
                                                0,
                                                0.089776442959,
                                                0.813439428749,
                                                0.096784128292,
                                                0,
                                                0.017541170380,
                                                0.111546553302,
                                                0.870912276318,
                                                0,
                                                0,
                                                0,
                                                0,
                                                1};

template <class Count, class Name>
std::vector<std::string> list(Count count, Name name) {
  std::vector<std::string> out;
  for (int i = 0; i < count; ++i) out.emplace_back(name(i));
  return out;
}

void check_name(const char* what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string nearest = nearest_name(name, known);
  throw Unsupported{fmt::format("has no {} '{}'; allowed: {}{}", what, name, join(known),
                                nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest))};
}

void check_space(const OCIO::Config& config, const std::string& name) {
  if (config.getColorSpace(name.c_str())) return;
  check_name("colour space", name,
             list(config.getNumColorSpaces(), [&](int i) { return config.getColorSpaceNameByIndex(i); }));
}

/// The space that the picture's light is in, and what goes before it to bring it there.
std::string source_space(const OCIO::Config& config, const std::string& wanted, OCIO::GroupTransform& group) {
  if (!wanted.empty()) {
    check_space(config, wanted);
    return wanted;
  }
  for (const char* name : kLinearRec709)
    if (config.getColorSpace(name)) return name;
  if (!config.hasRole("aces_interchange"))
    throw Unsupported{"does not say which of its spaces is linear Rec.709; give `from`"};
  const auto matrix = OCIO::MatrixTransform::Create();
  matrix->setMatrix(kAp0FromRec709.data());
  group.appendTransform(matrix);
  return "aces_interchange";
}

OCIO::GroupTransformRcPtr chain_of(const OCIO::Config& config, const OcioRequest& request) {
  const auto group = OCIO::GroupTransform::Create();
  const std::string from = source_space(config, request.from, *group);
  if (!request.looks.empty()) {
    const auto look = OCIO::LookTransform::Create();
    look->setSrc(from.c_str());
    look->setDst(from.c_str());
    look->setLooks(request.looks.c_str());
    group->appendTransform(look);
  }
  if (!request.to.empty()) {
    check_space(config, request.to);
    const auto space = OCIO::ColorSpaceTransform::Create();
    space->setSrc(from.c_str());
    space->setDst(request.to.c_str());
    group->appendTransform(space);
    return group;
  }
  const std::string display = request.display.empty() ? config.getDefaultDisplay() : request.display;
  check_name("display", display, list(config.getNumDisplays(), [&](int i) { return config.getDisplay(i); }));
  const std::string view = request.view.empty() ? config.getDefaultView(display.c_str()) : request.view;
  check_name("view", view,
             list(config.getNumViews(display.c_str()), [&](int i) { return config.getView(display.c_str(), i); }));
  const auto shown = OCIO::DisplayViewTransform::Create();
  shown->setSrc(from.c_str());
  shown->setDisplay(display.c_str());
  shown->setView(view.c_str());
  shown->setLooksBypass(!request.looks.empty());
  group->appendTransform(shown);
  return group;
}

// ---- the whole in a curve and a cube

constexpr int kCube = 65;
constexpr double kStops = 12;  // on both sides of 1

/// 0 for black, then by logarithm: x + 2^-12 so that the curve goes through 0.
double shaped(double light) {
  const double toe = std::exp2(-kStops);
  return std::clamp(std::log2((std::max(light, 0.0) + toe) / toe) / std::log2(std::exp2(kStops) / toe + 1), 0.0, 1.0);
}
double light_of(double shape) {
  const double toe = std::exp2(-kStops);
  return toe * (std::exp2(shape * std::log2(std::exp2(kStops) / toe + 1)) - 1);
}

std::array<float, 3> tetrahedral(const std::vector<std::array<float, 3>>& cube, const std::array<double, 3>& c) {
  std::array<int, 3> cell{}, order{0, 1, 2};
  std::array<double, 3> f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double p = shaped(c[i]) * (kCube - 1);
    cell[i] = std::min(static_cast<int>(p), kCube - 2);
    f[i] = p - cell[i];
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) { return f[std::size_t(a)] > f[std::size_t(b)]; });
  const auto at = [&](const std::array<int, 3>& i) {
    return cube[static_cast<std::size_t>((i[0] * kCube + i[1]) * kCube + i[2])];
  };
  std::array<double, 3> sum{};
  double before = 1;
  std::array<int, 3> corner = cell;
  for (int step = 0; step <= 3; ++step) {
    const double next = step < 3 ? f[std::size_t(order[std::size_t(step)])] : 0;
    const auto value = at(corner);
    for (std::size_t i = 0; i < 3; ++i) sum[i] += (before - next) * double(value[i]);
    if (step < 3) ++corner[std::size_t(order[std::size_t(step)])];
    before = next;
  }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

Lut baked(const OCIO::ConstConfigRcPtr& config, const OCIO::CPUProcessor& processor) {
  std::vector<std::array<float, 3>> cube(static_cast<std::size_t>(kCube * kCube * kCube));
  LutTaker taker(config);
  taker.begin(LutKind::table_half, 65536, 65536 / kLutRow);
  for (int bits = 0; bits < 65536; ++bits) {
    Imath::half half;
    half.setBits(static_cast<std::uint16_t>(bits));
    const double value = half.isNan() ? 0.0 : std::clamp(double(static_cast<float>(half)), -65504.0, 65504.0);
    const auto shape = static_cast<float>(shaped(value));
    taker.put(bits % kLutRow, bits / kLutRow, {shape, shape, shape, 1});
  }
  taker.begin(LutKind::table3d, kCube, kCube * ((kCube + 1) / 2));
  for (int r = 0; r < kCube; ++r)
    for (int g = 0; g < kCube; ++g)
      for (int b = 0; b < kCube; ++b) {
        auto& c = cube[static_cast<std::size_t>((r * kCube + g) * kCube + b)];
        const std::array<int, 3> at{r, g, b};
        for (std::size_t i = 0; i < 3; ++i) c[i] = static_cast<float>(light_of(double(at[i]) / (kCube - 1)));
        processor.applyRGB(c.data());
        taker.put(r + kCube * (b & 1), g + kCube * (b >> 1), {c[0], c[1], c[2], 1});
      }
  Lut table = taker.finish();
  std::uint32_t state = 1;
  const auto next = [&] { return (state = state * 1664525 + 1013904223) / 4294967296.0; };
  for (int i = 0; i < 20000; ++i) {
    const double level = 14 * next() - 9;
    std::array<double, 3> c{};
    std::array<float, 3> exact{};
    for (std::size_t k = 0; k < 3; ++k) exact[k] = static_cast<float>(c[k] = std::exp2(level + 3 * next() - 1.5));
    const auto found = tetrahedral(cube, c);
    processor.applyRGB(exact.data());
    for (std::size_t k = 0; k < 3; ++k)
      table.baked_error = std::max(table.baked_error, std::abs(double(found[k]) - double(exact[k])));
  }
  return table;
}

}  // namespace

Lut lut_of_view(const OcioRequest& request) {
  const auto config = OCIO::Config::CreateFromFile(request.config.c_str());
  const auto chain = chain_of(*config, request);
  const auto processor = config->getProcessor(chain);
  try {
    return LutTaker(config).take(
        *processor->getOptimizedProcessor(OCIO::OPTIMIZATION_LOSSLESS)->createGroupTransform());
  } catch (const Unsupported&) {
    return baked(config, *processor->getDefaultCPUProcessor());
  }
}

}  // namespace afterglow
