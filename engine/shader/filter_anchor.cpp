// SPDX-License-Identifier: MIT
#include "shader/filter_anchor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "shader/axis.h"

namespace afterglow {
namespace {

constexpr std::size_t kMaxReads = 1024;  ///< texels in straight-line code
constexpr std::size_t kLoopReads = 96;   ///< from here on a separable filter loops over its rows
constexpr std::size_t kMaxAxisReads = 256;
constexpr double kMaxOffset = 65536;

/// A sum of products: variable → constant. "" is the plain number.
using Weight = std::map<std::string, double>;

std::string expression(const Weight& weight) {
  std::string out;
  for (const auto& [variable, constant] : weight) {
    if (!out.empty()) out += " + ";
    out += product(constant, variable);
  }
  return weight.size() > 1 ? "(" + out + ")" : out;
}

/// One texel or fetch along an axis, ready to print: where, and its weight as an expression.
struct Read {
  std::string at, weight;
};

Error bad_filter(std::string what, std::string allowed) {
  Error error;
  error.kind = ErrorKind::script;
  error.message = std::move(what);
  error.allowed = std::move(allowed);
  return error;
}

Result<void> check(const Filter& filter) {
  const auto fine = [](double offset, double weight) {
    return std::isfinite(weight) && std::abs(weight) <= 1e30 && std::abs(offset) <= kMaxOffset;
  };
  bool ok = true;
  for (const auto& tap : filter.x) ok = ok && fine(tap.offset, tap.weight);
  for (const auto& tap : filter.y) ok = ok && fine(tap.offset, tap.weight);
  for (const auto& tap : filter.taps) ok = ok && fine(tap.dx, tap.weight) && fine(tap.dy, tap.weight);
  if (!ok) return bad_filter("a tap of the filter is not usable", "finite weights, offsets of at most 65536 texels");
  if (filter.separable() && (filter.x.empty() || filter.y.empty()))
    return bad_filter("the filter has no taps", "at least one tap on each axis");
  return {};
}

Error too_many(std::size_t reads, std::size_t most) {
  return bad_filter(fmt::format("the filter reads {} texels", reads),
                    fmt::format("at most {}; split it into several filters", most));
}

/// Adds `reads`, each times its weight, to the variable `into`; equal weights are factored out.
std::string weighted_sum(const std::string& into, const std::vector<std::pair<std::string, std::string>>& reads) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;  // weight → fetches, in order of appearance
  for (const auto& read : reads) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == read.first; });
    if (group == groups.end()) group = groups.insert(groups.end(), {read.first, {}});
    group->second.push_back(read.second);
  }
  std::string out;
  for (const auto& [weight, fetches] : groups) {
    out += fmt::format("  {} += ", into);
    if (weight != "1.0") out += weight + " * ";
    if (fetches.size() > 1 && weight != "1.0") out += "(";
    for (std::size_t i = 0; i < fetches.size(); ++i) out += (i ? "\n    + " : "") + fetches[i];
    if (fetches.size() > 1 && weight != "1.0") out += ")";
    out += ";\n";
  }
  return out;
}

/// The texels of one axis of a separable filter, merged.
std::vector<Read> axis_reads(Axis& axis, const std::vector<Tap>& taps) {
  std::map<TexelKey, Weight> texels;
  for (const auto& tap : taps)
    for (const auto& term : axis.read(tap.offset)) texels[term.texel][term.variable] += tap.weight * term.constant;
  std::vector<Read> reads;
  for (const auto& [texel, weight] : texels) {
    if (weight.size() == 1 && weight.begin()->second == 0) continue;
    reads.push_back({axis.index(texel), expression(weight)});
  }
  return reads;
}

/// The filtered fetches of one axis of a separable filter.
std::vector<Read> axis_fetches(Axis& axis, const std::vector<Tap>& taps) {
  std::vector<FetchTerm> terms;
  if (axis.fixed()) {
    std::map<TexelKey, double> texels;
    for (const auto& tap : taps)
      for (const auto& term : axis.read(tap.offset)) texels[term.texel] += tap.weight * term.constant;
    std::erase_if(texels, [](const auto& texel) { return texel.second == 0; });
    terms = axis.fetch_pairs(texels);
  } else {
    for (const auto& tap : taps)
      for (auto& term : axis.fetch(tap.offset)) {
        term.constant *= tap.weight;
        terms.push_back(std::move(term));
      }
  }
  std::vector<Read> reads;
  for (const auto& term : terms) reads.push_back({term.position, product(term.constant, term.variable)});
  return reads;
}

