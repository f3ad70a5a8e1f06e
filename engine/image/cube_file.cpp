// SPDX-License-Identifier: MIT
// The text of a .cube (Adobe's specification 1.0 and Resolve's dialect of it), looked through line by line.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/parse_number.h"
#include "core/text.h"
#include "image/lut_file.h"

namespace afterglow {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while (at < line.size() && words.size() <= 8) {
    while (at < line.size() && is_space(line[at])) ++at;
    const std::size_t begin = at;
    while (at < line.size() && !is_space(line[at])) ++at;
    if (at > begin) words.push_back(line.substr(begin, at - begin));
  }
  return words;
}

std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  return parse_number<double>(word);
}

std::string shown(std::string_view text) {
  std::string out(text.substr(0, 40));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7F) c = '?';
  return out;
}

class CubeCheck {
 public:
  explicit CubeCheck(const std::string& file) : file_(file) {}

  Result<void> run(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) return fail("begins with a byte order mark, which OpenColorIO does not read");
    while (!text.empty()) {
      ++line_;
      const std::size_t end = text.find('\n');
      AFTERGLOW_CHECK(line(text.substr(0, end)));
      if (end == std::string_view::npos) break;
      text.remove_prefix(end + 1);
    }
    return complete();
  }

 private:
  Error fail(std::string what, std::string allowed = {}, std::string nearest = {}) const {
    return {ErrorKind::script, std::move(what), file_, line_, std::move(allowed), std::move(nearest), {}};
  }

  Result<void> line(std::string_view text) {
    if (const auto comment = text.find('#'); comment != std::string_view::npos) {
      const auto words = words_of(text);
      if (!words.empty() && words[0].starts_with('#')) return {};
    }
    const auto words = words_of(text);
    if (words.empty()) return {};
    const char first = words[0][0];
    if ((first >= '0' && first <= '9') || first == '-' || first == '+' || first == '.' || number(words[0]))
      return colour(words);
    return keyword(words);
  }

  Result<void> colour(const std::vector<std::string_view>& words) {
    if (size_1d_ == 0 && size_3d_ == 0)
      return fail("colours before the size of the table", "LUT_1D_SIZE or LUT_3D_SIZE first");
    if (words.size() != 3) return fail(fmt::format("a colour has 3 numbers, not {}", words.size()));
    for (const auto word : words) {
      const auto value = number(word);
      if (!value) return fail(fmt::format("'{}' is not a number", shown(word)));
      if (!std::isfinite(static_cast<float>(*value))) return fail(fmt::format("'{}' is not finite", shown(word)));
    }
    if (++colours_ > wanted()) return fail(fmt::format("more than the {} colours that the size asks for", wanted()));
    return {};
  }

  Result<void> keyword(const std::vector<std::string_view>& words) {
    static const std::vector<std::string> kKnown{
        "DOMAIN_MAX", "DOMAIN_MIN", "LUT_1D_INPUT_RANGE", "LUT_1D_SIZE", "LUT_3D_INPUT_RANGE", "LUT_3D_SIZE", "TITLE"};
    const std::string name(words[0]);
    if (name == "TITLE") return {};
    if (colours_ > 0) return fail(fmt::format("'{}' behind the first colour", shown(name)));
    if (name == "LUT_1D_SIZE") return size(words, size_1d_, kMostLut1d);
    if (name == "LUT_3D_SIZE") return size(words, size_3d_, kMostLut3d);
    if (name == "DOMAIN_MIN") return domain(words, 0);
    if (name == "DOMAIN_MAX") return domain(words, 1);
    if (name == "LUT_1D_INPUT_RANGE" || name == "LUT_3D_INPUT_RANGE") return range(words);
    return fail(fmt::format("unknown word '{}'", shown(name)), join(kKnown), nearest_name(name, kKnown));
  }

  Result<void> size(const std::vector<std::string_view>& words, int& to, int most) {
    const std::string name(words[0]);
    const auto value = words.size() == 2 ? number(words[1]) : std::nullopt;
    if (!value || *value != std::floor(*value) || *value < 2 || *value > most)
      return fail(fmt::format("{} is {}", name, words.size() > 1 ? shown(words[1]) : "missing"),
                  fmt::format("an integer, 2…{}", most));
    if (to != 0) return fail(fmt::format("{} is there twice", name));
    to = static_cast<int>(*value);
    return {};
  }

  Result<void> domain(const std::vector<std::string_view>& words, std::size_t side) {
    if (words.size() != 4) return fail(fmt::format("{} has 3 numbers, not {}", shown(words[0]), words.size() - 1));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = number(words[i + 1]);
      if (!value || !std::isfinite(static_cast<float>(*value)))
        return fail(fmt::format("{}: '{}' is not a finite number", shown(words[0]), shown(words[i + 1])));
      domain_[side][i] = *value;
    }
    domain_line_ = line_;
    return {};
  }

  Result<void> range(const std::vector<std::string_view>& words) {
    const auto low = words.size() == 3 ? number(words[1]) : std::nullopt;
    const auto high = words.size() == 3 ? number(words[2]) : std::nullopt;
    if (!low || !high || !std::isfinite(static_cast<float>(*low)) || !std::isfinite(static_cast<float>(*high)) ||
        *low >= *high)
      return fail(fmt::format("{} is no range", shown(words[0])), "2 numbers, the smaller one first");
    return {};
  }

  long long wanted() const { return size_1d_ + static_cast<long long>(size_3d_) * size_3d_ * size_3d_; }

  Result<void> complete() {
    if (wanted() == 0) return fail("holds no table", "LUT_1D_SIZE or LUT_3D_SIZE, and colours");
    if (colours_ < wanted()) return fail(fmt::format("ends after {} of {} colours", colours_, wanted()));
    for (std::size_t i = 0; i < 3; ++i)
      if (domain_[0][i] >= domain_[1][i]) {
        line_ = domain_line_;
        return fail("DOMAIN_MIN is not below DOMAIN_MAX");
      }
    return {};
  }

  const std::string& file_;
  int line_ = 0, domain_line_ = 0;
  int size_1d_ = 0, size_3d_ = 0;
  long long colours_ = 0;
  std::array<std::array<double, 3>, 2> domain_{{{0, 0, 0}, {1, 1, 1}}};
};

}  // namespace

Result<void> check_cube(const std::string& text, const std::string& file) { return CubeCheck(file).run(text); }

}  // namespace afterglow
