// SPDX-License-Identifier: MIT
#include "exec/idle_programs.h"

#include <algorithm>

namespace afterglow {

Graph IdlePrograms::graph_of(const Graph& graph, const Key& key) {
  Graph out = key.divides ? graph : without_division(graph);
  return std::ranges::find(key.idle, true) == key.idle.end() ? out : without_idle(out, key.idle);
}

std::vector<Skipped> IdlePrograms::skipped_by(const Graph& graph, const Key& key) {
  std::vector<Skipped> out;
  for (std::size_t i = 0; i < key.idle.size(); ++i)
    if (key.idle[i]) out.push_back({graph.idle[i].effect, idle_reason(graph.idle[i])});
  const int passes = straight_passes(graph);
  if (passes > 0 && !key.divides) out.push_back(skipped_division(passes));
  return out;
}

Result<IdlePrograms::Choice> IdlePrograms::choose(Device& device, ShaderLibrary& shaders, KernelCompiler& compiler,
                                                  Program& whole, const Graph& graph, const ProgramOptions& options,
                                                  const SourceContent& content) {
  const Key key{idle_effects(graph, content.brightest), straight_passes(graph) > 0 && !content.opaque};
  auto found = variants_.find(key);
  if (found == variants_.end()) {
    Variant variant;
    variant.skipped = skipped_by(graph, key);
    variant.whole =
        std::ranges::find(key.idle, true) == key.idle.end() && key.divides == (straight_passes(whole.graph()) > 0);
    if (!variant.whole) {
      const Graph reduced = graph_of(graph, key);
      if (reduced.result != reduced.source) {
        AFTERGLOW_TRY(variant.program, Program::create(device, shaders, compiler, reduced, options));
      }
    }
    found = variants_.emplace(key, std::move(variant)).first;
  }
  const Variant& variant = found->second;
  return Choice{variant.whole ? &whole : variant.program.get(), &variant.skipped};
}

Result<void> IdlePrograms::set_parameters(const Graph& graph) {
  for (auto& [key, variant] : variants_) {
    if (variant.program) AFTERGLOW_CHECK(variant.program->set_parameters(graph_of(graph, key)));
    variant.skipped = skipped_by(graph, key);
  }
  return {};
}

Program* IdlePrograms::program(std::uint64_t id) const {
  for (const auto& [idle, variant] : variants_)
    if (variant.program && variant.program->id() == id) return variant.program.get();
  return nullptr;
}

Result<void> IdlePrograms::use(const std::shared_ptr<Histories>& histories) {
  for (auto& [key, variant] : variants_)
    if (variant.program) AFTERGLOW_CHECK(variant.program->use(histories));
  return {};
}

int IdlePrograms::size() const {
  return static_cast<int>(
      std::ranges::count_if(variants_, [](const auto& entry) { return entry.second.program != nullptr; }));
}

}  // namespace afterglow
