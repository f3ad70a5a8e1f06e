// SPDX-License-Identifier: MIT
// KernelCompiler: memory cache, disk cache, compiler, in this order.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <system_error>

#include "core/cache_folder.h"
#include "core/file.h"
#include "shader/cpu/defeat_uniform_inlining.h"
#include "shader/cpu/interleave.h"
#include "shader/cpu/merge_equal.h"
#include "shader/give_values.h"
#include "shader/glsl.h"
#include "shader/guard_loops.h"
#include "shader/held_divisors.h"
#include "shader/kernel.h"
#include "shader/kernel_file.h"
#include "shader/loop_places.h"
#include "shader/reflect.h"
#include "shader/source_hash.h"
#include "shader/spirv_module.h"
#include "shader/spirv_passes.h"
#include "shader/unroll_arrays.h"
#include "shader/usable.h"
#include "shader/weight.h"

namespace afterglow {
namespace fs = std::filesystem;

const std::uint32_t kMaxLoopTurns = kMaxTurns;

struct KernelCompiler::State {
  /// One text; its mutex is held while it is being made, so that other threads wait for it instead of doing it again.
  struct Entry {
    std::mutex mutex;
    std::shared_ptr<const KernelFile> made;
    std::uint64_t used = 0;  ///< when, counted in kernels asked for
  };
  static constexpr std::size_t kMostEntries = 512;  ///< beyond, half of them go: those that were not wanted for longest

  fs::path folder;
  std::mutex mutex;
  std::map<Hash, std::shared_ptr<Entry>> entries;
  std::uint64_t asked = 0;
  std::atomic<std::uint64_t> saved = 0;
  std::atomic<int> compiled = 0, from_disk = 0, from_memory = 0;

  fs::path file_for(const Hash& text) const {
    static const std::string version = glsl_compiler_version();
    const Hash key = Hasher().add(text.hex()).add(version).add(kShaderSourceHash).finish();
    return folder / (key.hex() + ".kernel");
  }

  std::shared_ptr<Entry> entry(const Hash& text) {
    const std::lock_guard lock(mutex);
    if (entries.size() >= kMostEntries && !entries.contains(text)) forget_old();
    auto& entry = entries[text];
    if (!entry) entry = std::make_shared<Entry>();
    entry->used = ++asked;
    return entry;
  }

  void forget_old() {
    std::vector<std::uint64_t> used;
    for (const auto& [text, entry] : entries) used.push_back(entry->used);
    const auto middle = used.begin() + static_cast<std::ptrdiff_t>(used.size() / 2);
    std::nth_element(used.begin(), middle, used.end());
    std::erase_if(entries, [limit = *middle](const auto& entry) { return entry.second->used < limit; });
  }

  std::shared_ptr<const KernelFile> load(const AssembledKernel& assembled) const {
    if (folder.empty()) return nullptr;
    const fs::path file = file_for(assembled.hash);
    auto bytes = read_file(file);
    if (!bytes) return nullptr;
    auto kernel = decode(*bytes);
    if (!kernel || kernel->text != assembled.hash || kernel->offsets.size() != assembled.params.size()) return nullptr;
    note_cache_use(file);
    return std::make_shared<const KernelFile>(std::move(*kernel));
  }

