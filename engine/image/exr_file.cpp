// SPDX-License-Identifier: MIT
#include "image/exr_file.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

#include "core/exception.h"
#include "core/parallel.h"
#include "image/exr_lines.h"
#include "image/exr_metadata.h"
#include "image/exr_primaries.h"

namespace afterglow {
namespace {

constexpr int kMaxThreads = 16;

/// A channel as layers see it. Luminance-chroma channels Y, RY, BY appear as the R, G, B that OpenEXR makes of them.
struct ChannelSlot {
  std::string stored;  ///< name in the file
  int chroma = -1;     ///< 0, 1, 2: R, G, B made from luminance and chroma
  ExrChannelType type = ExrChannelType::half;
};

struct PartSlots {
  std::vector<ChannelSlot> channels;
  std::optional<std::string> chroma_layer;  ///< prefix of the luminance-chroma layer
};

bool has_channel(const ExrPart& part, const std::string& name) {
  return std::any_of(part.channels.begin(), part.channels.end(), [&](const ExrChannel& c) { return c.name == name; });
}

/// Renderers list R, G, B, A or X, Y, Z; EXR sorts by name. People read lists of channels in the first order.
int channel_order(const std::string& name) {
  static constexpr std::string_view kOrder = "RGBAXYZ";
  const std::size_t dot = name.rfind('.');
  const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
  const std::size_t index = last.size() == 1 ? kOrder.find(last[0]) : std::string_view::npos;
  return index == std::string_view::npos ? static_cast<int>(kOrder.size()) : static_cast<int>(index);
}

bool is_window(const Imath::Box2i& box, const Rect& window) {
  return box.min.x == window.x && box.min.y == window.y && box.max.x - box.min.x + 1 == window.width &&
         box.max.y - box.min.y + 1 == window.height;
}

/// Did OpenEXR read from the file what we did? Memory was counted, and is written, by what we read.
bool same(const Imf::Header& header, const ExrPart& part) {
  if (!is_window(header.dataWindow(), part.data_window) || !is_window(header.displayWindow(), part.display_window))
    return false;
  if (header.compression() != part.compression) return false;
  if (header.hasType() && Imf::isTiled(header.type()) != part.tiled) return false;
  if (part.tiled) {
    const Imf::TileDescription& tiles = header.tileDescription();
    if (static_cast<int>(tiles.xSize) != part.tile.width || static_cast<int>(tiles.ySize) != part.tile.height)
      return false;
  }
  const Imf::ChannelList& channels = header.channels();
  std::ptrdiff_t count = 0;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) ++count;
  if (count != std::ssize(part.channels)) return false;
  return std::ranges::all_of(part.channels, [&](const ExrChannel& channel) {
    const Imf::Channel* found = channels.findChannel(channel.name);
    return found && static_cast<int>(found->type) == static_cast<int>(channel.type) &&
           found->xSampling == channel.x_sampling && found->ySampling == channel.y_sampling;
  });
}

class ExrFile : public PictureFile {
 public:
  ExrFile(const std::filesystem::path& file, std::vector<ExrPart> header) : header_(std::move(header)) {
    path_ = file;
    format_ = "openexr";
    for (const ExrPart& part : header_) add_part(part);
  }

  std::uint64_t buffer_bytes(int part) const override {
    return header_[static_cast<std::size_t>(part)].buffer_bytes(Imf::globalThreadCount());
  }

  Result<bool> read_targets(int part, std::span<const ReadTarget> targets, const RowsArrived& rows) override {
    try {
      AFTERGLOW_CHECK(open());
      const auto chroma = chroma_targets(part, targets);
      const bool told = read_plain(part, targets, chroma.empty() ? rows : RowsArrived());
      read_chroma(part, chroma);
      return told;
    } catch (const std::exception& error) {
      return failed("cannot be read: " + exception_text(error));
    }
  }

