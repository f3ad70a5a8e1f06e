// SPDX-License-Identifier: MIT
// What has to run of a Program, and what its images hold.
#include <algorithm>
#include <bit>
#include <map>

#include "exec/host_input.h"
#include "exec/program_state.h"
#include "graph/changes.h"
#include "graph/history.h"

namespace afterglow {

/// Of each kernel, all that decides its image but the values of parameters and what it reads: equal ones in two
/// programs can take each other's place. Equal kernels within one program differ by their turn.
void Program::State::identify() {
  std::map<ImageId, Hash> known;
  std::map<Hash, std::uint64_t> turns;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    const ImageId output = plan.kernels[i].output;
    const CompiledKernel& kernel = compiled_of(i);
    const auto number = [](auto value) { return static_cast<std::uint64_t>(value); };
    Hasher hasher;
    hasher.add(kernel.hash.high).add(kernel.hash.low).add(number(kernel.rows)).add(number(image_format(output)));
    const GraphImage& image = graph.images[output];
    hasher.add(number(image.size.width)).add(number(image.size.height));
    const Rect& part = parts.kernels[i];
    for (const int value : {part.x, part.y, part.width, part.height}) hasher.add(number(value));
    hasher.add(number(linear)).add(number(options.config.storage_reads)).add(number(options.config.hardware_filter));
    for (const ImageId read : images[i]) {
      if (read == output) continue;  // a compute kernel stores to it
      const GraphImage& from = graph.images[read];
      hasher.add(number(from.size.width)).add(number(from.size.height));
      if (const auto made_before = known.find(read); made_before != known.end())
        hasher.add(made_before->second.high).add(made_before->second.low);
      else if (from.data)
        hasher.add("brought along");  // by the look: what it holds may change
      else
        hasher.add(from.name);  // of an input or a history
    }
    const Hash alike = hasher.finish();
    hasher.add(turns[alike]++);
    identities.push_back(hasher.finish());
    known[output] = identities.back();
  }
}

/// What each kernel's image holds once it has run, see graph/changes.h.
std::vector<Hash> Program::State::content(const InputVersions& given) const {
  std::map<ImageId, std::uint64_t> versions;
  for (const auto& [name, id] : inputs_of(graph))
    if (const auto version = given.find(name); version != given.end()) versions[id] = version->second;
  const auto brought = [&](ImageId id) {
    if (graph.images[id].data) return graph.images[id].data->hash;
    Hasher hasher;
    if (const History* history = history_of_previous(graph, id)) {
      hasher.add(histories->turn());
      for (const double value : history->initial) hasher.add(std::bit_cast<std::uint64_t>(value));
    } else if (const auto version = versions.find(id); version != versions.end()) {
      hasher.add(version->second);
    }
    return hasher.finish();
  };
  std::vector<Hash> own;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    Hasher hasher;
    hasher.add(identities[i].high).add(identities[i].low).add(parameters.bytes(i));
    // What is handed on goes into the other image in every frame.
    if (histories && history_of_next(graph, plan.kernels[i].output)) hasher.add(histories->turn());
    own.push_back(hasher.finish());
  }
  return content_keys(graph, plan, own, brought);
}

std::optional<Hash>& Program::State::holds(std::size_t kernel) {
  PooledImage* pooled = arena.pooled(plan.kernels[kernel].output);
  return pooled ? pooled->holds : made[kernel];
}

std::uint64_t Program::runaways() const { return state_->loops.runaways(); }

Result<void> Program::check_loops(std::uint64_t since) {
  State& s = *state_;
  AFTERGLOW_CHECK(s.loops.look());
  if (s.loops.runaways() == since) return {};
  for (std::size_t i = 0; i < s.plan.kernels.size(); ++i) s.holds(i).reset();
  if (s.histories) s.histories->reset();
  return s.loops.error();
}

Result<void> Program::forget_runaways() { return state_->loops.look(); }

std::vector<bool> Program::begin_run(const InputVersions& inputs, bool result_lost) {
  State& s = *state_;
  const std::size_t count = s.plan.kernels.size();
  s.making = s.content(inputs);
  std::vector<bool> stale(count);
  for (std::size_t i = 0; i < count; ++i)
    stale[i] = s.holds(i) != s.making[i] || (result_lost && s.plan.kernels[i].output == s.graph.result);
  s.running = kernels_to_run(s.graph, s.plan, stale);
  const bool any = std::ranges::find(s.running, true) != s.running.end();
  if (any && !s.options.keep_images) {  // the others share memory: they hold nothing from frame to frame
    for (std::size_t i = 0; i < count; ++i) stale[i] = stale[i] || !s.plan.once[i];
    s.running = kernels_to_run(s.graph, s.plan, stale);
  }
  for (std::size_t i = 0; i < count; ++i)
    if (s.running[i]) s.holds(i).reset();
  return s.running;
}

void Program::up_to_date() {
  State& s = *state_;
  for (std::size_t i = 0; i < s.running.size(); ++i)
    if (s.running[i]) s.holds(i) = s.making[i];
  if (s.histories) s.histories->made();
}

}  // namespace afterglow
