// SPDX-License-Identifier: MIT
#include "image/oiio_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/exception.h"
#include "core/file.h"
#include "core/saturated.h"
#include "core/text.h"
#include "image/container_bytes.h"
#include "image/container_color.h"
#include "image/dpx_header.h"
#include "image/heif_check.h"
#include "image/input_space.h"
#include "image/movie_color.h"
#include "image/oiio_metadata.h"
#include "image/read_webp.h"
#include "image/unpack_bmp.h"

namespace afterglow {
namespace {

constexpr std::size_t kMaxParts =
    64;  // pages of a TIFF; other formats' further images are animation frames or thumbnails

/// What the library says: its first line, when there are several of a kind (one for each strip of a TIFF).
std::string message_of(const std::string& said) {
  std::string text = trim(said);
  text = trim(text.substr(0, text.find('\n')));
  while (!text.empty() && text.back() == '.') text.pop_back();
  return text.empty() ? "cannot be read" : "cannot be read: " + text;
}

/// Offsets that differences of coordinates would not survive, and windows without pixels (a TIFF's position may be any
/// number).
bool absurd(const Rect& window) {
  constexpr int kFar = 1 << 29;
  return window.x < -kFar || window.x > kFar || window.y < -kFar || window.y > kFar || window.width < 1 ||
         window.height < 1;
}

class OiioFile : public PictureFile {
 public:
  OiioFile(const std::filesystem::path& file, const ContainerFacts& container) : container_(container) { path_ = file; }

  Result<void> open(const std::string& format, const SizeLimits& limits) {
    try {
      if (format == "heif") AFTERGLOW_CHECK(check_heif(path_, container_));
      if (format == "bmp") {
        AFTERGLOW_TRY(in_place_, unpack_bmp(path_, limits.max_bytes));
      }
      if (container_.line_padding > 0) {
        AFTERGLOW_TRY(in_place_, with_line_padding(limits.max_bytes));
      }
      AFTERGLOW_CHECK(open_input(format));
      format_ = input_->format_name();
      AFTERGLOW_CHECK(add_parts(limits));
    } catch (const std::exception& error) {
      return failed("cannot be read: " + exception_text(error));
    }
    return {};
  }

  std::uint64_t buffer_bytes(int part) const override {
    const OIIO::ImageSpec& spec = specs_[static_cast<std::size_t>(part)];
    constexpr std::uint64_t kLines = 64;
    const std::uint64_t tiles = container_.kind == ContainerFacts::Kind::png ? 0 : spec.tile_bytes(true);
    return saturated_sum({saturated_product({spec.scanline_bytes(true), kLines}), saturated_product({tiles, 16}),
                          container_.decoder_bytes});
  }

  Result<bool> read_targets(int part, std::span<const ReadTarget> targets, const RowsArrived&) override {
    std::vector<ReadTarget> sorted(targets.begin(), targets.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const ReadTarget& a, const ReadTarget& b) { return a.channel < b.channel; });
    try {
      // Runs of neighbouring channels that go to neighbouring floats are read in one pass over the file.
      for (std::size_t i = 0; i < sorted.size();) {
        std::size_t end = i + 1;
        while (end < sorted.size() && sorted[end].channel == sorted[end - 1].channel + 1 &&
               sorted[end].base == sorted[end - 1].base + 1 && sorted[end].pixel_stride == sorted[i].pixel_stride)
          ++end;
        AFTERGLOW_CHECK(read_run(part, sorted[i], static_cast<int>(end - i)));
        i = end;
      }
    } catch (const std::exception& error) {
      return failed("cannot be read: " + exception_text(error));
    }
    return false;
  }

