// SPDX-License-Identifier: MIT
#include "image/ffmpeg_planes.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>
#include <zimg.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <vector>

namespace afterglow {
namespace to_rgb {  // a type of the header has these in it

constexpr std::size_t kAlign = 64;  // of zimg's rows and planes

struct AlignedDelete {
  void operator()(std::byte* bytes) const { ::operator delete[](bytes, std::align_val_t{kAlign}); }
};
using AlignedBytes = std::unique_ptr<std::byte[], AlignedDelete>;
static AlignedBytes aligned_bytes(std::size_t size) {
  return AlignedBytes(
      static_cast<std::byte*>(::operator new[](std::max<std::size_t>(size, 1), std::align_val_t{kAlign})));
}
static std::size_t aligned(std::size_t size) { return (size + kAlign - 1) / kAlign * kAlign; }

/// How samples lie once they are planes of their own.
struct Layout {
  const AVPixFmtDescriptor* format = nullptr;
  bool as_it_is = false;  ///< the frame's own planes will do
  bool rgb = false, grey = false, alpha = false, floating = false;
  int depth = 8;         ///< of a sample in its plane
  int bytes = 1;         ///< of a sample in its plane
  int stored_depth = 8;  ///< in the frame; below 8 they are widened
  int colors() const { return grey ? 1 : 3; }
  int planes() const { return colors() + (alpha ? 1 : 0); }
  /// zimg takes whole samples of chroma alone: sides are rounded up, and what is not there is not looked at.
  int even_width(int width) const {
    return rgb || grey ? width : -(-width >> format->log2_chroma_w) << format->log2_chroma_w;
  }
  int even_height(int height) const {
    return rgb || grey ? height : -(-height >> format->log2_chroma_h) << format->log2_chroma_h;
  }
};

static bool planes_will_do(const AVPixFmtDescriptor& format) {
  if ((format.flags & (AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM)) != 0) return false;
  if ((format.flags & AV_PIX_FMT_FLAG_BE) != 0 && format.comp[0].depth > 8) return false;
  for (int i = 0; i < format.nb_components; ++i) {
    const AVComponentDescriptor& own = format.comp[i];
    const int bytes = own.depth > 16 ? 4 : own.depth > 8 ? 2 : 1;
    if (own.shift != 0 || own.offset != 0 || own.step != bytes || own.depth < 8) return false;
    for (int k = 0; k < i; ++k)
      if (format.comp[k].plane == own.plane) return false;
  }
  return true;
}

static bool layout_of(AVPixelFormat pixels, Layout& out) {
  const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(pixels);
  constexpr std::uint64_t kNot = AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER;
  if (!format || (format->flags & kNot) != 0 || std::strncmp(format->name, "xyz", 3) == 0) return false;
  out.format = format;
  const bool palette = (format->flags & AV_PIX_FMT_FLAG_PAL) != 0;
  out.rgb = palette || (format->flags & AV_PIX_FMT_FLAG_RGB) != 0;
  out.grey = !out.rgb && format->nb_components <= 2;
  out.alpha = palette || (format->flags & AV_PIX_FMT_FLAG_ALPHA) != 0;
  out.floating = (format->flags & AV_PIX_FMT_FLAG_FLOAT) != 0;
  out.as_it_is = planes_will_do(*format);
  for (int i = 0; i < format->nb_components; ++i) {
    const int depth = format->comp[i].depth;
    if (out.floating ? depth != 32 : depth > 16) return false;
    if (depth != format->comp[0].depth && !palette) out.as_it_is = false;
  }
  out.stored_depth = palette ? 8 : format->comp[0].depth;
  out.depth = out.stored_depth < 8 ? 16 : out.stored_depth;
  out.bytes = out.floating ? 4 : out.as_it_is && out.depth == 8 ? 1 : 2;
  if (out.floating && !out.as_it_is && (format->flags & AV_PIX_FMT_FLAG_BE) != 0) return false;
  return true;
}

struct GraphDelete {
  void operator()(zimg_filter_graph* graph) const { zimg_filter_graph_free(graph); }
};
using Graph = std::unique_ptr<zimg_filter_graph, GraphDelete>;

static zimg_chroma_location_e place_of_chroma(int location) {
  return location > AVCHROMA_LOC_UNSPECIFIED && location <= AVCHROMA_LOC_BOTTOM
             ? static_cast<zimg_chroma_location_e>(location - 1)
             : ZIMG_CHROMA_LEFT;
}

/// Colour, or alpha alone as a grey picture of full range.
static Result<Graph> make_graph(const FramePlanes& planes, const Layout& layout, bool alpha) {
  zimg_image_format from, to;
  zimg_image_format_default(&from, ZIMG_API_VERSION);
  zimg_image_format_default(&to, ZIMG_API_VERSION);
  const bool grey = alpha || layout.grey;
  from.width = static_cast<unsigned>(layout.even_width(planes.stored.width));
  from.height = static_cast<unsigned>(layout.even_height(planes.stored.height));
  from.active_region = {0, 0, static_cast<double>(planes.stored.width), static_cast<double>(planes.stored.height)};
  to.width = static_cast<unsigned>(planes.wanted.width);
  to.height = static_cast<unsigned>(planes.wanted.height);
  from.pixel_type = layout.floating ? ZIMG_PIXEL_FLOAT : layout.bytes == 1 ? ZIMG_PIXEL_BYTE : ZIMG_PIXEL_WORD;
  from.depth = static_cast<unsigned>(layout.floating ? 32 : layout.depth);
  from.color_family = grey ? ZIMG_COLOR_GREY : layout.rgb ? ZIMG_COLOR_RGB : ZIMG_COLOR_YUV;
  from.pixel_range = alpha || planes.full_range ? ZIMG_RANGE_FULL : ZIMG_RANGE_LIMITED;
  to.pixel_type = ZIMG_PIXEL_FLOAT;
  to.depth = 32;
  to.color_family = grey ? ZIMG_COLOR_GREY : ZIMG_COLOR_RGB;
  to.pixel_range = ZIMG_RANGE_FULL;
  if (!grey) {
    to.matrix_coefficients = ZIMG_MATRIX_RGB;
    from.matrix_coefficients = layout.rgb ? ZIMG_MATRIX_RGB : static_cast<zimg_matrix_coefficients_e>(planes.matrix);
    from.transfer_characteristics = to.transfer_characteristics =
        static_cast<zimg_transfer_characteristics_e>(planes.transfer);
    from.color_primaries = to.color_primaries = static_cast<zimg_color_primaries_e>(planes.primaries);
    if (!layout.rgb) {
      from.subsample_w = layout.format->log2_chroma_w;
      from.subsample_h = layout.format->log2_chroma_h;
      from.chroma_location = place_of_chroma(planes.chroma_place);
    }
  }
  zimg_graph_builder_params parameters;
  zimg_graph_builder_params_default(&parameters, ZIMG_API_VERSION);
  parameters.resample_filter = ZIMG_RESIZE_BICUBIC;
  parameters.resample_filter_uv = ZIMG_RESIZE_BILINEAR;
  parameters.cpu_type = ZIMG_CPU_AUTO;
  Graph graph(zimg_filter_graph_build(&from, &to, &parameters));
  if (graph) return graph;
  std::array<char, 256> why{};
  zimg_get_last_error(why.data(), why.size());
  return Error{ErrorKind::io,
               fmt::format("is of a kind that cannot be made RGB ({}: {})", layout.format->name, why.data())};
}

/// The frame's samples as planes that zimg takes: its own, or copies.
class Planes {
 public:
  Planes(const AVFrame& frame, const Layout& layout) {
    for (int plane = 0; plane < layout.planes(); ++plane) {
      const int component = layout.alpha && plane == layout.planes() - 1 ? alpha_component(layout) : plane;
      const bool chroma = !layout.rgb && !layout.grey && (plane == 1 || plane == 2);
      const int width = layout.even_width(frame.width) >> (chroma ? layout.format->log2_chroma_w : 0);
      const int height = layout.even_height(frame.height) >> (chroma ? layout.format->log2_chroma_h : 0);
      const int there_width = chroma ? width : frame.width, there_height = chroma ? height : frame.height;
      const auto index = static_cast<std::size_t>(plane);
      const int own = layout.format->comp[component].plane;
      data_[index] = frame.data[own];
      stride_[index] = frame.linesize[own];
      const bool fits = reinterpret_cast<std::uintptr_t>(data_[index]) % kAlign == 0 &&
                        stride_[index] % static_cast<std::ptrdiff_t>(kAlign) == 0;
      if (!layout.as_it_is || !fits || there_width < width || there_height < height)
        copy(frame, layout, plane, component, {there_width, there_height}, {width, height});
    }
  }
  const void* data(int plane) const { return data_[static_cast<std::size_t>(plane)]; }
  std::ptrdiff_t stride(int plane) const { return stride_[static_cast<std::size_t>(plane)]; }

