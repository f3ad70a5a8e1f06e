// SPDX-License-Identifier: MIT
#include "image/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/exception.h"
#include "core/file_record.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "image/choice_report.h"
#include "image/color_encoding.h"
#include "image/exr_header.h"
#include "image/half_colors.h"
#include "image/input_space.h"
#include "image/metadata.h"
#include "image/movie.h"
#include "image/movie_container.h"
#include "image/orientation.h"
#include "image/picture_format.h"
#include "image/picture_report.h"
#include "image/read_plan.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

/// How far each pixel's content moves in one frame, x to the right and y down. Files hold y upwards. Blender's four
/// channels are the ways from the previous frame and to the next one; the mean of both is taken, whichever way round
/// each of them is written: what moves goes on in about the same direction.
Image motion_of(const Image& stored) {
  static constexpr float kFarthest = 16384;  // pixels: the largest picture
  Image out(stored.width, stored.height, 2);
  const auto channels = static_cast<std::size_t>(stored.channels);
  const auto finite = [](float v) { return std::isfinite(v) ? std::clamp(v, -kFarthest, kFarthest) : 0.0f; };
  for (std::size_t i = 0; i < out.pixels.size() / 2; ++i) {
    const float* from = stored.pixels.data() + i * channels;
    float x = finite(from[0]), y = finite(from[1]);
    if (channels == 4) {
      float nx = finite(from[2]), ny = finite(from[3]);
      if (x * nx + y * ny < 0) nx = -nx, ny = -ny;
      x = 0.5f * (x + nx), y = 0.5f * (y + ny);
    }
    out.pixels[2 * i] = x;
    out.pixels[2 * i + 1] = -y;
  }
  return out;
}

/// Targets that spread the given channels over the channels of `image`; a channel that occurs twice is read once, into
/// its first place.
void add_targets(const std::vector<int>& channels, Image& image, std::vector<ReadTarget>& targets) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i] < 0 || std::find(channels.begin(), channels.begin() + static_cast<std::ptrdiff_t>(i),
                                     channels[i]) != channels.begin() + static_cast<std::ptrdiff_t>(i))
      continue;
    targets.push_back({channels[i], image.pixels.data() + i, static_cast<std::size_t>(image.channels),
                       static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels)});
  }
}

/// What add_targets left out: channels that occur twice.
void fill_twice(const std::vector<int>& channels, Image& image) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto first = static_cast<std::size_t>(std::ranges::find(channels, channels[i]) - channels.begin());
    if (channels[i] < 0 || first == i) continue;
    const auto count = static_cast<std::size_t>(image.channels);
    for (std::size_t at = 0; at < image.pixels.size(); at += count) image.pixels[at + i] = image.pixels[at + first];
  }
}

/// `image`, which covers `window`, cut or padded to cover `wanted`, with `background` by channel.
Image placed(Image image, const Rect& window, const Rect& wanted, const std::array<float, 4>& background) {
  if (window == wanted) return image;
  Image out(wanted.width, wanted.height, image.channels);
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] = background[std::min(i % channels, background.size() - 1)];
  const int x0 = std::max(window.x, wanted.x), x1 = std::min(window.x + window.width, wanted.x + wanted.width);
  const int y0 = std::max(window.y, wanted.y), y1 = std::min(window.y + window.height, wanted.y + wanted.height);
  for (int y = y0; y < y1 && x0 < x1; ++y)
    std::copy_n(image.at(x0 - window.x, y - window.y),
                static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(image.channels),
                out.at(x0 - wanted.x, y - wanted.y));
  return out;
}

/// `window`: what the layer's own pixels cover, which `found` counts from.
void note_layer(Picture& picture, const std::string& layer, const NonFinite& found, const Rect& window) {
  if (found.count() == 0) return;
  NonFinite& noted = picture.non_finite[layer] = found;
  // Places are counted from the display window's corner, like those of --region.
  noted.first->x += window.x - picture.display_window.x;
  noted.first->y += window.y - picture.display_window.y;
}

Error non_finite_error(const Picture& picture, const fs::path& file) {
  return {ErrorKind::io,
          fmt::format("the picture has values that are not finite (--nan-policy fail): {}", non_finite_text(picture)),
          file.string()};
}