  ColorEncoding color_encoding(const ChannelChoice& color, Diagnostics& diagnostics) const override {
    const OIIO::ImageSpec& spec = specs_[static_cast<std::size_t>(color.part)];
    ColorEncoding encoding;
    encoding.grey = color.channels[0] == color.channels[1];
    // OpenImageIO says nothing of these, which hold straight colours (JPEG 2000: where that is asked for).
    const bool straight = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) != 0 || format_ == "jpeg2000" ||
                          format_ == "dpx" || format_ == "bmp" || format_ == "sgi" || format_ == "webp";
    if (color.channels[3] >= 0) encoding.alpha = straight ? AlphaKind::straight : AlphaKind::associated;
    const OIIO::TypeDesc type = sample_type(color);
    const bool integer = !type.is_floating_point();
    if (container_.deep_pnm)
      encoding.max_code = container_.deep_pnm->most;
    else if (integer && type.size() <= 2)
      encoding.max_code = type.size() == 1 ? 255 : 65535;
    encoding.curve = integer ? TransferCurve::srgb : TransferCurve::linear;
    encoding.gain = 1 / container_.exposure;
    const OIIO::ParamValue* passed = spec.find_attribute("ICCProfile");
    std::span<const std::uint8_t> profile = container_.profile;
    if (passed)
      profile = {static_cast<const std::uint8_t*>(passed->data()), static_cast<std::size_t>(passed->type().size())};
    if (made_of_inks(spec)) {
      diagnostics.warn(
          fmt::format("{}: is CMYK; its inks become RGB by a plain rule, whatever its profile says: make it RGB where "
                      "colours matter",
                      path_.string()));
      profile = {};
    }
    if (container_.deeper_bits > 0)
      diagnostics.warn_once("bits of HEIF",
                            fmt::format("{}: has {} bits a sample and is read with 8; of PQ and HLG they "
                                        "show steps",
                                        path_.string(), container_.deeper_bits));
    const bool said = use_container_color(container_, profile, path_.string(), encoding, diagnostics);
    if (integer && format_ == "dpx" && use_film_transfer(spec, encoding)) return encoding;
    if (!said && integer && format_ != "pnm")  // whose files say nothing: "Rec709" is the library's guess
      use_color_space(spec.get_string_attribute("oiio:ColorSpace"), encoding, diagnostics);
    return encoding;
  }

