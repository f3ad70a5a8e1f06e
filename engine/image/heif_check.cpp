// SPDX-License-Identifier: MIT
#include "image/heif_check.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdint>
#include <memory>

namespace afterglow {
namespace {

// What is used of libheif's C interface, which is stable. Its headers are no dependency of OpenImageIO's package.
struct HeifError {
  int code, subcode;
  const char* message;
};
/// heif_color_profile_nclx, as far as it has been since its first version.
struct HeifCodes {
  std::uint8_t version;
  int primaries, transfer, matrix;
  std::uint8_t full_range;
};
constexpr int kRgb = 1, kInterleavedRgb = 10, kInterleavedRgba = 11, kInterleaved = 10;

class Heif {
 public:
  Heif() : library_(dlopen("libheif.so.1", RTLD_LAZY | RTLD_LOCAL)) {
    if (!library_) return;
    whole_ =
        take(alloc, "heif_context_alloc") && take(free, "heif_context_free") &&
        take(read, "heif_context_read_from_file") && take(primary, "heif_context_get_primary_image_handle") &&
        take(has_alpha, "heif_image_handle_has_alpha_channel") && take(claimed_width, "heif_image_handle_get_width") &&
        take(claimed_height, "heif_image_handle_get_height") && take(release, "heif_image_handle_release") &&
        take(decode, "heif_decode_image") && take(width, "heif_image_get_width") &&
        take(height, "heif_image_get_height") && take(release_image, "heif_image_release") &&
        take(profile_size, "heif_image_handle_get_raw_color_profile_size") &&
        take(profile, "heif_image_handle_get_raw_color_profile") &&
        take(bits, "heif_image_handle_get_luma_bits_per_pixel") &&
        take(codes, "heif_image_handle_get_nclx_color_profile") && take(free_codes, "heif_nclx_color_profile_free");
  }
  bool whole() const { return whole_; }

  void* (*alloc)() = nullptr;
  void (*free)(void*) = nullptr;
  HeifError (*read)(void*, const char*, const void*) = nullptr;
  HeifError (*primary)(void*, void**) = nullptr;
  int (*has_alpha)(const void*) = nullptr;
  int (*claimed_width)(const void*) = nullptr;
  int (*claimed_height)(const void*) = nullptr;
  void (*release)(const void*) = nullptr;
  HeifError (*decode)(const void*, void**, int, int, const void*) = nullptr;
  int (*width)(const void*, int) = nullptr;
  int (*height)(const void*, int) = nullptr;
  void (*release_image)(const void*) = nullptr;
  std::size_t (*profile_size)(const void*) = nullptr;
  int (*bits)(const void*) = nullptr;
  HeifError (*profile)(const void*, void*) = nullptr;
  HeifError (*codes)(const void*, HeifCodes**) = nullptr;
  void (*free_codes)(HeifCodes*) = nullptr;

 private:
  template <typename Function>
  bool take(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(library_, name));
    return function != nullptr;
  }
  void* library_;
  bool whole_ = false;
};

/// The reader does not pass them on. RGB that it hands out has full range.
void take_colors(const Heif& heif, const void* handle, ContainerFacts& facts) {
  constexpr std::size_t kMostProfile = 16u << 20;
  const std::size_t size = heif.profile_size(handle);
  if (size > 0 && size <= kMostProfile) {
    facts.profile.resize(size);
    if (heif.profile(handle, facts.profile.data()).code != 0) facts.profile.clear();
  }
  HeifCodes* codes = nullptr;
  if (heif.codes(handle, &codes).code != 0 || !codes) return;
  facts.codes = {codes->primaries, codes->transfer, false};
  heif.free_codes(codes);
}

}  // namespace

Result<void> check_heif(const std::filesystem::path& file, ContainerFacts& facts) {
  static const Heif heif;
  const auto failed = [&](const std::string& why) { return Error{ErrorKind::io, why, file.string()}; };
  if (!heif.whole()) return failed("cannot be read: libheif.so.1 is missing");
  const std::unique_ptr<void, void (*)(void*)> context(heif.alloc(), heif.free);
  void *handle = nullptr, *image = nullptr;
  if (!context || heif.read(context.get(), file.c_str(), nullptr).code != 0 ||
      heif.primary(context.get(), &handle).code != 0 || !handle)
    return {};  // whose reader says why
  const std::unique_ptr<void, void (*)(const void*)> held(handle, heif.release);
  take_colors(heif, handle, facts);
  if (const int bits = heif.bits(handle); bits > 8) facts.deeper_bits = bits;
  const int chroma = heif.has_alpha(handle) != 0 ? kInterleavedRgba : kInterleavedRgb;
  if (heif.decode(handle, &image, kRgb, chroma, nullptr).code != 0 || !image) return {};
  const std::unique_ptr<void, void (*)(const void*)> decoded(image, heif.release_image);
  const int width = heif.width(image, kInterleaved), height = heif.height(image, kInterleaved);
  if (width == heif.claimed_width(handle) && height == heif.claimed_height(handle)) return {};
  return failed(fmt::format("is damaged: it claims {}×{} pixels and holds {}×{}", heif.claimed_width(handle),
                            heif.claimed_height(handle), width, height));
}

}  // namespace afterglow
