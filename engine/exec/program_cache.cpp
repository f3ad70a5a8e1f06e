// SPDX-License-Identifier: MIT
#include "exec/program_cache.h"

#include <algorithm>
#include <iterator>
#include <list>
#include <utility>

#include "core/stopwatch.h"
#include "exec/cpu/driver.h"
#include "exec/describe.h"
#include "exec/histories.h"
#include "exec/idle_programs.h"
#include "graph/condition.h"
#include "graph/history.h"
#include "graph/region.h"

namespace afterglow {

struct ProgramCache::State {
  State(Device& device_in, std::shared_ptr<SharedKernels> shared_in, const ProgramCacheOptions& options_in)
      : device(device_in), shared(std::move(shared_in)), options(options_in) {}

  /// A program and what it was made for. Values of the graph may be older or newer than the program's.
  struct Entry {
    FrameWork work;
    std::unique_ptr<Program> program;  ///< null: nothing runs
    IdlePrograms idle;
  };
  using Entries = std::list<Entry>;

  Device& device;
  std::shared_ptr<SharedKernels> shared;
  ProgramCacheOptions options;
  std::shared_ptr<Histories> histories = std::make_shared<Histories>();
  Entries entries;       ///< the one used last first
  bool present = false;  ///< the first is the present one
  bool fresh = false;    ///< it was made by the last `find`, with the values of its frame
  /// The program that the histories were fitted to, and their images then.
  struct Fitted {
    std::uint64_t program = 0, images = 0;
    friend bool operator==(const Fitted&, const Fitted&) = default;
  };
  Fitted fitted;
  double milliseconds = 0;

  Entries::iterator found(const FrameWork& work) {
    return std::ranges::find_if(entries, [&](const Entry& entry) { return same_program(entry.work, work); });
  }
  Result<void> fit_histories();
  Result<void> use_histories(Entry& entry);
  /// Of the present program.
  Storage storage() const {
    return present ? entries.front().work.storage.value_or(options.config.storage) : options.config.storage;
  }
  ProgramOptions program_options() const;
  /// What a whole program is made of: the graph, or what is left of it for opaque pictures, which most are. Frames with
  /// another alpha get a program of their own (`for_content`).
  Graph graph_of_program(const Graph& graph) const {
    const bool asked_for_each_frame = options.own_images && options.skip_idle && !options.reference;
    return asked_for_each_frame ? without_division(graph) : graph;
  }
  Result<void> make(FrameWork work, ShaderLibrary& shaders);
  void drop_spares();
};

bool same_program(const FrameWork& a, const FrameWork& b) {
  return a.region == b.region && a.unorm8 == b.unorm8 && a.storage == b.storage && a.texts == b.texts &&
         same_structure(a.graph, b.graph) && (!a.region || same_reach(a.graph, b.graph));
}

namespace {

/// Compiles the kernels of one plan.
class KernelCheck {
 public:
  KernelCheck(ShaderLibrary& shaders, KernelCompiler& compiler, const Graph& graph, CheckedKernels& checked)
      : shaders_(shaders), compiler_(compiler), graph_(graph), checked_(checked) {}

  void run(const ProgramOptions& options) {
    for (const auto& kernel : make_plan(graph_, options.config).kernels) {
      if (options.config.compute && !kernel.workgroups) continue;
      auto good = compile(kernel, options);
      if (good) continue;
      if (kernel.passes.size() > 1 && may_compile_apart(good.error(), options.config)) return run_apart(options);
      found.errors.push_back(shaders_.with_known_names(std::move(good).error()));
    }
  }
  ShaderFindings found;

 private:
  void run_apart(ProgramOptions options) {
    options.config.fusion = Fusion::filters;
    run(options);
  }
  Result<void> compile(const PlanKernel& kernel, const ProgramOptions& options) {
    AFTERGLOW_TRY(KernelDesc desc, describe_kernel(shaders_, graph_, kernel, options));
    const auto same = [&](const KernelDesc& other) { return same_kernel(other, desc); };
    if (std::ranges::any_of(checked_.described, same)) return {};
    checked_.described.push_back(desc);
    AFTERGLOW_TRY(AssembledKernel assembled, assemble(desc));
    if (!checked_.texts.insert(assembled.hash).second) return {};
    AFTERGLOW_TRY(const CompiledKernel compiled, compiler_.compile(desc, std::move(assembled)));
    found.warnings.insert(found.warnings.end(), compiled.warnings.begin(), compiled.warnings.end());
    return {};
  }

