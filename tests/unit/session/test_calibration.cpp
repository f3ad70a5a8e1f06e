// SPDX-License-Identifier: MIT
// Which choice is taken from a calibration, and what a bad one says.
#include <gmock/gmock.h>

#include "core/file.h"
#include "exec/calibration.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

constexpr const char* kTable = R"({ "devices": [
  { "device": "Card 1", "driver": "blob 7*", "choices": [ { "max_error": 0.005, "choice": "fused fp16 hardware-filter" },
                                                          { "max_error": 0.001, "choice": "fused fp16" } ] },
  { "device": "Card*", "choices": [ { "max_error": 0, "choice": "fused-filters fp32" } ] },
  { "kind": "gpu", "choices": [ { "max_error": 0, "choice": "fused fp32 rows2" } ] }
] })";

DeviceInfo device(const char* name, const char* driver, const char* type = "discrete") {
  DeviceInfo info;
  info.name = name;
  info.driver = driver;
  info.type = type;
  return info;
}

std::string choice_for(const DeviceInfo& info, double max_error) {
  const auto table = Calibration::parse(kTable, "table.json");
  EXPECT_TRUE(table) << table.error().text();
  return execution_name(table->find(info, max_error).choice);
}

TEST(Calibration, TakesTheLargestErrorThatIsAllowed) {
  const auto card = device("Card 1", "blob 7.1");
  EXPECT_EQ(choice_for(card, 0.005), "fused fp16 hardware-filter");
  EXPECT_EQ(choice_for(card, 0.0049), "fused fp16");
  EXPECT_EQ(choice_for(card, 0.001), "fused fp16");
}

TEST(Calibration, GoesOnToTheNextEntryThatFits) {
  EXPECT_EQ(choice_for(device("Card 1", "blob 7.1"), 1e-5), "fused-filters fp32");  // the first has nothing so exact
  EXPECT_EQ(choice_for(device("Card 1", "blob 8"), 1), "fused-filters fp32");       // another driver
  EXPECT_EQ(choice_for(device("Other", "blob 7"), 1), "fused fp32 rows2");
}

TEST(Calibration, DevicesItDoesNotKnowAreExact) {
  const auto table = Calibration::parse(kTable, "table.json");
  const auto found = table->find(device("Other", "x", "cpu"), 1);
  EXPECT_EQ(found.choice, ExecutionConfig{});
  EXPECT_THAT(found.from, HasSubstr("built in"));
}

TEST(Calibration, SaysWhereAChoiceCameFrom) {
  const auto table = Calibration::parse(kTable, "table.json");
  EXPECT_EQ(table->find(device("Card 2", "x"), 1).from, "table.json, Card*");
  EXPECT_EQ(table->find(device("Other", "x"), 1).from, "table.json, any gpu");
  EXPECT_EQ(table->find(device("Card 1", "blob 7"), 1).from, "table.json, Card 1 with blob 7*");
}

TEST(Calibration, BrokenTablesSayWhatIsWrong) {
  const struct {
    const char *json, *says;
  } kCases[] = {
      {"{", "not JSON"},
      {"[]", "no list of 'devices'"},
      {R"({"devices": 3})", "no list of 'devices'"},
      {R"({"devices": [7]})", "entry 1"},
      {R"({"devices": [{"kind": "cpu", "choices": [{"max_error": 0, "choice": "fused"}]}, {"device": 1}]})", "entry 2"},
      {R"({"devices": [{"kind": "fpga"}]})", "'kind'"},
      {R"({"devices": [{}]})", "'choices'"},
      {R"({"devices": [{"choices": []}]})", "'choices'"},
      {R"({"devices": [{"choices": [1]}]})", "no object"},
      {R"({"devices": [{"choices": [{"choice": "fused"}]}]})", "'max_error'"},
      {R"({"devices": [{"choices": [{"max_error": -1, "choice": "fused"}]}]})", "negative"},
      {R"({"devices": [{"choices": [{"max_error": 0}]}]})", "'choice'"},
      {R"({"devices": [{"choices": [{"max_error": 0, "choice": "quick"}]}]})", "'quick'"},
  };
  for (const auto& c : kCases) {
    const auto table = Calibration::parse(c.json, "bad.json");
    ASSERT_FALSE(table) << c.json;
    EXPECT_EQ(table.error().kind, ErrorKind::io) << c.json;
    EXPECT_EQ(table.error().file, "bad.json");
    EXPECT_THAT(table.error().text(), HasSubstr(c.says));
  }
}

TEST(Calibration, TheShippedTableIsSoundAndKnowsEveryKind) {
  setenv("AFTERGLOW_HOME", AFTERGLOW_PROJECT_FOLDER, 1);
  const auto table = Calibration::shipped();
  ASSERT_TRUE(table) << table.error().text();
  for (const char* type : {"cpu", "discrete", "integrated", "virtual"})
    for (const double max_error : {0.0, 1e-5, 2e-3, 1.0})
      EXPECT_THAT(table->find(device("unheard of", "x", type), max_error).from, HasSubstr("calibration/devices.json"));
  // What is exact must not store halves or let a sampler interpolate.
  for (const auto& entry : table->entries)
    for (const auto& [max_error, choice] : entry.choices)
      if (max_error < 1e-3) {
        EXPECT_EQ(choice.storage, Storage::fp32) << entry.name();
        EXPECT_FALSE(choice.hardware_filter) << entry.name();
      }
}

}  // namespace
}  // namespace afterglow
