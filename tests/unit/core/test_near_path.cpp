// SPDX-License-Identifier: MIT
// What names of files may mean where there is no such file.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "../image/temporary_folder.h"
#include "core/near_path.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

class NearPaths : public testing::Test {
 protected:
  NearPaths() {
    for (const char* file : {"own/LUTs/Film.cube", "own/LUTs/Film.clf", "own/luts.txt", "base/luts/cold.cube"}) {
      fs::create_directories((folder_ / file).parent_path());
      std::ofstream(folder_ / file) << "x";
    }
  }
  std::string near(const std::string& name) const { return near_path({folder_ / "own", folder_ / "base"}, name); }
  TemporaryFolder folder_;
};

TEST_F(NearPaths, CaseAndSlipsDoNotCountInAnyPart) {
  EXPECT_EQ(near("LUTs/film.cube"), "LUTs/Film.cube");
  EXPECT_EQ(near("LUTs/Film.CUBE"), "LUTs/Film.cube");
  EXPECT_EQ(near("luts/film.cube"), "LUTs/Film.cube") << "luts is there too, without such a file";
  EXPECT_EQ(near("LUT/film.cube"), "LUTs/Film.cube");
  EXPECT_EQ(near("LUTS/COLD.cube"), "luts/cold.cube") << "LUTs is as near, without such a file";
}

TEST_F(NearPaths, WhatIsOfAnotherKindOrFarIsNotMeant) {
  EXPECT_EQ(near("LUTs/film.spi3d"), "");
  EXPECT_EQ(near("LUTs/noise.cube"), "");
  EXPECT_EQ(near("pictures/film.cube"), "");
  EXPECT_EQ(near(""), "");
  EXPECT_EQ(near("a/b/c/d/e/f/g/h/i/j/k.cube"), "");
}

TEST_F(NearPaths, OfVeryManyFoldersThatAreSpelledAlikeSomeAreLookedInto) {
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j)
      fs::create_directories(folder_ / "own" / ("folder" + std::to_string(i)) / ("folder" + std::to_string(j)));
  std::ofstream(folder_ / "own/folder39/folder39/film.cube") << "x";
  EXPECT_EQ(near("folderx/folderx/film.cube"), "");
  EXPECT_EQ(near("folder39/folderx/film.cube"), "folder39/folder39/film.cube");
}

TEST_F(NearPaths, NamesAreWrittenWithOneSlashBetweenFolders) {
  EXPECT_EQ(tidy_path("LUTs\\Film.cube"), "LUTs/Film.cube");
  EXPECT_EQ(tidy_path("./LUTs//Film.cube"), "LUTs/Film.cube");
  EXPECT_EQ(tidy_path(" LUTs/Film.cube "), "LUTs/Film.cube");
  for (const char* other : {"../Film.cube", "/LUTs/Film.cube", "\\\\host\\Film.cube", "C:\\Film.cube", "", " ", "./"})
    EXPECT_EQ(tidy_path(other), "") << other;
}

TEST_F(NearPaths, AFileIsFoundInEitherFormOfUnicode) {
  const std::string together = "Bl\u00fcte.cube", apart = "Blu\u0308te.cube";
  EXPECT_EQ(file_in(folder_.path(), together, nullptr), "");
  std::ofstream(folder_ / apart) << "x";
  EXPECT_EQ(file_in(folder_.path(), together, nullptr), folder_ / apart);
  std::ofstream(folder_ / together) << "x";
  EXPECT_EQ(file_in(folder_.path(), together, nullptr), folder_ / together) << "the one that is named first of all";
  EXPECT_EQ(file_in(folder_.path(), apart, nullptr), folder_ / apart);
}

}  // namespace
}  // namespace afterglow