/// Values that are all read, or made from those that are (grey, no alpha), may be anything before.
Image color_image(const ReadPlan& plan, const ColorEncoding& encoding, PixelMemory* memory) {
  const Size size = plan.color_part().data_window.size();
  bool all_made = true;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto& channels = plan.color.channels;
    const bool made = c == 3 ? encoding.alpha == AlphaKind::none : c > 0 && encoding.grey;
    const bool twice = std::find(channels.begin(), channels.begin() + static_cast<std::ptrdiff_t>(c), channels[c]) !=
                       channels.begin() + static_cast<std::ptrdiff_t>(c);
    all_made = all_made && (made || (channels[c] >= 0 && !twice));
  }
  if (!memory || !all_made) return {size.width, size.height, 4};
  Image image;
  image.width = size.width;
  image.height = size.height;
  image.channels = 4;
  image.pixels = memory->take(static_cast<std::size_t>(size.area()) * 4);
  return image;
}

/// Colours as the half floats that the file holds, where that was allowed and nothing else is to be read. False: they
/// have to be read as floats.
Result<bool> read_halves(const ReadPlan& plan, const ColorEncoding& encoding, const ReadOptions& options,
                         Picture& picture) {
  if (!options.halves || !options.memory || !plan.auxiliary.empty()) return false;
  if (plan.color_part().orientation > 1 || !stays_half(encoding)) return false;
  if (picture.data_window != upright_data(plan.color_part())) return false;
  const Size size = picture.data_window.size();
  UnsetVector<std::uint16_t> halves = options.memory->take_halves(static_cast<std::size_t>(size.area()) * 4);
  HalfColors colors(halves.data(), size.width, encoding.keep_negative);
  AFTERGLOW_TRY(const bool read, plan.file->read_halves(plan.color, halves.data(),
                                                        [&](int begin, int end) { colors.take_rows(begin, end); }));
  if (!read || !colors.finite()) return false;
  picture.color.width = size.width;
  picture.color.height = size.height;
  picture.color.channels = 4;
  picture.halves = std::move(halves);
  picture.sanitized.negative = colors.negative();
  picture.sanitized.far_below = colors.far_below();
  return true;
}

/// What is remembered of the files of a plan.
FileFacts facts_of(const ReadPlan& plan) {
  FileFacts facts = plan.file->facts(plan.color);
  if (!plan.mattes) return facts;
  facts.mattes = plan.mattes->path();
  const auto& parts = plan.mattes->parts();
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (!parts[part].unreadable.empty() || parts[part].channels.empty()) continue;
    const Metadata said = plan.mattes->facts({static_cast<int>(part), {0, 0, 0, -1}}).metadata;
    facts.matte_metadata.insert(facts.matte_metadata.end(), said.begin(), said.end());
  }
  return facts;
}

/// Names of all layers that can be asked for.
std::vector<std::string> layers_of(const ReadPlan& plan) {
  std::vector<std::string> names = layer_names(plan.file->parts());
  if (!plan.mattes) return names;
  for (const std::string& name : layer_names(plan.mattes->parts()))
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  return names;
}

