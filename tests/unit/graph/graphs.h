// SPDX-License-Identifier: MIT
// Small graphs for tests, built the way the script room builds them.
#pragma once

#include "graph/graph.h"

namespace afterglow::test {

class Builder {
 public:
  explicit Builder(Size size = {16, 8}) { graph.source = graph.result = image("source", size, -1); }

  ImageId pixel(const std::string& name, ImageId source, std::vector<PassInput> more = {}) {
    Pass pass = base(name, PassKind::pixel);
    pass.shader = "test/" + name;
    pass.inputs = {{"source", source, true}};
    pass.inputs.insert(pass.inputs.end(), more.begin(), more.end());
    return add(std::move(pass), graph.images[source].size);
  }
  ImageId filter(const std::string& name, ImageId source, Size size) {
    Pass pass = base(name, PassKind::filter);
    pass.inputs = {{"source", source}};
    return add(std::move(pass), size);
  }
  ImageId sample(const std::string& name, std::vector<PassInput> inputs, Size size) {
    Pass pass = base(name, PassKind::sample);
    pass.shader = "test/" + name;
    pass.inputs = std::move(inputs);
    return add(std::move(pass), size);
  }

  Graph graph;

 private:
  Pass base(const std::string& name, PassKind kind) {
    Pass pass;
    pass.name = "test." + name;
    pass.effect = "test";
    pass.kind = kind;
    pass.file = "test.lua";
    pass.line = static_cast<int>(graph.passes.size()) + 1;
    return pass;
  }
  ImageId image(const std::string& name, Size size, int producer) {
    graph.images.push_back({name, size, producer});
    return static_cast<ImageId>(graph.images.size()) - 1;
  }
  ImageId add(Pass pass, Size size) {
    pass.output = image(pass.name, size, static_cast<int>(graph.passes.size()));
    graph.passes.push_back(std::move(pass));
    return graph.result = graph.passes.back().output;
  }
};

}  // namespace afterglow::test