 private:
  static int alpha_component(const Layout& layout) {
    return (layout.format->flags & AV_PIX_FMT_FLAG_PAL) != 0 ? 3 : layout.format->nb_components - 1;
  }

  void copy(const AVFrame& frame, const Layout& layout, int plane, int component, const Size& there,
            const Size& wanted) {
    const int width = there.width;
    const std::size_t row = aligned(static_cast<std::size_t>(wanted.width) * static_cast<std::size_t>(layout.bytes));
    const std::size_t size = row * static_cast<std::size_t>(wanted.height);
    AlignedBytes bytes = aligned_bytes(size);
    std::memset(bytes.get(), 0, size);
    const bool palette = (layout.format->flags & AV_PIX_FMT_FLAG_PAL) != 0;
    const std::uint8_t* from[4] = {frame.data[0], frame.data[1], frame.data[2], frame.data[3]};
    const int depth = layout.format->comp[component].depth;
    for (int y = 0; y < there.height; ++y) {
      std::byte* to = bytes.get() + row * static_cast<std::size_t>(y);
      if (layout.as_it_is) {
        const int own = layout.format->comp[component].plane;
        std::memcpy(to, frame.data[own] + static_cast<std::ptrdiff_t>(y) * frame.linesize[own],
                    static_cast<std::size_t>(width) * static_cast<std::size_t>(layout.bytes));
        continue;
      }
      if (palette) {
        look_up(frame, y, component, {reinterpret_cast<std::uint16_t*>(to), static_cast<std::size_t>(width)});
        continue;
      }
      av_read_image_line2(to, from, frame.linesize, layout.format, 0, y, component, width, 0, layout.floating ? 4 : 2);
      if (depth != layout.depth) widen(reinterpret_cast<std::uint16_t*>(to), width, depth, layout.depth);
    }
    const auto index = static_cast<std::size_t>(plane);
    data_[index] = bytes.get();
    stride_[index] = static_cast<std::ptrdiff_t>(row);
    kept_[index] = std::move(bytes);
  }

