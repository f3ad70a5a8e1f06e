// SPDX-License-Identifier: MIT
#include "shader/axis.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace afterglow {
namespace {

constexpr double kSnap = 1e-9;  ///< offsets this near a whole texel are meant to be one

/// Splits into a whole part and a fraction in [0, 1).
std::pair<int, double> split(double value) {
  double whole = std::floor(value);
  double fraction = value - whole;
  if (fraction > 1 - kSnap) {
    whole += 1;
    fraction = 0;
  } else if (fraction < kSnap) {
    fraction = 0;
  }
  return {static_cast<int>(whole), fraction};
}

/// Weights of texels i−1 … i+2 (math.md §1).
std::array<double, 4> bspline(double f) {
  const double g = 1 - f;
  return {g * g * g / 6, (4 - 6 * f * f + 3 * f * f * f) / 6, (4 - 6 * g * g + 3 * g * g * g) / 6, f * f * f / 6};
}

std::string sum(const std::string& base, int shift) {
  if (shift == 0) return base;
  return fmt::format("{} {} {}", base, shift < 0 ? '-' : '+', std::abs(shift));
}

}  // namespace

std::string float_literal(double value) {
  std::string text = fmt::format("{}", static_cast<float>(value));
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string product(double constant, const std::string& variable) {
  if (variable.empty()) return float_literal(constant);
  if (static_cast<float>(constant) == 1.0f) return variable;
  return float_literal(constant) + " * " + variable;
}

Axis::Axis(char letter, AxisRatio ratio, const Filter& filter, int pixels)
    : letter_(letter), ratio_(ratio), interpolation_(filter.interpolation), edges_(filter.edges), pixels_(pixels) {}

std::string Axis::name(const char* what, int phase) const { return fmt::format("ag_{}{}{}", letter_, what, phase); }

std::string Axis::base(int phase) const {
  if (ratio_ == AxisRatio::same) return fmt::format("ag_pixel.{}", letter_);
  if (fixed()) return fmt::format("ag_{}0", letter_);
  return name("i", phase);
}

int Axis::phase_for(double fraction) {
  for (std::size_t i = 0; i < fractions_.size(); ++i)
    if (std::abs(fractions_[i] - fraction) < kSnap) return static_cast<int>(i);
  fractions_.push_back(fraction);
  return static_cast<int>(fractions_.size()) - 1;
}

std::vector<TapTerm> Axis::read(double offset, int pixel) {
  if (interpolation_ == Interpolation::nearest) offset += 0.5;  // ⌊p + offset⌋ = ⌊t + ½⌋
  std::vector<TapTerm> terms;
  const auto add = [&](int phase, int shift, double constant, std::string variable = {}) {
    if (constant != 0) terms.push_back({{phase, shift}, constant, std::move(variable)});
  };
  if (fixed()) {
    const auto [i, f] = split(offset + (pixel + 0.5) * step() - 0.5);
    if (interpolation_ == Interpolation::nearest) {
      add(0, i, 1);
    } else if (interpolation_ == Interpolation::linear) {
      add(0, i, 1 - f);
      add(0, i + 1, f);
    } else {
      const auto weights = bspline(f);
      for (int k = 0; k < 4; ++k) add(0, i - 1 + k, weights[static_cast<std::size_t>(k)]);
    }
    return terms;
  }
  const auto [i, fraction] = split(offset);
  const int phase = phase_for(fraction);
  if (interpolation_ == Interpolation::nearest) {
    add(phase, i, 1);
  } else if (interpolation_ == Interpolation::linear) {
    add(phase, i, 1, name("g", phase));
    add(phase, i + 1, 1, name("f", phase));
  } else {
    for (int k = 0; k < 4; ++k) add(phase, i - 1 + k, 1, name("w", phase) + '.' + "xyzw"[k]);
  }
  return terms;
}

std::vector<PlacedTerm> Axis::read_placed(double offset) {
  const int base = phase_for(0);
  Axis whole_period = *this;
  whole_period.pixels_ = period();
  std::map<int, std::vector<double>> columns;
  for (int place = 0; place < period(); ++place) {
    const int carry = split((place + 0.5) * step() - 0.5).first;  // as setup() gives it to the base
    for (const auto& term : whole_period.read(offset, place)) {
      auto& weights = columns[term.texel.shift - carry];
      weights.resize(static_cast<std::size_t>(period()));
      weights[static_cast<std::size_t>(place)] += term.constant;
    }
  }
  std::vector<PlacedTerm> terms;
  for (auto& [column, weights] : columns) terms.push_back({{base, column}, std::move(weights)});
  return terms;
}

std::string Axis::weight(const std::vector<double>& by_place) const {
  std::vector<std::string> literals;
  for (const double value : by_place) literals.push_back(float_literal(value));
  const std::string out = this->by_place(literals);
  return out == literals.back() ? out : "(" + out + ")";
}

std::vector<FetchTerm> Axis::fetch(double offset) {
  if (fixed()) {
    std::map<TexelKey, double> texels;
    for (const auto& term : read(offset)) texels[term.texel] += term.constant;
    return fetch_pairs(texels);
  }
  const auto [i, fraction] = split(offset);
  const int phase = phase_for(fraction);
  const auto position = [&](int shift, const std::string& part) {
    return inside(fmt::format("float({}) + ({} + 0.5)", sum(base(phase), shift), part));
  };
  if (interpolation_ == Interpolation::linear) return {{position(i, name("f", phase)), 1, {}}};
  const std::string w = name("w", phase);
  return {{position(i - 1, fmt::format("{0}.y / ({0}.x + {0}.y)", w)), 1, fmt::format("({0}.x + {0}.y)", w)},
          {position(i + 1, fmt::format("{0}.w / ({0}.z + {0}.w)", w)), 1, fmt::format("({0}.z + {0}.w)", w)}};
}

std::string Axis::inside(const std::string& position) const {
  if (edges_ == Edges::stretch) return position;  // as the sampler has it
  return fmt::format("ag_mirrored_at({}, float(ag_source_size.{}))", position, letter_);
}

std::vector<FetchTerm> Axis::fetch_pairs(const std::map<TexelKey, double>& texels) const {
  std::vector<FetchTerm> terms;
  for (auto it = texels.begin(); it != texels.end(); ++it) {
    double shift = it->first.shift, weight = it->second;
    const auto next = std::next(it);
    if (next != texels.end() && next->first.shift == it->first.shift + 1 && next->second * weight > 0) {
      weight += next->second;
      shift += next->second / weight;
      ++it;
    }
    terms.push_back({inside(fmt::format("float({}) + {}", base(0), float_literal(shift + 0.5))), weight, {}});
  }
  return terms;
}

std::string Axis::by_place(const std::vector<std::string>& values) const {
  std::string out = values.back();
  for (std::size_t place = values.size() - 1; place-- > 0;)
    if (values[place] != values[place + 1])
      out = fmt::format("ag_{}place <= {} ? {} : {}", letter_, place, values[place], out);
  return out;
}

std::string Axis::setup() const {
  std::string out;
  if (ratio_ == AxisRatio::half) out += fmt::format("  int ag_{0}0 = 2 * ag_pixel.{0};\n", letter_);
  if (period() > 1) out += fmt::format("  int ag_{0}0 = ag_pixel.{0} >> {1};\n", letter_, period() / 2);
  if (fixed()) return out;
  if (period() > 1) {
    out += fmt::format("  int ag_{0}place = ag_pixel.{0} & {1};\n", letter_, period() - 1);
  } else {
    out += fmt::format(
        "  int ag_{0}i, ag_{0}rest;\n"
        "  ag_phase(ag_pixel.{0}, ag_source_size.{0}, ag_target_size.{0}, ag_{0}i, ag_{0}rest);\n",
        letter_);
  }
  for (std::size_t c = 0; c < fractions_.size(); ++c) {
    const int phase = static_cast<int>(c);
    const double fraction = fractions_[c];
    const std::string i = name("i", phase), f = name("f", phase), g = name("g", phase);
    if (period() > 1) {
      std::vector<std::string> carries, fs, gs;
      std::array<std::vector<std::string>, 4> weights;
      for (int place = 0; place < period(); ++place) {
        const auto [carry, rest] = split(fraction + (place + 0.5) * step() - 0.5);
        carries.push_back(std::to_string(carry));
        fs.push_back(float_literal(rest));
        gs.push_back(float_literal(1 - rest));
        for (std::size_t k = 0; k < 4; ++k) weights[k].push_back(float_literal(bspline(rest)[k]));
      }
      out += fmt::format("  int {} = ag_{}0 + ({});\n", i, letter_, by_place(carries));
      // The same numbers as on a fixed axis, so that it does not matter how many pixels an invocation makes.
      if (interpolation_ == Interpolation::cubic_bspline) {
        out += fmt::format("  vec4 {} = vec4({}, {}, {}, {});\n", name("w", phase), by_place(weights[0]),
                           by_place(weights[1]), by_place(weights[2]), by_place(weights[3]));
      } else {
        out += fmt::format("  float {} = {}, {} = {};\n", f, by_place(fs), g, by_place(gs));
      }
    } else if (fraction == 0) {
      out += fmt::format(
          "  int {1} = ag_{0}i;\n  float {2}, {3};\n  ag_fraction(ag_{0}rest, ag_target_size.{0}, {2}, {3});\n",
          letter_, i, f, g);
    } else {
      const double high = std::floor(fraction * 256) / 256;
      out += fmt::format(
          "  int {1} = ag_{0}i;\n  float {2}, {3};\n"
          "  ag_fraction_beyond({1}, ag_{0}rest, ag_target_size.{0}, {4}, {5}, {2}, {3});\n",
          letter_, i, f, g, float_literal(high), float_literal(fraction - high));
    }
    if (interpolation_ == Interpolation::cubic_bspline && period() == 1)
      out += fmt::format(
          "  vec4 {0} = vec4({2} * {2} * {2}, 4.0 + (3.0 * {1} - 6.0) * ({1} * {1}), 4.0 + (3.0 * {2} - 6.0) * ({2} * "
          "{2}), "
          "{1} * {1} * {1}) * {3};\n",
          name("w", phase), f, g, float_literal(1.0 / 6));
  }
  return out;
}

std::string Axis::index(TexelKey texel) const {
  const std::string at = sum(base(texel.phase), texel.shift);
  const int first_beyond = ratio_ == AxisRatio::half ? 2 : 1;  // texels 0 … first_beyond−1 belong to the pixel itself
  if (edges_ == Edges::mirror && (!fixed() || texel.shift < 0 || texel.shift >= first_beyond))
    return fmt::format("ag_mirrored({}, ag_last.{})", at, letter_);
  if (!fixed()) return fmt::format("clamp({}, 0, ag_last.{})", at, letter_);
  if (texel.shift < 0) return fmt::format("max({}, 0)", at);
  if (texel.shift >= first_beyond) return fmt::format("min({}, ag_last.{})", at, letter_);
  return at;
}

}  // namespace afterglow
