// SPDX-License-Identifier: MIT
// .cube files that are wrong, by accident or on purpose: refused at the line, before anything large is allocated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "image/lut_file.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {
using testing::HasSubstr;

std::string fault_of(const std::string& text) {
  const auto checked = check_cube(text, "a.cube");
  return checked ? "" : checked.error().text();
}

std::string rows(int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += "0.1 0.2 0.3\n";
  return out;
}

TEST(Cube, WhatIsRightPasses) {
  EXPECT_EQ(fault_of("LUT_1D_SIZE 2\n0 0 0\n1 1 1\n"), "");
  EXPECT_EQ(
      fault_of("# by hand\nTITLE \"x\"\n\nLUT_3D_SIZE 2\r\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n# data\n" + rows(8)),
      "");
  EXPECT_EQ(fault_of("LUT_1D_SIZE 3\nLUT_1D_INPUT_RANGE 0 2\nLUT_3D_SIZE 2\n" + rows(11)), "");
  EXPECT_EQ(fault_of("LUT_1D_SIZE 2\n-1e-3 +0.5 .25\n1E2 1. 0\n"), "");
  EXPECT_EQ(fault_of("LUT_1D_SIZE 2\n0 0 0\n1 1 1"), "");  // no newline at the end
}

TEST(Cube, SizesThatNoFileHas) {
  for (const char* size : {"1000000", "130", "1", "0", "-2", "2.5", "nan", "1e9", "99999999999999999999", "x", ""})
    EXPECT_THAT(fault_of(std::string("LUT_3D_SIZE ") + size + "\n" + rows(8)),
                HasSubstr("a.cube:1: error: LUT_3D_SIZE"))
        << size;
  EXPECT_THAT(fault_of("LUT_1D_SIZE 65537\n"), HasSubstr("allowed: an integer, 2…65536"));
  EXPECT_THAT(fault_of("LUT_3D_SIZE 2\nLUT_3D_SIZE 2\n"), HasSubstr("a.cube:2: error: LUT_3D_SIZE is there twice"));
}

TEST(Cube, TooFewAndTooMany) {
  EXPECT_THAT(fault_of("LUT_3D_SIZE 2\n" + rows(7)), HasSubstr("ends after 7 of 8 colours"));
  EXPECT_THAT(fault_of("LUT_3D_SIZE 2\n" + rows(9)), HasSubstr("a.cube:10: error: more than the 8 colours"));
  EXPECT_THAT(fault_of(""), HasSubstr("holds no table"));
  EXPECT_THAT(fault_of("0 0 0\n"), HasSubstr("a.cube:1: error: colours before the size"));
}

TEST(Cube, Values) {
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\n0 0 nan\n0 0 0\n"), HasSubstr("a.cube:2: error: 'nan' is not finite"));
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\n0 0 1e39\n0 0 0\n"), HasSubstr("a.cube:2: error: '1e39' is not finite"));
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\n0 0\n0 0 0\n"), HasSubstr("a.cube:2: error: a colour has 3 numbers, not 2"));
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\n0 0 zero\n"), HasSubstr("a.cube:2: error: 'zero' is not a number"));
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\nDOMAIN_MIN 0 0 1\n" + rows(2)),
              HasSubstr("a.cube:2: error: DOMAIN_MIN is not below"));
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\nDOMAIN_MAX 1 inf 1\n"), HasSubstr("a.cube:2: error: DOMAIN_MAX"));
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\nLUT_1D_INPUT_RANGE 1 0\n"),
              HasSubstr("a.cube:2: error: LUT_1D_INPUT_RANGE is no range"));
}

TEST(Cube, Words) {
  EXPECT_THAT(fault_of("LUT_3D_SIZ 2\n"), HasSubstr("a.cube:1: error: unknown word 'LUT_3D_SIZ'"));
  EXPECT_THAT(fault_of("LUT_3D_SIZ 2\n"), HasSubstr("did you mean 'LUT_3D_SIZE'?"));
  EXPECT_THAT(fault_of("LUT_1D_SIZE 2\n0 0 0\nDOMAIN_MIN 0 0 0\n"),
              HasSubstr("a.cube:3: error: 'DOMAIN_MIN' behind the first"));
  EXPECT_THAT(fault_of("\xEF\xBB\xBFLUT_1D_SIZE 2\n"), HasSubstr("byte order mark"));
}

