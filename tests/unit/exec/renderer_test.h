// SPDX-License-Identifier: MIT
// What tests of frames in flight and of programs begin with: two effects, their graphs, kernels that are shared.
#pragma once

#include <gtest/gtest.h>

#include "exec/renderer.h"
#include "workshop.h"

namespace afterglow {

class RendererTest : public Workshop {
 protected:
  static constexpr Size kSize{61, 37};

  void SetUp() override {
    Workshop::SetUp();
    shader("test/gain", "uniform float gain;\nvec4 apply(vec4 color) { return vec4(color.rgb * gain, color.a); }\n");
    shader("test/offset", "uniform float by;\nvec4 apply(vec4 color) { return vec4(color.rgb + by, color.a); }\n");
    shared_ = std::make_shared<SharedKernels>(std::filesystem::path());
  }
  std::unique_ptr<ProgramCache> cache(const ProgramCacheOptions& options = {}) {
    return std::make_unique<ProgramCache>(device(), shared_, options);
  }
  static std::unique_ptr<Renderer> renderer(int frames, bool direct = false) {
    auto made = Renderer::create(device(), {.direct = direct, .frames = frames});
    EXPECT_TRUE(made) << made.error().text();
    return std::move(*made);
  }
  /// `offset`: another structure than without.
  static Graph graph(double gain, bool offset = false) {
    GraphBuilder builder(kSize);
    ImageId image = builder.pixel("gain", "test/gain", builder.source(), {}, {{"gain", number(gain)}});
    if (offset) image = builder.pixel("offset", "test/offset", image, {}, {{"by", number(1)}});
    return builder.finish(image);
  }
  RenderRequest request(ProgramCache& programs, const Graph& graph, const std::vector<float>& pixels) {
    RenderRequest out{.programs = &programs, .shaders = library_.get()};
    out.work = {.graph = graph, .texts = texts_of(graph, *library_).value()};
    out.inputs["source"] = {pixels.data(), kSize, 4};
    return out;
  }
  std::shared_ptr<SharedKernels> shared_;
};

}  // namespace afterglow
