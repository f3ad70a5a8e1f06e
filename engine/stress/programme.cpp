// SPDX-License-Identifier: MIT
#include "stress/programme.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/stopwatch.h"
#include "core/text.h"

namespace afterglow::stress {
namespace {

namespace fs = std::filesystem;

/// A folder of this process for pictures that go through a file.
const fs::path& scratch() {
  struct Folder {
    fs::path path;
    Folder() {
      std::string pattern = (fs::temp_directory_path() / "afterglow-stress-XXXXXX").string();
      if (mkdtemp(pattern.data())) path = pattern;
    }
    ~Folder() {
      std::error_code ec;
      if (!path.empty()) fs::remove_all(path, ec);
    }
  };
  static const Folder folder;
  return folder.path;
}

class Run {
 public:
  Run(Harness& harness, const Trials& trials, const ProgrammeOptions& options, Diagnostics& diagnostics,
      const Report& report)
      : harness_(harness), trials_(trials), options_(options), diagnostics_(diagnostics), report_(report) {}

  Result<Summary> all(const Step& step) {
    const auto start = Clock::now();
    for (std::uint64_t index = options_.trial.value_or(0);; ++index) {
      summary_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
      if (done(index)) break;
      if (auto go = step(summary_); !go) {
        if (go.error().kind != ErrorKind::interrupted) return std::move(go).error();
        summary_.interrupted = true;
        break;
      }
      AFTERGLOW_CHECK(one(trials_.at(index)));
    }
    return std::move(summary_);
  }

 private:
  bool done(std::uint64_t index) const {
    if (options_.trial) return index > *options_.trial;
    if (options_.cases > 0 && summary_.cases >= options_.cases) return true;
    if (options_.seconds > 0 && summary_.seconds >= options_.seconds) return true;
    return options_.cases == 0 && options_.seconds <= 0 && index >= trials_.round();
  }

  Result<void> one(const Trial& trial) {
    ++summary_.trials;
    harness_.forget();
    const auto facts = harness_.facts(trial.look, trial.size, trial.frame);
    if (!facts) return refused(trial, facts.error());
    Activity& activity = summary_.activity[trial.subject];
    ++activity.trials;
    activity.active += facts->runs;
    if (!facts->runs) activity.reason = facts->left_out;
    for (const auto& spec : trial.pictures) AFTERGLOW_CHECK(picture(trial, spec));
    const auto turn = trial.index / trials_.subjects().size();
    if (options_.digests_every > 0 && turn % static_cast<std::uint64_t>(options_.digests_every) == 0) {
      auto digest = digest_of(harness_, trial, diagnostics_);
      if (digest) summary_.digests[trial.index] = *digest;
    }
    return {};
  }

  /// Settings that the effect refuses are no settings; defaults that it refuses are a fault.
  Result<void> refused(const Trial& trial, const Error& error) {
    ++summary_.refused;
    const bool defaults = trial.index < trials_.subjects().size();
    return defaults ? Result<void>(error) : Result<void>();
  }

  Result<void> picture(const Trial& trial, const PictureSpec& spec) {
    AFTERGLOW_TRY(Situation situation, situation_of(trial, spec, diagnostics_));
    const bool gentle = find_picture_kind(spec.kind)->gentle;
    for (const Check& check : checks()) {
      if (check.promise && !gentle) continue;
      situation.check = check.name;
      AFTERGLOW_TRY(const Outcome outcome, tried(situation));
      if (!outcome.applies) continue;
      ++summary_.cases;
      summary_.checks[check.name].add(outcome);
      summary_.subjects[trial.subject][check.name].add(outcome);
      if (!outcome.holds) AFTERGLOW_CHECK(found(trial, spec, situation, outcome));
    }
    return {};
  }

  /// A stack that cannot be made or run is a failure of the check, unless the device is gone.
  Result<Outcome> tried(const Situation& situation) {
    auto outcome = run_check(harness_, situation);
    if (outcome || outcome.error().kind == ErrorKind::device) return outcome;
    return Outcome{.holds = false, .measured = 1, .allowed = 0, .what = "does not run: " + outcome.error().text()};
  }

