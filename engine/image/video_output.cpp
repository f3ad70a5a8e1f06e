// SPDX-License-Identifier: MIT
#include "image/video_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>

#include "core/text.h"
#include "image/kept_values.h"
#include "image/output_metadata.h"
#include "image/time_code.h"

namespace afterglow {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

struct Codec {
  const char* name;
  std::vector<std::string> encoders, layouts;  ///< layouts: the first is for 8 bits, `deep` for more
  const char* deep;
  const char* alpha = nullptr;  ///< layout with alpha, for 8 bits and for more; null: none
  const char* deep_alpha = nullptr;
  std::optional<int> crf = std::nullopt;  ///< the default; none: it takes no quality
  int worst_crf = 0;
  bool bitrate = false;
  bool exact = false;
  Settings settings = {};
};

struct Container {
  const char* extension;
  const char* muxer;
  std::vector<std::string> codecs;  ///< the first is the default
};

const std::vector<Codec>& codecs() {
  static const std::vector<Codec> all{
      {.name = "h264",
       .encoders = {"libx264"},
       .layouts = {"yuv420p", "yuv422p", "yuv444p", "yuv420p10le", "yuv422p10le", "yuv444p10le"},
       .deep = "yuv420p",
       .crf = 18,
       .worst_crf = 51,
       .bitrate = true,
       .settings = {{"preset", "medium"}}},
      {.name = "h265",
       .encoders = {"libx265"},
       .layouts = {"yuv420p", "yuv422p", "yuv444p", "yuv420p10le", "yuv422p10le", "yuv444p10le", "yuv420p12le",
                   "yuv422p12le", "yuv444p12le"},
       .deep = "yuv420p10le",
       .crf = 20,
       .worst_crf = 51,
       .bitrate = true,
       // Without the note of its settings, which names threads: pieces of several machines are one video.
       .settings = {{"preset", "medium"}, {"x265-params", "log-level=error:info=0"}}},
      {.name = "prores",
       .encoders = {"prores_ks"},
       .layouts = {"yuv422p10le"},
       .deep = "yuv422p10le",
       .settings = {{"profile", "hq"}, {"vendor", "apl0"}}},
      {.name = "prores4444",
       .encoders = {"prores_ks"},
       .layouts = {"yuv444p10le", "yuva444p10le"},
       .deep = "yuv444p10le",
       .alpha = "yuva444p10le",
       .deep_alpha = "yuva444p10le",
       .settings = {{"profile", "4444"}, {"vendor", "apl0"}, {"alpha_bits", "16"}}},
      {.name = "dnxhr",
       .encoders = {"dnxhd"},
       .layouts = {"yuv422p10le", "yuv422p", "yuv444p10le"},
       .deep = "yuv422p10le"},
      {.name = "ffv1",
       .encoders = {"ffv1"},
       .layouts = {"bgr0",        "bgra",        "gbrp10le",    "gbrp12le",    "gbrp16le",    "gbrap10le",
                   "gbrap12le",   "gbrap16le",   "yuv420p",     "yuv422p",     "yuv444p",     "yuv420p10le",
                   "yuv422p10le", "yuv444p10le", "yuv420p12le", "yuv422p12le", "yuv444p12le", "yuv420p16le",
                   "yuv422p16le", "yuv444p16le", "yuva420p",    "yuva444p10le"},
       .deep = "gbrp16le",
       .alpha = "bgra",
       .deep_alpha = "gbrap16le",
       .exact = true,
       .settings = {{"level", "3"}, {"g", "1"}, {"slices", "16"}, {"slicecrc", "1"}}},
      {.name = "vp9",
       .encoders = {"libvpx-vp9"},
       .layouts = {"yuv420p", "yuv422p", "yuv444p", "yuv420p10le", "yuv422p10le", "yuv444p10le", "yuv420p12le",
                   "yuv422p12le", "yuv444p12le", "yuva420p"},
       .deep = "yuv420p",
       .alpha = "yuva420p",
       .deep_alpha = "yuva420p",
       .crf = 24,
       .worst_crf = 63,
       .bitrate = true,
       .settings = {{"row-mt", "1"}, {"deadline", "good"}, {"cpu-used", "4"}}},
      {.name = "av1",
       .encoders = {"libsvtav1", "libaom-av1"},
       .layouts = {"yuv420p10le", "yuv420p"},
       .deep = "yuv420p10le",
       .crf = 26,
       .worst_crf = 63,
       .bitrate = true},
      {.name = "gif",
       .encoders = {"gif"},
       .layouts = {"rgba", "rgb24"},
       .deep = "rgb24",
       .alpha = "rgba",
       .deep_alpha = "rgba",
       .exact = true},
      {.name = "apng",
       .encoders = {"apng"},
       .layouts = {"rgb24", "rgba"},
       .deep = "rgb24",
       .alpha = "rgba",
       .deep_alpha = "rgba",
       .exact = true,
       .settings = {{"pred", "mixed"}}},
  };
  return all;
}

const std::vector<Container>& containers() {
  static const std::vector<Container> all{
      {".mp4", "mp4", {"h264", "h265", "av1", "vp9"}},
      {".mov", "mov", {"prores", "prores4444", "dnxhr", "h264", "h265"}},
      {".mkv", "matroska", {"h264", "h265", "ffv1", "prores", "prores4444", "vp9", "av1"}},
      {".webm", "webm", {"vp9", "av1"}},
      {".gif", "gif", {"gif"}},
      {".apng", "apng", {"apng"}},
  };
  return all;
}

const Container* container_of(const std::filesystem::path& file) {
  const std::string extension = lower(file.extension().string());
  const auto found = std::ranges::find(containers(), extension, [](const Container& c) { return c.extension; });
  return found == containers().end() ? nullptr : &*found;
}

/// Names that people have for the same.
std::string plain_name(const std::string& text) {
  const std::string name = lower(text);
  if (name == "hevc" || name == "x265") return "h265";
  if (name == "avc" || name == "x264") return "h264";
  return name;
}

Result<const Codec*> codec_of(const Container& container, const WriteOptions& options, bool has_alpha,
                              const std::filesystem::path& file) {
  std::string name = plain_name(options.video.codec);
  if (name.empty()) name = container.codecs.front();
  if (options.video.codec.empty() && name == "prores" && has_alpha) name = "prores4444";
  const std::vector<std::string> known = video_codecs();
  const auto codec = std::ranges::find(codecs(), name, [](const Codec& c) { return c.name; });
  if (codec == codecs().end())
    return Error{ErrorKind::usage,       fmt::format("'{}' is no codec that is written", options.video.codec),
                 file.string(),          0,
                 join(container.codecs), nearest_name(name, known)};
  if (std::ranges::find(container.codecs, name) == container.codecs.end())
    return Error{ErrorKind::usage, fmt::format("{} files do not hold {}", container.extension + 1, name), file.string(),
                 0, join(container.codecs)};
  return &*codec;
}

bool has_ten_bits(const Codec& codec) { return std::ranges::find(codec.layouts, "yuv420p10le") != codec.layouts.end(); }

/// Logarithms, HDR and light itself show steps in eight bits.
bool wants_ten_bits(const Codec& codec, const WriteOptions& options) {
  return has_ten_bits(codec) && options.space && !options.space->of_display();
}

Result<const PixelLayout*> layout_of(const Codec& codec, const WriteOptions& options, bool deep, bool has_alpha,
                                     const std::filesystem::path& file) {
  const std::string& wanted = options.video.pixel_format;
  if (wanted.empty()) {
    const char* alpha = deep ? codec.deep_alpha : codec.alpha;
    const char* opaque = deep ? codec.deep : codec.layouts.front().c_str();
    if (std::string_view(codec.name) == "gif" && !has_alpha) opaque = "rgb24";
    if (wants_ten_bits(codec, options) && std::string_view(opaque) == "yuv420p") opaque = "yuv420p10le";
    return find_pixel_layout(has_alpha && alpha ? alpha : opaque);
  }
  const PixelLayout* layout = find_pixel_layout(lower(wanted));
  if (layout && std::ranges::find(codec.layouts, layout->name) != codec.layouts.end()) return layout;
  return Error{ErrorKind::usage,    fmt::format("{} has no pixel format '{}'", codec.name, wanted),
               file.string(),       0,
               join(codec.layouts), nearest_name(wanted, codec.layouts)};
}

Error not_taken(const Codec& codec, const char* option, const std::filesystem::path& file) {
  std::vector<std::string> takers;
  for (const Codec& one : codecs())
    if (one.bitrate) takers.emplace_back(one.name);
  return {ErrorKind::usage, fmt::format("{} takes no {}", codec.name, option), file.string(), 0, join(takers)};
}

Result<void> choose_quality(const Codec& codec, const WriteOptions& options, const std::filesystem::path& file,
                            VideoPlan& plan) {
  const auto& [name, pixel_format, bitrate, crf, audio, piece] = options.video;
  if (crf && !codec.crf) return not_taken(codec, "--crf", file);
  if (!bitrate.empty() && !codec.bitrate) return not_taken(codec, "--bitrate", file);
  if (crf && (*crf < 0 || *crf > codec.worst_crf))
    return Error{ErrorKind::usage, fmt::format("--crf {} is no quality of {}", *crf, codec.name), file.string(), 0,
                 fmt::format("0 (best) to {}", codec.worst_crf)};
  if (!bitrate.empty()) {
    AFTERGLOW_TRY(plan.bitrate, parse_bitrate(bitrate));
  } else if (codec.crf) {
    plan.settings.emplace_back("crf", std::to_string(crf.value_or(*codec.crf)));
  }
  return {};
}

}  // namespace

