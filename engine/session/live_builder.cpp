// SPDX-License-Identifier: MIT
#include "session/live_builder.h"

#include <algorithm>
#include <iterator>

#include "core/exception.h"
#include "core/file.h"
#include "core/locale.h"
#include "core/stopwatch.h"
#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::chrono::milliseconds kPatience{100};  // with a script whose files have changed meanwhile
constexpr std::size_t kMostSaid = 1000;  // messages that are not repeated; a frame may print others each time
constexpr std::chrono::milliseconds kStarving{250};  // without a new stack: a build is finished, overtaken or not

constexpr Clock::rep kNever = Clock::time_point::max().time_since_epoch().count();

/// The line that an error is about, without the space around it.
std::string line_of(const Error& error) {
  if (error.file.empty() || error.line < 1) return {};
  const auto text = read_file(error.file);
  if (!text) return {};
  const auto lines = split(*text, '\n');
  return error.line <= static_cast<int>(lines.size()) ? trim(lines[static_cast<std::size_t>(error.line) - 1]) : "";
}

}  // namespace

LiveBuilder::LiveBuilder(Device& device, std::filesystem::path preset, const LiveOptions& options,
                         Diagnostics& diagnostics)
    : device_(device),
      preset_(std::move(preset)),
      options_(options),
      diagnostics_(diagnostics),
      may_warm_up_(options.warm_up && WarmUp::helps(device)),
      files_(options.watch, options.follow
                                ? [this](Clock::time_point since, bool polled) { files_may_differ(since, polled); }
                                : Watcher::Look()) {
  const std::lock_guard lock(mutex_);  // what polls has begun
  request_.overrides = options.stack.preset.overrides;
  request_.arguments = options.stack.preset.arguments;
  wanted_.request = true;
  wanted_.note(Clock::now());
  status_.building = true;
  thread_ = std::thread([this] { run(); });
}

LiveBuilder::~LiveBuilder() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    if (until_) until_->store(0);
  }
  changed_.notify_all();
  thread_.join();
}

void LiveBuilder::notify() const {
  if (options_.notify) options_.notify();
}

// ---- what is wanted

/// Files that change faster than builds end would let none of them come to anything. With `mutex_` held.
bool LiveBuilder::starves() const { return gave_up_ && Clock::now() - *gave_up_ > kStarving; }

/// A script that runs on for something that is no longer wanted comes to an end.
void LiveBuilder::overtake() {
  if (until_ && !starves())
    until_->store(std::min(until_->load(), (script_began_ + kPatience).time_since_epoch().count()));
  changed_.notify_all();
}

void LiveBuilder::files_may_differ(Clock::time_point since, bool polled) {
  const std::lock_guard lock(mutex_);
  wanted_.files = true;
  wanted_.note(since);
  if (polled)
    changed_.notify_all();
  else
    overtake();
}

void LiveBuilder::change(const std::function<void(LiveRequest&)>& apply, bool build) {
  const std::lock_guard lock(mutex_);
  apply(request_);
  if (!build) return;
  wanted_.request = true;
  wanted_.note(Clock::now());
  status_.building = true;
  overtake();
}

void LiveBuilder::look() { files_may_differ(Clock::now(), true); }

void LiveBuilder::settle() {
  std::unique_lock lock(mutex_);
  const std::uint64_t call = ++asked_;
  wanted_.files = true;
  wanted_.note(Clock::now());
  changed_.notify_all();
  // Not until nothing is wanted: while a file is written again and again there always is something.
  changed_.wait(lock, [&] { return answered_ >= call; });
}

bool LiveBuilder::overtaken() const {
  {
    const std::lock_guard lock(mutex_);
    if (ends_ || wanted_.request) return true;
    if (!wanted_.files) return false;
  }
  return files_.build_changed();
}

// ---- the thread

void LiveBuilder::run() {
  const PlainLocale plain;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ends_ || wanted_.any() || !dead_.empty(); });
    if (ends_) return;
    std::vector<BuiltStack> dead = std::move(dead_);
    dead_.clear();
    const Wanted why = std::exchange(wanted_, {});
    const std::uint64_t asked = asked_;
    builds_ = why.any();
    const LiveRequest request = request_;
    if (why.any()) request_.for_frame = false;
    lock.unlock();
    try {
      if (why.any()) work(why, request);
    } catch (const std::exception& exception) {  // out of memory
      fail(exception_error(exception));
    }
    dead.clear();
    lock.lock();
    builds_ = false;
    if (!gave_up_) answered_ = asked;
    const bool was = std::exchange(status_.building, wanted_.request);
    changed_.notify_all();
    if (was != status_.building) {
      lock.unlock();
      notify();
      lock.lock();
    }
  }
}

void LiveBuilder::work(const Wanted& why, const LiveRequest& request) {
  files_.take_later();
  if (!why.request && !files_.changed()) return;
  BuildTimes times;
  times.notice = milliseconds_between(why.since.value_or(Clock::now()), Clock::now());
  {
    const std::lock_guard lock(mutex_);
    ++counters_.builds;
    status_.building = true;
  }
  auto built = build(request, times);
  if (!built) fail(std::move(built).error());
}