  Result<void> found(const Trial& trial, const PictureSpec& spec, const Situation& situation, const Outcome& outcome) {
    ++summary_.failures;
    if (summary_.subjects[trial.subject][situation.check].failures > static_cast<std::uint64_t>(options_.kept_per_kind))
      return {};
    const StillFails fails = [&](const Situation& candidate) {
      const auto again = tried(candidate);
      return again && again->applies && !again->holds;
    };
    const Shrunk small = shrink(situation, fails);
    AFTERGLOW_TRY(Outcome last, tried(small.situation));
    if (last.holds) last = outcome;  // it comes and goes
    Finding finding{.subject = trial.subject,
                    .check = situation.check,
                    .stack = small.situation.look.line(),
                    .picture = spec.kind,
                    .what = last.what,
                    .size = small.situation.picture.color.size(),
                    .trial = trial.index,
                    .tries = small.tries,
                    .folder = {}};
    if (!options_.out.empty()) {
      finding.folder =
          options_.out / fmt::format("{}-{}-{}-{}", trial.subject, situation.check, trial.index, spec.kind);
      const auto& info = harness_.device().info();
      AFTERGLOW_CHECK(write_reproducer(finding.folder, small.situation, last,
                                       {options_.version, info.name, info.driver, options_.seed, trial.index}));
    }
    report_(finding);
    summary_.findings.push_back(std::move(finding));
    return {};
  }

  Harness& harness_;
  const Trials& trials_;
  const ProgrammeOptions& options_;
  Diagnostics& diagnostics_;
  const Report& report_;
  Summary summary_;
};

}  // namespace

void Tally::add(const Outcome& outcome) {
  ++cases;
  failures += !outcome.holds;
  const auto share = [](double measured, double limit) { return limit > 0 ? measured / limit : measured; };
  if (cases == 1 || share(outcome.measured, outcome.allowed) > share(worst, allowed)) {
    worst = outcome.measured;
    allowed = outcome.allowed;
  }
}

Result<Situation> situation_of(const Trial& trial, const PictureSpec& spec, Diagnostics& diagnostics) {
  Situation out{.look = trial.look,
                .picture = make_picture(spec),
                .frame = trial.frame,
                .check = {},
                .seed = trial.seed ^ spec.seed};
  if (!find_picture_kind(spec.kind)->gentle) {
    AFTERGLOW_TRY(out.picture, as_read(out.picture, scratch(), diagnostics));
  }
  note_content(out.picture);
  return out;
}

/// Numbers below the smallest normal float may be 0 or not (docs/determinism.md): light and settings make other numbers
/// of them, within these bounds too small to matter.
constexpr float kBrightest = 1e8f, kTiny = 1e-27f;
bool is_within_promise(const Image& source) {
  return std::ranges::all_of(source.pixels, [](float v) { return std::abs(v) <= kBrightest; });
}

Result<Hash> digest_of(Harness& harness, const Trial& trial, Diagnostics& diagnostics) {
  Hasher all;
  for (const auto& spec : trial.pictures) {
    AFTERGLOW_TRY(const Situation situation, situation_of(trial, spec, diagnostics));
    if (!is_within_promise(situation.picture.color)) continue;
    for (const Storage storage : {Storage::fp32, Storage::fp16}) {
      Way way = usual_way(harness);
      way.choice.storage = storage;
      AFTERGLOW_TRY(Made made, harness.run(situation.look, situation.picture, situation.frame, way));
      for (float& v : made.image.pixels)
        if (std::abs(v) < kTiny) v = 0;
      const Hash hash = hash_bytes(made.image.pixels.data(), made.image.bytes());
      all.add(hash.high).add(hash.low);
    }
  }
  return all.finish();
}

Result<Summary> run_programme(Harness& harness, const Trials& trials, const ProgrammeOptions& options,
                              Diagnostics& diagnostics, const Step& step, const Report& report) {
  return Run(harness, trials, options, diagnostics, report).all(step);
}

}  // namespace afterglow::stress
