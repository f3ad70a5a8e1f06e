// SPDX-License-Identifier: MIT
// The program's own allocations fail, one at a time.
#include <algorithm>

#include "fault_test.h"

namespace afterglow::test {
namespace {

class MemoryFault : public FaultTest {
 protected:
  /// `most` places over the whole run, and the `last` ones, when outputs have their names and records are written.
  void strike(const std::vector<std::string>& arguments, const std::vector<std::string>& outputs, long most,
              std::size_t last = 0) {
    const Fault fault = memory_fault();
    const std::vector<long> where = distinct_places(arguments, fault);
    take_reference(outputs);
    int failed = 0;
    std::vector<long> places = some(where, most);
    places.insert(places.end(), where.end() - static_cast<std::ptrdiff_t>(std::min(last, where.size())), where.end());
    for (const long place : places) {
      SCOPED_TRACE("allocation " + std::to_string(place) + " of " + std::to_string(where.back()));
      const Outcome outcome = run_with(arguments, fault, place);
      expect_clean_end(outcome);
      expect_whole_or_absent();
      expect_nothing_left_over();
      failed += outcome.exit_code != kDone ? 1 : 0;
      remove_outputs();
    }
    EXPECT_GT(failed, 0);
  }
};

TEST_F(MemoryFault, OnePicture) {
  make_exr("in.exr");
  strike({"run", neon_night(), "in.exr", "-o", "out.png"}, {"out.png"}, 40);
}

TEST_F(MemoryFault, ASequenceThatLooksBack) {
  write("look.lua", kLooksBack);
  make_exr("in.0001.exr");
  make_exr("in.0002.exr");
  strike({"run", "look.lua", "in.%04d.exr", "-o", "out.%04d.exr"}, {"out.0001.exr", "out.0002.exr"}, 30, 60);
}

TEST_F(MemoryFault, PlaybackWithoutAWindow) {
  make_exr("in.0001.exr");
  make_exr("in.0002.exr");
  strike({"play", neon_night(), "in.%04d.exr", "--headless", "--count", "4", "--screenshot", "shot.png"}, {"shot.png"},
         30);
}

}  // namespace
}  // namespace afterglow::test
