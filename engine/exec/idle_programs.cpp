#include "exec/idle_programs.h"

#include <algorithm>

#include "graph/condition.h"

namespace afterglow {

namespace {

std::vector<Skipped> skipped_by(const Graph& graph, const std::vector<bool>& idle) {
  std::vector<Skipped> out;
  for (std::size_t i = 0; i < idle.size(); ++i)
    if (idle[i]) out.push_back({graph.idle[i].effect, idle_reason(graph.idle[i])});
  return out;
}

}  // namespace

Result<IdlePrograms::Choice> IdlePrograms::choose(Device& device, ShaderLibrary& shaders, KernelCompiler& compiler,
                                                  Program& whole, const Graph& graph, const ProgramOptions& options,
                                                  float brightest) {
  static const std::vector<Skipped> kNone;
  const std::vector<bool> idle = idle_effects(graph, brightest);
  if (std::ranges::none_of(idle, [](bool is) { return is; })) return Choice{&whole, &kNone};
  auto found = variants_.find(idle);
  if (found == variants_.end()) {
    const Graph reduced = without_idle(graph, idle);
    Variant variant;
    variant.skipped = skipped_by(graph, idle);
    if (reduced.result != reduced.source) {
      AFTERGLOW_TRY(variant.program, Program::create(device, shaders, compiler, reduced, options));
    }
    found = variants_.emplace(idle, std::move(variant)).first;
  }
  return Choice{found->second.program.get(), &found->second.skipped};
}

void IdlePrograms::set_parameters(const Graph& graph) {
  for (auto& [idle, variant] : variants_) {
    if (variant.program) variant.program->set_parameters(without_idle(graph, idle));
    variant.skipped = skipped_by(graph, idle);
  }
}

Program* IdlePrograms::program(std::uint64_t id) const {
  for (const auto& [idle, variant] : variants_)
    if (variant.program && variant.program->id() == id) return variant.program.get();
  return nullptr;
}

Result<void> IdlePrograms::use(const std::shared_ptr<Histories>& histories) {
  for (auto& [idle, variant] : variants_)
    if (variant.program) AFTERGLOW_CHECK(variant.program->use(histories));
  return {};
}

}  // namespace afterglow
