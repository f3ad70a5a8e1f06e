// SPDX-License-Identifier: MIT
#include "image/picture_format.h"

#include <array>
#include <fstream>
#include <string_view>

#include "core/text.h"
#include "image/file_signature.h"
#include "image/still_brands.h"

namespace afterglow {
namespace {

using namespace std::string_view_literals;

constexpr std::array kPictureSignatures{
    FileSignature{0, "\x89PNG\r\n\x1a\n"sv, "png"},
    FileSignature{0, "\xff\xd8\xff"sv, "jpeg"},
    FileSignature{0, "II*\0"sv, "tiff"},
    FileSignature{0, "MM\0*"sv, "tiff"},
    FileSignature{0, "II+\0"sv, "tiff"},
    FileSignature{0, "MM\0+"sv, "tiff"},
    FileSignature{0, "#?"sv, "hdr"},
    FileSignature{0, "SDPX"sv, "dpx"},
    FileSignature{0, "XPDS"sv, "dpx"},
    FileSignature{0, "\x80\x2a\x5f\xd7"sv, "cineon"},
    FileSignature{0, "\xd7\x5f\x2a\x80"sv, "cineon"},
    FileSignature{0, "BM"sv, "bmp"},
    FileSignature{8, "WEBP"sv, "webp"},
    FileSignature{0, "\0\0\0\x0cjP  "sv, "jpeg2000"},
    FileSignature{0, "\xff\x4f\xff\x51"sv, "jpeg2000"},
    FileSignature{0, "\x01\xda"sv, "sgi"},
    FileSignature{0, "GIF8"sv, "gif"},
};

/// P1 … P6, PF and Pf, each with white space behind it.
bool is_pnm(std::string_view head) {
  return head.size() >= 3 && head[0] == 'P' && "123456Ff"sv.find(head[1]) != std::string_view::npos &&
         " \t\r\n#"sv.find(head[2]) != std::string_view::npos;
}

bool is_targa(const std::filesystem::path& file, std::ifstream& in) {
  constexpr std::string_view kFooter = "TRUEVISION-XFILE.\0"sv;
  std::array<char, kFooter.size()> tail{};
  in.clear();
  in.seekg(-static_cast<std::streamoff>(kFooter.size()), std::ios::end);
  if (in.read(tail.data(), tail.size()) && std::string_view(tail.data(), tail.size()) == kFooter) return true;
  const std::string extension = lower(file.extension().string());
  return extension == ".tga" || extension == ".tpic";
}

}  // namespace

std::string picture_format(const std::filesystem::path& file) {
  std::array<char, 400> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), static_cast<std::size_t>(in.gcount()));
  if (const auto format = format_by_signature(kPictureSignatures, head); !format.empty()) return std::string(format);
  if (still_of(head) == Still::heif) return "heif";
  if (is_pnm(head)) return "pnm";
  return is_targa(file, in) ? "targa" : "";
}

}  // namespace afterglow
