// SPDX-License-Identifier: MIT
// KernelCompiler: reflection, errors, caches in memory and on disk, threads.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "core/file.h"
#include "shader/source_hash.h"
#include "shader_files.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kThreshold = R"(uniform float threshold;
uniform vec3 tint;
uniform bool fade;
uniform ivec2 corner;
layout(constant_id = 0) const int count = 2;
vec4 apply(vec4 color, vec4 high) {
  if (fade) color *= float(count);
  return vec4(max(color.rgb - threshold, 0.0) * tint, color.a) + high + float(corner.x);
}
)";

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(folder)) files.push_back(file.path());
  return files;
}

TEST(KernelCompiler, ReflectsOffsetsOfEveryParameter) {
  ShaderFiles files;
  KernelCompiler compiler{fs::path()};
  const auto kernel = compiler.compile(one(files.stage("t/a", kThreshold)));
  ASSERT_TRUE(kernel.ok()) << kernel.error().text();
  ASSERT_EQ(kernel->params.size(), 4u);
  const auto offset = [&](std::size_t i) { return kernel->params[i].offset; };
  EXPECT_EQ(kernel->params[0].name, "threshold");
  EXPECT_EQ(offset(0), 0u);
  EXPECT_EQ(kernel->params[1].name, "tint");
  EXPECT_EQ(kernel->params[1].type, ParamType::float3);
  EXPECT_EQ(offset(1), 16u);
  EXPECT_EQ(kernel->params[2].name, "fade");
  EXPECT_EQ(offset(2), 28u);
  EXPECT_EQ(kernel->params[3].name, "corner");
  EXPECT_EQ(offset(3), 32u);
  EXPECT_EQ(kernel->block_size, 48u);
  ASSERT_EQ(kernel->images.size(), 2u);
  EXPECT_EQ(kernel->images[0].stage, -1);
  EXPECT_EQ(kernel->images[0].name, "source");
  EXPECT_EQ(kernel->images[1].stage, 0);
  EXPECT_EQ(kernel->images[1].name, "high");
}

TEST(KernelCompiler, NoParametersMeanNoBlock) {
  KernelCompiler compiler{fs::path()};
  const auto kernel = compiler.compile({});
  ASSERT_TRUE(kernel.ok()) << kernel.error().text();
  EXPECT_EQ(kernel->block_size, 0u);
  EXPECT_TRUE(kernel->params.empty());
}

TEST(KernelCompiler, OneTextIsCompiledOnce) {
  ShaderFiles files;
  KernelCompiler compiler{fs::path()};
  const auto stage = files.stage("t/a", kThreshold);
  const auto first = compiler.compile(one(stage)), second = compiler.compile(one(stage));
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(first->spirv, second->spirv);
  EXPECT_EQ(compiler.counters().compiled, 1);
  EXPECT_EQ(compiler.counters().from_memory, 1);
  EXPECT_EQ(compiler.counters().from_disk, 0);
  auto other = stage;
  other.constants["count"] = 3;
  const auto third = compiler.compile(one(other));
  ASSERT_TRUE(third.ok());
  EXPECT_NE(third->hash, first->hash);
  EXPECT_EQ(compiler.counters().compiled, 2);
}

