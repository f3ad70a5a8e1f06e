// SPDX-License-Identifier: MIT
// Which images the kernels of a Program find behind their descriptors.
#include <fmt/format.h>

#include <algorithm>

#include "exec/program_state.h"
#include "graph/history.h"

namespace afterglow {

/// Every slot of these sets for which `look` knows an image.
void Program::State::write_set(const Place& place, int which, const Look& look) const {
  for (std::size_t i = 0; i < images.size(); ++i)
    for (std::size_t slot = 0; slot < images[i].size(); ++slot) {
      Seen seen = look(images[i][slot]);
      if (images[i][slot] == plan.kernels[i].output) seen.layout = VK_IMAGE_LAYOUT_GENERAL;  // it is stored to
      if (seen.view != VK_NULL_HANDLE)
        place.descriptors.write_image(set_index(which, i), slot, seen.view, seen.layout,
                                      interpolates(i, slot) ? interpolating.get() : sampler.get());
    }
}

/// Images between passes, and those that the graph brings along.
Program::State::Seen Program::State::look_between(ImageId image) const {
  if (const GpuImage* brought = data.image(image)) return {brought->view(), data.layout()};
  const UnboundImage* found = arena.image(image);
  return found ? Seen{found->view(), read_layout()} : Seen{};
}

Program::State::Seen Program::State::look_at_input(const Place& place, ImageId image) const {
  const auto found = place.inputs.find(image);
  if (found == place.inputs.end()) return {};
  return {found->second.view, input_layout()};
}

const GpuImage* Program::State::history_image(ImageId image, int parity) const {
  if (!histories) return nullptr;
  if (const History* history = history_of_previous(graph, image)) return histories->image(history->name, parity);
  if (const History* history = history_of_next(graph, image)) return histories->image(history->name, 1 - parity);
  return nullptr;
}

Program::State::Seen Program::State::look_at_history(ImageId image, int parity) const {
  const GpuImage* found = history_image(image, parity);
  return found ? Seen{found->view(), history_layout()} : Seen{};
}

/// As the frame that began finds them: histories without a frame before it may have a first image instead.
Program::State::Seen Program::State::look_in_first_frame(const Place& place, ImageId image) const {
  const History* history = history_of_previous(graph, image);
  if (history && history->first != kNoImage && lacks_previous(*history))
    return look_in_first_frame(place, history->first);
  if (const Seen seen = look_at_history(image, parity()); seen.view != VK_NULL_HANDLE) return seen;
  if (const Seen seen = look_between(image); seen.view != VK_NULL_HANDLE) return seen;
  return look_at_input(place, image);
}

void Program::State::show_histories(const Place& place) const {
  for (const int parity : {kEven, kOdd})
    write_set(place, parity, [&](ImageId id) { return look_at_history(id, parity); });
}

/// Whether some history has nothing of the frame before.
bool Program::State::begins_anew() const {
  return histories && std::ranges::any_of(graph.histories, [this](const auto& h) { return lacks_previous(h); });
}

Result<void> Program::State::use(std::shared_ptr<Histories> given) {
  if (graph.histories.empty()) return {};
  if (given && given->images_id() == history_images) return {};
  for (const auto& history : graph.histories) {
    const GpuImage* image = given ? given->image(history.name, 0) : nullptr;
    if (!image || image->desc().size != graph.images[history.next].size ||
        image->desc().format != image_format(history.next))
      return Error{ErrorKind::other, fmt::format("there are no images for the history '{}'", history.name)};
  }
  history_images = 0;  // of none, until all that follows is done: what is left of it by an exception is done again
  ++uses;
  histories = std::move(given);
  for (const Place& place : places) show_histories(place);
  make_commands();
  history_images = histories->images_id();
  return {};
}

}  // namespace afterglow