  ShaderLibrary& shaders_;
  KernelCompiler& compiler_;
  const Graph& graph_;
  CheckedKernels& checked_;
};

}  // namespace

ShaderFindings check_kernels(ShaderLibrary& shaders, KernelCompiler& compiler, const FrameWork& work,
                             const ExecutionConfig& config, CheckedKernels& checked) {
  ProgramOptions options{.config = config, .inputs_are_storage = true, .unorm8 = work.unorm8, .flag_non_finite = true};
  fit_to_cpu_driver(options.config);
  options.config.guard_loops = true;
  KernelCheck check(shaders, compiler, work.graph, checked);
  for (const bool compute : {false, true}) {  // both ways of passes that have two
    options.config.compute = compute;
    check.run(options);
  }
  return std::move(check.found);
}

Result<Hash> texts_of(const Graph& graph, ShaderLibrary& shaders) {
  Hasher hasher;
  for (const auto& pass : graph.passes)
    for (const auto& name : shaders_of(pass)) {
      AFTERGLOW_TRY(const auto source, shaders.find(name));
      hasher.add(source->hash.high).add(source->hash.low);
    }
  return hasher.finish();
}

ProgramCache::ProgramCache(Device& device, std::shared_ptr<SharedKernels> shared, const ProgramCacheOptions& options)
    : state_(std::make_unique<State>(device, std::move(shared), options)) {}
ProgramCache::~ProgramCache() = default;

const ProgramCacheOptions& ProgramCache::options() const { return state_->options; }
bool ProgramCache::has(const FrameWork& work) const { return state_->found(work) != state_->entries.end(); }
const FrameWork* ProgramCache::work() const { return state_->present ? &state_->entries.front().work : nullptr; }
Program* ProgramCache::program() const { return state_->present ? state_->entries.front().program.get() : nullptr; }
Program* ProgramCache::program(std::uint64_t id) const {
  Program* const whole = program();
  if (!whole || whole->id() == id) return whole;
  return state_->entries.front().idle.program(id);
}
double ProgramCache::milliseconds() const { return state_->milliseconds; }

ProgramOptions ProgramCache::State::program_options() const {
  ProgramOptions out;
  out.config = options.config;
  out.config.storage = storage();
  out.reference = options.reference;
  out.inputs_are_storage = out.result_by_rows = out.result_stored = options.own_images;
  out.flag_non_finite = options.flag_non_finite;
  out.keep_images = options.keep_images;
  out.max_memory = options.max_memory;
  out.pipelines = &shared->pipelines;
  out.images = &shared->images;
  out.histories = histories;
  if (present) {
    out.unorm8 = entries.front().work.unorm8;
    out.region = entries.front().work.region;
  }
  return out;
}

/// What earlier frames handed on stays where it still means the same.
Result<void> ProgramCache::State::fit_histories() {
  ExecutionConfig config = options.config;
  config.storage = options.reference ? Storage::fp32 : storage();
  const Graph& graph = entries.front().work.graph;
  return histories->fit(device, graph, Histories::options_for(device, graph, config, options.max_memory));
}

/// Programs that were not there last, or whose images another one (of a frame that failed, too) has let go, are pointed
/// at those that there are.
Result<void> ProgramCache::State::use_histories(Entry& entry) {
  if (fitted == Fitted{entry.program->id(), histories->images_id()}) return {};
  AFTERGLOW_CHECK(fit_histories());
  AFTERGLOW_CHECK(entry.program->use(histories));
  AFTERGLOW_CHECK(entry.idle.use(histories));
  fitted = {entry.program->id(), histories->images_id()};
  return {};
}

/// Images that programs share go with the last of them: where they are kept, the program before stays until the new one
/// is there.
Result<void> ProgramCache::State::make(FrameWork work, ShaderLibrary& shaders) {
  present = false;
  if (options.spare == 0 && !options.keep_images) entries.clear();
  entries.push_front({.work = std::move(work), .program = nullptr, .idle = {}});
  present = true;
  Entry& entry = entries.front();
  if (!entry.work.runs()) return {};
  const auto start = Clock::now();
  AFTERGLOW_CHECK(fit_histories());
  const auto create = [&] {
    return Program::create(device, shaders, shared->compiler, graph_of_program(entry.work.graph), program_options());
  };
  auto made = create();
  if (!made && made.error().kind == ErrorKind::device &&
      entries.size() > 1) {  // the memory may be what spare ones have
    entries.erase(std::next(entries.begin()), entries.end());
    made = create();
  }
  if (!made) return shaders.with_known_names(std::move(made).error());
  entry.program = std::move(made).value();
  if (options.diagnostics)
    for (const auto& warning : entry.program->warnings()) options.diagnostics->warn_once(warning, warning);
  device.save_pipeline_cache();
  milliseconds += milliseconds_since(start);
  return {};
}

/// As many as may stay, within a part of the memory that there may be. What runs nothing is made at once when it is
/// wanted.
void ProgramCache::State::drop_spares() {
  constexpr std::uint64_t kPart = 4;
  const auto bytes_of = [](const Entry& entry) { return entry.program ? entry.program->memory().arena : 0; };
  std::uint64_t bytes = bytes_of(entries.front());
  int stay = 0;
  for (auto entry = std::next(entries.begin()); entry != entries.end();) {
    bytes += bytes_of(*entry);
    const bool stays = entry->program && stay < options.spare && bytes <= options.max_memory / kPart;
    stay += stays ? 1 : 0;
    entry = stays ? std::next(entry) : entries.erase(entry);
  }
}

const std::shared_ptr<SharedKernels>& ProgramCache::kernels() const { return state_->shared; }
ProgramOptions ProgramCache::program_options() const { return state_->program_options(); }

Result<void> ProgramCache::find(FrameWork work, ShaderLibrary& shaders) {
  State& s = *state_;
  const auto found = s.found(work);
  s.fresh = found == s.entries.end();
  if (s.fresh) {
    const auto drop = [&s] {  // an entry without a program would be one that runs nothing
      if (std::exchange(s.present, false)) s.entries.pop_front();
    };
    try {
      auto made = s.make(std::move(work), shaders);
      if (!made) drop();
      return made;
    } catch (...) {
      drop();
      throw;
    }
  }
  if (found != s.entries.begin()) s.entries.splice(s.entries.begin(), s.entries, found);
  s.entries.front().work = std::move(work);
  s.present = true;
  return {};
}

Result<void> ProgramCache::begin() {
  State& s = *state_;
  if (!s.present) return {};
  State::Entry& entry = s.entries.front();
  const FrameWork& work = entry.work;
  if (entry.program) AFTERGLOW_CHECK(s.use_histories(entry));
  if (!s.fresh && entry.program) AFTERGLOW_CHECK(entry.program->set_parameters(s.graph_of_program(work.graph)));
  if (!s.fresh) AFTERGLOW_CHECK(entry.idle.set_parameters(work.graph));
  s.drop_spares();
  if (work.runs())
    s.histories->begin(work.frame, work.step, work.restart);
  else
    s.histories->reset();
  return {};
}

Result<void> ProgramCache::prepare(FrameWork work, ShaderLibrary& shaders) {
  AFTERGLOW_CHECK(find(std::move(work), shaders));
  return begin();
}

bool ProgramCache::depends_on_content() const {
  const ProgramCacheOptions& options = state_->options;
  return program() && options.skip_idle && !options.reference &&
         (!work()->graph.idle.empty() || straight_passes(work()->graph) > 0);
}

Result<ProgramCache::Choice> ProgramCache::for_content(const SourceContent& content, ShaderLibrary& shaders) {
  State& s = *state_;
  const auto start = Clock::now();
  State::Entry& entry = s.entries.front();
  const int before = entry.idle.size();
  ProgramOptions options = s.program_options();
  options.max_memory -= std::min(options.max_memory, entry.program->memory().arena);
  AFTERGLOW_TRY(
      const IdlePrograms::Choice choice,
      entry.idle.choose(s.device, shaders, s.shared->compiler, *entry.program, entry.work.graph, options, content));
  if (entry.idle.size() > before) {
    s.device.save_pipeline_cache();
    s.milliseconds += milliseconds_since(start);
  }
  return Choice{choice.program, *choice.skipped};
}

Result<Program*> ProgramCache::usual(ShaderLibrary& shaders) {
  if (!depends_on_content()) return program();
  AFTERGLOW_TRY(const Choice choice, for_content({.opaque = true}, shaders));
  return choice.program;
}

void ProgramCache::made() { state_->histories->made(); }
void ProgramCache::reset_histories() { state_->histories->reset(); }

void ProgramCache::take_over(ProgramCache& before, bool programs) {
  State &s = *state_, &from = *before.state_;
  if (programs && s.entries.empty()) {
    s.entries = std::move(from.entries);
    s.present = std::exchange(from.present, false);
    s.fitted = from.fitted;
    s.histories = from.histories;
    return;
  }
  if (program()) {
    s.histories->take(*from.histories);
    if (programs) s.entries.splice(s.entries.end(), from.entries);
    s.drop_spares();
  } else {
    s.histories = from.histories;  // the program that will be made keeps what fits
  }
  from.entries.clear();
  from.present = false;
}

Result<std::unique_ptr<Program>> ProgramCache::by_passes(const Graph& graph, const std::optional<Rect>& region,
                                                         ShaderLibrary& shaders) const {
  const State& s = *state_;
  ProgramOptions options;
  const bool halves = std::ranges::any_of(graph.histories, [](const History& history) { return !history.precise; });
  if (halves) options.config.storage = s.storage();
  options.config.storage_reads = s.options.config.storage_reads;  // as the histories are made
  options.config.four_channels = s.options.config.four_channels;
  options.reference = true;
  options.region = region;
  options.max_memory = s.options.max_memory;
  options.pipelines = &s.shared->pipelines;
  options.histories = s.histories;
  return Program::create(s.device, shaders, s.shared->compiler, graph, options);
}

std::vector<std::string> ProgramCache::take_replaced_histories() { return state_->histories->take_replaced(); }

bool ProgramCache::can_use_again(Program& by_passes) const {
  return static_cast<bool>(by_passes.use(state_->histories));
}

int ProgramCache::programs() const { return program() ? 1 + state_->entries.front().idle.size() : 0; }

}  // namespace afterglow
