// SPDX-License-Identifier: MIT
#include "batch/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <system_error>

#include "core/environment.h"
#include "core/file.h"
#include "core/file_stamp.h"
#include "core/temporary.h"
#include "core/text.h"
#include "core/version.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestNote = 1u << 20;
constexpr const char* kInPath = "path:";  // before a name that is looked up along the search path

fs::path record_file(const fs::path& output) {
  return output.parent_path() / ".afterglow" / (output.filename().string() + ".made");
}

/// Of a file among others; zero: it is not there.
Hash named_stamp(const fs::path& file, const std::string& stamp) {
  return stamp.empty() ? Hash{} : Hasher().add(file.filename().string()).add(stamp).finish();
}

/// What stands behind a word and a space; none: the line begins otherwise.
std::optional<std::string> behind(const std::string& line, const std::string& word) {
  if (!line.starts_with(word + " ")) return std::nullopt;
  return line.substr(word.size() + 1);
}

}  // namespace

Result<Hash> look_hash(const Preset& preset, const Inventory& inventory, const std::string& options) {
  Hasher hasher;
  FileHashes hashes(preset);
  hasher.add(version()).add(options);
  // By names that hold for the copies that a farm reads, too.
  for (const auto& [name, file] : PortableNames(preset.path()).of(inventory.sources)) {
    AFTERGLOW_TRY(const Hash hash, hashes.of(file));
    hasher.add(name).add(hash.hex());
  }
  return hasher.finish();
}

Hash FrameNotes::inputs_of(const FrameJob& job) {
  const EarlierFiles& earlier = job.earlier;
  SequenceStamps* stamps =
      earlier.of ? &stamps_.try_emplace(earlier.of, earlier.of->files.size()).first->second : nullptr;
  std::size_t place = earlier.of ? earlier.of->begin_of(job.frame) : 0;  // of its own files, for the frames behind it
  Hasher hasher;
  bool all = true;
  for (const auto& file : job.sources()) {
    const std::string stamp = file_stamp(file);
    all = all && !stamp.empty();
    hasher.add(file.filename().string()).add(stamp);
    if (stamps && place < earlier.of->files.size() && earlier.of->files[place] == file)
      stamps->set(place++, named_stamp(file, stamp));
  }
  if (!all) return {};
  if (!stamps || earlier.files().empty()) return hasher.finish();
  const auto before = stamps->of(earlier.begin, earlier.end, [&](std::size_t at) {
    const fs::path& file = earlier.of->files[at];
    return named_stamp(file, file_stamp(file));
  });
  return before ? hasher.add(before->hex()).finish() : Hash{};
}

std::string FrameNotes::text(const Hash& inputs, const Dependencies& depends) {
  std::string out = fmt::format("look {}\ninputs {}\n", look_.hex(), inputs.hex());
  for (const auto& [file, asked] : depends.files) {
    const auto hash = hashes_.of(file);
    const std::string name = asked.empty() ? names_.place(file) : asked == kOcioVariable ? asked : kInPath + asked;
    out += fmt::format("file {} {}\n", hash ? hash->hex() : "", name);
  }
  for (const auto& file : depends.beside)
    out += fmt::format("beside {} {}\n", content_or_none(file), names_.place(file));
  for (const auto& [name, value] : depends.environment) out += fmt::format("variable {}={}\n", name, value);
  return out;
}

/// Of a file that need not be there.
std::string FrameNotes::content_or_none(const fs::path& file) {
  const auto hash = hashes_.of(file);
  return hash ? hash->hex() : "-";
}

fs::path FrameNotes::file_of(const std::string& name) const {
  if (name == kOcioVariable) return environment("OCIO");
  if (name.starts_with(kInPath)) return path_.find_asset(name.substr(std::string_view(kInPath).size()));
  return names_.file_at(name);
}

bool FrameNotes::is_same(const std::string& line, const FrameJob& job) {
  if (const auto look = behind(line, "look")) return *look == look_.hex();
  if (const auto inputs = behind(line, "inputs")) {
    const Hash now = inputs_of(job);
    return now != Hash{} && now.hex() == *inputs;
  }
  if (const auto output = behind(line, "output")) return *output == file_stamp(job.output);
  if (const auto file = behind(line, "file")) {
    const std::size_t space = file->find(' ');
    if (space == std::string::npos) return false;
    const auto hash = hashes_.of(file_of(file->substr(space + 1)));
    return hash && hash->hex() == file->substr(0, space);
  }
  if (const auto file = behind(line, "beside")) {
    const std::size_t space = file->find(' ');
    return space != std::string::npos && content_or_none(file_of(file->substr(space + 1))) == file->substr(0, space);
  }
  if (const auto given = behind(line, "variable")) {
    const std::size_t equals = given->find('=');
    return equals != std::string::npos && environment(given->substr(0, equals)) == given->substr(equals + 1);
  }
  return false;
}

bool FrameNotes::is_up_to_date(const FrameJob& job) {
  const auto note = read_file(record_file(job.output), kLargestNote);
  if (!note || !note->ends_with('\n')) return false;
  const auto lines = split(note->substr(0, note->size() - 1), '\n');
  constexpr std::size_t kLeast = 3;  // look, inputs, output
  return lines.size() >= kLeast && lines.back().starts_with("output ") &&
         std::ranges::all_of(lines, [&](const std::string& line) { return is_same(line, job); });
}

int remove_leftovers(const FrameRecords& frames) {
  std::set<fs::path> folders;
  for (const auto& frame : frames) folders.insert(frame.job.output.parent_path());
  int removed = 0;
  for (const auto& folder : folders)
    removed += remove_abandoned_temporaries(folder) + remove_abandoned_temporaries(folder / ".afterglow");
  return removed;
}

Result<void> record_made(const FrameJob& job, const std::string& stamp) {
  if (job.made_of.empty()) return {};
  const fs::path file = record_file(job.output);
  const fs::path folder = job.output.has_parent_path() ? job.output.parent_path() : fs::path(".");
  std::error_code ec;
  // Whoever may write the outputs may write their notes.
  if (fs::create_directory(file.parent_path(), ec))
    fs::permissions(file.parent_path(), fs::status(folder, ec).permissions(), ec);
  return write_file_atomically(file, job.made_of + "output " + stamp + "\n");
}

}  // namespace afterglow
