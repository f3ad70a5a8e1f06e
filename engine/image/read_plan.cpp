// SPDX-License-Identifier: MIT
#include "image/read_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/file.h"
#include "core/saturated.h"
#include "core/text.h"
#include "image/movie.h"
#include "image/orientation.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

SizeLimits limits_of(const ReadOptions& options) { return {options.max_side, options.max_bytes}; }

Error in_file(Error error, const fs::path& file) {
  if (error.file.empty()) error.file = file.string();
  return error;
}

std::uint64_t area(const Rect& rect) { return static_cast<std::uint64_t>(rect.size().area()); }

/// A name that nothing answers to and that looks like a file was probably meant as one.
bool looks_like_file(const std::string& name) {
  const std::string extension = lower(fs::path(name).extension().string());
  const std::vector<std::string> known{".exr", ".png", ".tif", ".tiff", ".hdr", ".jpg", ".jpeg", ".pfm"};
  return name.find('/') != std::string::npos || std::find(known.begin(), known.end(), extension) != known.end();
}

/// A file given for this purpose alone may hold just one grey layer, under whatever name.
std::optional<ChannelChoice> sole_layer(const PictureFile& file, const AuxiliaryKind& kind) {
  const auto color = find_color(file.parts(), "");
  if (!color) return std::nullopt;
  ChannelChoice choice = color.value();
  choice.channels.resize(static_cast<std::size_t>(kind.channels));
  const bool grey = choice.channels.size() > 1 && choice.channels[0] == choice.channels[1];
  return grey ? std::nullopt : std::optional(choice);
}

/// An image of another file has to fit.
Result<void> check_size(const AuxiliaryPlan& made, const ReadPlan& plan) {
  const Rect color = upright_data(plan.color_part()), window = upright_data(plan.part_of(made));
  const bool same_frame = upright_display(plan.color_part()) == upright_display(plan.part_of(made));
  if (!made.other || same_frame || window.size() == color.size()) return {};
  return Error{ErrorKind::io,
               fmt::format("its {} is {}×{} pixels, but the picture '{}' has {}×{}", made.name, window.width,
                           window.height, plan.file->path().string(), color.width, color.height),
               made.other->path().string()};
}

Result<std::optional<AuxiliaryPlan>> plan_auxiliary(const AuxiliaryKind& kind, const LayerChoice& wanted,
                                                    const ReadPlan& plan, const ReadOptions& options) {
  AuxiliaryPlan made;
  made.name = kind.name;
  made.kind = &kind;
  if (!wanted.file.empty()) {
    AFTERGLOW_TRY(made.other, open_picture(wanted.file, limits_of(options)));
  }
  const PictureFile& file = plan.file_of(made);
  const BesideColor color(&plan.color, made.other ? &plan.file->parts() : nullptr);
  auto found = &kind == &kDepth    ? find_depth(file.parts(), wanted.name, color)
               : &kind == &kNormal ? find_normal(file.parts(), wanted.name, color)
                                   : find_motion(file.parts(), wanted.name, color);
  if (!found) {
    if (!made.other && looks_like_file(wanted.name)) return missing_file(wanted.name);
    return in_file(std::move(found).error(), file.path());
  }
  if (!found.value() && made.other) {
    found = sole_layer(file, kind);
    if (!found.value()) return Error{ErrorKind::io, fmt::format("has no {} layer", kind.name), file.path().string()};
  }
  if (!found.value()) return std::optional<AuxiliaryPlan>();
  made.choice = *found.value();
  AFTERGLOW_CHECK(check_size(made, plan));
  return std::optional<AuxiliaryPlan>(std::move(made));
}

/// Of the picture, or else of the file with mattes. None: neither has it; whoever asks for it is told so by name, with
/// what is there.
Result<std::optional<AuxiliaryPlan>> plan_layer(const std::string& name, const ReadPlan& plan) {
  AuxiliaryPlan made{.name = name, .kind = nullptr, .other = nullptr, .choice = {}};
  const std::string layer = name.substr(kLayerPrefix.size());
  if (auto choice = find_layer(plan.file->parts(), layer, &plan.color)) {
    made.choice = std::move(*choice);
    return std::optional(std::move(made));
  }
  auto choice = plan.mattes ? find_layer(plan.mattes->parts(), layer, {&plan.color, &plan.file->parts()}) : std::nullopt;
  if (!choice) return std::optional<AuxiliaryPlan>();
  made.other = plan.mattes;
  made.choice = std::move(*choice);
  AFTERGLOW_CHECK(check_size(made, plan));
  return std::optional(std::move(made));
}

}  // namespace

Rect upright_data(const FilePart& part) { return upright(part.data_window, part.display_window, part.orientation); }
Rect upright_display(const FilePart& part) {
  return upright(part.display_window, part.display_window, part.orientation);
}

