// SPDX-License-Identifier: MIT
#include "batch/sequence_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "image/sequence.h"

namespace afterglow {
namespace {

bool has_name(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

std::string numbers_text(std::vector<int> frames) {
  std::ranges::sort(frames);
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return (frames.size() == 1 ? "frame " : "frames ") + frames_text(frames);
}

bool is_numbered(const FrameJob& job) { return !job.movie && own_frame_number(job.input).has_value(); }

/// "layer:albedo" is the layer albedo.
std::string input_text(const std::string& name) {
  constexpr std::string_view kLayer = "layer:";
  return name.starts_with(kLayer) ? "layer '" + name.substr(kLayer.size()) + "'" : name;
}

void tell_inputs(const std::string& file, const SequenceInputs& inputs, const RunEvents& events) {
  for (const auto& [name, input] : inputs) {
    if (!input.elsewhere) continue;
    const std::string what = input_text(name), other = input.elsewhere->filename().string();
    if (!input.failed.empty())
      events.failed({ErrorKind::io,
                     fmt::format("{}: no {}, which '{}' needs and other frames have, as {}; required = false in its "
                                 "entry makes such frames without it",
                                 numbers_text(input.failed), what, input.effect, other),
                     file});
    if (input.without.empty()) continue;
    const std::string made =
        input.effect.empty() ? "what uses it was made without" : "'" + input.effect + "' was skipped";
    events.diagnostics.warn(fmt::format("{}: {}: no {}, which other frames have, as {}: {}", file,
                                        numbers_text(input.without), what, other, made));
  }
}

std::string overscan_text(const Overscan& overscan) {
  if (overscan == Overscan{}) return "none";
  return fmt::format("{} pixels left, {} above, {} right, {} below", overscan[0], overscan[1], overscan[2],
                     overscan[3]);
}

void tell_overscan(const std::string& file, const SequenceOverscan& overscan, Diagnostics& diagnostics) {
  if (overscan.size() < 2) return;
  const auto usual = std::ranges::max_element(overscan, {}, [](const auto& one) { return one.second.size(); });
  std::vector<int> others;
  for (auto one = overscan.begin(); one != overscan.end(); ++one)
    if (one != usual) others.insert(others.end(), one->second.begin(), one->second.end());
  diagnostics.warn(
      fmt::format("{}: {}: the overscan is another than in other frames, which have {}: centres, heights "
                  "and data windows of EXRs jump; --overscan cut leaves it out of all",
                  file, numbers_text(others), overscan_text(usual->first)));
}

}  // namespace

void SequenceRecord::know(const FrameRecords& frames, Inputs inputs) {
  frames_ = &frames;
  inputs_ = std::move(inputs);
}

/// Looks at the neighbours first, then at so many frames all over the sequence.
bool SequenceRecord::is_elsewhere(const FrameJob& job, const std::string& name, SequenceInput& input) const {
  if (input.elsewhere) return true;
  if (!frames_ || std::exchange(input.looked, true)) return false;
  constexpr std::size_t kMost = 32;
  const std::string sequence = without_frame_number(job.input);
  std::vector<const FrameJob*> others, asked;
  for (const FrameRecord& frame : *frames_)
    if (frame.job.input != job.input && is_numbered(frame.job) && without_frame_number(frame.job.input) == sequence)
      others.push_back(&frame.job);
  const auto behind = std::ranges::find_if(others, [&](const FrameJob* other) { return other->frame > job.frame; });
  if (behind != others.end()) asked.push_back(*behind);
  if (behind != others.begin()) asked.push_back(*(behind - 1));
  const std::size_t some = std::min(kMost, others.size());
  for (std::size_t i = 0; i < some; ++i) asked.push_back(others[i * others.size() / some]);
  for (const FrameJob* other : asked) {
    if (!has_name(inputs_(*other), name)) continue;
    input.elsewhere = other->input;
    return true;
  }
  return false;
}

void SequenceRecord::warn_skipped(const Skipped& skipped) const {
  const std::string text = fmt::format("effect '{}' is skipped: {}", skipped.name, skipped.reason);
  diagnostics_->warn_once(text, text);
}

std::optional<Error> SequenceRecord::add_input(const FrameJob& job, const std::string& name, SequenceInput& input,
                                               const Build& build) const {
  const Skipped* lacking = nullptr;
  for (const Skipped& one : build.graph.skipped)
    if (has_name(one.lacks, name) && (!lacking || lacking->can_lack)) lacking = &one;
  const bool elsewhere = lacking && is_elsewhere(job, name, input);
  if (lacking && input.effect.empty()) input.effect = lacking->name;
  if (!lacking || !elsewhere || lacking->can_lack) {
    if (lacking && !elsewhere) warn_skipped(*lacking);
    input.without.push_back(job.frame);
    return std::nullopt;
  }
  input.failed.push_back(job.frame);
  return Error{ErrorKind::io,
               fmt::format("has no {}, which '{}' needs and others have, as {}", input_text(name), lacking->name,
                           input.elsewhere->filename().string()),
               job.input.string()};
}

std::optional<Error> SequenceRecord::add(FrameRecord& frame, const PictureHeader& header,
                                         const std::vector<std::string>& wanted, const Build& build) {
  if (!taken_ || *taken_ != header.taken)
    taken_ = std::make_shared<const std::map<std::string, std::string>>(header.taken);
  frame.taken = taken_;
  const FrameJob& job = frame.job;
  if (!is_numbered(job)) {
    for (const Skipped& one : build.graph.skipped)
      if (!one.lacks.empty()) warn_skipped(one);
    return std::nullopt;
  }
  Sequence& sequence = sequences_[without_frame_number(job.input)];
  const Rect &data = header.data_window, &display = header.display_window;
  const Overscan around{display.x - data.x, display.y - data.y, data.x + data.width - display.x - display.width,
                        data.y + data.height - display.y - display.height};
  sequence.overscan[around].push_back(job.frame);
  std::optional<Error> error;
  for (const std::string& name : wanted) {
    SequenceInput& input = sequence.inputs[name];
    if (has_name(header.auxiliary, name)) {
      if (!input.elsewhere) input.elsewhere = job.input;
      continue;
    }
    auto lacking = add_input(job, name, input, build);
    if (!error) error = std::move(lacking);
  }
  return error;
}

void SequenceRecord::sum_up(const RunEvents& events, bool whole) {
  for (const auto& [file, sequence] : std::exchange(sequences_, {})) {
    tell_inputs(file, sequence.inputs, events);
    if (whole) tell_overscan(file, sequence.overscan, events.diagnostics);
  }
}

}  // namespace afterglow