  Result<bool> read_halves(const ChannelChoice& color, std::uint16_t* rgba, const RowsArrived& rows) override {
    const ExrPart& part = header_[static_cast<std::size_t>(color.part)];
    const auto target = half_target(part, color, rgba);
    if (!target) return false;
    try {
      AFTERGLOW_CHECK(open());
      Imf::InputPart input(*file_, color.part);
      if (has_zipped_lines(part, lines_of(*target))) {
        read_zipped_halves(input, part, *target, rows);
      } else {
        read_plain_halves(input, part, *target);
        parallel_rows(part.data_window.height, static_cast<long long>(part.data_window.size().area()) * 4, rows);
      }
      return true;
    } catch (const std::exception& error) {
      return failed("cannot be read: " + exception_text(error));
    }
  }

  ColorEncoding color_encoding(const ChannelChoice& color, Diagnostics& diagnostics) const override {
    ColorEncoding encoding;
    encoding.grey = color.channels[0] == color.channels[1];
    encoding.alpha = color.channels[3] >= 0 ? AlphaKind::associated : AlphaKind::none;
    const Imf::Header& header = file_->header(color.part);
    if (!Imf::hasChromaticities(header) || encoding.grey) return encoding;
    const auto primaries = own_primaries(header);
    if (primaries) {
      encoding.matrix = to_rec709(*primaries);
    } else if (to_rec709(chromaticities_of(header)) == Matrix3{}) {
      diagnostics.warn(fmt::format("{}: its chromaticities make no sense; Rec.709 is assumed", path_.string()));
    }
    return encoding;
  }

  FileFacts facts(const ChannelChoice& color) const override {
    FileFacts facts;
    facts.file = path_;
    facts.format = format_;
    facts.part = color.part;
    facts.floating = true;
    facts.bits = 16;
    facts.orientation = parts_[static_cast<std::size_t>(color.part)].orientation;
    const PartSlots& slots = slots_[static_cast<std::size_t>(color.part)];
    for (std::size_t i = 0; i < 4; ++i) {
      if (color.channels[i] < 0) continue;
      const ChannelSlot& slot = slots.channels[static_cast<std::size_t>(color.channels[i])];
      facts.color_channels[i] = slot.stored;
      if (slot.type != ExrChannelType::half) facts.bits = 32;
    }
    facts.exr_header = std::make_shared<Imf::Header>(file_->header(color.part));
    facts.had_chromaticities = Imf::hasChromaticities(*facts.exr_header);
    if (color.channels[0] != color.channels[1]) facts.primaries = own_primaries(*facts.exr_header);
    facts.metadata = metadata_of(*facts.exr_header);
    return facts;
  }

  /// Errors: io. Headers are parsed by OpenEXR here, after our own look at them.
  Result<void> open() {
    if (file_) return {};
    use_exr_threads();
    try {
      file_ = std::make_unique<Imf::MultiPartInputFile>(path_.c_str());
      bool alike = file_->parts() == static_cast<int>(header_.size());
      for (int i = 0; alike && i < file_->parts(); ++i)
        alike = same(file_->header(i), header_[static_cast<std::size_t>(i)]);
      if (!alike) {
        file_.reset();
        return failed("has a malformed header, or changed while it was read");
      }
    } catch (const std::exception& error) {
      return failed("cannot be read: " + exception_text(error));
    }
    return {};
  }

 private:
  void add_part(const ExrPart& part) {
    FilePart shown;
    shown.name = part.name;
    shown.data_window = part.data_window;
    shown.display_window = part.display_window;
    shown.orientation = part.orientation;
    shown.view = part.view;
    shown.views = part.views;
    PartSlots slots;
    for (const ExrChannel& channel : part.channels) {
      const std::size_t dot = channel.name.rfind('.');
      const std::string prefix = dot == std::string::npos ? "" : channel.name.substr(0, dot + 1);
      // OpenEXR's converter looks at the first part only, and prefers R, G, B when they are there.
      if (parts_.empty() && has_channel(part, prefix + "Y") && has_channel(part, prefix + "RY") &&
          has_channel(part, prefix + "BY") && !has_channel(part, prefix + "R")) {
        const std::string last = channel.name.substr(prefix.size());
        if (last == "Y") add_chroma(prefix, channel, shown, slots);
        if (last == "Y" || last == "RY" || last == "BY") continue;
      }
      if (channel.x_sampling != 1 || channel.y_sampling != 1) continue;
      shown.channels.push_back(channel.name);
      slots.channels.push_back({channel.name, -1, channel.type});
    }
    if (part.deep) {
      shown.unreadable = "is a deep EXR, which is not supported; flatten it first";
    } else if (shown.channels.empty()) {
      shown.unreadable = "has only sub-sampled channels, which are not supported";
    }
    sort_channels(shown, slots);
    parts_.push_back(std::move(shown));
    slots_.push_back(std::move(slots));
  }