bool is_video_output(const std::filesystem::path& file) { return container_of(file) != nullptr; }

std::vector<std::string> video_codecs() {
  std::vector<std::string> names;
  for (const Codec& codec : codecs()) names.emplace_back(codec.name);
  return names;
}

std::vector<std::string> video_extensions() {
  std::vector<std::string> names;
  for (const Container& container : containers()) names.emplace_back(container.extension);
  return names;
}

void describe_space(const OutputSpace& space, const PixelLayout& layout, VideoPlan& plan) {
  constexpr int kBt2020 = 9;
  const SpaceCodes codes = space_codes(space);
  const bool wide = codes.primaries == kBt2020;
  plan.primaries = codes.primaries;
  plan.transfer = codes.transfer;
  plan.matrix = layout.rgb_colors() ? 0 : wide ? kBt2020 : 1;
  plan.pack.luma = wide ? kBt2020Luma : kBt709Luma;
}

bool describe_view(const WriteOptions& options, VideoPlan& plan) {
  if (plan.pack.layout->rgb_colors()) plan.primaries = plan.transfer = SpaceCodes{}.primaries;
  const auto codec = std::ranges::find(codecs(), plan.codec, [](const Codec& c) { return c.name; });
  return plan.pack.layout->bits == 8 && options.video.pixel_format.empty() && codec != codecs().end() &&
         has_ten_bits(*codec);
}

