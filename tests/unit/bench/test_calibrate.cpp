// SPDX-License-Identifier: MIT
// What calibration chooses from measured times and errors.
#include <gtest/gtest.h>

#include <set>

#include "bench/calibrate.h"
#include "reports.h"

namespace afterglow::bench {
namespace {
using test::point;

std::string chosen(const std::vector<Point>& points) {
  std::string out;
  for (const auto& [max_error, choice] : fastest_within_errors(points))
    out += (out.empty() ? "" : "; ") + std::to_string(max_error).substr(0, 6) + " " + execution_name(choice);
  return out;
}

TEST(Calibrate, TheFastestThatIsExactIsForEveryError) {
  EXPECT_EQ(chosen({point("fused fp32", 10, 1e-6), point("fused fp32 storage-reads", 5, 2e-6)}),
            "0.0000 fused fp32 storage-reads");
}

/// A look that hardly filters and has no bright light shows nothing of it.
TEST(Calibrate, TheFirstChoiceIsExactWhateverTheLookShows) {
  EXPECT_EQ(chosen({point("fused fp32", 10, 2e-6), point("fused fp32 hardware-filter", 5, 1e-6)}),
            "0.0000 fused fp32; 0.0005 fused fp32 hardware-filter");
  EXPECT_EQ(chosen({point("fused fp32", 10, 1e-4), point("fused fp32 hardware-filter", 5, 1e-6)}), "");
}

TEST(Calibrate, LessExactChoicesMustBeAllowedAndWorthIt) {
  EXPECT_EQ(chosen({point("fused fp32", 10, 1e-6), point("fused fp16", 5, 1e-3),
                    point("fused fp16 hardware-filter", 4, 4e-3), point("fused-filters fp16", 1, 1)}),
            "0.0000 fused fp32; 0.0020 fused fp16; 0.0050 fused fp16 hardware-filter");
  EXPECT_EQ(chosen({point("fused fp32", 10, 1e-6), point("fused fp16", 9.9, 1e-3)}), "0.0000 fused fp32");
}

TEST(Calibrate, NothingToGoByIsNothingChosen) {
  Point unknown = point("fused fp32", 1, 0);
  unknown.quality.reset();
  EXPECT_TRUE(fastest_within_errors({unknown}).empty());
  EXPECT_TRUE(fastest_within_errors({point("fused fp16", 1, 1)}).empty());
}

TEST(Calibrate, ComputeShadersMustBeWorthIt) {
  EXPECT_TRUE(compute_pays({point("fused fp32", 10, 0), point("fused fp32 compute", 9, 0)}));
  EXPECT_FALSE(compute_pays({point("fused fp32", 10, 0), point("fused fp32 compute", 9.8, 0)}));
  EXPECT_FALSE(compute_pays({}));
}

TEST(Calibrate, CandidatesAreAllDifferent) {
  std::set<std::string> names;
  for (const auto& choice : candidates()) names.insert(execution_name(choice));
  EXPECT_EQ(names.size(), candidates().size());
  EXPECT_TRUE(names.contains("fused fp32"));
}

TEST(Calibrate, ItsFileIsATableThatFitsTheDevice) {
  CalibrationResult result;
  result.device.name = "Card (rev. 2)";
  result.device.driver = "blob 7";
  result.cell = test::report({point("fused fp32", 10, 1e-6)}).cells[0];
  result.operations = {{"copy RGBA32F", 5.25}};
  result.choices = {{0, *parse_execution("fused fp32")}, {2e-3, *parse_execution("fused fp16")}};
  const auto table = Calibration::parse(calibration_json(result), "made.json");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(execution_name(table->find(result.device, 2e-3).choice), "fused fp16");
  EXPECT_EQ(execution_name(table->find(result.device, 1e-3).choice), "fused fp32");
  DeviceInfo other = result.device;
  other.driver = "blob 8";
  EXPECT_EQ(table->find(other, 2e-3).from, "built in: exact everywhere");
}

}  // namespace
}  // namespace afterglow::bench
