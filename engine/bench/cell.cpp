// SPDX-License-Identifier: MIT
#include "bench/cell.h"

#include <fmt/format.h>

#include "bench/oracle.h"
#include "bench/quality.h"
#include "exec/timing.h"

namespace afterglow::bench {
namespace {

/// The right result, R, G and B; empty when there is none.
struct Truth {
  std::string name;
  std::vector<double> rgb;
};

Result<Truth> find_truth(Device& device, const CellRequest& request, Diagnostics& diagnostics) {
  if (!request.quality) return Truth{"not asked for", {}};
  const Picture& picture = *request.picture;
  if (picture.color.size().area() > kMostPixelsForTruth)
    return Truth{fmt::format("not measured above {} megapixels", kMostPixelsForTruth >> 20), {}};
  StackOptions options = request.base;
  options.choice.reset();
  options.reference = true;
  AFTERGLOW_TRY(const auto stack, Stack::load(request.preset, options, diagnostics));
  AFTERGLOW_TRY(const auto build, stack->evaluate(context_of(picture)));
  const auto entries = oracle_entries(*build);
  const std::string unknown = reference::effect_without_oracle(entries);
  if (unknown.empty() && build->length_scale == 1) return Truth{"double precision", oracle_result(picture, entries)};

  AFTERGLOW_TRY(PreparedStack slow,
                PreparedStack::create(device, request.preset, options, {.label = "--reference"}, picture, diagnostics));
  std::vector<float> rgb;
  AFTERGLOW_TRY(const Point ignored, slow.try_out(device, picture, false, rgb));
  const std::string why = unknown.empty() ? "the oracle knows no scaled lengths (reference_height)"
                                          : fmt::format("'{}' has no oracle", unknown);
  return Truth{"--reference: " + why, {rgb.begin(), rgb.end()}};
}

/// What is measured in turns.
struct Field {
  std::map<PictureKind, DevicePicture> pictures;
  std::vector<PreparedStack> stacks;
  KernelWork copy;
  BufferCopy memory;
};

Result<void> prepare(Device& device, const CellRequest& request, Field& field) {
  const Picture& picture = *request.picture;
  std::vector<PictureKind> kinds(1);  // full floats, for the copy
  for (const auto& stack : field.stacks) kinds.push_back(stack.picture_kind());
  for (const PictureKind& kind : kinds)
    if (!field.pictures.contains(kind)) {
      AFTERGLOW_TRY(field.pictures[kind], DevicePicture::create(device, picture, kind));
    }
  for (auto& stack : field.stacks) AFTERGLOW_CHECK(stack.record(device, field.pictures.at(stack.picture_kind())));
  KernelCompiler compiler(request.base.cache_folder.empty() ? "" : request.base.cache_folder / "shaders");
  const DevicePicture& floats = field.pictures.at(PictureKind{});
  AFTERGLOW_TRY(field.copy, KernelWork::create(device, compiler, {}, floats.source(), floats.result(), "copy"));
  const auto bytes = static_cast<VkDeviceSize>(picture.color.size().area()) * 16;
  AFTERGLOW_TRY(field.memory, BufferCopy::create(device, bytes));
  return {};
}

}  // namespace

Result<Cell> measure_cell(Device& device, const CellRequest& request, Diagnostics& diagnostics, const Step& step) {
  const Picture& picture = *request.picture;
  Cell cell{.preset = request.preset.stem().string(), .size = picture.color.size()};
  const std::string where = fmt::format("{} {}×{}", cell.preset, cell.size.width, cell.size.height);
  AFTERGLOW_CHECK(step(where + ": the truth"));
  AFTERGLOW_TRY(const Truth truth, find_truth(device, request, diagnostics));
  cell.truth = truth.name;

  Field field;
  for (const auto& variant : request.variants) {
    AFTERGLOW_CHECK(step(where + ": " + variant.label));
    AFTERGLOW_TRY(PreparedStack stack,
                  PreparedStack::create(device, request.preset, request.base, variant, picture, diagnostics));
    std::vector<float> rgb;
    AFTERGLOW_TRY(Point point, stack.try_out(device, picture, request.passes, rgb));
    if (!truth.rgb.empty()) point.quality = compare_pictures(rgb, truth.rgb, cell.size, request.visible);
    cell.points.push_back(std::move(point));
    field.stacks.push_back(std::move(stack));
  }

  AFTERGLOW_CHECK(prepare(device, request, field));
  std::vector<Measured> all{[&] { return field.copy.work().run(); }, [&] { return field.memory.work().run(); }};
  for (auto& stack : field.stacks) all.emplace_back([&stack] { return stack.work().run(); });
  AFTERGLOW_TRY(const auto spreads, run_in_turns(all, request.repeat, [&](int round) {
                  return step(fmt::format("{}: round {} of {}", where, round, request.repeat));
                }));
  cell.copy = spreads[0];
  cell.memory = spreads[1];
  // Read once and written once.
  cell.gigabytes_per_second = 2 * 16e-6 * static_cast<double>(cell.size.area()) / cell.memory.median;
  for (std::size_t i = 0; i < cell.points.size(); ++i) cell.points[i].execute = spreads[i + 2];
  mark_front(cell);
  return cell;
}

}  // namespace afterglow::bench
