// SPDX-License-Identifier: MIT
#include "fault_test.h"

#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <numeric>
#include <sstream>

namespace afterglow::test {
namespace {

/// The runtime of the sanitizer that tests and program are built with, if any: it must be the first to be loaded.
std::string sanitizer_runtime() {
  std::string found;
  const auto look = [](dl_phdr_info* info, std::size_t, void* into) {
    for (const char* name : {"libasan.so", "libtsan.so"})
      if (std::strstr(info->dlpi_name, name)) *static_cast<std::string*>(into) = info->dlpi_name;
    return 0;
  };
  dl_iterate_phdr(look, &found);
  return found;
}

std::string preload(const std::string& library) {
  const std::string first = sanitizer_runtime();
  return first.empty() ? library : first + ":" + library;
}

}  // namespace

Fault vulkan_fault(const std::string& code) {
  return {"vulkan " + code,
          {{"VK_ADD_LAYER_PATH", AFTERGLOW_FAULT_LAYER_FOLDER},
           {"VK_INSTANCE_LAYERS", "VK_LAYER_AFTERGLOW_fault"},
           {"AFTERGLOW_FAULT_CODE", code}}};
}

Fault memory_fault() { return {"memory", {{"LD_PRELOAD", preload(AFTERGLOW_MEMORY_PRELOAD)}}}; }

Fault file_fault(const std::string& kind, const fs::path& root) {
  return {"file " + kind,
          {{"LD_PRELOAD", preload(AFTERGLOW_FILE_PRELOAD)},
           {"AFTERGLOW_FAULT_KIND", kind},
           {"AFTERGLOW_FAULT_ROOT", root.string()}}};
}

Fault thread_fault() { return {"threads", {{"LD_PRELOAD", preload(AFTERGLOW_THREAD_PRELOAD)}}}; }

RunOptions FaultTest::options_at(const Fault& fault, long place) const {
  RunOptions options;
  options.program = program_;
  options.environment = environment_;
  options.environment.insert(fault.environment.begin(), fault.environment.end());
  options.environment["AFTERGLOW_FAULT_CALL"] = std::to_string(place);
  return options;
}

Outcome FaultTest::run_with(const std::vector<std::string>& arguments, const Fault& fault, long place) const {
  return run(arguments, options_at(fault, place));
}

void FaultTest::fill_caches(const std::vector<std::string>& arguments) const {
  const std::vector<std::string> before = files();
  RunOptions options;
  options.program = program_;
  options.environment = environment_;
  EXPECT_EQ(run(arguments, options).exit_code, kDone);
  for (const auto& name : files())
    if (std::ranges::find(before, name) == before.end()) fs::remove_all(path(name));
}

std::vector<long> FaultTest::distinct_places(const std::vector<std::string>& arguments, const Fault& fault) const {
  if (!environment_.contains("AFTERGLOW_CACHE")) fill_caches(arguments);
  const fs::path log = path("places.log");
  fs::remove(log);
  RunOptions options = options_at(fault, 0);
  options.environment["AFTERGLOW_FAULT_LOG"] = log.string();
  const Outcome outcome = run(arguments, options);
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  std::istringstream lines(read("places.log"));
  fs::remove(log);
  std::vector<long> places;
  for (std::string line; std::getline(lines, line);) places.push_back(std::atol(line.c_str()));
  EXPECT_FALSE(places.empty()) << "the faults do not reach the program";
  return places.empty() ? std::vector<long>{0} : places;
}

long FaultTest::places(const std::vector<std::string>& arguments, const Fault& fault) const {
  return distinct_places(arguments, fault).back();
}

std::vector<long> FaultTest::some(const std::vector<long>& places, long most) {
  const auto count = static_cast<long>(places.size());
  const char* asked = std::getenv("AFTERGLOW_FAULTS");
  const std::string wanted = asked ? asked : "";
  if (const auto dash = wanted.find('-'); dash != std::string::npos) {
    const long from = std::clamp(std::atol(wanted.c_str()), 1L, count);
    const long to = std::clamp(std::atol(wanted.c_str() + dash + 1), from, count);
    std::cout << "places " << from << " to " << to << " of " << count << std::endl;
    return {places.begin() + (from - 1), places.begin() + to};
  }
  if (!wanted.empty()) most = wanted == "every" ? count : std::atol(wanted.c_str());
  std::set<long> chosen;
  for (long i = 0; i < most && most > 1; ++i) chosen.insert(places[(count - 1) * i / (most - 1)]);
  return {chosen.begin(), chosen.end()};
}

std::vector<long> FaultTest::some(long last, long most) {
  std::vector<long> places(last);
  std::iota(places.begin(), places.end(), 1);
  return some(places, most);
}

void FaultTest::take_reference(const std::vector<std::string>& outputs) {
  reference_.clear();
  for (const auto& name : outputs) {
    reference_[name] = read(name);
    EXPECT_FALSE(reference_[name].empty()) << name;
  }
  remove_outputs();
}

void FaultTest::remove_outputs() const {
  for (const auto& [name, bytes] : reference_) {
    fs::remove(path(name));
    fs::remove_all(path(name).parent_path() / ".afterglow");
  }
}

int FaultTest::expect_whole_or_absent() const {
  int there = 0;
  for (const auto& [name, bytes] : reference_) {
    if (!fs::exists(path(name))) continue;
    ++there;
    EXPECT_TRUE(read(name) == bytes) << name << " is neither whole nor absent";
  }
  return there;
}

void FaultTest::expect_nothing_left_over() const {
  for (const auto& name : files()) EXPECT_EQ(name.find(".tmp"), std::string::npos) << name << " was left";
}

void FaultTest::expect_clean_end(const Outcome& outcome) {
  EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kDone, kOther, kScript, kFiles, kDevice)) << outcome.err;
  if (outcome.exit_code != kDone) {
    EXPECT_THAT(outcome.err, HasSubstr("error: "));
  }
  EXPECT_THAT(outcome.err, Not(HasSubstr("internal error")));
  EXPECT_THAT(outcome.err, Not(HasSubstr("terminate called")));
  EXPECT_THAT(outcome.err, Not(HasSubstr("validation")));
}

}  // namespace afterglow::test