/// Names the coordinates and weights of an axis, so that each is computed once: declarations, then short reads.
std::string declare(char letter, const char* type, const std::string& scale, std::vector<Read>& reads) {
  std::string out;
  for (std::size_t i = 0; i < reads.size(); ++i) {
    const std::string at = fmt::format("ag_{}{}", letter == 'x' ? "col" : "row", i);
    out += scale.empty() ? fmt::format("  {} {} = {};\n", type, at, reads[i].at)
                         : fmt::format("  {} {} = ({}) * {};\n", type, at, reads[i].at, scale);
    reads[i].at = at;
    const bool number = reads[i].weight.find("ag_") == std::string::npos;
    if (number) continue;
    const std::string weight = fmt::format("ag_{}w{}", letter == 'x' ? "col" : "row", i);
    out += fmt::format("  float {} = {};\n", weight, reads[i].weight);
    reads[i].weight = weight;
  }
  return out;
}

using Fetch = std::string (*)(const std::string& x, const std::string& y);

std::string texel(const std::string& x, const std::string& y) { return fmt::format("ag_texel0(ivec2({}, {}))", x, y); }
std::string filtered(const std::string& x, const std::string& y) {
  return fmt::format("textureLod(ag_image0, vec2({}, {}), 0.0)", x, y);
}

/// What the rows of the target weigh in each row of texels: row of the target → constant.
using RowWeights = std::map<int, double>;

/// Several rows of the target at once: each line of texels is summed once and added to all rows that it is part of.
std::string shared_rows(const std::vector<Read>& x, Axis& axis, const std::vector<Tap>& taps, int rows) {
  std::map<TexelKey, RowWeights> texels;
  for (int row = 0; row < rows; ++row)
    for (const auto& tap : taps)
      for (const auto& term : axis.read(tap.offset, row)) texels[term.texel][row] += tap.weight * term.constant;
  std::string out;
  for (int row = 0; row < rows; ++row) out += fmt::format("  vec4 ag_color{} = vec4(0.0);\n", row);
  if (x.empty()) return out;
  out += "  vec4 ag_line;\n  int ag_row;\n";
  for (const auto& [key, weights] : texels) {
    if (std::ranges::all_of(weights, [](const auto& w) { return w.second == 0; })) continue;
    std::vector<std::pair<std::string, std::string>> reads;
    for (const auto& column : x)
      reads.emplace_back(column.weight, fmt::format("ag_texel0(ivec2({}, ag_row))", column.at));
    out += fmt::format("  ag_row = {};\n  ag_line = vec4(0.0);\n", axis.index(key)) + weighted_sum("ag_line", reads);
    for (const auto& [row, weight] : weights)
      if (weight != 0) out += fmt::format("  ag_color{} += {};\n", row, product(weight, "ag_line"));
  }
  return out;
}

/// Rows first, then their weighted sum.
std::string straight_rows(const std::vector<Read>& x, const std::vector<Read>& y, Fetch fetch) {
  std::string out = "  ag_color = vec4(0.0);\n";
  if (x.empty() || y.empty()) return out;
  out += "  vec4 ag_line;\n";
  for (const auto& row : y) {
    std::vector<std::pair<std::string, std::string>> reads;
    for (const auto& column : x) reads.emplace_back(column.weight, fetch(column.at, row.at));
    if (row.weight == "1.0") {
      out += weighted_sum("ag_color", reads);
      continue;
    }
    out += "  ag_line = vec4(0.0);\n" + weighted_sum("ag_line", reads);
    out += fmt::format("  ag_color += {} * ag_line;\n", row.weight);
  }
  return out;
}