/// Allocates, reads and decodes everything of the plan. May throw std::bad_alloc.
Result<Picture> read_planned(ReadPlan& plan, const ReadOptions& options, Diagnostics& diagnostics) {
  const NanPolicy policy = options.nan_policy;
  const FilePart& part = plan.color_part();
  Picture picture;
  const Rect data = upright_data(part);
  picture.data_window = upright_frame(plan);
  picture.display_window = upright_display(part);
  picture.has_alpha = plan.color.channels[3] >= 0;
  picture.asked = options.auxiliary;
  const auto facts = std::make_shared<FileFacts>(facts_of(plan));
  picture.facts = facts;
  picture.layers = layers_of(plan);
  picture.hints = likely_channels(plan);
  report_choices(plan, options, diagnostics);
  report_shape(picture, plan.file->path(), diagnostics);
  ColorEncoding encoding = plan.file->color_encoding(plan.color, diagnostics);
  if (!options.input_space.empty()) {
    AFTERGLOW_TRY(const InputSpace* space, find_input_space(options.input_space));
    use_input_space(*space, encoding);
    facts->primaries.reset();
    if (space->linear() && encoding.matrix) facts->primaries = space->primaries;
  }
  encoding.data = options.raw;
  encoding.keep_negative = facts->keeps_negative = options.keep_negative.value_or(false);

  AFTERGLOW_TRY(const bool done, read_halves(plan, encoding, options, picture));
  if (done) {
    report_values(picture, encoding, policy, plan.file->path(), diagnostics);
    return picture;
  }

  // Everything from the colour's own part is read in one go: the file is decompressed once.
  picture.color = color_image(plan, encoding, options.memory);
  std::vector<ReadTarget> targets;
  add_targets(plan.color.channels, picture.color, targets);
  std::vector<Image> auxiliary;
  for (const AuxiliaryPlan& extra : plan.auxiliary) {
    const Rect window = plan.part_of(extra).data_window;
    auxiliary.emplace_back(window.width, window.height, static_cast<int>(extra.choice.channels.size()));
  }
  for (std::size_t i = 0; i < auxiliary.size(); ++i) {
    const AuxiliaryPlan& extra = plan.auxiliary[i];
    const auto taken = [&](int channel) {
      return std::any_of(targets.begin(), targets.end(), [&](const ReadTarget& t) { return t.channel == channel; });
    };
    const bool together = !extra.other && extra.choice.part == plan.color.part &&
                          std::none_of(extra.choice.channels.begin(), extra.choice.channels.end(), taken);
    if (together) {
      add_targets(extra.choice.channels, auxiliary[i], targets);
    } else {
      std::vector<ReadTarget> own;
      add_targets(extra.choice.channels, auxiliary[i], own);
      AFTERGLOW_CHECK(plan.file_of(extra).read(extra.choice.part, own));
    }
  }
  NonFinite found;
  if (part.orientation <= 1 && policy != NanPolicy::neighbour) {
    AFTERGLOW_CHECK(
        plan.file->read(plan.color.part, targets, decoder_of_rows(encoding, picture.color, picture.sanitized, &found)));
  } else {
    AFTERGLOW_CHECK(plan.file->read(plan.color.part, targets));
    // Turned first: what is found has the place where the picture shows it.
    picture.color = upright(std::move(picture.color), part.orientation);
    if (policy == NanPolicy::neighbour) {
      found = find_non_finite(picture.color);
      if (found.count() > 0) repair_from_neighbours(picture.color);
    }
    decode_color(encoding, picture.color, picture.sanitized, policy == NanPolicy::neighbour ? nullptr : &found);
  }
  note_layer(picture, "color", found, data);
  picture.color =
      placed(std::move(picture.color), data, picture.data_window, {0, 0, 0, picture.has_alpha ? 0.0f : 1.0f});
  for (std::size_t i = 0; i < auxiliary.size(); ++i) {
    const AuxiliaryPlan& extra = plan.auxiliary[i];
    const FilePart& from = plan.part_of(extra);
    fill_twice(extra.choice.channels, auxiliary[i]);
    Image image = upright(std::move(auxiliary[i]), from.orientation);
    const Rect window = upright_auxiliary(plan, extra);
    const NonFinite in_layer = find_non_finite(image);
    if (in_layer.count() > 0 && policy == NanPolicy::neighbour) repair_from_neighbours(image);
    note_layer(picture, extra.name, in_layer, window);
    if (extra.kind == &kMotion) {
      image = motion_of(image);
      turn_vectors(image, from.orientation);
    }
    const float nothing = extra.kind ? extra.kind->background : 0.0f;
    image = placed(std::move(image), window, picture.data_window, {nothing, nothing, nothing, nothing});
    if (extra.kind == &kDepth) sanitize_depth(image, picture.sanitized);
    if (extra.kind == &kNormal) sanitize_normal(image, picture.sanitized);
    if (!extra.kind)
      for (float& value : image.pixels)
        if (!std::isfinite(value)) value = 0;
    flush_smallest(image.pixels.data(), image.pixels.size());
    picture.auxiliary.emplace(extra.name, std::move(image));
  }
  if (policy == NanPolicy::fail && !picture.non_finite.empty()) return non_finite_error(picture, plan.file->path());
  report_values(picture, encoding, policy, plan.file->path(), diagnostics);
  return picture;
}

/// A picture whose header was parsed and whose pixels were not read yet.
struct Opened : OpenedPicture {
  ReadPlan plan;
  FileProbes looks;  ///< what the files were before
  bool read = false;
};

