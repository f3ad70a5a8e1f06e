// SPDX-License-Identifier: MIT
#include "image/write_webp.h"

#include <fmt/format.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <vector>

namespace afterglow {
namespace {

int write_some(const std::uint8_t* data, std::size_t size, const WebPPicture* picture) {
  return static_cast<OutputFile*>(picture->custom_ptr)->write(data, size) ? 1 : 0;
}

struct PictureOfWebp : WebPPicture {
  PictureOfWebp() : valid(WebPPictureInit(this) != 0) {}
  ~PictureOfWebp() { WebPPictureFree(this); }
  PictureOfWebp(const PictureOfWebp&) = delete;
  PictureOfWebp& operator=(const PictureOfWebp&) = delete;
  bool valid;
};

struct MemoryOfWebp : WebPMemoryWriter {
  MemoryOfWebp() { WebPMemoryWriterInit(this); }
  ~MemoryOfWebp() { WebPMemoryWriterClear(this); }
  MemoryOfWebp(const MemoryOfWebp&) = delete;
  MemoryOfWebp& operator=(const MemoryOfWebp&) = delete;
};

/// False: no memory.
bool write_with_exif(const MemoryOfWebp& made, std::span<const char> exif, OutputFile& out) {
  const WebPData whole{made.mem, made.size};
  const WebPData block{reinterpret_cast<const std::uint8_t*>(exif.data()), exif.size()};
  WebPMux* const mux = WebPMuxCreate(&whole, 0);
  WebPData assembled{};
  const bool done =
      mux && WebPMuxSetChunk(mux, "EXIF", &block, 0) == WEBP_MUX_OK && WebPMuxAssemble(mux, &assembled) == WEBP_MUX_OK;
  if (done) out.write(assembled.bytes, assembled.size);
  WebPDataClear(&assembled);
  WebPMuxDelete(mux);
  return done;
}

}  // namespace

Result<void> write_webp(const Picture& picture, const StripForm& form, OutputFile& out, std::optional<float> quality,
                        std::span<const char> exif) {
  const Size size = picture.display_window.size();
  if (size.width > WEBP_MAX_DIMENSION || size.height > WEBP_MAX_DIMENSION)
    return Error{ErrorKind::io, fmt::format("cannot be written: WebP files hold sides up to {}, not {}x{}",
                                            WEBP_MAX_DIMENSION, size.width, size.height)};
  const std::size_t row_bytes = form.row_bytes(picture);
  std::vector<std::uint8_t> pixels(row_bytes * static_cast<std::size_t>(size.height));
  encode_strip(picture, form, 0, size.height, pixels.data());

  constexpr int kFast = 1, kMiddle = 4;  // of 6: lossless files of 1 are a few per cent larger, and five times faster
  WebPConfig config;
  PictureOfWebp webp;
  bool done = webp.valid && WebPConfigInit(&config) != 0;
  if (!done) return Error{ErrorKind::io, "cannot be written: libwebp is of another version"};
  config.lossless = quality ? 0 : 1;
  config.quality = quality.value_or(50);  // of a lossless file: how hard it tries
  config.method = quality ? kMiddle : kFast;
  config.exact = 1;  // colours below an alpha of 0 stay
  config.thread_level = 1;
  webp.use_argb = quality ? 0 : 1;
  webp.width = size.width;
  webp.height = size.height;
  MemoryOfWebp memory;
  if (exif.empty()) {
    webp.writer = write_some;
    webp.custom_ptr = &out;
  } else {
    webp.writer = WebPMemoryWrite;
    webp.custom_ptr = &memory;
  }
  const auto stride = static_cast<int>(row_bytes);
  done = form.alpha ? WebPPictureImportRGBA(&webp, pixels.data(), stride) != 0
                    : WebPPictureImportRGB(&webp, pixels.data(), stride) != 0;
  done = done && WebPEncode(&config, &webp) != 0;
  if (done && exif.empty()) return {};
  if (done && write_with_exif(memory, exif, out)) return {};
  return Error{ErrorKind::io, fmt::format("cannot be written: libwebp failed ({})", static_cast<int>(webp.error_code))};
}

}  // namespace afterglow
