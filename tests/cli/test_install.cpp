// `cmake --install`: a tree that works from wherever it is put, and a package that other projects find.
#include "cli_test.h"

namespace afterglow::test {
namespace {

class Installed : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    RunOptions options;
    options.program = AFTERGLOW_CMAKE;
    const Outcome outcome = run({"--install", AFTERGLOW_BUILD_FOLDER, "--prefix", text("first")}, options);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    fs::rename(path("first"), path("moved"));
    make_exr("a.exr");
  }

  Outcome run_installed(const std::vector<std::string>& arguments, RunOptions options = {}) const {
    options.program = text("moved/bin/afterglow");
    return run(arguments, options);
  }
};

TEST_F(Installed, RunsFromAnotherFolderWithItsOwnScripts) {
  const Outcome outcome =
      run_installed({"run", "moved/share/afterglow/presets/neon_night.lua", "a.exr", "-o", "a.png"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  EXPECT_TRUE(fs::exists(path("a.png")));
  const Outcome effects = run_installed({"effects", "bloom"});
  EXPECT_THAT(effects.out, HasSubstr(text("moved/share/afterglow/scripts/effects/bloom.lua")));

  // AFTERGLOW_HOME names another installation.
  fs::copy(path("moved/share/afterglow"), path("home"), fs::copy_options::recursive);
  RunOptions options;
  options.environment["AFTERGLOW_HOME"] = text("home");
  EXPECT_THAT(run_installed({"effects", "bloom"}, options).out, HasSubstr(text("home/scripts/effects/bloom.lua")));
  options.environment["AFTERGLOW_HOME"] = text("nowhere");
  const Outcome broken = run_installed({"effects"}, options);
  EXPECT_NE(broken.exit_code, kDone) << "an installation that is not there holds no effects";
  EXPECT_TRUE(is_one_error_line(broken.err));
}

TEST_F(Installed, OtherProjectsFindThePackage) {
  write("project/CMakeLists.txt",
        "cmake_minimum_required(VERSION 3.25)\nproject(host CXX)\nset(CMAKE_CXX_STANDARD 20)\n"
        "find_package(afterglow REQUIRED)\n"
        "add_executable(host host.cpp)\ntarget_link_libraries(host PRIVATE afterglow::session)\n");
  write("project/host.cpp",
        "#include <cstdio>\n#include \"session/stack.h\"\n"
        "int main(int, char** argv) {\n"
        "  afterglow::Diagnostics none;\n"
        "  auto stack = afterglow::Stack::load(argv[1], {}, none);\n"
        "  if (!stack) return std::puts(stack.error().text().c_str()), 1;\n"
        "  return std::puts((*stack)->preset().name().c_str()), 0;\n}\n");
  RunOptions options;
  options.program = AFTERGLOW_CMAKE;
  Outcome outcome = run({"-S", "project", "-B", "project/build", "-G", "Ninja", "-DCMAKE_PREFIX_PATH=" + text("moved"),
                         "-DCMAKE_CXX_FLAGS=" AFTERGLOW_CXX_FLAGS},
                        options);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  outcome = run({"--build", "project/build"}, options);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out;
  options.program = text("project/build/host");
  options.environment["AFTERGLOW_HOME"] = text("moved/share/afterglow");
  outcome = run({"moved/share/afterglow/presets/neon_night.lua"}, options);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_EQ(outcome.out, "Neon night\n");
}

}  // namespace
}  // namespace afterglow::test