TEST(Cube, InUtf16) {
  const std::string text = "LUT_3D_SIZE 2\n";
  std::string wide;
  for (const char c : text) wide += std::string({c, '\0'});
  for (const char* const mark : {"", "\xff\xfe"})
    EXPECT_EQ(check_table(mark + wide, "a.cube", TableUse::of_look).error().message, "is UTF-16; save it as UTF-8");
}

TEST(Cube, NothingCrashes) {
  std::mt19937 random(17);
  const std::string good = "TITLE \"t\"\nLUT_1D_SIZE 2\nLUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\n" + rows(10);
  for (int i = 0; i < 20000; ++i) {
    std::string text = good;
    for (unsigned k = random() % 6; k-- > 0;) text[random() % text.size()] = static_cast<char>(random() % 256);
    if (random() % 3 == 0) text.resize(random() % text.size());
    (void)check_cube(text, "a.cube");
  }
}

/// OpenColorIO reads a title in one kind of .cube alone, which has no such ranges.
TEST(Cube, DaVincisAreReadWithTheirTitle) {
  const TemporaryFolder folder;
  const std::string table =
      "LUT_3D_SIZE 2\nLUT_3D_INPUT_RANGE 0.25 0.75\n# data\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
      "0 0 1\n1 0 1\n0 1 1\n0.5 0.25 0.125\n";
  std::ofstream(folder / "plain.cube") << table;
  std::ofstream(folder / "titled.cube") << "TITLE \"a look\"\n" << table;
  const auto plain = read_lut(folder / "plain.cube"), titled = read_lut(folder / "titled.cube");
  ASSERT_TRUE(plain && titled) << (titled ? "" : titled.error().text());
  EXPECT_EQ(titled->table, plain->table);
  EXPECT_EQ(titled->steps.size(), plain->steps.size());
  std::ofstream(folder / "short.cube") << "TITLE \"a look\"\nLUT_3D_INPUT_RANGE 0 1\nLUT_3D_SIZE 2\n0 0 0\n";
  EXPECT_THAT(read_lut(folder / "short.cube").error().file, HasSubstr("short.cube"));
}

TEST(Cube, EveryFormatRefusesRubbish) {
  const TemporaryFolder folder;
  for (const char* name : {"a.3dl", "a.csp", "a.spi1d", "a.spi3d", "a.clf", "a.cub", "a.hdl", "a.itx", "a.m3d", "a.vf",
                           "a.cc", "a.ccc", "a.cdl"}) {
    for (const char* text : {"", "rubbish\n", "\x01\x02\x03", "LUT_3D_SIZE 1000000\n", "<ProcessList>"}) {
      std::ofstream(folder / name) << text;
      const auto read = read_lut(folder / name);
      ASSERT_FALSE(read) << name << ": " << text;
      EXPECT_EQ(read.error().kind, ErrorKind::script);
      EXPECT_THAT(read.error().file, HasSubstr(name));
    }
  }
  EXPECT_THAT(read_lut(folder / "a.png").error().text(), HasSubstr("no format of look-up tables"));
  EXPECT_THAT(read_lut(folder / "none.cube").error().text(), HasSubstr("none.cube: error: "));
}

TEST(Cube, OpenColorIosReasonIsWhole) {
  const TemporaryFolder folder;
  const auto deep = folder / (std::string(120, 'a') + "/" + std::string(120, 'b') + "/line 7");
  std::filesystem::create_directories(deep);
  const auto told = [&](const char* name, const char* text) {
    std::ofstream(deep / name) << text;
    const auto read = read_lut(deep / name);
    return read ? Error{ErrorKind::other, ""} : read.error();
  };
  const Error cdl = told("a.cc", "<ColorCorrection id=\"x\"><SOPNode><Slope>1 1</Slope></SOPNode></ColorCorrection>");
  EXPECT_THAT(cdl.message, HasSubstr("SOPNode: 3 values required"));
  EXPECT_EQ(cdl.line, 1);
  const Error list =
      told("a.clf",
           "<?xml version=\"1.0\"?>\n<ProcessList id=\"p\" compCLFversion=\"3\">\n<LUT1D inBitDepth=\"32f\" "
           "outBitDepth=\"32f\"><Array dim=\"5 3\">1 2 3</Array></LUT1D></ProcessList>");
  EXPECT_THAT(list.message, HasSubstr("Expected 5x3 Array values, found 3"));
  const Error shaper = told("a.csp", "rubbish");
  EXPECT_THAT(shaper.message, HasSubstr("First line: 'rubbish'"));
  for (const Error& error : {cdl, list, shaper}) {
    EXPECT_TRUE(error.message.starts_with("OpenColorIO cannot read it: ")) << error.message;
    EXPECT_THAT(error.message, testing::Not(HasSubstr("aaaa")));
    EXPECT_THAT(error.message, testing::Not(HasSubstr("\n")));
  }
}

