// SPDX-License-Identifier: MIT
// `afterglow new effect NAME`, `afterglow new look NAME`: something that works to start from.
//
// The templates are a tree of files in the installation that work by themselves; in names and texts, the words
// my_effect and my_look become the new name.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include "apps/command.h"
#include "apps/output.h"
#include "core/file.h"
#include "core/file_descriptor.h"
#include "core/paths.h"
#include "core/process.h"
#include "script/preset.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> kPlaceholders{"my_effect", "my_look"};

struct NewArguments {
  std::string kind, name, folder = ".";
};

struct NewFile {
  fs::path path;  ///< relative
  std::string text;
  bool executable = false;
};

std::string renamed(std::string text, const std::string& name) {
  for (const auto placeholder : kPlaceholders)
    for (std::size_t at = 0; (at = text.find(placeholder, at)) != std::string::npos; at += name.size())
      text.replace(at, placeholder.size(), name);
  return text;
}

Result<std::vector<NewFile>> files_of(const fs::path& templates, const std::string& name) {
  std::vector<NewFile> files;
  std::error_code ec;
  for (fs::recursive_directory_iterator it(templates, ec), end; !ec && it != end; it.increment(ec)) {
    if (!it->is_regular_file()) continue;
    AFTERGLOW_TRY(std::string text, read_file(it->path()));
    const bool executable = (it->status().permissions() & fs::perms::owner_exec) != fs::perms::none;
    files.push_back(
        {renamed(fs::relative(it->path(), templates).string(), name), renamed(std::move(text), name), executable});
  }
  if (files.empty())
    return Error{ErrorKind::io, "the installation has no templates (AFTERGLOW_HOME names its folder)",
                 templates.string()};
  std::sort(files.begin(), files.end(), [](const NewFile& a, const NewFile& b) { return a.path < b.path; });
  return files;
}

/// What was written, to be taken away again.
class Written {
 public:
  /// A file that must not exist, with its folders. Errors: io.
  Result<void> add(const fs::path& path, const NewFile& file) {
    std::error_code ec;
    std::vector<fs::path> missing;
    for (fs::path folder = path.parent_path(); !folder.empty() && !fs::exists(folder, ec);
         folder = folder.parent_path())
      missing.push_back(folder);
    made_.insert(made_.end(), missing.rbegin(), missing.rend());
    fs::create_directories(path.parent_path(), ec);
    const int out = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, file.executable ? 0777 : 0666);
    if (out >= 0) made_.push_back(path);
    if (out >= 0 && write_and_close(out, file.text)) return {};
    return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(errno)), path.string()};
  }
  void discard() const {
    std::error_code ec;
    for (auto one = made_.rbegin(); one != made_.rend(); ++one) fs::remove(*one, ec);  // of folders the empty ones
  }

 private:
  /// On failure errno tells.
  static bool write_and_close(int file, std::string_view text) {
    const bool good = write_all(file, text);
    const int reason = errno;
    if (close(file) != 0) return false;
    errno = reason;
    return good;
  }

  std::vector<fs::path> made_;  ///< folders before what lies in them
};

Result<void> run_new(const NewArguments& arguments) {
  const fs::path folder = arguments.folder;
  const bool is_effect = arguments.kind == "effect";
  AFTERGLOW_CHECK(is_effect ? check_new_effect_name(arguments.name, search_path_for(folder / "preset.lua", {}))
                            : check_new_look_name(arguments.name));
  AFTERGLOW_TRY(const auto files, files_of(find_installation() / "templates" / arguments.kind, arguments.name));
  for (const auto& file : files)
    if (fs::exists(fs::symlink_status(folder / file.path)))
      return Error{ErrorKind::io, "exists already; nothing was written", (folder / file.path).string()};
  Written written;
  for (const auto& file : files) {
    auto done = written.add(folder / file.path, file);
    if (done) continue;
    written.discard();
    return done;
  }
  const auto place = [&](const std::string& file) { return (folder / file).lexically_normal().string(); };
  for (const auto& file : files) output("{}\n", place(file.path));
  output("Try it:  afterglow run {} PICTURE -o out.png\n", shell_word(place(arguments.name + ".lua")));
  if (is_effect) output("Test it: {}\n", shell_word(place("tests/" + arguments.name + ".sh")));
  return {};
}

}  // namespace

Command add_new_command(CLI::App& program) {
  auto* app = program.add_subcommand(
      "new", "Write something that works to start from: a look, or an effect with script, shader, example, test");
  auto arguments = std::make_shared<NewArguments>();
  app->add_option("KIND", arguments->kind, "What to write: look, effect")
      ->required()
      ->check(CLI::IsMember({"look", "effect"}));
  app->add_option("NAME", arguments->name, "Its name: letters, digits and '_'")->required();
  app->add_option("--in", arguments->folder, "Folder to write into (default: this one)")->type_name("FOLDER");
  app->footer("Never overwrites a file.\nExamples:\n  afterglow new look dusk\n  afterglow new effect haze");
  return {app, [arguments](Console&) { return run_new(*arguments); }};
}

}  // namespace afterglow