TEST(SameKernel, AllButLabelsCounts) {
  ShaderFiles files;
  KernelDesc kernel = one(files.stage("t/a", kThreshold));
  kernel.filter = Filter{};
  const auto changed = [&](const auto& change) {
    KernelDesc other = kernel;
    change(other);
    return other;
  };
  const KernelDesc labelled = changed([](KernelDesc& k) { k.stages[0].label = "another.level[3]"; });
  EXPECT_TRUE(same_kernel(kernel, kernel));
  EXPECT_TRUE(same_kernel(kernel, labelled));
  EXPECT_EQ(assemble(kernel)->hash, assemble(labelled)->hash);

  const KernelStage stage = files.stage("t/b", kThreshold);
  const KernelDesc others[] = {
      changed([](KernelDesc& k) { k.filter->x[0].weight = 0.5; }),
      changed([](KernelDesc& k) { k.filter.reset(); }),
      changed([](KernelDesc& k) { k.ratio_x = AxisRatio::half; }),
      changed([](KernelDesc& k) { k.ratio_y = AxisRatio::half; }),
      changed([](KernelDesc& k) { k.filter_channels = 1; }),
      changed([&](KernelDesc& k) { k.sample = stage; }),
      changed([&](KernelDesc& k) { k.stages.push_back(stage); }),
      changed([&](KernelDesc& k) { k.stages[0].shader = stage.shader; }),
      changed([](KernelDesc& k) { k.stages[0].constants["count"] = 3; }),
      changed([](KernelDesc& k) { k.stages[0].straight = true; }),
      changed([](KernelDesc& k) { k.stages[0].color = kOwnImage; }),
      changed([](KernelDesc& k) { k.stages[0].values["high"] = 0; }),
      changed([](KernelDesc& k) {
        k.stages[0].again["high"] = {0, "source"};
      }),
      changed([](KernelDesc& k) { k.stages[0].channels = 1; }),
      changed([](KernelDesc& k) { k.config.rows = 2; }),
      changed([](KernelDesc& k) { k.target = KernelTarget::float16; }),
      changed([](KernelDesc& k) { k.target_channels = 2; }),
      changed([](KernelDesc& k) { k.finite_check = FiniteCheck::flag; }),
      changed([](KernelDesc& k) { k.reads = {ImageRead::storage_rgba32f}; }),
  };
  for (std::size_t i = 0; i < std::size(others); ++i) EXPECT_FALSE(same_kernel(kernel, others[i])) << i;
}

class KernelCache : public testing::Test {
 protected:
  Result<CompiledKernel> compile(KernelCompiler::Counters& counters) {
    KernelCompiler compiler(folder_);
    auto kernel = compiler.compile(one(stage_));
    counters = compiler.counters();
    return kernel;
  }
  /// Compiles anew in a fresh compiler and says where the kernel came from.
  std::string origin() {
    KernelCompiler::Counters counters;
    const auto kernel = compile(counters);
    if (!kernel.ok()) return kernel.error().text();
    if (spirv_.empty()) spirv_ = kernel->spirv;
    if (kernel->spirv != spirv_ || kernel->params.size() != 4 || kernel->params[3].offset != 32 ||
        kernel->block_size != 48)
      return "wrong kernel";
    return counters.compiled ? "compiled" : counters.from_disk ? "disk" : "memory";
  }
  fs::path only_file() {
    const auto list = files_in(folder_);
    EXPECT_EQ(list.size(), 1u);
    return list.empty() ? fs::path() : list[0];
  }

  ShaderFiles files_;
  fs::path folder_ = files_.root() / "cache" / "kernels";
  KernelStage stage_ = files_.stage("t/a", kThreshold);
  std::vector<std::uint32_t> spirv_;
};

TEST_F(KernelCache, ComesBackFromDisk) {
  EXPECT_EQ(origin(), "compiled");
  EXPECT_EQ(only_file().extension(), ".kernel");
  EXPECT_EQ(origin(), "disk");
  EXPECT_EQ(files_in(folder_).size(), 1u) << "no temporary files stay behind";
}

