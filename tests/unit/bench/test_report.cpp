// SPDX-License-Identifier: MIT
// Reports as JSON, CSV, HTML and SVG, and comparing them.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/report.h"
#include "reports.h"

namespace afterglow::bench {
namespace {
using test::point;
using testing::HasSubstr;
using testing::Not;

const auto kPoints = [] { return std::vector<Point>{point("plain16f", 20, 1e-3), point("fused fp32", 10, 1e-6)}; };

TEST(Report, JsonHasEverythingByName) {
  Report report = test::report(kPoints());
  report.goals.push_back(
      {.name = "g", .size = "1×1", .ratio = 2.0, .goal = 3, .next = 4, .at_least = true, .unit = "", .note = ""});
  const auto json = nlohmann::json::parse(report_json(report));
  EXPECT_EQ(json.at("format"), "afterglow bench 1");
  EXPECT_EQ(json.at("device"), "Card \"1\"");
  EXPECT_EQ(json.at("repeat"), 3);
  const auto& cell = json.at("cells").at(0);
  EXPECT_EQ(cell.at("width"), 640);
  EXPECT_EQ(cell.at("truth"), "double precision");
  EXPECT_EQ(cell.at("copy").at("median"), 2);
  const auto& p = cell.at("points").at(1);
  EXPECT_EQ(p.at("choice"), "fused fp32");
  EXPECT_EQ(p.at("execute").at("samples").size(), 3u);
  EXPECT_EQ(p.at("error").at("p9999"), 1e-6);
  EXPECT_EQ(p.at("error").at("visible"), 0.25);
  EXPECT_EQ(p.at("front"), true);
  EXPECT_EQ(cell.at("points").at(0).at("front"), false);
  EXPECT_EQ(p.at("passes").at(0).at("milliseconds"), 1.5);
  EXPECT_EQ(json.at("goals").at(0).at("reached"), false);
}

TEST(Report, JsonStaysJsonWithoutQualityAndWithInfinity) {
  auto points = kPoints();
  points[0].quality.reset();
  points[1].quality->psnr = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(report_json(test::report(points)));
  EXPECT_TRUE(json.at("cells").at(0).at("points").at(0).at("error").is_null());
  EXPECT_TRUE(json.at("cells").at(0).at("points").at(1).at("error").at("psnr").is_null());
}

TEST(Report, CsvHasAsManyColumnsInEveryLine) {
  auto points = kPoints();
  points[0].quality.reset();
  const std::string csv = report_csv(test::report(points));
  std::vector<long> commas;
  std::size_t begin = 0;
  for (std::size_t end; (end = csv.find('\n', begin)) != std::string::npos; begin = end + 1)
    commas.push_back(std::count(csv.begin() + static_cast<long>(begin), csv.begin() + static_cast<long>(end), ','));
  ASSERT_EQ(commas.size(), 3u);
  EXPECT_EQ(commas[1], commas[0]);
  EXPECT_EQ(commas[2], commas[0]);
  EXPECT_THAT(csv, HasSubstr("\"Card \"\"1\"\"\""));
}

TEST(Report, HtmlNeedsNothingElse) {
  const std::string html = report_html(test::report(kPoints()));
  for (const char* mark : {"@chart@", "@data@", "@script@"}) EXPECT_THAT(html, Not(HasSubstr(mark)));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
  EXPECT_THAT(html, HasSubstr("Chart.js v"));         // the licence notice of the library
  EXPECT_THAT(html, Not(HasSubstr("up+</script>")));  // a pass cannot end the script it stands in
  const auto data = html.find("id=\"data\"");
  const auto begin = html.find('>', data) + 1, end = html.find("</script>", begin);
  const auto json = nlohmann::json::parse(html.substr(begin, end - begin));
  EXPECT_EQ(json.at("cells").at(0).at("points").at(0).at("passes").at(0).at("name"), "glow.up+</script>");
}

TEST(Report, SvgNamesEveryPointAndDrawsTheFront) {
  auto points = kPoints();
  points.push_back(point("exact & \"fast\"", 15, 0));
  const Report report = test::report(points);
  const std::string svg = front_svg(report, report.cells[0]);
  for (const char* text :
       {"plain16f", "fused fp32", "exact &amp; ", "one copy pass", "look 640×360", "stroke=\"#c43\""})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Compare, RatiosOfWhatIsInBoth) {
  const std::string old = report_json(test::report(kPoints()));
  const Report now = test::report({point("plain16f", 30, 1e-3), point("new", 1, 1)});
  const auto found = compare_reports(old, "old.json", now);
  ASSERT_TRUE(found) << found.error().text();
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ(found->at(0).what, "look 640×360 plain16f");
  EXPECT_DOUBLE_EQ(found->at(0).before, 20);
  EXPECT_DOUBLE_EQ(found->at(0).ratio(), 1.5);
}

TEST(Compare, SettingsAndSizesTellPointsApart) {
  auto points = kPoints();
  points[0].settings = "glow.scatter=0.5";
  const std::string old = report_json(test::report(points));
  Report now = test::report(kPoints());
  EXPECT_EQ(compare_reports(old, "", now)->size(), 1u);
  now.cells[0].size = {641, 360};
  EXPECT_TRUE(compare_reports(old, "", now)->empty());
}

TEST(Compare, OtherFilesAreRefused) {
  for (const char* text :
       {"", "{", "[]", "{\"format\": \"x\"}", "{\"format\": 3}", "{\"format\": \"afterglow bench 1\"}",
        "{\"format\": \"afterglow bench 1\", \"cells\": [{\"points\": [{}]}]}"}) {
    const auto found = compare_reports(text, "old.json", test::report(kPoints()));
    ASSERT_FALSE(found) << text;
    EXPECT_EQ(found.error().kind, ErrorKind::io);
    EXPECT_EQ(found.error().file, "old.json");
  }
}

}  // namespace
}  // namespace afterglow::bench