/// The same as a loop over the rows, for long filters: compilers of shaders take their time over long straight code.
std::string looped_rows(const std::vector<Read>& x, const std::vector<Read>& y, const char* coordinate, Fetch fetch) {
  std::string positions, weights;
  for (const auto& row : y) {
    positions += (positions.empty() ? "" : ", ") + row.at;
    weights += (weights.empty() ? "" : ", ") + row.weight;
  }
  std::vector<std::pair<std::string, std::string>> reads;
  for (const auto& column : x) reads.emplace_back(column.weight, fetch(column.at, "ag_rows[ag_j]"));
  return fmt::format(
      "  ag_color = vec4(0.0);\n"
      "  {0} ag_rows[{1}] = {0}[]({2});\n"
      "  float ag_weights[{1}] = float[]({3});\n"
      "  for (int ag_j = 0; ag_j < {1}; ++ag_j) {{\n"
      "  vec4 ag_line = vec4(0.0);\n{4}"
      "  ag_color += ag_weights[ag_j] * ag_line;\n"
      "  }}\n",
      coordinate, y.size(), positions, weights, weighted_sum("ag_line", reads));
}

constexpr const char* kLast = "  ivec2 ag_last = ag_source_size - 1;\n";
constexpr const char* kTexelSize = "  vec2 ag_texel = 1.0 / vec2(ag_source_size);\n";

Result<std::string> separable_anchor(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y, bool hardware_filter) {
  Axis x('x', ratio_x, filter), y('y', ratio_y, filter);
  auto columns = axis_reads(x, filter.x);
  auto rows = axis_reads(y, filter.y);
  bool sampler = hardware_filter && filter.interpolation != Interpolation::nearest;
  if (sampler) {
    auto fetched_columns = axis_fetches(x, filter.x);
    auto fetched_rows = axis_fetches(y, filter.y);
    sampler = fetched_columns.size() * fetched_rows.size() < columns.size() * rows.size();
    if (sampler) {
      columns = std::move(fetched_columns);
      rows = std::move(fetched_rows);
    }
  }
  if (columns.size() > kMaxAxisReads || rows.size() > kMaxAxisReads)
    return too_many(std::max(columns.size(), rows.size()), kMaxAxisReads);
  std::string out = x.setup() + y.setup() + kLast;
  if (sampler) out += kTexelSize;
  const char* type = sampler ? "float" : "int";
  out += declare('x', type, sampler ? "ag_texel.x" : "", columns);
  out += declare('y', type, sampler ? "ag_texel.y" : "", rows);
  const Fetch fetch = sampler ? filtered : texel;
  if (columns.size() * rows.size() > kLoopReads && rows.size() > 1)
    return out + looped_rows(columns, rows, type, fetch);
  return out + straight_rows(columns, rows, fetch);
}

/// Free taps: texels that several taps read are read once.
Result<std::string> free_anchor(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y) {
  Axis x('x', ratio_x, filter), y('y', ratio_y, filter);
  std::map<std::pair<TexelKey, TexelKey>, Weight> texels;  // y, then x
  for (const auto& tap : filter.taps) {
    const auto across = x.read(tap.dx);
    for (const auto& down : y.read(tap.dy))
      for (const auto& term : across) {
        const char* times = term.variable.empty() || down.variable.empty() ? "" : " * ";
        texels[{down.texel, term.texel}][term.variable + times + down.variable] +=
            tap.weight * term.constant * down.constant;
      }
    if (texels.size() > kMaxReads) return too_many(texels.size(), kMaxReads);
  }
  std::string out = x.setup() + y.setup() + kLast + "  ag_color = vec4(0.0);\n";
  std::map<TexelKey, std::string> columns, rows;
  for (const auto& [key, weight] : texels) {
    if (auto [column, fresh] = columns.try_emplace(key.second); fresh) {
      column->second = fmt::format("ag_col{}", columns.size() - 1);
      out += fmt::format("  int {} = {};\n", column->second, x.index(key.second));
    }
    if (auto [row, fresh] = rows.try_emplace(key.first); fresh) {
      row->second = fmt::format("ag_row{}", rows.size() - 1);
      out += fmt::format("  int {} = {};\n", row->second, y.index(key.first));
    }
  }
  std::vector<std::pair<std::string, std::string>> reads;
  for (const auto& [key, weight] : texels)
    if (weight.size() > 1 || weight.begin()->second != 0)
      reads.emplace_back(expression(weight), texel(columns[key.second], rows[key.first]));
  return out + weighted_sum("ag_color", reads);
}

