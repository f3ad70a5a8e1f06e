// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "core/patient_reader.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class PatientReads : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "afterglow-patience-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// Opened for both, so that it has a writer for as long as it is open.
  std::shared_ptr<FileDescriptor> pipe() const {
    return std::make_shared<FileDescriptor>(open((folder_ / "pipe").c_str(), O_RDWR | O_CLOEXEC));
  }
  fs::path folder_;
};

TEST_F(PatientReads, APipeGivesWhatIsThereAndIsGivenUpWhenNothingComes) {
  const auto both = pipe();
  ASSERT_EQ(write(both->get(), "abc", 3), 3);
  PatientReader reader(both, {milliseconds(1), nullptr});
  char bytes[8] = {};
  const auto first = reader.read(bytes, sizeof bytes);
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_EQ(std::string(bytes, *first), "abc");
  const auto none = reader.read(bytes, sizeof bytes);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::io);
  EXPECT_EQ(none.error().message,
            "has given no bytes for 0.001 s (AFTERGLOW_INPUT_TIMEOUT says how long to wait, 0: for ever)");
  ASSERT_EQ(write(both->get(), "d", 1), 1);
  EXPECT_FALSE(reader.read(bytes, sizeof bytes)) << "what was given up stays so";
}

TEST_F(PatientReads, ThePipesEndIsNoError) {
  auto both = pipe();
  const auto from = std::make_shared<FileDescriptor>(open((folder_ / "pipe").c_str(), O_RDONLY | O_CLOEXEC));
  ASSERT_EQ(write(both->get(), "ab", 2), 2);
  PatientReader reader(from, {milliseconds(0), nullptr});
  both.reset();
  char bytes[8];
  EXPECT_EQ(reader.read(bytes, 1).value(), 1u);
  EXPECT_EQ(reader.read(bytes, 8).value(), 1u);
  EXPECT_EQ(reader.read(bytes, 8).value(), 0u);
}

TEST_F(PatientReads, WhoGivesUpWaitsNoLonger) {
  std::atomic<bool> flag{true};
  char byte = 0;
  PatientReader reader(pipe(), {milliseconds(0), &flag});
  const auto given_up = reader.read(&byte, 1);
  ASSERT_FALSE(given_up);
  EXPECT_EQ(given_up.error().kind, ErrorKind::interrupted);
  PatientReader other(pipe(), {milliseconds(0), nullptr}, &flag);
  EXPECT_EQ(other.read(&byte, 1).error().kind, ErrorKind::interrupted);
}

TEST_F(PatientReads, AFileIsReadFromWhereItStands) {
  std::string content(1'000'000, '\0');
  std::iota(content.begin(), content.end(), '\1');
  std::ofstream(folder_ / "file", std::ios::binary) << content;
  const auto from = std::make_shared<FileDescriptor>(open((folder_ / "file").c_str(), O_RDONLY | O_CLOEXEC));
  PatientReader reader(from, {});
  std::string got;
  std::vector<char> buffer(300'001);
  for (std::size_t count = 1; count > 0;) {
    count = reader.read(buffer.data(), buffer.size()).value();
    got.append(buffer.data(), count);
  }
  EXPECT_TRUE(got == content);
  ASSERT_EQ(lseek(reader.descriptor(), 999'998, SEEK_SET), 999'998);
  EXPECT_EQ(reader.read(buffer.data(), buffer.size()).value(), 2u);
  EXPECT_EQ(std::string(buffer.data(), 2), content.substr(999'998));
}

TEST_F(PatientReads, AFolderCannotBeRead) {
  const auto from = std::make_shared<FileDescriptor>(open(folder_.c_str(), O_RDONLY | O_CLOEXEC));
  char byte = 0;
  const auto read = PatientReader(from, {}).read(&byte, 1);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "cannot be read: Is a directory");
}

TEST(Patience, IsGivenInSeconds) {
  EXPECT_EQ(parse_patience("").value().most, std::nullopt);
  EXPECT_EQ(parse_patience("0").value().most, milliseconds(0));
  EXPECT_EQ(parse_patience("1.5").value().most, milliseconds(1500));
  EXPECT_EQ(parse_patience("0.00001").value().most, milliseconds(1)) << "a limit all the same";
  for (const char* wrong : {"-1", "nan", "inf", "2s", "1e9", " 1"}) {
    const auto parsed = parse_patience(wrong);
    ASSERT_FALSE(parsed) << wrong;
    EXPECT_EQ(parsed.error().kind, ErrorKind::usage);
    EXPECT_NE(parsed.error().text().find("AFTERGLOW_INPUT_TIMEOUT: error: '" + std::string(wrong) +
                                         "' is no number of seconds"),
              std::string::npos)
        << parsed.error().text();
  }
}

}  // namespace
}  // namespace afterglow
