// SPDX-License-Identifier: MIT
// Where stacks come from.
#include <algorithm>
#include <mutex>

#include "api/backend.h"
#include "core/file_record.h"
#include "script/asset_store.h"
#include "session/live.h"

namespace afterglow::api {
namespace {

/// Messages of a load, those of the one before left out.
class NewMessages {
 public:
  bool is_new(const std::string& message) {
    said_.push_back(message);
    return std::ranges::find(before_, message) == before_.end();
  }
  /// The load is over; when it has failed, the one before it still counts.
  void end(bool loaded) {
    if (loaded) before_ = std::move(said_);
    said_.clear();
  }

 private:
  std::vector<std::string> before_, said_;
};

/// Loaded in the caller's thread, whenever it asks. Scripts and shaders are what they were when they were read first:
/// only `reload` reads them again.
class Loaded : public Source {
 public:
  Loaded(SharedDevice& device, const BackendOptions& options, Diagnostics& diagnostics)
      : device_(device), options_(options), diagnostics_(diagnostics) {
    options_.stack.preset.assets = std::make_shared<AssetStore>();
  }

  Stack& stack() override { return *stack_; }
  Result<void> set(const Given& given, MustFit must_fit) override {
    StackOptions wanted = options_.stack;
    wanted.preset.overrides = given.overrides;
    wanted.preset.arguments = given.arguments;
    wanted.preset.must_fit = must_fit;
    return load(wanted, false);
  }
  Result<bool> update() override { return false; }
  Result<void> reload(const std::optional<std::string>& text) override {
    StackOptions wanted = options_.stack;
    if (text) wanted.preset.text = *text;
    wanted.preset.record = FileRecord::keeping();
    return load(wanted, true);
  }
  Result<std::shared_ptr<const Build>> evaluate(const Shape& shape) override {
    AFTERGLOW_TRY(auto build, stack_->evaluate(shape.context));
    shape_ = shape;
    return build;
  }

 private:
  /// `anew`: shaders may be others.
  Result<void> load(const StackOptions& wanted, bool anew) {
    loading_ = true;
    auto loaded = tried(wanted, anew);
    loading_ = false;
    printed_.end(loaded.ok());
    AFTERGLOW_TRY(auto later, std::move(loaded));
    if (stack_) later->take_over(*stack_, !later->build());
    stack_ = std::move(later);
    options_.stack = wanted;
    options_.stack.preset.leave_out_unfit = true;  // the preset may come to be another one
    options_.stack.preset.must_fit = {};
    return {};
  }

  /// A stack that does for frames like the last one, if it is of files that were read anew: tables are read for a frame
  /// alone, and shaders compiled.
  Result<std::unique_ptr<Stack>> tried(const StackOptions& wanted, bool anew) {
    AFTERGLOW_TRY(auto later, Stack::load(options_.preset, wanted, said_));
    later->use(*device_.device, !options_.commands);
    if (!anew || !shape_) return later;
    AFTERGLOW_TRY(auto build, later->evaluate(shape_->context));
    AFTERGLOW_CHECK(later->prepare(request_for(std::move(build), shape_->encoding, shape_->region)));
    return later;
  }

  /// Each setting that is set runs the preset again, which prints what it printed before.
  void tell(Severity severity, const std::string& message) {
    if (severity == Severity::warning) return diagnostics_.warn(message);
    if (!loading_ || printed_.is_new(message)) diagnostics_.note(message);
  }

  SharedDevice& device_;
  BackendOptions options_;
  Diagnostics& diagnostics_;
  Diagnostics said_{[this](Severity severity, const std::string& message) { tell(severity, message); }};
  NewMessages printed_;
  bool loading_ = false;
  std::optional<Shape> shape_;  ///< of the last frame that could be made
  std::unique_ptr<Stack> stack_;
};

/// Built on a thread of the library's when files change.
class Followed : public Source {
 public:
  Followed(const BackendOptions& options, Diagnostics& diagnostics) : options_(options), diagnostics_(diagnostics) {}

  Result<void> open(SharedDevice& device) {
    if (!options_.stack.preset.arguments.empty()) AFTERGLOW_CHECK(attempt(options_.stack.preset));
    LiveOptions live;
    live.stack = options_.stack;
    live.own_images = !options_.commands;
    live.notify = options_.wake;
    AFTERGLOW_TRY(live_, LiveStack::open(*device.device, options_.preset, live, silent_));
    if (!live_->stack()) return failed();
    tell_messages();
    return {};
  }