  FileFacts facts(const ChannelChoice& color) const override {
    const OIIO::ImageSpec& spec = specs_[static_cast<std::size_t>(color.part)];
    FileFacts facts;
    facts.file = path_;
    facts.format = format_;
    facts.part = color.part;
    facts.orientation = parts_[static_cast<std::size_t>(color.part)].orientation;
    const OIIO::TypeDesc type = sample_type(color);
    facts.floating = type.is_floating_point();
    facts.bits = spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(type.size()) * 8);
    facts.had_profile = spec.find_attribute("ICCProfile") != nullptr || !container_.profile.empty();
    for (std::size_t i = 0; i < 4; ++i)
      if (color.channels[i] >= 0)
        facts.color_channels[i] =
            parts_[static_cast<std::size_t>(color.part)].channels[static_cast<std::size_t>(color.channels[i])];
    facts.metadata = metadata_of(spec.extra_attribs);
    if (format_ == "jpeg") correct_jpeg_shape(facts.metadata);
    return facts;
  }

 private:
  Result<void> open_input(const std::string& format) {
    OIIO::ImageSpec wanted, found;
    wanted.attribute("oiio:UnassociatedAlpha", 1);  // straight alpha stays straight: it is multiplied after decoding
    wanted.attribute("bmp:monochrome_detect", 0);   // grey ones that are packed are written beyond a line else
    input_ = OIIO::ImageInput::create(format);
    if (!input_) return failed(message_of(OIIO::geterror()));
    if (in_place_) {
      memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(in_place_->data(), in_place_->size());
      input_->set_ioproxy(memory_.get());
    }
    if (!input_->open(path_.string(), found, wanted)) return failed(message_of(input_->geterror()));
    return {};
  }

  /// A DPX whose header tells of the bytes behind its lines.
  Result<std::vector<std::uint8_t>> with_line_padding(std::size_t most) const {
    AFTERGLOW_TRY(const std::string text, read_file(path_, most));
    std::vector<std::uint8_t> bytes(text.begin(), text.end());
    if (bytes.size() < kDpxLinePaddingAt + 4) return failed("is truncated");
    const bool big = bytes[0] == 'S';
    put_ordered(&bytes[kDpxLinePaddingAt], 4, container_.line_padding, big);
    return bytes;
  }

  Result<void> add_parts(const SizeLimits& limits) {
    const bool pages = format_ == "tiff";
    for (std::size_t i = 0; i < (pages ? kMaxParts : 1) && input_->seek_subimage(static_cast<int>(i), 0); ++i) {
      OIIO::ImageSpec spec = input_->spec();
      add_exif(container_.exif, spec);
      FilePart part;
      part.data_window = {spec.x, spec.y, spec.width, spec.height};
      part.display_window = {spec.full_x, spec.full_y, spec.full_width, spec.full_height};
      if (absurd(part.data_window) || absurd(part.display_window)) {
        part.data_window = {0, 0, spec.width, spec.height};
        part.display_window = part.data_window;
      }
      const int said = spec.get_int_attribute("Orientation", 1);
      part.orientation = container_.orientation.value_or(said >= 1 && said <= 8 ? said : 1);
      part.channels = spec.channelnames;
      if (container_.fourth_is_padding && part.channels.size() == 4) part.channels.pop_back();
      if (i > 0) part.name = spec.get_string_attribute("oiio:subimagename", fmt::format("page{}", i + 1));
      if (spec.depth > 1) part.unreadable = "is a volume, not a picture";
      if (spec.deep) part.unreadable = "is a deep picture, which is not supported";
      if (inks(spec))
        part.unreadable = "holds inks (CMYK with an alpha, spot colours), which cannot be read; make it RGB";
      if (lab(spec)) part.unreadable = "holds CIE Lab colours, which cannot be read; make it RGB";
      if (const auto fits = check_sides(part.data_window, "data window", limits, path_); !fits) {
        if (i == 0) return fits;
        part.unreadable = fits.error().message;  // kept, so that parts and sub-images have the same numbers
      }
      parts_.push_back(std::move(part));
      specs_.push_back(std::move(spec));
    }
    if (parts_.empty()) return failed("holds no picture");
    return {};
  }

  static constexpr int kSeparated = 5;

  /// PhotometricInterpretation of a TIFF; 0 of other files.
  int tiff_colors(const OIIO::ImageSpec& spec) const {
    return format_ == "tiff" ? spec.get_int_attribute("tiff:PhotometricInterpretation", 0) : 0;
  }

  /// A separated TIFF of which OpenImageIO did not make RGB: it does of cyan, magenta, yellow and black alone.
  bool inks(const OIIO::ImageSpec& spec) const { return tiff_colors(spec) == kSeparated && spec.nchannels != 3; }

  /// CMYK of which OpenImageIO has made RGB.
  bool made_of_inks(const OIIO::ImageSpec& spec) const {
    return tiff_colors(spec) == kSeparated ||
           (format_ == "jpeg" && spec.get_string_attribute("jpeg:ColorSpace") == "CMYK");
  }

  /// A TIFF whose colours OpenImageIO would have libtiff make RGB of, with eight bits and without adapting their white.
  bool lab(const OIIO::ImageSpec& spec) const {
    constexpr int kLab = 8;  // libtiff reads none of the other kinds
    return tiff_colors(spec) == kLab;
  }

  OIIO::TypeDesc sample_type(const ChannelChoice& color) const {
    return specs_[static_cast<std::size_t>(color.part)].channelformat(color.channels[0]);
  }

  Result<void> read_run(int part, const ReadTarget& first, int channels) {
    const OIIO::ImageSpec& spec = specs_[static_cast<std::size_t>(part)];
    const auto x_stride = static_cast<OIIO::stride_t>(first.pixel_stride * sizeof(float));
    const auto y_stride = static_cast<OIIO::stride_t>(first.row_stride * sizeof(float));
    if (container_.deep_pnm) return read_pnm(first, channels);
    if (format_ == "webp" && spec.nchannels == 4) return read_straight_webp(first, channels);
    // Looking for further pages of a TIFF leaves its reader in a state in which it keeps silent when a disk fails.
    if (format_ == "tiff" && !std::exchange(opened_for_pixels_, true)) AFTERGLOW_CHECK(open_input(format_));
    static_cast<void>(input_->geterror());  // of earlier calls that succeeded another way
    const bool read = input_->read_image(part, 0, first.channel, first.channel + channels, OIIO::TypeFloat, first.base,
                                         x_stride, y_stride, y_stride * spec.height);
    // OpenImageIO 2.4 returns true, and black, for strips of a TIFF that are damaged or missing; but it says so.
    const std::string why = input_->geterror();
    if (!read || !why.empty()) return failed(message_of(why));
    if (white_is_zero(spec)) turn_samples(spec, first, channels);
    return {};
  }

  /// A TIFF of integers whose 0 is white.
  bool white_is_zero(const OIIO::ImageSpec& spec) const {
    constexpr int kWhiteIsZero = 0;
    return format_ == "tiff" && spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == kWhiteIsZero &&
           !spec.format.is_floating_point();
  }

  /// What OpenImageIO has not turned round: of more than 8 bits no sample; of 8 all, alpha too, which goes back.
  static void turn_samples(const OIIO::ImageSpec& spec, const ReadTarget& first, int channels) {
    const bool deep = spec.format.size() > 1;
    for (std::size_t y = 0; y < static_cast<std::size_t>(spec.height); ++y)
      for (std::size_t x = 0; x < static_cast<std::size_t>(spec.width); ++x)
        for (int c = 0; c < channels; ++c) {
          float& value = first.base[y * first.row_stride + x * first.pixel_stride + static_cast<std::size_t>(c)];
          if ((first.channel + c != spec.alpha_channel) == deep) value = 1 - value;
        }
  }

  /// Samples of whole pixels, `all` of each, one behind the other, to where they are wanted.
  template <class Sample>
  static void hand_out(const std::vector<Sample>& samples, float scale, const Size& size, int all,
                       const ReadTarget& first, int channels) {
    for (std::size_t y = 0, i = 0; y < static_cast<std::size_t>(size.height); ++y)
      for (std::size_t x = 0; x < static_cast<std::size_t>(size.width); ++x, i += static_cast<std::size_t>(all))
        for (int c = 0; c < channels; ++c)
          first.base[y * first.row_stride + x * first.pixel_stride + static_cast<std::size_t>(c)] =
              static_cast<float>(samples[i + static_cast<std::size_t>(first.channel + c)]) / scale;
  }

  Result<void> read_pnm(const ReadTarget& first, int channels) const {
    const DeepPnm& form = *container_.deep_pnm;
    AFTERGLOW_TRY(const std::vector<float> samples, read_deep_pnm(path_, form));
    hand_out(samples, 1, form.size, form.channels, first, channels);
    return {};
  }

  Result<void> read_straight_webp(const ReadTarget& first, int channels) const {
    const Size size{specs_.front().width, specs_.front().height};
    AFTERGLOW_TRY(const std::vector<std::uint8_t> codes, read_webp(path_, size));
    hand_out(codes, 255, size, 4, first, channels);
    return {};
  }

  /// What SMPTE ST 268 has more words for (table 5) than the library tells.
  static bool use_film_transfer(const OIIO::ImageSpec& spec, ColorEncoding& encoding) {
    constexpr int kCamera = 1, kBt709 = 1, kBt601Of625 = 5, kBt601Of525 = 6;  // of H.273
    const auto says = [&](const char* what, std::string_view word) {
      return spec.get_string_attribute(what).find(word) != std::string::npos;
    };
    constexpr const char *kTransfer = "dpx:Transfer", *kPrimaries = "dpx:Colorimetric";
    if (says(kTransfer, "Printing density")) {
      use_input_space(*find_input_space("cineon").value(), encoding);
      return true;
    }
    if (!says(kTransfer, "SMPTE 274M") && !says(kTransfer, "ITU-R 601")) return false;
    const int primaries = says(kPrimaries, "system B or G") ? kBt601Of625
                          : says(kPrimaries, "system M")    ? kBt601Of525
                                                            : kBt709;
    return use_codes(primaries, kCamera, encoding);
  }

  void use_color_space(const std::string& name, ColorEncoding& encoding, Diagnostics& diagnostics) const {
    const std::string space = lower(name);
    if (space.empty() || space == "srgb") return;
    if (space == "linear" || space == "lin_srgb" || space == "lin_rec709" || space == "scene_linear") {
      encoding.curve = TransferCurve::linear;
    } else if (space == "kodaklog") {
      use_input_space(*find_input_space("cineon").value(), encoding);
    } else if (space == "rec709") {
      use_input_space(*find_input_space("rec709").value(), encoding);
    } else if (space.starts_with("gamma")) {
      const double exponent = std::atof(space.c_str() + 5);
      if (!(exponent > 0.1 && exponent < 10)) return;
      encoding.curve = TransferCurve::power;
      encoding.exponent = exponent;
    } else {
      diagnostics.warn(fmt::format("{}: its colour space '{}' is not known; sRGB is assumed", path_.string(), name));
    }
  }

  ContainerFacts container_;
  std::optional<std::vector<std::uint8_t>> in_place_;  ///< what is read in place of the file
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;
  OIIO::ImageInput::unique_ptr input_;
  bool opened_for_pixels_ = false;
  std::vector<OIIO::ImageSpec> specs_;
};

}  // namespace

Result<std::unique_ptr<PictureFile>> open_with_oiio(const std::filesystem::path& file, const std::string& format,
                                                    const ContainerFacts& container, const SizeLimits& limits) {
  auto opened = std::make_unique<OiioFile>(file, container);
  AFTERGLOW_CHECK(opened->open(format, limits));
  return std::unique_ptr<PictureFile>(std::move(opened));
}

}  // namespace afterglow
