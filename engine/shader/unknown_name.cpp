// SPDX-License-Identifier: MIT
// What authors may have meant by a name that a compiler does not know.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"
#include "shader/builtins.h"
#include "shader/include.h"
#include "shader/library.h"
#include "shader/scan.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kNoFunction = "': no matching overloaded function found";
constexpr std::string_view kNoVariable = "': undeclared identifier";

/// The name in "'NAME': …"; empty: the message is another.
std::string unknown_name(std::string_view message) {
  if (!message.starts_with('\'')) return {};
  message = message.substr(0, message.find("; write "));
  const auto end = std::max(message.ends_with(kNoFunction) ? message.size() - kNoFunction.size() : 0,
                            message.ends_with(kNoVariable) ? message.size() - kNoVariable.size() : 0);
  return end > 1 ? std::string(message.substr(1, end - 1)) : std::string();
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// The words of a file, and what it gets from those that it includes.
struct Known {
  std::vector<std::string> defined;  ///< at file scope, here and in libraries
  std::map<std::string, int> lines;  ///< where the file's own are defined first
  std::vector<std::string> words;    ///< all of the file's own, in the order of the text
  std::vector<fs::path> files;       ///< its own, and those that it includes
};

/// "lerp(vec3 a, vec3 b, float t)" of each function of that name in a file.
void add_signatures(const fs::path& file, std::string_view name, std::vector<std::string>& out) {
  const auto text = read_shader(file, nullptr);
  if (!text) return;
  auto scanned = scan(*text, file.string(), ScanAs::library);
  if (!scanned) scanned = scan(*text, file.string(), ScanAs::stage);
  if (!scanned) return;
  const auto& tokens = scanned->tokens;
  for (std::size_t i = 1; i + 1 < tokens.size(); ++i) {
    if (tokens[i].text != name || tokens[i + 1].text != "(" || !tokens[i - 1].is_identifier()) continue;
    std::string signature = std::string(name) + "(";
    std::size_t at = i + 2;
    for (; at < tokens.size() && tokens[at].text != ")" && tokens[at].text != "("; ++at) {
      const bool apart = tokens[at].is_identifier() && !signature.ends_with('(');
      signature += (apart ? " " : "") + std::string(tokens[at].text);
    }
    if (at + 1 < tokens.size() && tokens[at].text == ")" && tokens[at + 1].text == "{") out.push_back(signature + ")");
  }
}

Result<Known> names_known_to(const fs::path& file, const SearchPath& path) {
  AFTERGLOW_TRY(const std::string text, read_shader(file, nullptr));
  auto scanned = scan(text, file.string(), ScanAs::stage);
  if (!scanned) scanned = scan(text, file.string(), ScanAs::library);
  if (!scanned) return std::move(scanned).error();
  AFTERGLOW_TRY(const auto includes, resolve_includes(path, file, *scanned));
  Known known;
  for (const auto& global : scanned->names) {
    known.defined.push_back(global.name);
    known.lines.emplace(global.name, global.line);
  }
  known.files.push_back(file);
  for (const auto& include : includes) known.files.push_back(include.path);
  for (const auto& include : includes)
    known.defined.insert(known.defined.end(), include.global_names.begin(), include.global_names.end());
  for (const auto& token : scanned->tokens)
    if (token.is_identifier()) known.words.emplace_back(token.text);
  return known;
}

/// The file below shaders/lib/ that defines it, as #include names it; empty: none does.
std::string library_with(const std::string& name, const SearchPath& path) {
  std::vector<fs::path> roots = path.user;
  if (!path.installation.empty()) roots.push_back(path.installation);
  for (const auto& root : roots)
    for (const auto& file : list_shader_files(root / "shaders" / "lib")) {
      if (file == "prelude.glsl") continue;  // every shader has it
      const auto text = read_shader(root / "shaders" / "lib" / file, nullptr);
      if (!text) continue;
      const auto scanned = scan(*text, file, ScanAs::library);
      if (scanned && std::ranges::find(scanned->names, name, &GlobalName::name) != scanned->names.end())
        return "lib/" + file;
    }
  return {};
}

}  // namespace

Error ShaderLibrary::with_known_names(Error error) const {
  const std::string name = unknown_name(error.message);
  if (name.empty() || error.file.empty()) return error;
  const auto known = names_known_to(error.file, path_);
  if (known && has(known->defined, name)) {
    std::vector<std::string> signatures;
    const auto end = error.message.find(kNoFunction);
    if (end != std::string::npos)
      for (const auto& of : known->files) add_signatures(of, name, signatures);
    const auto here = known->lines.find(name);
    if (end != std::string::npos && here != known->lines.end() && here->second > error.line)
      error.message = fmt::format("{}: it stands below, at line {}, and GLSL knows what stands above alone: move it up",
                                  error.message.substr(0, end + kNoFunction.size()), here->second);
    else if (!signatures.empty())
      error.message =
          fmt::format("{}; it is {}", error.message.substr(0, end + kNoFunction.size()), join(signatures, " or "));
    return error;
  }
  if (error.message.find("; write ") != std::string::npos) return error;
  if (!known || is_builtin_function(name) || is_prelude_function(name)) return error;
  if (const std::string library = library_with(name, path_); !library.empty()) {
    error.message = fmt::format("'{}' is not known here; {} has it: #include \"{}\"", name, library, library);
    return error;
  }
  std::vector<std::string> candidates = known->defined;
  if (error.message.ends_with(kNoFunction)) {
    for (const auto& functions : {prelude_functions(), builtin_functions()})
      candidates.insert(candidates.end(), functions.begin(), functions.end());
  } else {
    std::ranges::copy_if(known->words, std::back_inserter(candidates), [&](const auto& word) { return word != name; });
  }
  error.nearest = nearest_name(name, candidates);
  return error;
}

}  // namespace afterglow