void note_stamp(const fs::path& file, FileProbes& looks) {
  std::error_code ec;
  looks.emplace(fs::absolute(file, ec), inspect(file, FileProbe::Kind::stamp));
}

/// May throw.
Result<std::shared_ptr<Opened>> open_with(const fs::path& file, const ReadOptions& options,
                                          const std::vector<std::string>& auxiliary) {
  auto opened = std::make_shared<Opened>();
  note_stamp(file, opened->looks);
  AFTERGLOW_TRY(opened->plan, make_read_plan(file, options, auxiliary));
  for (const AuxiliaryPlan& extra : opened->plan.auxiliary)
    note_stamp(opened->plan.file_of(extra).path(), opened->looks);
  if (opened->plan.mattes) note_stamp(opened->plan.mattes->path(), opened->looks);
  return opened;
}

Result<Picture> read_opened(Opened& opened, const ReadOptions& options, Diagnostics& diagnostics) {
  ReadPlan& plan = opened.plan;
  if (std::exchange(opened.read, true))
    return Error{ErrorKind::other, "was read before with this header", plan.file->path().string()};
  keep_wanted(plan.auxiliary, options.auxiliary);
  if (const std::uint64_t bytes = host_bytes(plan, options.auxiliary); bytes > options.max_bytes)
    return Error{
        ErrorKind::io,
        fmt::format("needs {} of memory, more than the {}", needed_memory(bytes), allowed_memory(options.max_bytes)),
        plan.file->path().string()};
  auto picture = read_planned(plan, options, diagnostics);
  // Whatever was read then, it is neither the old picture nor the new one.
  if (const auto changed = first_changed(opened.looks))
    return Error{ErrorKind::io, "changed while it was read", changed->string()};
  return picture;
}

Error unreadable(const std::exception& error, const fs::path& file) {
  return {ErrorKind::io, fmt::format("cannot be read: {}", exception_text(error)), file.string()};
}

/// Auxiliary images that a header tells of: the usual ones, and layers that are asked for.
std::vector<std::string> of_header(const ReadOptions& options) {
  std::vector<std::string> names{kDepth.name, kNormal.name, kMotion.name};
  std::ranges::copy_if(options.auxiliary, std::back_inserter(names), is_layer);
  return names;
}

}  // namespace

bool has_pictures(const std::filesystem::path& file) {
  return is_exr(file) || !picture_format(file).empty() || !movie_format(file).empty();
}

Result<PictureHeader> read_header(const fs::path& file, const ReadOptions& options) {
  try {
    PictureHeader header;
    AFTERGLOW_TRY(const auto opened, open_with(file, options, of_header(options)));
    header.opened = opened;
    const ReadPlan& plan = opened->plan;
    header.data_window = upright_frame(plan);
    header.display_window = upright_display(plan.color_part());
    header.channels = static_cast<int>(plan.color_part().channels.size());
    for (const AuxiliaryPlan& extra : plan.auxiliary) header.auxiliary.push_back(extra.name);
    header.layers = layers_of(plan);
    header.taken = taken_channels(plan, options.auxiliary);
    header.hints = likely_channels(plan);
    header.has_alpha = plan.color.channels[3] >= 0;
    header.facts = std::make_shared<const FileFacts>(facts_of(plan));
    header.format = plan.file->format();
    header.host_bytes = host_bytes(plan, options.auxiliary);
    return header;
  } catch (const std::exception& error) {
    return unreadable(error, file);
  }
}

Result<Picture> read_picture(const PictureHeader& header, const ReadOptions& options, Diagnostics& diagnostics) {
  auto& opened = static_cast<Opened&>(*header.opened);
  try {
    return read_opened(opened, options, diagnostics);
  } catch (const std::exception& error) {
    return unreadable(error, opened.plan.file->path());
  }
}

Result<Picture> read_picture(const fs::path& file, const ReadOptions& options, Diagnostics& diagnostics) {
  try {
    AFTERGLOW_TRY(const auto opened, open_with(file, options, options.auxiliary));
    return read_opened(*opened, options, diagnostics);
  } catch (const std::exception& error) {
    return unreadable(error, file);
  }
}

}  // namespace afterglow
