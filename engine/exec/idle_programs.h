// SPDX-License-Identifier: MIT
// Programs of one graph without what a frame's content makes needless: idle effects, division by alpha
// (graph/condition.h).
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <vector>

#include "exec/program.h"
#include "graph/condition.h"

namespace afterglow {

/// Each program is made when a frame first wants it and kept, so that frames may alternate at no cost. Not thread-safe.
class IdlePrograms {
 public:
  /// What runs a frame.
  struct Choice {
    Program* program = nullptr;                     ///< null: nothing runs, the result is the source
    const std::vector<Skipped>* skipped = nullptr;  ///< what is left out, with reasons; never null
  };

  /// `whole` runs every effect; its graph says whether it divides by alpha. Errors: those of Program::create.
  Result<Choice> choose(Device& device, ShaderLibrary& shaders, KernelCompiler& compiler, Program& whole,
                        const Graph& graph, const ProgramOptions& options, const SourceContent& content);
  /// See Program::set_parameters. Limits of `graph` count from here on. Errors: device.
  Result<void> set_parameters(const Graph& graph);
  /// See Program::use.
  Result<void> use(const std::shared_ptr<Histories>& histories);
  /// The program of that number here; null when there is none.
  Program* program(std::uint64_t id) const;
  /// Programs made so far.
  int size() const;

 private:
  struct Key {
    std::vector<bool> idle;  ///< by Graph::idle: what is left out
    bool divides = false;    ///< by alpha
    auto operator<=>(const Key&) const = default;
  };
  struct Variant {
    std::unique_ptr<Program> program;  ///< null: the whole one, or nothing runs
    bool whole = false;
    std::vector<Skipped> skipped;
  };
  static Graph graph_of(const Graph& graph, const Key& key);
  static std::vector<Skipped> skipped_by(const Graph& graph, const Key& key);
  std::map<Key, Variant> variants_;
};

}  // namespace afterglow