/// Weight and texel of each read.
using Reads = std::vector<std::pair<std::string, std::string>>;

/// What each row of the target has of a line of texels: rows that weigh it alike, as those above and below it do, share
/// the sum.
std::string add_line(const std::vector<Reads>& of_row) {
  std::vector<std::pair<Reads, std::vector<std::size_t>>> alike;
  for (std::size_t row = 0; row < of_row.size(); ++row) {
    if (of_row[row].empty()) continue;
    auto same = std::find_if(alike.begin(), alike.end(), [&](const auto& a) { return a.first == of_row[row]; });
    if (same == alike.end()) same = alike.insert(alike.end(), {of_row[row], {}});
    same->second.push_back(row);
  }
  std::string out;
  for (const auto& [reads, rows] : alike) {
    out += "  ag_line = vec4(0.0);\n" + weighted_sum("ag_line", reads);
    for (const auto row : rows) out += fmt::format("  ag_color{} += ag_line;\n", row);
  }
  return out;
}

/// What a texel weighs in a row: a sum, or one number for each place of the pixel along x.
struct ColumnWeight {
  Weight sum;
  std::vector<double> by_place;

  void add(const std::vector<double>& weights, double times) {
    by_place.resize(weights.size());
    for (std::size_t place = 0; place < weights.size(); ++place) by_place[place] += times * weights[place];
  }
  bool none() const {
    if (!by_place.empty()) return std::ranges::all_of(by_place, [](double weight) { return weight == 0; });
    return sum.size() == 1 && sum.begin()->second == 0;
  }
  std::string text(const Axis& x) const { return by_place.empty() ? expression(sum) : x.weight(by_place); }
};

/// Free taps, several rows of the target at once: each texel is read once and added to all rows that it is part of.
Result<std::string> free_rows(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y, int rows) {
  Axis x('x', ratio_x, filter), y('y', ratio_y, filter, rows);
  std::map<TexelKey, std::map<TexelKey, std::map<int, ColumnWeight>>> lines;  // y → x → row
  std::size_t texels = 0;
  for (const auto& tap : filter.taps) {
    for (int row = 0; row < rows; ++row)
      for (const auto& down : y.read(tap.dy, row)) {
        auto& line = lines[down.texel];
        const std::size_t before = line.size();
        const double weight = tap.weight * down.constant;
        if (x.placed())
          for (const auto& term : x.read_placed(tap.dx)) line[term.texel][row].add(term.by_place, weight);
        else
          for (const auto& term : x.read(tap.dx)) line[term.texel][row].sum[term.variable] += weight * term.constant;
        texels += line.size() - before;
      }
    if (texels > kMaxReads) return too_many(texels, kMaxReads);
  }
  std::string out = x.setup() + y.setup() + kLast;
  for (int row = 0; row < rows; ++row) out += fmt::format("  vec4 ag_color{} = vec4(0.0);\n", row);
  out += "  vec4 ag_line;\n  int ag_row;\n";
  std::map<TexelKey, std::string> columns;
  std::size_t declared = 0;
  for (const auto& [line, line_texels] : lines) {
    out += fmt::format("  ag_row = {};\n", y.index(line));
    std::vector<Reads> of_row(static_cast<std::size_t>(rows));
    std::size_t reads = 0;
    for (const auto& [column, weights] : line_texels) {
      if (auto [at, fresh] = columns.try_emplace(column); fresh) {
        at->second = fmt::format("ag_col{}", columns.size() - 1);
        out += fmt::format("  int {} = {};\n", at->second, x.index(column));
      }
      const std::string read = fmt::format("ag_read{}", reads);
      out += fmt::format("  {}{} = {};\n", reads++ < declared ? "" : "vec4 ", read, texel(columns[column], "ag_row"));
      for (const auto& [row, weight] : weights)
        if (!weight.none()) of_row[static_cast<std::size_t>(row)].emplace_back(weight.text(x), read);
    }
    declared = std::max(declared, reads);
    out += add_line(of_row);
  }
  return out;
}

