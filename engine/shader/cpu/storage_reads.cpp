// SPDX-License-Identifier: MIT
#include "shader/cpu/storage_reads.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "shader/prelude.h"

namespace afterglow {
namespace {

constexpr std::array<std::string_view, 4> kReading{"fetch", "fetch_linear", "sample_scaled", "image_size"};
// Everything from here to the end of the prelude reads an image through `ag_texel` and `image_size`.
constexpr std::string_view kFirstFunction = "vec4 fetch(sampler2D image";
constexpr std::array<std::string_view, 6> kRenamed{"ag_texel(", "ag_bilinear(",   "fetch_linear(",
                                                   "fetch(",    "sample_scaled(", "image_size("};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

bool is_reading_function(std::string_view name) {
  return std::find(kReading.begin(), kReading.end(), name) != kReading.end();
}

bool read_by_prelude_alone(const std::vector<Token>& tokens, std::string_view name) {
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (!tokens[i].is_identifier() || !tokens[i].is(name)) continue;
    const bool declaration = i >= 2 && tokens[i - 1].is("sampler2D") && tokens[i - 2].is("uniform");
    const bool read =
        i >= 2 && tokens[i].directive < 0 && tokens[i - 1].is("(") && is_reading_function(tokens[i - 2].text);
    if (!declaration && !read) return false;
  }
  return true;
}

std::string storage_reads(const std::string& prefix, const std::string& variable) {
  std::string text(prelude_text().substr(prelude_text().find(kFirstFunction)));
  replace_all(text, "sampler2D image, ", "");
  replace_all(text, "(image, ", "(");
  replace_all(text, "(image)", "()");
  for (const auto name : kRenamed) {
    replace_all(
        text, name,
        "\1" + std::string(name.substr(0, name.size() - 1)) + "\2");  // marks keep later names from matching again
  }
  replace_all(text, "\1", prefix);
  replace_all(text, "\2", "(");
  return fmt::format(
             "ivec2 {0}image_size() {{ return imageSize({1}); }}\nvec4 {0}ag_texel(ivec2 pixel) {{ return "
             "imageLoad({1}, pixel); }}\n",
             prefix, variable) +
         text;
}

}  // namespace afterglow