bool is_audio_file(const std::filesystem::path& audio) {
  return !audio.empty() && audio != kNoAudio && audio != kCopiedAudio;
}

const OutputSpace* video_space(const WriteOptions& options, const PixelLayout& layout, bool view) {
  return options.space ? options.space : find_output_space(layout.rgb_colors() || view ? "srgb" : "rec709").value();
}

Result<VideoPlan> plan_video(const std::filesystem::path& file, const WriteOptions& options, bool deep,
                             bool has_alpha) {
  const Container* container = container_of(file);
  if (!container) return Error{ErrorKind::usage, "is no video that is written", file.string()};
  AFTERGLOW_TRY(const Codec* codec, codec_of(*container, options, has_alpha, file));
  VideoPlan plan;
  plan.container = container->muxer;
  plan.codec = codec->name;
  plan.encoders = codec->encoders;
  plan.settings = codec->settings;
  plan.exact = codec->exact;
  AFTERGLOW_TRY(plan.pack.layout, layout_of(*codec, options, deep, has_alpha, file));
  plan.shows_steps =
      wants_ten_bits(*codec, options) && plan.pack.layout->bits == 8 && options.video.pixel_format.empty();
  AFTERGLOW_CHECK(choose_quality(*codec, options, file, plan));
  if (plan.codec == "dnxhr") {
    const PixelLayout& layout = *plan.pack.layout;
    plan.settings.emplace_back("profile", layout.bits == 8      ? "dnxhr_hq"
                                          : layout.chroma_x > 0 ? "dnxhr_hqx"
                                                                : "dnxhr_444");
  }
  plan.pack.space = video_space(options, *plan.pack.layout, false);
  describe_space(*plan.pack.space, *plan.pack.layout, plan);
  plan.pack.dither = options.dither.value_or(codec->exact && plan.pack.layout->bits == 8);
  plan.silent = options.video.audio == kNoAudio;
  plan.copies_only = options.video.audio == kCopiedAudio;
  if (!options.video.piece && is_audio_file(options.video.audio)) plan.audio = options.video.audio;
  return plan;
}

