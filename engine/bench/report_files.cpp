// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "bench/page.h"
#include "bench/report.h"
#include "core/file.h"

namespace afterglow::bench {
namespace fs = std::filesystem;
namespace {

/// The first `mark` of `text` replaced.
std::string filled(std::string text, const std::string& mark, const std::string& content) {
  const auto at = text.find(mark);
  return at == std::string::npos ? text : text.replace(at, mark.size(), content);
}

/// JSON that may stand in a <script>: nothing in it ends the element, or begins a comment that hides its end.
std::string for_script(std::string json) {
  constexpr std::string_view kLess = "\\u003c";  // "<" stands in texts alone
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos; at += kLess.size())
    json.replace(at, 1, kLess);
  return json;
}

}  // namespace

std::string report_html(const Report& report) {
  // The library last: it may hold anything, marks too.
  std::string page = filled(kPageHtml, "@script@", kPageScript);
  page = filled(std::move(page), "@data@", for_script(report_json(report)));
  return filled(std::move(page), "@chart@", kPageChart);
}

Result<void> check_report_folder(const fs::path& folder) {
  std::error_code problem;
  fs::path there = fs::absolute(folder, problem);
  while (there.has_relative_path() && !fs::exists(there, problem)) there = there.parent_path();
  int why = 0;
  if (folder.empty() || !fs::is_directory(there, problem))
    why = ENOTDIR;
  else if (access(there.c_str(), W_OK | X_OK) != 0)
    why = errno;
  if (why == 0) return {};
  return Error{ErrorKind::io, fmt::format("cannot make the folder: {}", std::strerror(why)), folder.string()};
}

Result<void> write_report(const Report& report, const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem)
    return Error{ErrorKind::io, fmt::format("cannot make the folder: {}", problem.message()), folder.string()};
  AFTERGLOW_CHECK(write_file_atomically(folder / "bench.json", report_json(report)));
  AFTERGLOW_CHECK(write_file_atomically(folder / "bench.csv", report_csv(report)));
  AFTERGLOW_CHECK(write_file_atomically(folder / "bench.html", report_html(report)));
  if (!report.temporal.empty() || !report.resolutions.empty()) {
    AFTERGLOW_CHECK(write_file_atomically(folder / "stability.csv", stability_csv(report)));
    AFTERGLOW_CHECK(write_file_atomically(folder / "temporal.svg", temporal_svg(report)));
  }
  const auto largest = std::ranges::max_element(report.cells, {}, [](const Cell& cell) {
    return std::ranges::count_if(cell.points, [](const Point& p) { return p.quality.has_value(); });
  });
  if (largest == report.cells.end()) return {};
  return write_file_atomically(folder / "front.svg", front_svg(report, *largest));
}

}  // namespace afterglow::bench
