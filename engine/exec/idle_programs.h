// Programs of one graph without the effects that a frame's content makes idle (graph/condition.h).
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "exec/program.h"

namespace afterglow {

/// Each program is made when a frame first wants it and kept, so that frames may alternate at no cost. Not thread-safe.
class IdlePrograms {
 public:
  /// What runs a frame.
  struct Choice {
    Program* program = nullptr;                     ///< null: nothing runs, the result is the source
    const std::vector<Skipped>* skipped = nullptr;  ///< the idle effects, with reasons; never null
  };

  /// `whole` runs every effect. Errors: those of Program::create.
  Result<Choice> choose(Device& device, ShaderLibrary& shaders, KernelCompiler& compiler, Program& whole,
                        const Graph& graph, const ProgramOptions& options, float brightest);
  /// See Program::set_parameters. Limits of `graph` count from here on.
  void set_parameters(const Graph& graph);
  /// See Program::use.
  Result<void> use(const std::shared_ptr<Histories>& histories);
  /// The program of that number here; null when there is none.
  Program* program(std::uint64_t id) const;
  /// Programs made so far.
  int size() const { return static_cast<int>(variants_.size()); }

 private:
  struct Variant {
    std::unique_ptr<Program> program;
    std::vector<Skipped> skipped;
  };
  std::map<std::vector<bool>, Variant> variants_;  ///< by Graph::idle: what is left out
};

}  // namespace afterglow
