// SPDX-License-Identifier: MIT
#include "batch/resume.h"

#include <fmt/format.h>

#include <set>
#include <system_error>

#include "core/file.h"
#include "core/temporary.h"
#include "core/text.h"
#include "core/version.h"
#include "shader/library.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

fs::path record_file(const fs::path& output) {
  return output.parent_path() / ".afterglow" / (output.filename().string() + ".made");
}

}  // namespace

Result<Hash> look_hash(const Preset& preset, const Graph& graph, const std::string& options) {
  Hasher hasher;
  hasher.add(version()).add(options);
  for (const auto& file : preset.files()) {
    AFTERGLOW_TRY(const std::string text, read_file(file));
    hasher.add(text);
  }
  ShaderLibrary shaders(preset.path());
  for (const auto& pass : graph.passes)
    for (const auto& name : shaders_of(pass)) {
      AFTERGLOW_TRY(const auto shader, shaders.find(name));
      hasher.add(shader->hash.hex());
    }
  if (preset.may_change())
    for (const auto& name : shaders.names())
      if (const auto shader = shaders.find(name)) hasher.add((*shader)->hash.hex());
  return hasher.finish();
}

bool is_up_to_date(const FrameJob& job, const Hash& look) {
  std::error_code ec;
  const auto made = fs::last_write_time(job.output, ec);
  if (ec) return false;
  std::vector<fs::path> sources = job.sources();
  sources.insert(sources.end(), job.earlier.begin(), job.earlier.end());
  for (const auto& source : sources) {
    const auto changed = fs::last_write_time(source, ec);
    if (ec || changed >= made) return false;
  }
  const auto record = read_file(record_file(job.output), 1024);
  return record && trim(*record) == look.hex();
}

int remove_leftovers(const FrameRecords& frames) {
  std::set<fs::path> folders;
  for (const auto& frame : frames) folders.insert(frame.job.output.parent_path());
  int removed = 0;
  for (const auto& folder : folders)
    removed += remove_abandoned_temporaries(folder) + remove_abandoned_temporaries(folder / ".afterglow");
  return removed;
}

Result<void> record_made(const FrameJob& job, const Hash& look) {
  const fs::path file = record_file(job.output);
  const fs::path folder = job.output.has_parent_path() ? job.output.parent_path() : fs::path(".");
  std::error_code ec;
  // Whoever may write the outputs may write their notes.
  if (fs::create_directory(file.parent_path(), ec))
    fs::permissions(file.parent_path(), fs::status(folder, ec).permissions(), ec);
  return write_file_atomically(file, look.hex() + "\n");
}

}  // namespace afterglow