/// What `rows` rows of the target read of a free filter's texels: line → columns.
std::map<TexelKey, std::set<TexelKey>> texels_of_rows(const Filter& filter, Axis& x, Axis& y, int first, int rows) {
  std::map<TexelKey, std::set<TexelKey>> lines;
  for (const auto& tap : filter.taps)
    for (int row = first; row < first + rows; ++row)
      for (const auto& down : y.read(tap.dy, row))
        for (const auto& term : x.read(tap.dx)) lines[down.texel].insert(term.texel);
  return lines;
}

/// Free taps through the sampler: one filtered fetch a tap.
Result<std::string> free_sampler_anchor(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y) {
  Axis x('x', ratio_x, filter), y('y', ratio_y, filter);
  std::vector<std::pair<std::string, std::string>> reads;
  for (const auto& tap : filter.taps)
    for (const auto& across : x.fetch(tap.dx))
      for (const auto& down : y.fetch(tap.dy))
        reads.emplace_back(float_literal(tap.weight * across.constant * down.constant),
                           filtered(fmt::format("({}) * ag_texel.x", across.position),
                                    fmt::format("({}) * ag_texel.y", down.position)));
  if (reads.size() > kMaxReads) return too_many(reads.size(), kMaxReads);
  return x.setup() + y.setup() + kTexelSize + "  ag_color = vec4(0.0);\n" + weighted_sum("ag_color", reads);
}

}  // namespace

bool shares_rows(const Filter& filter, AxisRatio ratio_y, int rows) {
  return rows > 1 && Axis('y', ratio_y, filter, rows).fixed();
}

std::optional<RowsRead> rows_shared(const Filter& filter, AxisRatio ratio_y, int rows) {
  if (!shares_rows(filter, ratio_y, rows)) return std::nullopt;
  Axis axis('y', ratio_y, filter, rows);
  RowsRead read;
  if (!filter.separable()) {
    Axis x('x', AxisRatio::same, filter);
    const auto reads = [](const auto& lines) {
      int sum = 0;
      for (const auto& [line, columns] : lines) sum += static_cast<int>(columns.size());
      return sum;
    };
    const auto together = texels_of_rows(filter, x, axis, 0, rows);
    for (int row = 0; row < rows; ++row) read.apart += reads(texels_of_rows(filter, x, axis, row, 1));
    read.together = reads(together);
    read.lines = static_cast<int>(together.size());
    return read;
  }
  std::set<TexelKey> together;
  for (int row = 0; row < rows; ++row) {
    std::set<TexelKey> one;
    for (const auto& tap : filter.y)
      for (const auto& term : axis.read(tap.offset, row)) one.insert(term.texel);
    read.apart += static_cast<int>(one.size());
    together.insert(one.begin(), one.end());
  }
  read.lines = read.together = static_cast<int>(together.size());
  return read;
}

Result<std::string> filter_rows(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y, int rows) {
  AFTERGLOW_CHECK(check(filter));
  if (!filter.separable()) return free_rows(filter, ratio_x, ratio_y, rows);
  Axis x('x', ratio_x, filter), y('y', ratio_y, filter, rows);
  auto columns = axis_reads(x, filter.x);
  if (columns.size() > kMaxAxisReads || filter.y.size() > kMaxAxisReads)
    return too_many(std::max(columns.size(), filter.y.size()), kMaxAxisReads);
  std::string out = x.setup() + y.setup() + kLast + declare('x', "int", "", columns);
  return out + shared_rows(columns, y, filter.y, rows);
}

Result<std::string> filter_anchor(const Filter& filter, AxisRatio ratio_x, AxisRatio ratio_y, bool hardware_filter) {
  AFTERGLOW_CHECK(check(filter));
  if (filter.separable()) return separable_anchor(filter, ratio_x, ratio_y, hardware_filter);
  if (hardware_filter && filter.interpolation == Interpolation::linear)
    return free_sampler_anchor(filter, ratio_x, ratio_y);
  return free_anchor(filter, ratio_x, ratio_y);
}

}  // namespace afterglow
