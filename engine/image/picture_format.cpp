// SPDX-License-Identifier: MIT
#include "image/picture_format.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "core/text.h"

namespace afterglow {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::size_t at;
  std::string_view bytes;
  const char* format;
};
constexpr std::array kSignatures{
    Signature{0, "\x89PNG\r\n\x1a\n"sv, "png"},
    Signature{0, "\xff\xd8\xff"sv, "jpeg"},
    Signature{0, "II*\0"sv, "tiff"},
    Signature{0, "MM\0*"sv, "tiff"},
    Signature{0, "II+\0"sv, "tiff"},
    Signature{0, "MM\0+"sv, "tiff"},
    Signature{0, "#?"sv, "hdr"},
    Signature{0, "SDPX"sv, "dpx"},
    Signature{0, "XPDS"sv, "dpx"},
    Signature{0, "\x80\x2a\x5f\xd7"sv, "cineon"},
    Signature{0, "\xd7\x5f\x2a\x80"sv, "cineon"},
    Signature{0, "BM"sv, "bmp"},
    Signature{8, "WEBP"sv, "webp"},
    Signature{0, "\0\0\0\x0cjP  "sv, "jpeg2000"},
    Signature{0, "\xff\x4f\xff\x51"sv, "jpeg2000"},
    Signature{0, "\x01\xda"sv, "sgi"},
    Signature{0, "GIF8"sv, "gif"},
    Signature{8, "avif"sv, "heif"},
    Signature{8, "heic"sv, "heif"},
    Signature{8, "heix"sv, "heif"},
    Signature{8, "mif1"sv, "heif"},
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
  std::array<char, 16> bytes{};
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), static_cast<std::size_t>(in.gcount()));
  const auto found = std::ranges::find_if(kSignatures, [&](const Signature& signature) {
    return head.size() >= signature.at && head.substr(signature.at).starts_with(signature.bytes);
  });
  if (found != kSignatures.end()) return found->format;
  if (is_pnm(head)) return "pnm";
  return is_targa(file, in) ? "targa" : "";
}

}  // namespace afterglow
