// SPDX-License-Identifier: MIT
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

/// A program with the build's and the source's folders hidden, where the system lets us.
class InstalledHosts : public Installed {
 protected:
  Outcome run_host(const std::string& program, const std::vector<std::string>& arguments,
                   RunOptions options = {}) const {
    options.environment["AFTERGLOW_HOME"] = "";  // not the one of whoever runs the tests
    static const bool can_hide = run({"--mount", "mount", "-t", "tmpfs", "none", "/mnt"}, unshare()).exit_code == 0;
    if (!can_hide) {
      options.program = program;
      return run(arguments, options);
    }
    options.program = unshare().program;
    std::string hide = "set -e\n";
    for (const char* folder : {AFTERGLOW_BUILD_FOLDER, AFTERGLOW_PROJECT_FOLDER})
      hide += std::string("if [ -d '") + folder + "' ]; then mount -t tmpfs none '" + folder + "'; fi\n";
    write("hidden.sh", hide + "exec \"$@\"\n");
    std::vector<std::string> all{"--mount", "sh", text("hidden.sh"), program};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all, options);
  }
  static RunOptions unshare() {
    RunOptions options;
    options.program = "/usr/bin/unshare";
    return options;
  }
  /// Runs a tool that must succeed.
  void must(const std::string& program, const std::vector<std::string>& arguments, RunOptions options = {}) const {
    options.program = program;
    const Outcome outcome = run(arguments, options);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  }
};

TEST_F(InstalledHosts, FindThePackage) {
  fs::copy(AFTERGLOW_PROJECT_FOLDER "/examples", path("examples"));
  RunOptions options;
  options.limit = std::chrono::seconds(300);
  must(AFTERGLOW_CMAKE,
       {"-S", "examples", "-B", "built", "-G", "Ninja", "-DCMAKE_PREFIX_PATH=" + text("moved"),
        "-DCMAKE_C_FLAGS=" AFTERGLOW_CXX_FLAGS, "-DCMAKE_CXX_FLAGS=" AFTERGLOW_CXX_FLAGS},
       options);
  must(AFTERGLOW_CMAKE, {"--build", "built"}, options);
  Outcome outcome = run_host(text("built/example_memory"), {"neon_night", text("graded.ppm")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(path("graded.ppm")));
  outcome = run_host(text("built/example_memory_cpp"), {text("moved/share/afterglow/presets/neon_night.lua")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  RunOptions own_device;
  own_device.environment["ASAN_OPTIONS"] = "detect_leaks=0";  // it unloads the driver, whose memory has no names then
  outcome = run_host(text("built/example_vulkan"), {"neon_night"}, own_device);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  // Look-up tables that are no .cube come from a module, which lies beside the library.
  EXPECT_TRUE(fs::exists(path("moved/" AFTERGLOW_MODULE_FOLDER "/afterglow_ocio.so")));
}

TEST_F(InstalledHosts, FindTheLibraryByPkgConfig) {
  RunOptions options;
  options.environment["PKG_CONFIG_PATH"] = text("moved/" AFTERGLOW_LIBRARY_FOLDER "/pkgconfig");
  write("build.sh", "set -e\ncc -std=c11 " AFTERGLOW_CXX_FLAGS " '" AFTERGLOW_PROJECT_FOLDER
                    "/examples/memory.c' -o host $(pkg-config --cflags --libs afterglow)\n");
  must("/bin/sh", {"build.sh"}, options);
  RunOptions at_run_time;
  at_run_time.environment["LD_LIBRARY_PATH"] = text("moved/" AFTERGLOW_LIBRARY_FOLDER);
  const Outcome outcome = run_host(text("host"), {"neon_night", text("graded.ppm")}, at_run_time);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(InstalledHosts, NeedNoHeaderOfTheEngine) {
  std::vector<std::string> headers;
  for (const auto& entry : fs::recursive_directory_iterator(path("moved/include")))
    if (entry.is_regular_file()) headers.push_back(entry.path().filename());
  EXPECT_THAT(headers, testing::UnorderedElementsAre("afterglow.h", "afterglow.hpp"));
  for (const auto& entry : fs::recursive_directory_iterator(path("moved")))
    EXPECT_NE(entry.path().extension(), ".a") << entry.path();
}

#ifdef AFTERGLOW_PYTHON_PROGRAM
TEST_F(InstalledHosts, ImportThePythonModule) {
  RunOptions options;
  options.environment["PYTHONPATH"] = text("moved/" AFTERGLOW_PYTHON_FOLDER);
  write("host.py",
        "import numpy, afterglow\n"
        "result = afterglow.Stack('neon_night').run(numpy.full((8, 8, 3), 4, numpy.float32))\n"
        "print(afterglow.__file__, result.shape)\n");
  const Outcome outcome = run_host(AFTERGLOW_PYTHON_PROGRAM, {text("host.py")}, options);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(text("moved") + "/"));
  EXPECT_THAT(outcome.out, HasSubstr("(8, 8, 3)"));
}
#endif

}  // namespace
}  // namespace afterglow::test