Lut ending_with(LutKind kind, float value) {
  Lut lut{{{LutKind::range, 0, 0}, {kind, 1, 1}}, {1, 3}, std::vector<float>(12, 0.0f)};
  lut.table[2] = 7;  // the range's; the last step begins a row further
  lut.table[4] = value;
  return lut;
}

std::string utf16(const std::string& text) {
  std::string out = "\xFF\xFE";
  for (const char c : text) out += std::string{c, '\0'};
  return out;
}

/// OpenColorIO tries every format on every file: the name says nothing of what is in it.
TEST(Lut, WhatLeadsElsewhereIsRefusedInEveryFormat) {
  TemporaryFolder folder;
  const auto of_file = [&](const std::string& name, const std::string& text) {
    write_bytes(folder / name, text);
    const auto lut = read_lut(folder / name);
    return lut ? std::string() : lut.error().message;
  };
  write_bytes(folder / "secret.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
  const std::string secret = (folder / "secret.cube").string();
  const std::string head = "<?xml version=\"1.0\"?>\n", list = "<ProcessList id=\"a\" compCLFversion=\"3\">\n",
                    path = " path=\"" + secret + "\" inBitDepth=\"32f\" outBitDepth=\"32f\"/>\n",
                    end = "</ProcessList>\n";
  for (const char* name : {"a.clf", "a.cub", "a.3dl", "a.spi1d"}) {
    EXPECT_THAT(of_file(name, head + list + "<Reference" + path + end), HasSubstr("refers to another file")) << name;
    EXPECT_THAT(of_file(name, head + "<!DOCTYPE ProcessList [<!ENTITY x '<&#82;eference" + path + "'>]>\n" + list +
                                  "&x;" + end),
                HasSubstr("has a document type"))
        << name;
    EXPECT_THAT(of_file(name, utf16(head + list + "<Reference" + path + end)), HasSubstr("is UTF-16; save it as UTF-8")) << name;
    EXPECT_THAT(of_file(name, "title\nlut_3d_size \t 2204\n"), HasSubstr("LUT_3D_SIZE is 2204")) << name;
    EXPECT_THAT(of_file(name, "LUT_1D_SIZE 2\nLUT_1D_SIZE 00100000\n"), HasSubstr("LUT_1D_SIZE is 100000")) << name;
    EXPECT_THAT(of_file(name, "LUT_3D_SIZE 999999999999999999999999\n"), HasSubstr("LUT_3D_SIZE is 9999")) << name;
  }
  // A word is no reference.
  EXPECT_EQ(of_file("b.clf", head + list +
                                 "<Description>Reference white</Description>\n"
                                 "<Matrix inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"3 3\">\n"
                                 "1 0 0\n0 1 0\n0 0 0.5\n</Array></Matrix>\n" +
                                 end),
            "");
}

TEST(Lut, TablesOfUnitEntriesAtTheEndGiveNoMore) {
  for (const auto kind : {LutKind::table1d, LutKind::table3d, LutKind::table3d_linear, LutKind::table_half}) {
    EXPECT_TRUE(gives_unit(ending_with(kind, 0)));
    EXPECT_TRUE(gives_unit(ending_with(kind, 1)));
    EXPECT_FALSE(gives_unit(ending_with(kind, 1.001f)));
    EXPECT_FALSE(gives_unit(ending_with(kind, -0.001f)));
  }
  EXPECT_FALSE(gives_unit(ending_with(LutKind::matrix, 0.5f)));
  EXPECT_FALSE(gives_unit({}));
}

}  // namespace
}  // namespace afterglow
