// SPDX-License-Identifier: MIT
// The images that frames hand on to the frames after them (graph/history.h): two of each, which take turns, so that
// nothing is copied.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "gpu/image.h"
#include "graph/graph.h"
#include "shader/execution_config.h"

namespace afterglow {

/// Shared by the programs of one stack, so that frames which run different ones of them go on from each other. Not
/// thread-safe.
class Histories {
 public:
  struct Options {
    bool half = false;           ///< store those that are not precise as half floats
    bool storage = false;        ///< they are read as storage images too
    bool four_channels = false;  ///< whatever the graph says
    std::uint64_t max_memory = 6ull << 30;
  };
  /// As programs of this graph with this execution find them.
  static Options options_for(const Device& device, const Graph& graph, const ExecutionConfig& config,
                             std::uint64_t max_memory);
  /// Makes images for the histories of this graph. Those whose part of the graph, size and format are as before keep
  /// their pixels; others begin anew; what the graph does not have goes. Must not be called while a submission that
  /// uses them is in flight; programs have to be pointed at them afterwards (`images_id`). Errors: device, io (over
  /// `max_memory`).
  Result<void> fit(const Device& device, const Graph& graph, const Options& options);
  /// Names of those that held a frame and began anew in `fit`, since this was asked last.
  std::vector<std::string> take_replaced() { return std::exchange(replaced_, {}); }
  /// Takes over the images of `other` that fit as well as those here, with what they hold and the place in time;
  /// `other` is left without them. For a stack that takes another's place. As `fit` in the rest.
  void take(Histories& other);

  /// A frame begins. It follows the frame made last when its number is `step` greater: then it reads what that one
  /// made. The number of the frame made last: the same frame once more, reading what it read before. Any other, or with
  /// `restart`: nothing is before it.
  void begin(double frame, double step = 1, bool restart = false);
  /// The frame that began has been made (or recorded: what is recorded must then be submitted, in that order).
  void made();
  /// The next frame has none before it, whatever its number is.
  void reset();

  /// Which of two images is the previous one in the frame that began; the other is the next one.
  int previous() const { return previous_; }
  /// Grows with every frame that begins; a frame that is made once more is the same.
  std::uint64_t turn() const { return turn_; }
  /// Another number as soon as an image has come or gone; no two histories have the same. Whoever was pointed at the
  /// images by another number has images that may be gone.
  std::uint64_t images_id() const { return images_id_; }
  /// Whether the frame that began has one before it, for this history. Unknown names have not.
  bool has_previous(const std::string& name) const;
  /// One of the two images of a history; null for unknown names.
  const GpuImage* image(const std::string& name, int which) const;
  std::uint64_t bytes() const;
  int images() const { return 2 * static_cast<int>(kept_.size()); }

 private:
  struct Kept {
    Hash part;
    std::array<GpuImage, 2> images;
    bool previous_holds = false, next_holds = false;  ///< what the frame before and this one made
  };
  /// Numbers of all histories differ, so that a program notices when it is given others.
  static std::uint64_t next_number();
  static Result<Kept> make(const Device& device, const std::string& name, const Hash& part, ImageDesc desc);

  std::map<std::string, Kept> kept_;
  std::vector<std::string> replaced_;
  int previous_ = 0;
  std::uint64_t turn_ = 0, images_id_ = next_number();
  std::optional<double> before_;  ///< number of the frame that `previous` holds
  std::optional<double> begun_;
  std::optional<double> made_;  ///< equal to `begun_` once that has been made
};

}  // namespace afterglow
