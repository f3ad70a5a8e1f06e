// SPDX-License-Identifier: MIT
// Builds a Graph pass by pass and checks each pass against what its shader declares. No Lua: the binding turns a table
// into a PassRequest. Failures carry the key of the request they are about, so that the binding can point at its line.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/graph.h"
#include "script/numbers.h"
#include "script/preset.h"
#include "script/script_error.h"
#include "script/value.h"
#include "shader/library.h"

namespace afterglow::script {

/// An image as scripts hold it. `build` tells the images of one run of Preset::evaluate from those of another.
struct ImageRef {
  std::uint64_t build = 0;
  ImageId id = kNoImage;
  Size size;
};

/// An input or parameter of a pass, as the script named it.
struct Argument {
  std::string name;
  std::optional<ImageRef> image;  ///< else `value`
  Value value;
  Numbers numbers{};  ///< of a table
};

struct PassRequest {
  std::optional<std::string> name;
  std::string shader;
  std::string by_workgroups;  ///< see Pass::by_workgroups
  std::optional<Size> size;
  std::optional<double> reach;      ///< see Pass::reach
  std::optional<double> channels;   ///< see GraphImage::channels
  bool precise = false;             ///< see GraphImage::precise
  std::vector<Argument> arguments;  ///< "source" among them
};

struct FilterRequest {
  std::optional<std::string> name;
  std::optional<ImageRef> source;
  std::optional<Size> size;
  std::optional<double> channels;  ///< default: those of the source
  bool precise = false;
  Filter filter;
};

struct HistoryRequest {
  std::optional<std::string> name;
  std::optional<Size> size;       ///< default: that of `first`
  std::optional<ImageRef> first;  ///< else `initial`
  std::array<double, 4> initial{};
  std::optional<double> channels;
  bool precise = true;
  std::optional<double> pre_roll;
};

/// Where a script asks for a pass.
struct CallPlace {
  std::string file;
  int line = 0;
};

inline constexpr const char* kChannelCounts = "1, 2, 4";

/// All functions throw ScriptError; messages name pass and effect.
class GraphBuilder {
 public:
  GraphBuilder(const BuildContext& context, ShaderLibrary& shaders, std::uint64_t build);

  ImageRef source() const { return ref(graph_.source); }
  std::uint64_t build() const { return build_; }
  const BuildContext& context() const { return context_; }
  /// Pixels of the picture for each pixel that settings in px are given in.
  double length_scale() const { return length_scale_; }
  void scale_lengths(double scale) { length_scale_ = scale; }

  /// Passes that follow belong to this entry. `inputs`: auxiliary images that it may ask for. `effect`: whose shaders
  /// may want straight colour, see Pass::straight; null: none does. `prefix` stands before the names of its passes,
  /// whose values are no colours: "glow.mask.luma".
  void begin(const StackEntry& entry, std::vector<std::string> inputs, const EffectSchema* effect = nullptr,
             const std::string& prefix = "");
  const StackEntry& entry() const { return *entry_; }

  ImageRef pass(const PassRequest& request, const CallPlace& place);
  ImageRef filter(FilterRequest request, const CallPlace& place);
  /// What the frame before kept. Must be given its next image by `keep`, once, while the same entry is built.
  ImageRef history(const HistoryRequest& request, const CallPlace& place);
  void keep(const ImageRef& history, const ImageRef& next, const CallPlace& place);
  /// The present entry has been built. Throws for histories that were not kept.
  void end();

  /// Empty when the picture has no such image.
  std::optional<ImageRef> input(const std::string& name);
  /// An image that the look brings along; the same data is the same image.
  ImageRef data(const std::string& name, std::shared_ptr<const ImageData> pixels);
  /// What an author should know about the alpha of what an effect made; none: nothing.
  std::optional<std::string> fixed_alpha(const ImageRef& made) const;
  /// What authors should know about the shaders of the present entry.
  void tell_warnings(Diagnostics& diagnostics) const {
    for (const auto& warning : warnings_) diagnostics.warn_once(warning, warning);
  }
  void skip(std::string reason) { skip_reason_ = std::move(reason); }
  const std::optional<std::string>& skip_reason() const { return skip_reason_; }

  void add_skipped(std::string name, std::string reason, std::vector<std::string> lacks = {}, bool can_lack = false) {
    graph_.skipped.push_back({std::move(name), std::move(reason), std::move(lacks), can_lack});
  }
  /// The present entry makes `output` of `source`, which stay equal while nothing of `source` is above `limit`: those
  /// of as many channels.
  void add_idle(const ImageRef& source, const ImageRef& output, double limit);
  Graph finish(ImageId result);

 private:
  ImageRef ref(ImageId id) const { return {build_, id, graph_.images[static_cast<std::size_t>(id)].size}; }
  ImageId add_image(std::string name, Size size, int producer);
  Pass start(std::string name, const std::optional<std::string>& given, const CallPlace& place);
  ImageRef add(Pass pass, Size size, int channels, bool precise);
  /// What is wrong with `channels = …`; none: nothing.
  static std::optional<std::string> wrong_channels(std::optional<double> wanted);
  int channels_of(const Pass& pass, std::optional<double> wanted, int otherwise) const;
  void check_image(const Pass& pass, const std::string& key, const ImageRef& image) const;
  void check_size(const Pass& pass, const Size& size) const;
  History* history_of(const ImageRef& image);
  bool depends_on_history(const History& history) const;
  ImageId copy_of(ImageId image, int channels, const CallPlace& place);
  [[noreturn]] void fail_history(const History& history, const std::string& message, KeyPath key = {},
                                 std::string allowed = {}) const;
  [[noreturn]] void fail(const Pass& pass, const std::string& message, KeyPath key = {}, std::string allowed = {},
                         std::string nearest = {}) const;
  std::shared_ptr<const ShaderSource> find_shader(const Pass& pass, const std::string& name, const char* key) const;
  void check_workgroups(const Pass& pass, const PassRequest& request, const ShaderInterface& interface) const;
  void bind(Pass& pass, const PassRequest& request, const ShaderSource& shader) const;
  void bind_image(Pass& pass, const Argument& argument, bool pixelwise) const;
  void bind_param(Pass& pass, const Argument& argument, const ShaderParam& param) const;
  static std::vector<double> rows_for(const Argument& argument, const ShaderParam& param,
                                      const std::function<void(const std::string&)>& wrong);
  void check_complete(const Pass& pass, const ShaderInterface& interface, bool needs_source) const;
  Size target_size(const Pass& pass, const PassRequest& request) const;

  BuildContext context_;
  ShaderLibrary& shaders_;
  std::uint64_t build_;
  double length_scale_ = 1;
  Graph graph_;
  const StackEntry* entry_ = nullptr;
  std::vector<std::string> inputs_;
  bool straight_ = false, lights_black_ = false;  ///< as those of Pass
  std::vector<std::string> warnings_;
  std::string prefix_;
  /// Of the present entry: histories that wait for `keep`, and the places that asked for them.
  std::vector<std::pair<std::string, CallPlace>> open_histories_;
  std::map<std::string, int> names_;  // taken names; how often each was wanted
  std::optional<std::string> skip_reason_;
};

}  // namespace afterglow::script