/// A change of any source that has a hand in kernels makes all of them anew.
TEST_F(KernelCache, TheSourcesOfTheCompilerAreInItsKey) {
  const fs::path sources = files_.root() / "sources", made = files_.root() / "hash.cpp";
  const auto hash = [&] {
    const std::string command =
        fmt::format("'{}' -D root='{}' -D 'globs=*.cpp;*.h' -D template='{}/source_hash.cpp.in' -D output='{}' -P '{}'",
                    AFTERGLOW_CMAKE, sources.string(), sources.string(), made.string(),
                    AFTERGLOW_PROJECT_FOLDER "/cmake/source_hash.cmake");
    EXPECT_EQ(std::system(command.c_str()), 0);
    const std::string text = read_file(made).value();
    const std::size_t begin = text.find('"', text.find("kShaderSourceHash")) + 1;
    return text.substr(begin, text.find('"', begin) - begin);
  };
  fs::copy(AFTERGLOW_PROJECT_FOLDER "/engine/shader", sources, fs::copy_options::recursive);
  EXPECT_EQ(hash(), kShaderSourceHash);
  std::ofstream(sources / "cpu/interleave.cpp", std::ios::app) << "// another way\n";
  EXPECT_NE(hash(), kShaderSourceHash);
}

TEST_F(KernelCache, EveryTruncationIsRebuilt) {
  EXPECT_EQ(origin(), "compiled");
  const auto file = only_file();
  const auto whole = read_file(file).value();
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{3}, std::size_t{40}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, length);
    EXPECT_EQ(origin(), "compiled") << length;
    EXPECT_EQ(read_file(file).value(), whole) << "the file is mended";
  }
}

TEST_F(KernelCache, EveryFlippedBitIsSeen) {
  EXPECT_EQ(origin(), "compiled");
  const auto file = only_file();
  const auto whole = read_file(file).value();
  for (std::size_t at = 0; at < whole.size(); at += at < 100 ? 1 : 197) {
    auto broken = whole;
    broken[at] = static_cast<char>(broken[at] ^ 0x10);
    std::ofstream(file, std::ios::binary) << broken;
    EXPECT_EQ(origin(), "compiled") << at;
  }
  std::ofstream(file, std::ios::binary) << whole + "x";
  EXPECT_EQ(origin(), "compiled") << "longer than it should be";
  EXPECT_EQ(origin(), "disk");
}

TEST_F(KernelCache, AnotherKernelsFileIsNotTaken) {
  EXPECT_EQ(origin(), "compiled");
  const auto file = only_file();
  KernelCompiler compiler(folder_);
  auto sibling = stage_;  // as many parameters and bytes: only the text tells them apart
  sibling.constants["count"] = 9;
  ASSERT_TRUE(compiler.compile(one(sibling)).ok());
  for (const auto& other : files_in(folder_))
    if (other != file) fs::copy_file(other, file, fs::copy_options::overwrite_existing);
  EXPECT_EQ(origin(), "compiled");
}

TEST_F(KernelCache, AFolderThatCannotBeWrittenIsNoError) {
  std::ofstream(files_.root() / "file") << "not a folder";
  folder_ = files_.root() / "file" / "cache";
  EXPECT_EQ(origin(), "compiled");
  EXPECT_EQ(origin(), "compiled");
  if (geteuid() == 0) return;  // root writes everywhere
  folder_ = files_.root() / "locked";
  fs::create_directory(folder_);
  chmod(folder_.c_str(), 0500);
  EXPECT_EQ(origin(), "compiled");
  chmod(folder_.c_str(), 0700);
}

TEST_F(KernelCache, AFolderInPlaceOfTheFileIsNoError) {
  EXPECT_EQ(origin(), "compiled");
  const auto file = only_file();
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_EQ(origin(), "compiled");
}

TEST_F(KernelCache, FailuresAreNotCached) {
  stage_ = files_.stage("t/bad", "vec4 apply(vec4 c) { return d; }\n");
  KernelCompiler compiler(folder_);
  EXPECT_FALSE(compiler.compile(one(stage_)).ok());
  EXPECT_FALSE(compiler.compile(one(stage_)).ok());
  EXPECT_EQ(compiler.counters().compiled, 0);
  EXPECT_EQ(compiler.counters().from_memory, 0);
  EXPECT_FALSE(fs::exists(folder_));
}