  Stack& stack() override { return *live_->stack(); }

  Result<void> set(const Given& given, MustFit must_fit) override {
    PresetOptions wanted = options_.stack.preset;
    wanted.overrides = given.overrides;
    wanted.arguments = given.arguments;
    wanted.leave_out_unfit = true;
    wanted.must_fit = must_fit;
    const auto fits = attempt(wanted);
    if (!fits && !is_of_the_files(fits.error())) return fits.error();
    live_->set_overrides(given.overrides, given.arguments);
    live_->settle();  // what is wrong with the files, or with a frame of these, `update` tells
    if (live_->update()) tell_messages();
    return {};
  }

  Result<bool> update() override {
    if (live_->update()) {
      tell_messages();
      return true;  // what is wrong with a later edit is said the next time
    }
    const LiveStatus status = live_->status();
    const std::string text = status.error ? status.error->text() : "";
    if (text == told_error_) return false;
    told_error_ = text;
    if (status.error) return *status.error;
    return false;
  }

  Result<void> reload(const std::optional<std::string>&) override {
    live_->reload();
    return settle();
  }

  Result<std::shared_ptr<const Build>> evaluate(const Shape& shape) override {
    const bool new_shape = !shape_ || shape_->context.size != shape.context.size ||
                           shape_->context.auxiliary != shape.context.auxiliary || shape_->encoding != shape.encoding;
    live_->set_context(shape.context, shape.encoding);
    if (new_shape) {
      live_->settle();
      if (live_->update()) tell_messages();
    }
    auto build = live_->stack()->evaluate(shape.context);
    if (!build) {
      if (shape_) live_->set_context(shape_->context, shape_->encoding);  // edits are built for what can be made
      return build;
    }
    shape_ = shape;
    live_->also_follow((*build)->files);
    return build;
  }

 private:
  /// A LiveStack leaves out all that does not fit: what must fit is tried here first.
  Result<void> attempt(const PresetOptions& wanted) const {
    ShaderLibrary shaders(search_path_for(options_.preset, wanted.paths, nullptr, wanted.installation));
    AFTERGLOW_TRY(const Preset fits, Preset::load(options_.preset, wanted, shaders, silent_));
    return {};
  }
  /// Whether an error is one of the preset alone, as it lies there now, and of no value that was set.
  bool is_of_the_files(const Error& error) const {
    PresetOptions alone = options_.stack.preset;
    alone.overrides = {};
    alone.leave_out_unfit = true;
    alone.must_fit = {};
    const auto opens = attempt(alone);
    return !opens && opens.error().text() == error.text();
  }
  Result<void> settle() {
    live_->settle();
    if (live_->update()) tell_messages();
    const LiveStatus status = live_->status();
    told_error_ = status.error ? status.error->text() : "";
    return status.error ? failed() : Result<void>();
  }
  Error failed() const {
    const LiveStatus status = live_->status();
    return status.error ? *status.error : Error{ErrorKind::script, "the preset cannot be loaded"};
  }
  void tell_messages() {
    const LiveStatus status = live_->status();
    for (const auto& note : status.notes)
      if (printed_.is_new(note)) diagnostics_.note(note);
    printed_.end(true);
    for (const auto& warning : status.warnings)
      if (warned_.is_new(warning)) diagnostics_.warn(warning);
    warned_.end(true);
  }

  BackendOptions options_;
  Diagnostics& diagnostics_;
  mutable Diagnostics silent_;  ///< messages of builds come with the status of the one that is shown
  std::unique_ptr<LiveStack> live_;
  std::optional<Shape> shape_;  ///< of the last frame that could be made
  NewMessages printed_, warned_;
  std::string told_error_;
};

}  // namespace

Result<std::unique_ptr<Source>> load_source(SharedDevice& device, const BackendOptions& options,
                                            Diagnostics& diagnostics) {
  auto source = std::make_unique<Loaded>(device, options, diagnostics);
  AFTERGLOW_CHECK(source->reload({}));
  return std::unique_ptr<Source>(std::move(source));
}

Result<std::unique_ptr<Source>> follow_source(SharedDevice& device, const BackendOptions& options,
                                              Diagnostics& diagnostics) {
  auto source = std::make_unique<Followed>(options, diagnostics);
  AFTERGLOW_CHECK(source->open(device));
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace afterglow::api