BuiltStack LiveBuilder::new_stack() {
  auto heard = std::make_shared<Heard>();
  auto diagnostics = std::make_unique<Diagnostics>([this, heard](Severity severity, const std::string& message) {
    {
      const std::lock_guard lock(heard->mutex);
      if (severity == Severity::warning)
        heard->warnings.push_back(message);
      else if (!heard->built)
        heard->notes.push_back(message);
    }
    {
      const std::lock_guard lock(said_mutex_);
      auto& said = severity == Severity::warning ? said_ : noted_;
      if (said.size() >= kMostSaid) said.clear();
      if (!said.insert(message).second) return;
    }
    severity == Severity::warning ? diagnostics_.warn(message) : diagnostics_.note(message);
  });
  return {token_, std::move(heard), std::move(diagnostics), nullptr};
}

/// Everything that reads files.
Result<BuiltStack> LiveBuilder::load(const LiveRequest& request, const std::shared_ptr<FileRecord>& record,
                                     std::optional<Basis>& work, std::vector<std::string>& wants) {
  BuiltStack built = new_stack();
  StackOptions options = options_.stack;
  options.preset.overrides = request.overrides;
  options.preset.arguments = request.arguments;
  options.preset.leave_out_unfit = true;
  options.preset.record = record;
  if (request.text) {
    options.preset.text = *request.text;
    record->note(preset_, FileProbe::Kind::content);  // whoever wrote the text wants to know when the file changes
  }
  {
    const std::lock_guard lock(mutex_);
    script_began_ = Clock::now();
    until_ = std::make_shared<Until>(ends_ ? 0 : kNever);
    options.preset.limits.until = until_;
  }
  AFTERGLOW_TRY(built.stack, Stack::load(preset_, options, *built.diagnostics));
  built.stack->show(request.shown);
  built.stack->use(device_, options_.own_images);
  wants = not_asked(*built.stack, request);
  if (request.context && wants.empty()) {
    Basis made{.build = {}, .work = {}, .choice = built.stack->choice()};
    AFTERGLOW_TRY(made.build, built.stack->evaluate(*request.context));
    AFTERGLOW_TRY(made.work, built.stack->work({.build = made.build, .encoding = request.encoding}));
    work = std::move(made);
  }
  return built;
}

/// What a look wants of pictures that were not read for it.
std::vector<std::string> LiveBuilder::not_asked(Stack& stack, const LiveRequest& request) const {
  std::vector<std::string> out;
  if (!options_.inputs_follow || !request.context) return out;
  (void)stack.preset().note_needs(*request.context);  // what is wrong there is wrong when it is evaluated
  std::ranges::copy_if(stack.preset().needs(), std::back_inserter(out), [&](const std::string& name) {
    return std::ranges::find(request.context->asked, name) == request.context->asked.end();
  });
  return out;
}

/// Whoever reads pictures comes with another context, and that is built for.
void LiveBuilder::await_inputs(std::vector<std::string> wants) {
  {
    const std::lock_guard lock(mutex_);
    wants_ = std::move(wants);
    gave_up_.reset();
    status_.error.reset();
    status_.source_line.clear();
  }
  notify();
}

bool LiveBuilder::Basis::serves(const Basis& other) const {
  return choice.execution == other.choice.execution && choice.max_error == other.choice.max_error &&
         same_program(work, other.work);
}

Result<void> LiveBuilder::build(const LiveRequest& request, BuildTimes& times) {
  const auto start = Clock::now();
  std::optional<Basis> work;
  const auto record = std::make_shared<FileRecord>();
  std::vector<std::string> wants;
  Result<BuiltStack> built = load(request, record, work, wants);
  {
    const std::lock_guard lock(mutex_);
    until_->store(kNever);  // from now on the script is the stack's, and nobody interrupts it
    until_.reset();
  }
  if (files_.follow(*record->looks())) want_look();
  times.script = milliseconds_since(start);
  if (!built) return std::move(built).error();
  if (!wants.empty()) {
    await_inputs(std::move(wants));
    return {};
  }
  built->files = record->looks();
  if (work && basis_ && !request.for_frame && basis_->serves(*work)) {
    times.kind = BuildTimes::Kind::values;
    publish(std::move(*built), times);
    return {};
  }
  times.kind = request.for_frame ? BuildTimes::Kind::frame : BuildTimes::Kind::structure;
  if (work) {
    if (overtaken() && Clock::now() - published_at_ < kStarving) {
      give_up(request.for_frame);
      return {};
    }
    SharedKernels& shared = *options_.stack.shared;
    const auto pipelines = shared.pipelines.counters();
    const int compiled = shared.compiler.counters().compiled;
    AFTERGLOW_CHECK(built->stack->prepare(request_for(work->build, request.encoding)));
    const auto after = shared.pipelines.counters();
    times.pipeline = after.milliseconds - pipelines.milliseconds;
    times.shader = std::max(0.0, built->stack->compile_milliseconds() - times.pipeline);
    times.kernels_compiled = shared.compiler.counters().compiled - compiled;
    times.pipelines_made = static_cast<int>(after.made - pipelines.made);
    if (times.pipelines_made > 0) warm_up(*built->stack, times);
    basis_ = std::move(work);
    built->for_frame = request.for_frame;
  }
  publish(std::move(*built), times);
  return {};
}