Rect upright_frame(const ReadPlan& plan) {
  constexpr std::uint64_t kMostTimes = 4;
  const Rect data = upright_data(plan.color_part()), display = upright_display(plan.color_part());
  if (std::max(display.width, display.height) > SizeLimits().max_side) return data;
  if (plan.cut_overscan) return display;
  const int x0 = std::min(data.x, display.x), y0 = std::min(data.y, display.y);
  const std::int64_t x1 = std::max(std::int64_t{data.x} + data.width, std::int64_t{display.x} + display.width),
                     y1 = std::max(std::int64_t{data.y} + data.height, std::int64_t{display.y} + display.height);
  const std::int64_t width = x1 - x0, height = y1 - y0;
  if (std::max(width, height) > SizeLimits().max_side) return data;
  const Rect both{x0, y0, static_cast<int>(width), static_cast<int>(height)};
  return area(both) > kMostTimes * std::max(area(data), area(display)) ? data : both;
}

Rect upright_auxiliary(const ReadPlan& plan, const AuxiliaryPlan& auxiliary) {
  const FilePart& part = plan.part_of(auxiliary);
  if (!auxiliary.other || upright_display(part) == upright_display(plan.color_part())) return upright_data(part);
  return upright_data(plan.color_part());
}

Result<ReadPlan> make_read_plan(const fs::path& file, const ReadOptions& options,
                                const std::vector<std::string>& auxiliary) {
  ReadPlan plan;
  plan.cut_overscan = options.cut_overscan;
  if (options.movie) {
    plan.file = Movie::frame(options.movie, options.movie_frame);
  } else {
    AFTERGLOW_TRY(plan.file, open_picture(file, limits_of(options)));
  }
  auto color = find_color(plan.file->parts(), options.layer);
  if (!color) return in_file(std::move(color).error(), file);
  plan.color = std::move(color).value();
  if (!options.mattes.empty()) {
    AFTERGLOW_TRY(plan.mattes, open_picture(options.mattes, limits_of(options)));
  }
  AFTERGLOW_CHECK(check_sides(plan.color_part().data_window, "data window", limits_of(options), file));
  AFTERGLOW_CHECK(check_sides(plan.color_part().display_window, "display window", limits_of(options), file));
  for (const std::string& name : auxiliary) {
    if (is_layer(name)) {
      AFTERGLOW_TRY(auto made, plan_layer(name, plan));
      if (made) plan.auxiliary.push_back(std::move(*made));
      continue;
    }
    const auto kind = std::ranges::find(kKinds, name, &AuxiliaryKind::name);
    if (kind == kKinds.end()) continue;  // kinds that no file holds
    const LayerChoice& choice = *kind == &kDepth ? options.depth : *kind == &kNormal ? options.normal : options.motion;
    AFTERGLOW_TRY(auto made, plan_auxiliary(**kind, choice, plan, options));
    if (made) plan.auxiliary.push_back(std::move(*made));
  }
  return plan;
}

std::uint64_t host_bytes(const ReadPlan& plan, const std::vector<std::string>& wanted) {
  const std::uint64_t frame = area(upright_frame(plan)), pixels = area(plan.color_part().data_window);
  std::uint64_t images = frame * 4 * sizeof(float);
  std::uint64_t second = plan.color_part().orientation > 1 || frame != pixels ? pixels * 4 * sizeof(float) : 0;
  std::uint64_t buffers = plan.file->buffer_bytes(plan.color.part);
  for (const AuxiliaryPlan& auxiliary : plan.auxiliary) {
    if (std::find(wanted.begin(), wanted.end(), auxiliary.name) == wanted.end()) continue;
    const FilePart& part = plan.part_of(auxiliary);
    const std::uint64_t pixel =
        (auxiliary.kind ? static_cast<std::uint64_t>(auxiliary.kind->channels) : auxiliary.choice.channels.size()) *
        sizeof(float);
    images += frame * pixel;
    second = std::max(second, area(part.data_window) * pixel);
    buffers = std::max(buffers, plan.file_of(auxiliary).buffer_bytes(auxiliary.choice.part));
  }
  return saturated_sum({images, second, buffers});
}

void keep_wanted(std::vector<AuxiliaryPlan>& plans, const std::vector<std::string>& wanted) {
  const auto place = [&](const AuxiliaryPlan& plan) { return std::ranges::find(wanted, plan.name); };
  std::erase_if(plans, [&](const AuxiliaryPlan& plan) { return place(plan) == wanted.end(); });
  std::ranges::stable_sort(plans, {}, place);
}

LayerChoice parse_layer_choice(const std::string& text) {
  const auto is_file = [](const std::string& name) {
    std::error_code ignored;
    return !name.empty() &&
           (fs::exists(name, ignored) || name.find('#') != std::string::npos || name.find('%') != std::string::npos);
  };
  if (is_file(text) && text.find(':') == std::string::npos) return {text, ""};
  std::error_code ignored;
  if (fs::exists(text, ignored)) return {text, ""};
  for (std::size_t colon = text.rfind(':'); colon != std::string::npos && colon > 0; colon = text.rfind(':', colon - 1))
    if (is_file(text.substr(0, colon))) return {text.substr(0, colon), text.substr(colon + 1)};
  return {"", text};
}

}  // namespace afterglow
