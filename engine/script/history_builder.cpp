// SPDX-License-Identifier: MIT
// GraphBuilder: images that are handed from frame to frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "graph/history.h"
#include "script/graph_builder.h"

namespace afterglow::script {
namespace {

constexpr int kMostPreRoll = 10'000;
constexpr std::size_t kMostHistories = 64;
/// Of histories that are made from themselves and do not say how soon they forget.
constexpr int kUsualPreRoll = 24;

}  // namespace

void GraphBuilder::fail_history(const History& history, const std::string& message, KeyPath key,
                                std::string allowed) const {
  throw failure(fmt::format("history '{}' of effect '{}': {}", history.name, entry_->effect, message), std::move(key),
                std::move(allowed));
}

ImageRef GraphBuilder::history(const HistoryRequest& request, const CallPlace& place) {
  History history;
  history.effect = entry_->name;
  history.name = start("history", request.name, place).name;
  names_.try_emplace(history.name, 1);
  if (graph_.histories.size() >= kMostHistories)
    fail_history(history, fmt::format("more than {} histories", kMostHistories));
  if (request.first && request.first->build != build_)
    fail_history(history, "'first' is an image of another run of build", {"first"});
  const History* const looked_back = request.first ? history_of_previous(graph_, request.first->id) : nullptr;
  if (looked_back && looked_back->effect == history.effect)
    fail_history(history, "'first' is itself an image of an earlier frame", {"first"},
                 "an image of this frame, numbers");
  if (!request.size && !request.first)
    fail_history(history, "its size is not known", {}, "size = an image, {width, height}; first = an image");
  const Size size = request.size.value_or(request.first ? request.first->size : Size{});
  Pass named;
  named.name = history.name;
  check_size(named, size);
  if (request.first && request.first->size != size)
    fail_history(history,
                 fmt::format("'first' is {}×{}, the history {}×{}", request.first->size.width,
                             request.first->size.height, size.width, size.height),
                 {"first"}, fmt::format("{}×{}", size.width, size.height));
  for (const double value : request.initial)
    if (!std::isfinite(static_cast<float>(value))) fail_history(history, "'first' is not finite", {"first"});
  if (const auto wrong = wrong_channels(request.channels)) fail_history(history, *wrong, {"channels"}, kChannelCounts);
  const int channels = static_cast<int>(request.channels.value_or(4));
  if (request.first && channels != 4)
    fail_history(history, "'first' is an image, which is for histories of four channels", {"first"}, "numbers");
  const double pre_roll = request.pre_roll.value_or(-1);
  if (request.pre_roll && !(pre_roll >= 0 && pre_roll <= kMostPreRoll && pre_roll == std::floor(pre_roll)))
    fail_history(history, fmt::format("pre_roll = {} is no number of frames", number_text(pre_roll)), {"pre_roll"},
                 fmt::format("integer 0…{}", kMostPreRoll));
  // What another effect looks back at may be this one's source: to it that is an image of this frame.
  if (request.first) history.first = looked_back ? copy_of(request.first->id, channels, place) : request.first->id;
  history.previous = add_image(history.name, size, -1);
  graph_.images.back().channels = channels;
  history.initial = request.initial;
  // What is not kept reads as of passes: 0, an alpha of 1.
  if (channels < 4) history.initial[2] = 0, history.initial[3] = 1;
  if (channels < 2) history.initial[1] = 0;
  history.precise = request.precise;
  history.pre_roll = static_cast<int>(pre_roll);
  open_histories_.emplace_back(history.name, place);
  graph_.histories.push_back(history);
  return ref(history.previous);
}

History* GraphBuilder::history_of(const ImageRef& image) {
  const auto found = std::ranges::find(graph_.histories, image.id, &History::previous);
  return image.build == build_ && found != graph_.histories.end() ? &*found : nullptr;
}

/// Whether its next image is made from the previous one, so that what was long ago still counts.
bool GraphBuilder::depends_on_history(const History& history) const {
  std::vector<bool> depends(graph_.images.size(), false);
  for (const auto& other : graph_.histories)
    if (other.effect == history.effect) depends[other.previous] = true;
  for (const auto& pass : graph_.passes)
    for (const auto& input : pass.inputs)
      if (depends[input.image]) depends[pass.output] = true;
  return depends[history.next];
}

ImageId GraphBuilder::copy_of(ImageId image, int channels, const CallPlace& place) {
  Pass pass = start("keep", {}, place);
  pass.kind = PassKind::filter;
  pass.filter.interpolation = Interpolation::nearest;
  pass.inputs.push_back({"source", image, false});
  const auto at = static_cast<std::size_t>(image);
  return add(std::move(pass), graph_.images[at].size, channels, graph_.images[at].precise).id;
}

void GraphBuilder::keep(const ImageRef& image, const ImageRef& next, const CallPlace& place) {
  History* history = history_of(image);
  if (!history || history->effect != entry_->name)
    throw failure(fmt::format("effect '{}': g:keep: the first image is no history of this effect", entry_->effect), {},
                  "what g:history returned");
  if (next.build != build_) fail_history(*history, "g:keep was given an image of another run of build");
  if (history->next != kNoImage) fail_history(*history, "g:keep was called for it before");
  if (next.size != image.size)
    fail_history(*history,
                 fmt::format("it is {}×{}, but is to keep {}×{}", image.size.width, image.size.height, next.size.width,
                             next.size.height),
                 {}, fmt::format("{}×{}", image.size.width, image.size.height));
  // What is kept lies in memory of its own: inputs do not, and two histories cannot share one image.
  const GraphImage& given = graph_.images[static_cast<std::size_t>(next.id)];
  const bool needs_copy = given.producer < 0 || is_computed(graph_, next.id) || history_of_next(graph_, next.id);
  const int channels = graph_.images[static_cast<std::size_t>(image.id)].channels;
  if (given.channels > channels && !needs_copy)
    fail_history(*history, fmt::format("it has {} channels, but is to keep an image of {}", channels, given.channels),
                 {}, fmt::format("channels = {} of what makes the image", channels));
  history->next = needs_copy ? copy_of(next.id, std::min(channels, given.channels), place) : next.id;
  if (history->pre_roll < 0) history->pre_roll = depends_on_history(*history) ? kUsualPreRoll : 1;
  std::erase_if(open_histories_, [&](const auto& open) { return open.first == history->name; });
}

void GraphBuilder::end() {
  if (open_histories_.empty()) return;
  const auto& [name, place] = open_histories_.front();
  throw ScriptError{
      {ErrorKind::script,
       fmt::format("history '{}' of effect '{}' is given nothing to keep for the next frame", name, entry_->effect),
       place.file,
       place.line,
       "g:keep(history, image)",
       {},
       {}}};
}

}  // namespace afterglow::script
