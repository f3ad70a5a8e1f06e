// SPDX-License-Identifier: MIT
// What a Program is made of. For program.cpp and the files that make and record it.
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "exec/arena.h"
#include "exec/barriers.h"
#include "exec/data_images.h"
#include "exec/describe.h"
#include "exec/descriptors.h"
#include "exec/histories.h"
#include "exec/kernel_pipelines.h"
#include "exec/loop_watch.h"
#include "exec/parameters.h"
#include "exec/program.h"
#include "exec/record.h"

namespace afterglow {

struct Program::State {
  State(Device& device_in, const Graph& graph_in, const ProgramOptions& options_in)
      : device(device_in), graph(graph_in), options(options_in) {}

  Device& device;
  Graph graph;
  ProgramOptions options;  ///< with what is left of the wished execution
  VkFormat format = VK_FORMAT_UNDEFINED;
  Plan plan;
  Regions parts;
  /// Of the plan's kernels, see graph/changes.h: what each does but for its parameters, what the images that are not of
  /// a pool hold, and of the run that began what images will hold, and which kernels run.
  std::vector<Hash> identities;
  std::vector<std::optional<Hash>> made;
  std::vector<Hash> making;
  std::vector<bool> running;
  std::uint64_t serial = 0;  ///< Program::id

  CompiledKernels compiled;
  std::vector<std::vector<ImageId>>
      images;  ///< to bind, parallel to the plan's kernels; of compute kernels also the target
  std::vector<std::vector<ImageId>> reads;  ///< what must be ready to be read before each kernel
  ParameterBuffer parameters;
  LoopWatch loops;
  Arena arena;
  DataImages data;
  KernelPipelines pipelines;             ///< of compiled.unique
  GpuImage marks;                        ///< for kernels with two draws, as large as the largest of them
  SamplerHandle sampler, interpolating;  ///< the second where the device's samplers interpolate, else null
  /// What one frame in flight finds behind its descriptors: see `Program::bind`.
  struct Place {
    Descriptors descriptors;  ///< one set for each SetOf and kernel
    std::map<ImageId, ImageBinding> inputs{};
    std::vector<VkImageView> result{};
    bool bound = false;
    int bindings = 0;  ///< how often `bound` changed
  };
  std::vector<Place> places;
  /// By which of a history's two images is the previous one; alike without histories.
  std::array<std::vector<KernelCommands>, 2> kernels;
  KernelBarriers begin;  ///< before the first kernel
  int result_rows = 1;
  bool linear = false;                   ///< images between kernels stay in GENERAL
  int uses = 0;                          ///< of histories
  std::shared_ptr<Histories> histories;  ///< null when the graph has none
  std::uint64_t history_images = 0;      ///< Histories::images_id of those that it was pointed at

  /// Sets of descriptors for each kernel: one for each image that a history's previous one may be, and one for frames
  /// that have none before them.
  enum SetOf { kEven = 0, kOdd = 1, kFirst = 2, kSets = 3 };
  std::size_t set_index(int which, std::size_t kernel) const {
    return static_cast<std::size_t>(which) * plan.kernels.size() + kernel;
  }
  int sets() const { return histories ? kSets : 1; }
  int parity() const { return histories ? histories->previous() : 0; }

  /// Images between kernels; one layout for both ways of reading.
  VkImageLayout read_layout() const {
    return options.config.storage_reads || linear ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }
  /// Histories are never linear: kernels that make them write one row at a time.
  VkImageLayout history_layout() const {
    return options.config.storage_reads ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }
  VkImageLayout input_layout() const {
    return options.inputs_are_storage && options.config.storage_reads ? VK_IMAGE_LAYOUT_GENERAL
                                                                      : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }
  VkImageLayout target_layout(ImageId output) const;
  /// Whether the result's image may be one that compute shaders store into.
  bool may_store_result() const;
  bool stores_result() const;
  VkFormat result_format() const { return options.unorm8 ? VK_FORMAT_R8G8B8A8_UNORM : format; }
  VkFormat image_format(ImageId image) const;
  ImageDesc result_desc() const;
  const CompiledKernel& compiled_of(std::size_t kernel) const { return compiled.unique[compiled.index[kernel]]; }

  // program_make.cpp
  void settle_config();
  void settle_workgroups(ShaderLibrary& shaders);
  Result<void> check();
  bool share_too_much() const;
  std::vector<Size> blocks() const;
  Result<void> find_parts();
  Result<std::vector<KernelDesc>> describe(ShaderLibrary& shaders);
  bool from_pool() const { return options.images && options.keep_images && !options.reference; }
  ArenaOptions arena_options(const std::vector<KernelDesc>& descs) const;
  bool can_be_linear() const;
  Result<void> settle_rows(KernelCompiler& compiler, std::vector<KernelDesc>& descs);
  Result<void> make_images(std::vector<KernelDesc>& descs);
  Result<void> take_images(const std::vector<KernelDesc>& descs);
  std::vector<ImageId> reads_of(const std::vector<ImageId>& bound) const;
  Result<void> compile(KernelCompiler& compiler, const std::vector<KernelDesc>& descs);
  Result<void> settle_and_compile(KernelCompiler& compiler, std::vector<KernelDesc>& descs);
  Result<void> make_pipelines();
  Result<void> make_marks();
  Result<void> make_place();
  Result<void> make_histories();

  // program.cpp
  void bring_along(const Graph& given);

  // program_reuse.cpp
  void identify();
  std::vector<Hash> content(const InputVersions& inputs) const;
  std::optional<Hash>& holds(std::size_t kernel);

  // program_images.cpp
  /// An image as kernels find it.
  struct Seen {
    VkImageView view = VK_NULL_HANDLE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  };
  using Look = std::function<Seen(ImageId)>;
  bool interpolates(std::size_t kernel, std::size_t slot) const {
    const auto& slots = compiled_of(kernel).images;
    return slot < slots.size() && slots[slot].interpolated;
  }
  void write_set(const Place& place, int which, const Look& look) const;
  Seen look_between(ImageId image) const;
  Seen look_at_input(const Place& place, ImageId image) const;
  Seen look_at_history(ImageId image, int parity) const;
  Seen look_in_first_frame(const Place& place, ImageId image) const;
  void show_histories(const Place& place) const;
  const GpuImage* history_image(ImageId image, int parity) const;
  bool lacks_previous(const History& history) const { return !histories->has_previous(history.name); }
  bool begins_anew() const;
  Result<void> use(std::shared_ptr<Histories> given);

  // program_record.cpp
  VkImage barrier_image(ImageId id, int parity) const;
  void make_commands();
  void begin_recording(VkCommandBuffer commands, const Place& place) const;
  VkDescriptorSet set_of(const Place& place, std::size_t kernel) const;
  KernelCommands commands_alone(std::size_t kernel) const;
  void record_all(VkCommandBuffer commands, const Place& place, const std::function<void(std::size_t)>& stamp) const;
  void record_some(VkCommandBuffer commands, const Place& place, const std::vector<bool>& run,
                   const std::function<void(std::size_t)>& stamp) const;
};

}  // namespace afterglow