  /// A cache that cannot be written is no cache, and no error.
  void save(const KernelFile& kernel) {
    if (folder.empty()) return;
    std::error_code ec;
    fs::create_directories(folder, ec);
    if (ec) return;
    const auto written = write_file_atomically(file_for(kernel.text), encode(kernel));
    static_cast<void>(written.ok());
    // Each edit of a shader leaves a file behind. Most processes write none, and need not look.
    constexpr std::uint64_t kTrimEvery = 128;
    if (saved++ % kTrimEvery == 0) trim_cache(folder, ".kernel");
  }
};

namespace {

/// Whether that is where the parameter's bytes go.
bool is_of(const Reflection::Member& member, const KernelParam& param) {
  return member.components == static_cast<std::uint32_t>(vector_length(param.type)) &&
         member.columns == static_cast<std::uint32_t>(std::max(matrix_side(param.type), 1)) &&
         member.elements == static_cast<std::uint32_t>(param.elements);
}

/// Compares what the compiler made with what the assembler promised; a difference is a fault of the engine.
Result<KernelFile> build(const AssembledKernel& assembled, const KernelDesc& desc) {
  constexpr int kTogether = 4;  // rows: more of them would not fit into a processor's registers
  KernelFile kernel;
  kernel.text = assembled.hash;
  const GlslStage stage = assembled.workgroup ? GlslStage::compute : GlslStage::fragment;
  const std::size_t bound = assembled.images.size() + (assembled.workgroup ? 1 : 0);  // and the target
  AFTERGLOW_TRY(kernel.spirv, compile_glsl(assembled.glsl, assembled.file_names, stage));
  AFTERGLOW_CHECK(check_weight(kernel.spirv, desc));
  AFTERGLOW_CHECK(check_usable(kernel.spirv, assembled, stage));
  ArraysUnrolled unrolled = unroll_over_arrays(std::move(kernel.spirv), desc.config.rows);
  kernel.spirv = std::move(unrolled.spirv);
  kernel.unset = read_before_written(kernel.spirv, assembled.unset);
  if (desc.config.guard_loops) {
    LoopsGuarded guarded = guard_loops(kernel.spirv, static_cast<std::uint32_t>(bound) + 1);
    kernel.spirv = std::move(guarded.spirv);
    if (guarded.guarded) {
      AFTERGLOW_TRY(kernel.loops, loop_places(assembled.glsl, stage, unrolled.loops));
    }
  }
  kernel.spirv = give_values(std::move(kernel.spirv));
  if (desc.config.rows > 1) {
    auto in_turns = interleave_rows(kernel.spirv, kTogether);
    kernel.rows_pay = in_turns.has_value();
    if (in_turns) kernel.spirv = std::move(*in_turns);
  }
  if (desc.config.rows > 1 && desc.sample) {
    constexpr double kWorthwhile = 1.25;  // times fewer reads
    MergedRows merged = merge_equal(std::move(kernel.spirv));
    kernel.spirv = std::move(merged.spirv);
    kernel.rows_pay =
        !merged.loops && static_cast<double>(merged.reads_before) > kWorthwhile * static_cast<double>(merged.reads);
  }
  // Behind what makes straight code of loops: most indices are constants then.
  AFTERGLOW_TRY(kernel.spirv, with_held_indices(kernel.spirv));
  kernel.spirv = with_held_divisors(std::move(kernel.spirv));
  if (desc.config.defeat_uniform_inlining) kernel.spirv = defeat_uniform_inlining(kernel.spirv);
  AFTERGLOW_TRY(const Reflection reflection, reflect(kernel.spirv));
  kernel.block_size = reflection.block_size;
  // Of a block that no shader reads the compiler leaves nothing: there are no bytes to give.
  const bool unread = reflection.members.empty();
  for (const auto& param : assembled.params) {
    if (unread) {
      kernel.offsets.push_back(KernelParam::kUnread);
      continue;
    }
    const auto member = reflection.members.find(fmt::format("ag_s{}_{}", param.stage, param.name));
    if (member == reflection.members.end() || !is_of(member->second, param))
      return Error{ErrorKind::other, fmt::format("parameter '{}' is not in the compiled shader", param.name)};
    kernel.offsets.push_back(member->second.offset);
  }
  if (!unread && reflection.members.size() != assembled.params.size())
    return Error{ErrorKind::other, "the compiled shader has other parameters than declared"};
  for (const auto binding : reflection.image_bindings)
    if (binding < 1 || binding > bound)
      return Error{ErrorKind::other, "the compiled shader has other images than declared"};
  return kernel;
}

}  // namespace

KernelCompiler::KernelCompiler(fs::path cache_folder) : state_(std::make_unique<State>()) {
  state_->folder = std::move(cache_folder);
}
KernelCompiler::~KernelCompiler() = default;

Result<CompiledKernel> KernelCompiler::compile(const KernelDesc& desc) {
  AFTERGLOW_TRY(AssembledKernel assembled, assemble(desc));
  return compile(desc, std::move(assembled));
}

Result<CompiledKernel> KernelCompiler::compile(const KernelDesc& desc, AssembledKernel assembled) {
  const auto entry = state_->entry(assembled.hash);
  std::shared_ptr<const KernelFile> made;
  {
    const std::lock_guard lock(entry->mutex);
    if (entry->made) {
      ++state_->from_memory;
    } else if ((entry->made = state_->load(assembled))) {
      ++state_->from_disk;
    } else {
      AFTERGLOW_TRY(KernelFile kernel, build(assembled, desc));
      ++state_->compiled;
      state_->save(kernel);
      entry->made = std::make_shared<const KernelFile>(std::move(kernel));
    }
    made = entry->made;
  }
  CompiledKernel out;
  out.spirv = made->spirv;
  out.images = std::move(assembled.images);
  out.params = std::move(assembled.params);
  for (std::size_t i = 0; i < out.params.size(); ++i) out.params[i].offset = made->offsets[i];
  std::erase_if(out.params, [](const KernelParam& param) { return param.offset == KernelParam::kUnread; });
  out.block_size = made->block_size;
  out.rows = desc.config.rows;
  out.rows_pay = made->rows_pay;
  out.workgroup = assembled.workgroup;
  if (out.workgroup) out.shared_bytes = shared_bytes(out.spirv);
  out.target = desc.target;
  out.target_channels = desc.target_channels;
  out.two_draws = assembled.two_draws;
  out.flat_parameters = desc.config.flat_parameters && !out.workgroup;
  out.warnings = std::move(assembled.warnings);
  for (const auto number : made->unset)
    if (number < assembled.unset.size()) out.warnings.push_back(unset_warning(assembled.unset[number]));
  for (std::size_t i = 0; i + 1 < made->loops.size(); i += 2) {
    const std::size_t file = made->loops[i];
    out.loops.push_back({file < assembled.file_names.size() ? assembled.file_names[file] : std::string(),
                         static_cast<int>(made->loops[i + 1])});
  }
  out.hash = assembled.hash;
  return out;
}

std::vector<std::uint32_t> tested_early(std::vector<std::uint32_t> spirv) {
  constexpr std::size_t kHeader = 5;
  for (std::size_t at = kHeader; at < spirv.size(); at += std::max(spirv[at] >> spv::WordCountShift, 1u)) {
    if ((spirv[at] & spv::OpCodeMask) != static_cast<std::uint32_t>(spv::OpExecutionMode)) continue;
    const std::array<std::uint32_t, 3> early{
        3u << spv::WordCountShift | static_cast<std::uint32_t>(spv::OpExecutionMode), spirv[at + 1],
        static_cast<std::uint32_t>(spv::ExecutionModeEarlyFragmentTests)};
    spirv.insert(spirv.begin() + static_cast<std::ptrdiff_t>(at), early.begin(), early.end());
    break;
  }
  return spirv;
}

KernelCompiler::Counters KernelCompiler::counters() const {
  return {state_->compiled, state_->from_disk, state_->from_memory};
}

}  // namespace afterglow
