// SPDX-License-Identifier: MIT
#include "farm_test.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <thread>

namespace afterglow::test {

bool wait_until(const std::function<bool()>& holds) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < limit) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return holds();
}

void FarmTest::SetUp() { CliTest::SetUp(); }

void FarmTest::TearDown() {
  if (HasFailure() && cluster_) std::fputs(cluster_->logs().c_str(), stderr);
  cluster_.reset();
  CliTest::TearDown();
}

void FarmTest::start_cluster() { cluster_ = std::make_unique<Cluster>(path("cluster")); }

Outcome FarmTest::farm(const std::vector<std::string>& words, RunOptions options) const {
  std::vector<std::string> all{"farm"};
  all.insert(all.end(), words.begin(), words.end());
  if (cluster_) options.environment["SLURM_CONF"] = cluster_->config();
  return run(all, options);
}

Outcome FarmTest::slurm(const std::string& program, const std::vector<std::string>& words) const {
  RunOptions options;
  options.program = program;
  options.environment["SLURM_CONF"] = cluster_->config();
  return run(words, options);
}

void FarmTest::make_frames(const std::string& folder, int first, int last, int width, int height) const {
  fs::create_directories(path(folder));
  for (int frame = first; frame <= last; ++frame) {
    char name[64];
    std::snprintf(name, sizeof name, "/shot.%04d.exr", frame);
    const std::string file = text(folder) + name;
    const OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::HALF);
    std::vector<float> pixels(static_cast<std::size_t>(width) * height * 4);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((i * 7 + static_cast<std::size_t>(frame) * 13) % 97) / 31.0f;
    auto out = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(out && out->open(file, spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && out->close())
        << OIIO::geterror();
  }
}

void FarmTest::make_look_back(int work) const {
  write("effects/back.lua", R"(
local fx = require "afterglow"
return fx.effect { name = "back", settings = {}, build = function(g, s, source)
  local before = g:history { size = { 1, 1 }, pre_roll = 3 }
  g:keep(before, g:pass { shader = "back/propagate", before = before, size = { 1, 1 }, frame = g.frame })
  return g:pass { shader = "back/show", source = source, before = before }
end })");
  write("shaders/back/propagate.glsl",
        "uniform sampler2D before;\nuniform float frame;\n"
        "vec4 sample_at(ivec2 p) { return vec4(frame, fetch(before, p).rg, 1.0); }\n");
  write("shaders/back/show.glsl",
        "uniform sampler2D before;\nvec4 apply(vec4 color) {\n  vec4 b = fetch(before, ivec2(0));\n"
        "  float x = color.r;\n  for (int i = 0; i < " +
            std::to_string(work) +
            "; ++i) x = sin(x + b.r);\n"
            "  return vec4(abs(x) + b.r / 64.0, color.g + b.g / 64.0, color.b + b.b / 64.0, color.a);\n}\n");
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.back {}, fx.tone_mapping {} }\n");
}

std::map<std::string, std::string> FarmTest::pictures(const std::string& folder) const {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::directory_iterator(path(folder)))
    if (const std::string name = entry.path().filename().string(); entry.is_regular_file() && name[0] != '.') {
      out[name] = read(folder + "/" + name);
    }
  return out;
}

void FarmTest::expect_as_one_run(const std::string& folder, const std::string& one) const {
  const auto made = pictures(folder), truth = pictures(one);
  EXPECT_FALSE(truth.empty());
  EXPECT_EQ(made.size(), truth.size());
  for (const auto& [name, content] : truth) {
    const auto at = made.find(name);
    EXPECT_TRUE(at != made.end() && at->second == content) << name;
  }
}

void FarmTest::expect_nothing_half_written(const std::string& folder) const {
  for (const auto& entry : fs::recursive_directory_iterator(path(folder)))
    EXPECT_EQ(entry.path().filename().string().find(".tmp"), std::string::npos) << entry.path();
}

fs::path FarmTest::job_of(const std::string& outputs) const {
  std::vector<fs::path> jobs;
  std::error_code ec;
  for (fs::directory_iterator it(path(outputs) / ".afterglow-farm", ec), end; !ec && it != end; it.increment(ec))
    jobs.push_back(it->path());
  EXPECT_EQ(jobs.size(), 1u);
  return jobs.empty() ? fs::path() : jobs.front();
}

std::vector<fs::path> FarmTest::attempts(const std::string& outputs, const std::string& ending) const {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(job_of(outputs) / "attempts"))
    if (entry.path().filename().string().ends_with(ending)) out.push_back(entry.path());
  return out;
}

nlohmann::json FarmTest::report_of(const std::string& outputs) const {
  const Outcome outcome = farm({"report", outputs, "--report", "merged.json"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
  return nlohmann::json::parse(read("merged.json"), nullptr, false);
}

}  // namespace afterglow::test