  static void add_chroma(const std::string& prefix, const ExrChannel& luminance, FilePart& shown, PartSlots& slots) {
    slots.chroma_layer = prefix.empty() ? "" : prefix.substr(0, prefix.size() - 1);
    for (int i = 0; i < 3; ++i) {
      shown.channels.push_back(prefix + "RGB"[i]);
      slots.channels.push_back({prefix + "Y", i, luminance.type});
    }
  }

  static void sort_channels(FilePart& shown, PartSlots& slots) {
    std::vector<std::size_t> order(shown.channels.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto prefix = [&](std::size_t i) { return shown.channels[i].substr(0, shown.channels[i].rfind('.') + 1); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      if (prefix(a) != prefix(b)) return prefix(a) < prefix(b);
      return channel_order(shown.channels[a]) < channel_order(shown.channels[b]);
    });
    FilePart sorted = shown;
    PartSlots sorted_slots = slots;
    for (std::size_t i = 0; i < order.size(); ++i) {
      sorted.channels[i] = shown.channels[order[i]];
      sorted_slots.channels[i] = slots.channels[order[i]];
    }
    shown = std::move(sorted);
    slots = std::move(sorted_slots);
  }

  static std::vector<ExrLineTarget> line_targets(const ExrPart& part, const PartSlots& slots,
                                                 std::span<const ReadTarget> targets) {
    std::vector<ExrLineTarget> lines;
    for (const ReadTarget& target : targets) {
      const ChannelSlot& slot = slots.channels[static_cast<std::size_t>(target.channel)];
      if (slot.chroma >= 0) continue;
      const auto channel = std::ranges::find(part.channels, slot.stored, &ExrChannel::name);
      lines.push_back({static_cast<std::size_t>(channel - part.channels.begin()), target.base, target.pixel_stride,
                       target.row_stride});
    }
    return lines;
  }

  /// Whether it called `rows`.
  bool read_plain(int part, std::span<const ReadTarget> targets, const RowsArrived& rows) {
    Imf::InputPart input(*file_, part);
    const ExrPart& header = header_[static_cast<std::size_t>(part)];
    const PartSlots& slots = slots_[static_cast<std::size_t>(part)];
    if (const auto lines = line_targets(header, slots, targets); has_zipped_lines(header, lines)) {
      read_zipped_lines(input, header, lines, rows);
      return rows != nullptr;
    }
    const Imath::Box2i window = input.header().dataWindow();
    Imf::FrameBuffer buffer;
    for (const ReadTarget& target : targets) {
      const ChannelSlot& slot = slots.channels[static_cast<std::size_t>(target.channel)];
      if (slot.chroma >= 0) continue;
      buffer.insert(slot.stored, Imf::Slice::Make(Imf::FLOAT, target.base, window, target.pixel_stride * sizeof(float),
                                                  target.row_stride * sizeof(float)));
    }
    if (buffer.begin() == buffer.end()) return false;
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    return false;
  }

  /// Nothing: a channel of the colours is missing, not half, or there twice.
  std::optional<ExrHalfTarget> half_target(const ExrPart& part, const ChannelChoice& color, std::uint16_t* rgba) const {
    ExrHalfTarget target{.channels = {}, .rgba = rgba};
    const PartSlots& slots = slots_[static_cast<std::size_t>(color.part)];
    for (std::size_t c = 0; c < 4; ++c) {
      if (color.channels[c] < 0 && c == 3) continue;
      if (color.channels[c] < 0) return std::nullopt;
      const ChannelSlot& slot = slots.channels[static_cast<std::size_t>(color.channels[c])];
      if (slot.chroma >= 0 || slot.type != ExrChannelType::half) return std::nullopt;
      const auto channel = std::ranges::find(part.channels, slot.stored, &ExrChannel::name) - part.channels.begin();
      if (std::ranges::count(target.channels, static_cast<std::size_t>(channel)) > 0) return std::nullopt;
      target.channels[c] = static_cast<std::size_t>(channel);
    }
    return target;
  }

