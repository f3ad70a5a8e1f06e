// SPDX-License-Identifier: MIT
#include "exec/histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/memory_limit.h"
#include "core/text.h"
#include "exec/few_channels.h"
#include "graph/history.h"

namespace afterglow {
namespace {

/// Numbers of frames may be computed from times.
bool same_frame(double a, double b) { return std::abs(a - b) < 1e-6; }

ImageDesc desc_of(const Graph& graph, const History& history, const Histories::Options& options) {
  // What is made from itself adds up its errors, frame for frame: full floats unless the effect says otherwise.
  const bool half = options.half && !history.precise;
  const int channels = options.four_channels ? 4 : graph.images[history.previous].channels;
  return {.name = history.name,
          .size = graph.images[history.next].size,
          .format = float_format(channels, half),
          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                   (options.storage ? VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT} : 0)};
}

bool fits(const ImageDesc& has, const ImageDesc& wanted) {
  return has.size == wanted.size && has.format == wanted.format && (has.usage & wanted.usage) == wanted.usage;
}

std::uint64_t bytes_of(const ImageDesc& desc) {
  return 2 * static_cast<std::uint64_t>(desc.size.area()) * bytes_per_pixel(desc.format);
}

}  // namespace

std::uint64_t Histories::next_number() {
  static std::atomic<std::uint64_t> numbers = 0;
  return ++numbers;
}

Result<Histories::Kept> Histories::make(const Device& device, const std::string& name, const Hash& part,
                                        ImageDesc desc) {
  Kept kept{.part = part, .images = {}};
  for (int i = 0; i < 2; ++i) {
    desc.name = fmt::format("{} {}", name, i == 0 ? "even" : "odd");
    AFTERGLOW_CHECK(check_image(device, desc));
    AFTERGLOW_TRY(kept.images[static_cast<std::size_t>(i)], GpuImage::create(device, desc));
  }
  return kept;
}

Histories::Options Histories::options_for(const Device& device, const Graph& graph, const ExecutionConfig& config,
                                          std::uint64_t max_memory) {
  return {.half = config.storage == Storage::fp16,
          .storage = config.storage_reads || config.dispatched,
          .four_channels = config.four_channels || !holds_few_channels(device, graph, config),
          .max_memory = max_memory};
}

Result<void> Histories::fit(const Device& device, const Graph& graph, const Options& options) {
  std::uint64_t total = 0;
  std::map<std::string, ImageDesc> wanted;
  for (const auto& history : graph.histories) {
    wanted[history.name] = desc_of(graph, history, options);
    total += bytes_of(wanted[history.name]);
  }
  if (total > options.max_memory)
    return Error{ErrorKind::io, fmt::format("the stack needs {} for its histories, more than the {}",
                                            needed_memory(total), allowed_memory(options.max_memory))};
  if (std::erase_if(kept_, [&](const auto& kept) { return !wanted.contains(kept.first); }) > 0)
    images_id_ = next_number();
  for (const auto& history : graph.histories) {
    const Hash part = history_part(graph, history);
    const ImageDesc& desc = wanted.at(history.name);
    const auto found = kept_.find(history.name);
    if (found != kept_.end() && found->second.part == part && fits(found->second.images[0].desc(), desc)) continue;
    turn_ = images_id_ = next_number();
    if (found != kept_.end() && found->second.next_holds && std::ranges::count(replaced_, history.name) == 0)
      replaced_.push_back(history.name);
    kept_.erase(history.name);  // before the new ones are made: they need not exist at once
    AFTERGLOW_TRY(Kept kept, make(device, history.name, part, desc));
    kept_.emplace(history.name, std::move(kept));
  }
  return {};
}

void Histories::take(Histories& other) {
  for (auto& [name, kept] : kept_) {
    const auto found = other.kept_.find(name);
    if (found == other.kept_.end() || found->second.part != kept.part ||
        !fits(found->second.images[0].desc(), kept.images[0].desc()))
      continue;
    kept = std::move(found->second);
  }
  previous_ = other.previous_;
  before_ = other.before_;
  begun_ = other.begun_;
  made_ = other.made_;
  turn_ = images_id_ = next_number();
  other.kept_.clear();
  other.images_id_ = next_number();
  other.reset();
}

void Histories::begin(double frame, double step, bool restart) {
  if (!restart && begun_ && same_frame(*begun_, frame)) {
    return;  // once more
  }
  const auto follows = [&](const std::optional<double>& last) { return last && same_frame(*last + step, frame); };
  turn_ = next_number();
  if (!restart && follows(made_)) {
    previous_ = 1 - previous_;
    before_ = made_;
    for (auto& [name, kept] : kept_) kept.previous_holds = std::exchange(kept.next_holds, false);
  } else if (restart || made_ || !follows(before_)) {
    before_.reset();
    for (auto& [name, kept] : kept_) kept.previous_holds = kept.next_holds = false;
  }  // else a frame began that was never made: this one takes its place
  begun_ = frame;
  made_.reset();
}

void Histories::made() {
  made_ = begun_;
  for (auto& [name, kept] : kept_) kept.next_holds = true;
}

void Histories::reset() {
  before_.reset();
  begun_.reset();
  made_.reset();
  for (auto& [name, kept] : kept_) kept.previous_holds = kept.next_holds = false;
}

bool Histories::has_previous(const std::string& name) const {
  const auto found = kept_.find(name);
  return before_ && found != kept_.end() && found->second.previous_holds;
}

const GpuImage* Histories::image(const std::string& name, int which) const {
  const auto found = kept_.find(name);
  return found == kept_.end() ? nullptr : &found->second.images[static_cast<std::size_t>(which)];
}

std::uint64_t Histories::bytes() const {
  std::uint64_t total = 0;
  for (const auto& [name, kept] : kept_) total += bytes_of(kept.images[0].desc());
  return total;
}

}  // namespace afterglow