  /// One component (red, green, blue, alpha) of a row of codes: a palette's colours are words of A, R, G, B, the
  /// highest byte first.
  static void look_up(const AVFrame& frame, int y, int component, std::span<std::uint16_t> to) {
    constexpr std::array<unsigned, 4> kShift{16, 8, 0, 24};
    const std::uint8_t* codes = frame.data[0] + static_cast<std::ptrdiff_t>(y) * frame.linesize[0];
    const unsigned shift = kShift[static_cast<std::size_t>(component)];
    for (std::size_t x = 0; x < to.size(); ++x) {
      std::uint32_t color = 0;
      std::memcpy(&color, frame.data[1] + std::size_t{4} * codes[x], sizeof color);
      to[x] = static_cast<std::uint16_t>(color >> shift & 255);
    }
  }

  static void widen(std::uint16_t* samples, int count, int depth, int wanted) {
    const unsigned most = (1u << depth) - 1, full = (1u << wanted) - 1;
    for (int i = 0; i < count; ++i) samples[i] = static_cast<std::uint16_t>((samples[i] * full + most / 2) / most);
  }

  std::array<const void*, 4> data_{};
  std::array<std::ptrdiff_t, 4> stride_{};
  std::array<AlignedBytes, 4> kept_;
};

/// Rows as zimg makes them, spread over the pixels.
struct Spread {
  float* rgba;
  std::size_t row_stride;
  std::array<const float*, 3> planes;
  std::size_t line;  ///< floats
  unsigned mask;
  int colors, first;  ///< channels of a pixel that are written: 1 for grey and alpha; where they begin
  bool grey;