TEST(KernelCompiler, RecursionIsToldWithItsPlace) {
  const ShaderFiles files;
  KernelCompiler compiler({});
  const auto told = [&](const std::string& shader) {
    KernelDesc desc;
    desc.stages = {files.stage("test/again", shader)};
    const auto kernel = compiler.compile(desc);
    EXPECT_FALSE(kernel) << shader;
    return kernel ? std::string() : kernel.error().text();
  };
  const std::string file = files.path("test/again.glsl").string();
  EXPECT_EQ(told("\nfloat f(float x) { return x > 1.0 ? f(x - 1.0) : x; }\nvec4 apply(vec4 color) { return color * "
                 "f(2.0); }\n"),
            file + ":2: error: 'f' calls itself: GLSL has no recursion");
  EXPECT_EQ(told("float g(float x);\nfloat f(float x) { return g(x); }\nfloat g(float x) { return f(x); }\n"
                 "vec4 apply(vec4 color) { return color * f(2.0); }\n"),
            file + ":2: error: 'f' calls itself by way of 'g': GLSL has no recursion");
}

TEST(KernelCompiler, EveryErrorOfAShaderIsToldOnce) {
  ShaderFiles files;
  const auto bad = files.stage("t/bad", "vec4 apply(vec4 c) {\n  c.r = d;\n  c.g = e;\n  c.b = f;\n  return c;\n}\n");
  const auto places = [](const Error& error) {
    std::vector<std::string> out{error.message};
    for (const std::string& line : error.trail) out.push_back(line.substr(line.rfind('/') + 1));
    return out;
  };
  const auto all = ElementsAre("'d': undeclared identifier", "bad.glsl:3: 'e': undeclared identifier",
                               "bad.glsl:4: 'f': undeclared identifier");
  KernelCompiler compiler{fs::path()};
  const auto alone = compiler.compile(one(bad));
  ASSERT_FALSE(alone.ok());
  EXPECT_THAT(places(alone.error()), all);
  KernelDesc twice = one(bad);
  twice.stages.push_back(bad);
  const auto fused = compiler.compile(twice);
  ASSERT_FALSE(fused.ok());
  EXPECT_THAT(places(fused.error()), all) << "the same stage behind itself";
}

TEST(KernelCompiler, WordsOfOtherLanguagesAreTranslated) {
  ShaderFiles files;
  KernelCompiler compiler{fs::path()};
  const auto message = [&](const std::string& body) {
    const auto made = compiler.compile(one(files.stage("t/foreign", "vec4 apply(vec4 color) { " + body + " }\n")));
    return made.ok() ? std::string() : made.error().message;
  };
  EXPECT_EQ(message("float3 c = color.rgb; return color;"), "'float3': undeclared identifier; write vec3");
  EXPECT_EQ(message("return saturate(color);"),
            "'saturate': no matching overloaded function found; write clamp(x, 0.0, 1.0)");
  EXPECT_EQ(message("half x = 0.5; return color * x;"), "'half': Reserved word; write float");
  EXPECT_EQ(message("float input = 0.5; return color * input;"), "'input' is a word of GLSL; choose another name");
  EXPECT_EQ(message("barrier(); return color;"), "'barrier' is for compute shaders (compute_at)");
  EXPECT_EQ(message("return color * float(gl_LocalInvocationID.x);"),
            "'gl_LocalInvocationID' is for compute shaders (compute_at)");
  EXPECT_EQ(message("return lost(color);"), "'lost': no matching overloaded function found");
  EXPECT_EQ(message("return vec4(image_size(color.rg), 0, 1);"),
            "'image_size': no matching overloaded function found; it is image_size(sampler2D image)");
}