namespace {

/// The simplest fraction that is as near as pictures say it.
Rational simple_ratio(float ratio) {
  constexpr int kMost = 1000;
  constexpr float kShapes = 100, kNear = 1e-4f;
  if (!(ratio > 1 / kShapes && ratio < kShapes)) return {1, 1};
  int below = 1;
  const auto above = [&] { return std::lround(ratio * static_cast<float>(below)); };
  while (below < kMost && std::abs(static_cast<float>(above()) / static_cast<float>(below) - ratio) > kNear * ratio)
    ++below;
  return {static_cast<int>(above()), below};
}

}  // namespace

void keep_facts(const FileFacts& first, VideoPlan& plan, std::size_t held) {
  const MetadataValue* code = find_metadata(first.metadata, kTimeCodeName);
  plan.time_code = code ? metadata_text(*code) : "";
  plan.pack.beyond = first.yuv && first.keeps_negative;
  if (held > 0) plan.time_code = time_code_after(plan.time_code, -static_cast<long long>(held), plan.rate);
  const Metadata kept = kept_metadata(first);
  if (const MetadataValue* aspect = find_metadata(kept, "PixelAspectRatio"))
    plan.pixel_aspect = simple_ratio(metadata_number(*aspect, 1));
}

double said_fps(const FileFacts& picture) {
  const MetadataValue* said = find_metadata(picture.metadata, "FramesPerSecond");
  const auto rate = said ? rate_of(*said) : std::nullopt;
  const double fps = rate ? static_cast<double>(rate->numerator) / rate->denominator : 0;
  return fps >= kSlowestRate && fps <= kFastestRate ? fps : 0;
}

Result<void> check_video_size(const VideoPlan& plan, Size size, const std::filesystem::path& file) {
  const PixelLayout& layout = *plan.pack.layout;
  const bool across = layout.chroma_x > 0 && size.width % 2 != 0, down = layout.chroma_y > 0 && size.height % 2 != 0;
  if (!across && !down) return {};
  return Error{
      ErrorKind::usage,
      fmt::format("{}x{} pixels do not go into {}, whose colour has half the {}", size.width, size.height, layout.name,
                  down ? "width and height" : "width"),
      file.string(), 0,
      fmt::format("even sides (--size {}x{} scales, --region 0,0,{},{} crops){}", size.width + (across ? 1 : 0),
                  size.height + (down ? 1 : 0), size.width - (across ? 1 : 0), size.height - (down ? 1 : 0),
                  plan.codec == "prores" ? ", --codec prores4444" : ", --pix-fmt yuv444p where the codec has it")};
}

Rational frame_rate(double fps) {
  fps = std::clamp(fps, kSlowestRate, kFastestRate);
  constexpr double kNtsc = 1000.0 / 1001;
  const double whole = std::round(fps), film = std::round(fps / kNtsc);
  if (std::abs(fps - whole) < 1e-6) return {static_cast<int>(whole), 1};
  if (std::abs(fps - film * kNtsc) < 1e-3) return {static_cast<int>(film) * 1000, 1001};
  constexpr int kParts = 1000000;
  const int parts = static_cast<int>(std::lround(fps * kParts)), common = std::gcd(parts, kParts);
  return {parts / common, kParts / common};
}

Result<long long> parse_bitrate(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string unit(end, text.data() + text.size());
  const double factor = unit.empty() ? 1 : lower(unit) == "k" ? 1e3 : lower(unit) == "m" ? 1e6 : 0;
  const double bits = value * factor;
  if (error != std::errc() || !(bits >= 1000 && bits <= 4e9))
    return Error{ErrorKind::usage, fmt::format("'{}' is no bit rate", text), "--bitrate", 0, "8M, 500k, 2500000"};
  return static_cast<long long>(bits);
}

}  // namespace afterglow
