// SPDX-License-Identifier: MIT
#include "play/finite_watch.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "core/exception.h"
#include "core/give_way.h"
#include "core/stopwatch.h"
#include "session/picture_inputs.h"
#include "session/session.h"

namespace afterglow {
namespace {

constexpr auto kQuiet = std::chrono::milliseconds(400);

Result<FiniteAnswer> answer(const DeviceOptions& device, StackOptions stack, const FiniteQuestion& question) {
  Diagnostics silent;  // the player has said all there is to say
  stack.preset.text = question.text;
  stack.preset.overrides = question.overrides;
  stack.preset.arguments = question.arguments;
  AFTERGLOW_TRY(const auto session, Session::open(question.preset, {.device = device, .stack = stack}, silent));
  const Picture& picture = question.picture->picture;
  AFTERGLOW_TRY(auto build, session->evaluate(context_of(picture, question.context)));
  const FrameRequest request = request_for(std::move(build));
  Picture made = picture;
  AFTERGLOW_CHECK(session->process(made, request));
  FiniteAnswer out{.name = question.name, .frame = question.context.frame, .passes = {}};
  if (!session->report().flagged) return out;
  made = {};
  AFTERGLOW_TRY(Trace trace, session->trace(picture, request, NanPolicy::zero));
  set_places(trace.passes, picture);
  out.untraced = trace.passes.empty() && trace.overflows.empty();
  out.passes = std::move(trace.passes);
  return out;
}

}  // namespace

struct FiniteWatch::State {
  FiniteWatchOptions options;
  StackOptions stack;
  std::function<void()> answered;

  std::mutex mutex;
  std::condition_variable changed;
  bool ends = false, works = false, hurries = false;
  std::optional<FiniteQuestion> question;
  Clock::time_point asked;
  std::optional<FiniteAnswer> newest;
  std::thread thread;  // last: it uses the rest

  void run();
};

void FiniteWatch::State::run() {
  give_way();
  std::unique_lock lock(mutex);
  while (!ends) {
    if (!question || (options.until_asked && !hurries)) {
      changed.wait(lock);
      continue;
    }
    if (const auto begins = asked + kQuiet; !hurries && Clock::now() < begins) {
      changed.wait_until(lock, begins);
      continue;
    }
    const FiniteQuestion one = *std::exchange(question, std::nullopt);
    works = true;
    lock.unlock();
    auto found = without_exceptions([&] { return answer(options.device, stack, one); });
    lock.lock();
    works = false;
    if (found) newest = std::move(found).value();
    changed.notify_all();
    lock.unlock();
    answered();
    lock.lock();
  }
}

FiniteWatch::FiniteWatch(FiniteWatchOptions options, StackOptions stack, std::function<void()> answered)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.options = std::move(options);
  s.options.device.presentation = nullptr;
  s.stack = std::move(stack);
  s.stack.keep_images = false;
  s.stack.spare_programs = 0;
  s.stack.flag_non_finite = true;
  s.stack.preset.leave_out_unfit = true;
  s.answered = std::move(answered);
  s.thread = std::thread([&s] { s.run(); });
}

FiniteWatch::~FiniteWatch() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ends = true;
  }
  state_->changed.notify_all();
  state_->thread.join();
}

void FiniteWatch::ask(FiniteQuestion question) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->question = std::move(question);
    state_->asked = Clock::now();
  }
  state_->changed.notify_all();
}

void FiniteWatch::finish() {
  State& s = *state_;
  std::unique_lock lock(s.mutex);
  s.hurries = true;
  s.changed.notify_all();
  s.changed.wait(lock, [&] { return !s.question && !s.works; });
  s.hurries = false;
}

std::optional<FiniteAnswer> FiniteWatch::take() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->newest, std::nullopt);
}

}  // namespace afterglow