  static int row(void* user, unsigned y, unsigned left, unsigned right) {
    const Spread& s = *static_cast<const Spread*>(user);
    float* out = s.rgba + y * s.row_stride;
    for (int c = 0; c < s.colors; ++c) {
      const float* in = s.planes[static_cast<std::size_t>(c)] + (y & s.mask) * s.line;
      float* to = out + s.first + c;
      for (unsigned x = left; x < right; ++x) to[4 * x] = in[x];
    }
    if (s.grey)
      for (unsigned x = left; x < right; ++x) out[4 * x + 1] = out[4 * x + 2] = out[4 * x];
    return 0;
  }
};

static Result<void> process(const zimg_filter_graph& graph, const Planes& planes, int first_plane, int count,
                            const Size& size, Spread spread) {
  std::size_t scratch = 0;
  unsigned lines = 0;
  zimg_filter_graph_get_tmp_size(&graph, &scratch);
  zimg_filter_graph_get_output_buffering(&graph, &lines);
  const unsigned mask = zimg_select_buffer_mask(lines);
  const auto held = mask == ZIMG_BUFFER_MAX ? static_cast<std::size_t>(size.height) : std::size_t{mask} + 1;
  const std::size_t row = aligned(static_cast<std::size_t>(size.width) * sizeof(float));
  const AlignedBytes out = aligned_bytes(row * held * static_cast<std::size_t>(count)), room = aligned_bytes(scratch);
  zimg_image_buffer_const from{};
  zimg_image_buffer to{};
  from.version = to.version = ZIMG_API_VERSION;
  for (int i = 0; i < count; ++i) {
    from.plane[i] = {planes.data(first_plane + i), planes.stride(first_plane + i), ZIMG_BUFFER_MAX};
    std::byte* own = out.get() + row * held * static_cast<std::size_t>(i);
    to.plane[i] = {own, static_cast<std::ptrdiff_t>(row), mask};
    spread.planes[static_cast<std::size_t>(i)] = reinterpret_cast<const float*>(own);
  }
  spread.line = row / sizeof(float);
  spread.mask = mask;
  if (zimg_filter_graph_process(&graph, &from, &to, room.get(), nullptr, nullptr, Spread::row, &spread) == 0) return {};
  std::array<char, 256> why{};
  zimg_get_last_error(why.data(), why.size());
  return Error{ErrorKind::io, fmt::format("cannot be made RGB ({})", why.data())};
}

}  // namespace to_rgb

using namespace to_rgb;

struct FfmpegPlanes::Graphs {
  FramePlanes planes;
  Layout layout;
  Graph color, alpha;
};

FfmpegPlanes::FfmpegPlanes() = default;
FfmpegPlanes::~FfmpegPlanes() = default;

Result<std::shared_ptr<const FfmpegPlanes::Graphs>> FfmpegPlanes::graphs(const FramePlanes& planes) {
  const std::lock_guard lock(mutex_);
  if (graphs_ && graphs_->planes == planes) return graphs_;
  auto made = std::make_shared<Graphs>();
  made->planes = planes;
  if (!layout_of(planes.format, made->layout)) {
    const char* name = av_get_pix_fmt_name(planes.format);
    return Error{ErrorKind::io, fmt::format("is of a pixel format that is not read ({})", name ? name : "none")};
  }
  AFTERGLOW_TRY(made->color, make_graph(planes, made->layout, false));
  if (made->layout.alpha) {
    AFTERGLOW_TRY(made->alpha, make_graph(planes, made->layout, true));
  }
  graphs_ = std::move(made);
  return graphs_;
}

Result<void> FfmpegPlanes::convert(const AVFrame& frame, const FramePlanes& planes, float* rgba,
                                   std::size_t row_stride) {
  AFTERGLOW_TRY(const std::shared_ptr<const Graphs> graphs, this->graphs(planes));
  const Layout& layout = graphs->layout;
  const Planes samples(frame, layout);
  const int colors = layout.colors();
  const Spread spread{rgba, row_stride, {}, 0, 0, colors, 0, layout.grey};
  AFTERGLOW_CHECK(process(*graphs->color, samples, 0, colors, planes.wanted, spread));
  if (!graphs->alpha) return {};
  return process(*graphs->alpha, samples, colors, 1, planes.wanted, {rgba, row_stride, {}, 0, 0, 1, 3, false});
}

bool is_readable_format(AVPixelFormat format) {
  Layout layout;
  return layout_of(format, layout);
}

}  // namespace afterglow