  static std::vector<ExrLineTarget> lines_of(const ExrHalfTarget& target) {
    std::vector<ExrLineTarget> lines;
    for (const auto& channel : target.channels)
      if (channel) lines.push_back({*channel});
    return lines;
  }

  static void read_plain_halves(Imf::InputPart& input, const ExrPart& part, const ExrHalfTarget& target) {
    constexpr std::size_t kPixel = 4 * sizeof(std::uint16_t);
    const auto width = static_cast<std::size_t>(part.data_window.width);
    const std::size_t values = width * static_cast<std::size_t>(part.data_window.height) * 4;
    const Imath::Box2i window = input.header().dataWindow();
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < 4; ++c) {
      if (!target.channels[c]) {
        for (std::size_t i = c; i < values; i += 4) target.rgba[i] = kOneAsHalf;
        continue;
      }
      buffer.insert(part.channels[*target.channels[c]].name,
                    Imf::Slice::Make(Imf::HALF, target.rgba + c, window, kPixel, width * kPixel));
    }
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
  }

  std::vector<ReadTarget> chroma_targets(int part, std::span<const ReadTarget> targets) const {
    const PartSlots& slots = slots_[static_cast<std::size_t>(part)];
    std::vector<ReadTarget> chroma;
    std::ranges::copy_if(targets, std::back_inserter(chroma), [&](const ReadTarget& target) {
      return slots.channels[static_cast<std::size_t>(target.channel)].chroma >= 0;
    });
    return chroma;
  }

  void read_chroma(int part, const std::vector<ReadTarget>& wanted) {
    const PartSlots& slots = slots_[static_cast<std::size_t>(part)];
    if (wanted.empty()) return;
    Imf::RgbaInputFile input(path_.c_str(), *slots.chroma_layer);
    const Imath::Box2i window = input.dataWindow();
    if (!is_window(window, header_[static_cast<std::size_t>(part)].data_window))
      throw std::runtime_error("it changed while it was read");
    const int width = window.max.x - window.min.x + 1;
    std::vector<Imf::Rgba> row(static_cast<std::size_t>(width));
    for (int y = window.min.y; y <= window.max.y; ++y) {
      input.setFrameBuffer(row.data() - window.min.x, 1, 0);
      input.readPixels(y);
      for (const ReadTarget& target : wanted) {
        const int component = slots.channels[static_cast<std::size_t>(target.channel)].chroma;
        float* out = target.base + static_cast<std::size_t>(y - window.min.y) * target.row_stride;
        for (const Imf::Rgba& pixel : row) {
          *out = component == 0 ? pixel.r : component == 1 ? pixel.g : pixel.b;
          out += target.pixel_stride;
        }
      }
    }
  }

  std::vector<ExrPart> header_;
  std::vector<PartSlots> slots_;
  std::unique_ptr<Imf::MultiPartInputFile> file_;
};

}  // namespace

void use_exr_threads() {
  static std::once_flag once;
  std::call_once(once, [] {
    const int wanted = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxThreads);
    // A pool of which some cannot be started ends the program.
    if (Imf::globalThreadCount() == 0 && can_start_threads(static_cast<std::size_t>(wanted)))
      Imf::setGlobalThreadCount(wanted);
  });
}

Result<std::unique_ptr<PictureFile>> open_exr(const std::filesystem::path& file, std::vector<ExrPart> header) {
  auto opened = std::make_unique<ExrFile>(file, std::move(header));
  AFTERGLOW_CHECK(opened->open());
  return std::unique_ptr<PictureFile>(std::move(opened));
}

}  // namespace afterglow
