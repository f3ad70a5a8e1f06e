// What a stack consists of, and how it comes by its programs. Private to stack.cpp and stack_programs.cpp.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exec/histories.h"
#include "session/calibration.h"
#include "session/stack.h"

namespace afterglow {

struct Stack::State {
  StackOptions options;
  std::shared_ptr<StackShared> shared;
  /// What comes from scripts; `adopt` replaces it whole.
  struct Scripts {
    Diagnostics* diagnostics = nullptr;
    std::unique_ptr<ShaderLibrary> shaders;
    std::optional<Preset> preset;
    std::string shown;
  } scripts;
  std::vector<std::string> images;  ///< of the last graph
  bool shows = true;
  Device* device = nullptr;
  Calibration calibration;
  StackChoice choice;
  bool own_images = false;
  Graph graph;
  std::optional<Hash> texts;   ///< of the shaders of `graph`, once they have been asked for
  bool adopted = false;        ///< the texts may not be those that `program` was made of
  std::optional<Rect> region;  ///< that `program` was made for
  bool encoded = false;        ///< its result holds display codes
  bool prepared = false;
  std::shared_ptr<Histories> histories = std::make_shared<Histories>();
  std::unique_ptr<Program> program;
  IdlePrograms idle;
  /// Of other structures, the one used last first.
  struct Spare {
    Graph graph;
    Hash texts;
    std::optional<Rect> region;
    bool encoded = false;
    std::unique_ptr<Program> program;
    IdlePrograms idle;
  };
  std::vector<Spare> spares;
  double script_ms = 0, compile_ms = 0;

  Result<Graph> build(const BuildContext& context, const std::optional<DisplayEncoding>& encoding);
  /// Of all shaders of a graph, with what they include.
  Result<Hash> texts_of(const Graph& built);
  ProgramOptions options_of_programs() const;
  /// What `program` is made of: the graph, or what is left of it for opaque pictures, which most are. Frames with
  /// another alpha get a program of their own (`program_for`).
  Graph graph_of_program() const;
  /// The program of `graph`.
  Result<void> make();
  /// What `prepare` would do.
  struct Next {
    Graph graph;
    std::optional<Rect> region;
    bool encoded = false;
    bool present = false;       ///< the present program will do
    std::optional<Hash> texts;  ///< where they were looked at
    std::vector<Spare>::iterator spare;
  };
  Result<Next> look_ahead(const BuildContext& context, const std::optional<DisplayEncoding>& encoding,
                          const std::optional<Rect>& region);
  /// Does it.
  Result<void> take(Next next, const BuildContext& context);
  /// The present program becomes a spare one, if it may be wanted again.
  void put_aside();
  /// As many as may stay, within the memory that the stack may have.
  void drop_spares();

 private:
  /// Ends the graph at the image that is shown. Passes behind it are dropped as nobody reads them.
  void cut(Graph& built);
  /// Before the programs are made: what earlier frames handed on stays where it still means the same.
  Result<void> fit_histories();
};

}  // namespace afterglow