/// The first stack is not worth it: its first frame is waited for anyway, and its kernels are compiled but once. What
/// goes wrong here goes wrong again where it counts.
void LiveBuilder::warm_up(Stack& stack, BuildTimes& times) {
  if (!may_warm_up_ || !basis_) return;
  const auto start = Clock::now();
  if (!warm_up_) {
    auto made = WarmUp::create(device_);
    may_warm_up_ = made.ok();
    if (!made) return;
    warm_up_ = std::move(made).value();
  }
  const ProgramCache& programs = *stack.programs();
  if (programs.program())
    (void)warm_up_->draw(stack.shaders(), options_.stack.shared->compiler, programs.program()->graph(),
                         programs.program_options());
  times.warm_up = milliseconds_since(start);
}

void LiveBuilder::also_follow(FileProbes looks) {
  files_.note_later(std::move(looks));
  want_look();
}

void LiveBuilder::want_look() {
  const std::lock_guard lock(mutex_);
  wanted_.files = true;
  wanted_.note(Clock::now());
  changed_.notify_all();
}

// ---- what comes of a build

void LiveBuilder::publish(BuiltStack built, const BuildTimes& times) {
  {
    const std::lock_guard lock(said_mutex_);
    const std::lock_guard heard_lock(built.heard->mutex);
    said_ = {built.heard->warnings.begin(), built.heard->warnings.end()};
    noted_.clear();
    built.heard->built = true;
  }
  BuiltParts old;
  {
    const std::lock_guard lock(mutex_);
    if (times.kind != BuildTimes::Kind::values) {
      std::swap(old.structure, parts_.structure);
      parts_.structure = std::move(built);
    }
    std::swap(old.values, parts_.values);
    if (times.kind == BuildTimes::Kind::values) parts_.values = std::move(built);
    // Untaken: the later build has done the work of both.
    const bool both = parts_.structure && times.kind == BuildTimes::Kind::values;
    if (!both) parts_.times = times;
    parts_.done = published_at_ = Clock::now();
    gave_up_.reset();
    wants_.clear();
    status_.error.reset();
    status_.source_line.clear();
  }
  notify();
}

void LiveBuilder::give_up(bool for_frame) {
  const std::lock_guard lock(mutex_);
  ++counters_.given_up;
  if (!gave_up_) gave_up_ = Clock::now();
  if (for_frame) request_.for_frame = true;
  wanted_.request = true;
}

void LiveBuilder::fail(Error error) {
  const bool interrupted = error.kind == ErrorKind::interrupted;
  // A file that was caught half written: the build that follows says what is wrong.
  if (interrupted || (overtaken() && !starves())) return give_up(false);
  std::string line = line_of(error);
  {
    const std::lock_guard lock(mutex_);
    ++counters_.failed;
    gave_up_.reset();
    wants_.clear();
    status_.error = std::move(error);
    status_.source_line = std::move(line);
  }
  notify();
}

std::vector<std::string> LiveBuilder::wants() const {
  const std::lock_guard lock(mutex_);
  return wants_;
}

BuiltParts LiveBuilder::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(parts_, {});
}

void LiveBuilder::release(BuiltStack stack) {
  const std::lock_guard lock(mutex_);
  dead_.push_back(std::move(stack));
  changed_.notify_all();
}

void LiveBuilder::forward(const std::function<void(LiveStatus&, LiveStack::Counters&)>& apply) {
  const std::lock_guard lock(mutex_);
  apply(status_, counters_);
}

LiveStatus LiveBuilder::status() const {
  LiveStatus status;
  {
    const std::lock_guard lock(mutex_);
    status = status_;
  }
  status.watching = files_.method();
  return status;
}

bool LiveBuilder::building() const {
  const std::lock_guard lock(mutex_);
  return builds_ || wanted_.any() || parts_.any();
}

LiveStack::Counters LiveBuilder::counters() const {
  LiveStack::Counters counters;
  {
    const std::lock_guard lock(mutex_);
    counters = counters_;
    counters.stacks = static_cast<std::uint64_t>(token_.use_count()) - 1;
  }
  const SharedKernels& shared = *options_.stack.shared;
  counters.compiled = static_cast<std::uint64_t>(shared.compiler.counters().compiled);
  const auto pipelines = shared.pipelines.counters();
  counters.pipelines = pipelines.made;
  counters.pipelines_alive = pipelines.alive;
  counters.images = shared.images.counters().alive;
  return counters;
}

}  // namespace afterglow