TEST(KernelCompiler, EightThreadsShareOneCompiler) {
  ShaderFiles files;
  constexpr int kThreads = 8, kShaders = 6;
  std::vector<KernelStage> stages;
  for (int i = 0; i < kShaders; ++i)
    stages.push_back(files.stage(
        "t/s" + std::to_string(i),
        "uniform float a" + std::to_string(i) + ";\nvec4 apply(vec4 c) { return c * a" + std::to_string(i) + "; }\n"));
  const auto bad = files.stage("t/bad", "\nvec4 apply(vec4 c) { return d; }\n");
  KernelCompiler compiler(files.root() / "cache");
  std::vector<std::vector<std::uint32_t>> spirv(kThreads * kShaders);
  std::vector<std::string> errors(kThreads);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < kShaders; ++i) {
        const int shader = (i + t) % kShaders;
        const auto kernel = compiler.compile(one(stages[static_cast<std::size_t>(shader)]));
        if (kernel.ok()) spirv[static_cast<std::size_t>(t * kShaders + shader)] = kernel->spirv;
      }
      const auto failed = compiler.compile(one(bad));
      if (!failed.ok()) errors[static_cast<std::size_t>(t)] = failed.error().text();
    });
  for (auto& thread : threads) thread.join();
  for (std::size_t i = 0; i < spirv.size(); ++i) {
    EXPECT_FALSE(spirv[i].empty());
    EXPECT_EQ(spirv[i], spirv[i % kShaders]);
  }
  for (const auto& error : errors) EXPECT_THAT(error, HasSubstr("bad.glsl:2: error: 'd': undeclared identifier"));
  EXPECT_EQ(compiler.counters().compiled, kShaders);
  EXPECT_EQ(compiler.counters().from_memory, kThreads * kShaders - kShaders);
}

TEST(KernelCompiler, TwoCompilersShareOneFolder) {
  ShaderFiles files;
  const auto stage = files.stage("t/a", kThreshold);
  std::vector<std::thread> threads;
  std::vector<int> ok(8);
  for (std::size_t t = 0; t < ok.size(); ++t)
    threads.emplace_back([&, t] { ok[t] = KernelCompiler(files.root() / "cache").compile(one(stage)).ok(); });
  for (auto& thread : threads) thread.join();
  EXPECT_THAT(ok, testing::Each(1));
  EXPECT_EQ(files_in(files.root() / "cache").size(), 1u);
}

TEST(KernelCompiler, PixelAndSampleShadersAlone) {
  ShaderFiles files;
  KernelCompiler compiler{fs::path()};
  EXPECT_TRUE(compiler.compile(one(files.stage("a", kThreshold, {{"count", 4}}))).ok());
  EXPECT_TRUE(
      compiler.compile(one(files.stage("b", "uniform sampler2D d;\nvec4 sample_at(ivec2 p) { return fetch(d, p); }\n")))
          .ok());
  const auto bad = compiler.compile(one(files.stage("c", "vec4 sample_at(ivec2 p) {\n return p;\n}\n")));
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().kind, ErrorKind::script);
  EXPECT_EQ(bad.error().file, files.path("c.glsl").string());
  EXPECT_EQ(bad.error().line, 2);
}

TEST(KernelCompiler, EveryShaderOfTheProject) {
  SearchPath search;
  search.installation = AFTERGLOW_PROJECT_FOLDER;
  ShaderLibrary library(search);
  KernelCompiler compiler{fs::path()};
  const auto names = library.names();
  EXPECT_FALSE(names.empty());
  for (const auto& name : names) {
    const auto source = library.find(name);
    ASSERT_TRUE(source.ok()) << source.error().text();
    const auto result = compiler.compile(one({*source, {}, {}}));
    EXPECT_TRUE(result.ok()) << result.error().text();
    // Every specialised switch, on its own and all together.
    std::map<std::string, double> all;
    for (const auto& param : (*source)->interface.params) {
      if (!param.specialised || param.type != ParamType::bool1) continue;
      all[param.name] = 1;
      EXPECT_TRUE(compiler.compile(one({*source, {{param.name, 1}}, {}})).ok()) << name << " " << param.name;
    }
    EXPECT_TRUE(compiler.compile(one({*source, all, {}})).ok()) << name;
  }
}

}  // namespace
}  // namespace afterglow
