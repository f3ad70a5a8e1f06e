// SPDX-License-Identifier: MIT
#include "shader/glsl.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <mutex>
#include <new>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/text.h"
#include "shader/foreign_words.h"
#include "shader/kernel.h"
#include "shader/prelude.h"
#include "shader/rename.h"
#include "shader/token.h"

namespace afterglow {
namespace {

constexpr std::size_t kMaxTrail = 31;     ///< further errors that are shown
constexpr std::size_t kMaxMessage = 300;  ///< characters of one error

std::string shortened(std::string text) {
  if (text.size() > kMaxMessage) text.replace(kMaxMessage, std::string::npos, "…");
  return text;
}

struct LogLine {
  std::size_t file = 0;
  int line = 0;
  std::string message;
  friend bool operator==(const LogLine&, const LogLine&) = default;
};

/// "fetch(sampler2D image, ivec2 pixel)" of a helper that every shader has; empty: there is none of that name.
std::string helper_signature(std::string_view name) {
  const std::string head = fmt::format(" {}(", name);
  for (const auto& line : split(std::string(prelude_text()), '\n')) {
    const auto at = line.find(head), end = line.find(") {");
    if (at != std::string::npos && end != std::string::npos && at < line.find('('))
      return line.substr(at + 1, end - at);
  }
  return {};
}

/// What compute shaders have alone: names of GLSL that the compiler does not know elsewhere.
bool is_of_compute(std::string_view token) {
  return token == "barrier" || token == "memoryBarrierShared" || token == "groupMemoryBarrier" ||
         token.starts_with("gl_LocalInvocation") || token.starts_with("gl_WorkGroup") ||
         token == "gl_GlobalInvocationID" || token == "gl_NumWorkGroups";
}

/// What an author may do about a message of the compiler, in place of it or behind it.
std::string advised(std::string message, std::string_view token) {
  const bool unknown = message.ends_with("undeclared identifier") || message.ends_with("overloaded function found");
  if (unknown && is_of_compute(token)) return fmt::format("'{}' is for compute shaders (compute_at)", token);
  if (const auto instead = in_glsl(token); !instead.empty()) return message + fmt::format("; write {}", instead);
  if (message.ends_with("Reserved word")) return fmt::format("'{}' is a word of GLSL; choose another name", token);
  if (message.find("can't modify a uniform") != std::string::npos)
    return "a uniform cannot be written to; copy it into a variable";
  if (message.find("cannot construct this type") != std::string::npos && token == "sampler/image")
    return message + " (is this texture2D? write fetch(image, texel) or fetch_linear(image, position in texels))";
  if (message.find("no matching overloaded function") == std::string::npos) return message;
  const std::string signature = helper_signature(token);
  return signature.empty() ? message : message + "; it is " + signature;
}

/// A word of GLSL that stands where a name should ("vec4 sample = …"), as its parser calls it; else empty.
std::string word_for_a_name(const std::string& message) {
  static constexpr std::string_view kWords[] = {
      "BUFFER",   "CENTROID", "COHERENT", "FLAT",   "INVARIANT", "LAYOUT",     "NOPERSPECTIVE", "PATCH",    "PRECISE",
      "READONLY", "RESTRICT", "SAMPLE",   "SHARED", "SMOOTH",    "SUBROUTINE", "VOLATILE",      "WRITEONLY"};
  static constexpr std::string_view kBefore = "unexpected ";
  const auto begin = message.find(kBefore);
  if (begin == std::string::npos) return "";
  const auto end = message.find(',', begin);
  std::string word = message.substr(begin + kBefore.size(), end - begin - kBefore.size());
  if (std::ranges::find(kWords, word) == std::end(kWords)) return "";
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

/// "ERROR: FILE:LINE: 'token' : message" with FILE a number.
std::optional<LogLine> parse_line(std::string_view text) {
  static constexpr std::string_view kPrefix = "ERROR: ";
  if (!text.starts_with(kPrefix)) return std::nullopt;
  text.remove_prefix(kPrefix.size());
  LogLine out;
  const char* end = text.data() + text.size();
  const auto file = std::from_chars(text.data(), end, out.file);
  if (file.ec == std::errc() && file.ptr != end && *file.ptr == ':') {
    const auto line = std::from_chars(file.ptr + 1, end, out.line);
    if (line.ec == std::errc() && line.ptr != end && *line.ptr == ':')
      text.remove_prefix(static_cast<std::size_t>(line.ptr + 1 - text.data()));
  } else {
    out.file = 0;
  }
  std::string message = trim(original_names(text));
  if (message.starts_with("'' : ")) message.erase(0, 5);
  if (const auto colon = message.find("' : "); colon != std::string::npos) message.replace(colon, 4, "': ");
  if (const std::string word = word_for_a_name(message); !word.empty())
    message = fmt::format("'{}' is a word of GLSL; choose another name", word);
  else if (message.find("expecting COMMA or SEMICOLON") != std::string::npos)
    message = "a ';' is missing before this: " + trim(message);
  out.message = shortened(trim(message));
  if (out.message.ends_with('.')) out.message.pop_back();  // "'half': Reserved word."
  const auto quote = out.message.find('\'', 1);
  if (!out.message.starts_with('\'') || quote == std::string::npos) return out;
  out.message = advised(out.message, std::string_view(out.message).substr(1, quote - 1));
  return out;
}

Error compile_error(const char* log, const std::vector<std::string>& file_names) {
  std::vector<LogLine> lines;
  std::size_t more = 0;
  for (const auto& text : split(log, '\n')) {
    auto line = parse_line(text);
    if (!line || line->message.find("compilation errors.") != std::string::npos ||
        line->message.find("compilation terminated") != std::string::npos)
      continue;
    // A stage that stands in a kernel twice has each of its errors twice.
    if (std::ranges::find(lines, *line) != lines.end()) continue;
    if (lines.size() <= kMaxTrail) {
      lines.push_back(std::move(*line));
    } else {
      ++more;
    }
  }
  const auto file = [&](const LogLine& line) {
    return line.file < file_names.size() ? file_names[line.file] : std::string();
  };
  if (lines.empty()) return shader_error("", 0, "the shader does not compile: " + shortened(trim(log)));
  Error error = shader_error(file(lines[0]), lines[0].line, lines[0].message);
  if (error.file.empty()) error.line = 0;  // the engine's own text: the line would mean nothing to an author
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string in = file(lines[i]);
    error.trail.push_back(in.empty() ? lines[i].message
                                     : fmt::format("{}:{}: {}", in, lines[i].line, lines[i].message));
  }
  if (more > 0) error.trail.push_back(fmt::format("and {} more", more));
  return error;
}

/// Where a name first stands with a parenthesis behind it, by the #line directives of the text.
LogLine first_place(const std::string& glsl, const std::string& name) {
  LogLine place;
  for (const auto& text : split(glsl, '\n')) {
    if (text.starts_with("#line ")) {
      std::istringstream numbers(text.substr(std::string_view("#line ").size()));
      numbers >> place.line >> place.file;
      continue;
    }
    if (text.find(" " + name + "(") != std::string::npos) return place;
    ++place.line;
  }
  return {};
}

Error error_where_named(const LogLine& place, const std::vector<std::string>& file_names, std::string message) {
  return shader_error(place.file < file_names.size() ? file_names[place.file] : std::string(), place.line,
                      std::move(message));
}

/// "Linking fragment stage: Recursion detected:" and then "    f(vf4; calling g(vf4;", without a place.
std::optional<Error> recursion_error(const std::string& log, const std::string& glsl,
                                     const std::vector<std::string>& file_names) {
  constexpr std::string_view kCalling = "; calling ";
  const auto found = log.find("Recursion detected:"), calls = log.find(kCalling, found);
  if (found == std::string::npos || calls == std::string::npos) return std::nullopt;
  const auto until_parenthesis = [&](std::size_t from) { return trim(log.substr(from, log.find('(', from) - from)); };
  const std::string caller = until_parenthesis(log.find('\n', found)),
                    called = until_parenthesis(calls + kCalling.size());
  const LogLine place = first_place(glsl, caller);
  const std::string by = called == caller ? "" : fmt::format(" by way of '{}'", original_names(called));
  return error_where_named(place, file_names,
                           fmt::format("'{}' calls itself{}: GLSL has no recursion", original_names(caller), by));
}

/// "Linking fragment stage: No function definition (body) found:" and then "    f(f1;", without a place.
std::optional<Error> undefined_error(const std::string& log, const std::string& glsl,
                                     const std::vector<std::string>& file_names) {
  constexpr std::string_view kFound = "No function definition (body) found:";
  const auto found = log.find(kFound);
  if (found == std::string::npos) return std::nullopt;
  const auto from = found + kFound.size();
  const std::string name = trim(log.substr(from, log.find('(', from) - from));
  if (name.empty()) return std::nullopt;
  const LogLine place = first_place(glsl, name);
  return error_where_named(place, file_names,
                           fmt::format("'{}' is declared here, but defined nowhere", original_names(name)));
}

/// Where the engine's own text alone does not compile: what it calls stands in the author's, between lines that the
/// preprocessor leaves out.
std::optional<Error> left_out_error(const std::string& log, const std::string& glsl,
                                    const std::vector<std::string>& file_names) {
  for (std::string_view rest = log;;) {
    const std::size_t quote = rest.find('\'');
    if (quote == std::string_view::npos) return std::nullopt;
    rest.remove_prefix(quote + 1);
    const std::string name(rest.substr(0, rest.find('\'')));
    const LogLine place = first_place(glsl, name);
    if (name.empty() || place.file >= file_names.size() || file_names[place.file].empty()) continue;
    return error_where_named(place, file_names,
                             fmt::format("'{}' stands in an #if that is not taken here", original_names(name)));
  }
}

constexpr auto kRules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);

bool parse(glslang::TShader& shader, EShLanguage language, const std::string& glsl, EShMessages rules) {
  const char* text = glsl.data();
  const int length = static_cast<int>(glsl.size());
  shader.setStringsWithLengths(&text, &length, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  return shader.parse(GetDefaultResources(), 460, false, rules);
}

/// Once for all threads. glslang makes its tables of built-in functions in the first parse, under a lock that stays
/// closed when memory ends there: every later call would wait for ever. So that parse is made here, and never again.
/// It is never finalised: other users of glslang in the process may come and go as they like.
bool begin_glslang() {
  static std::once_flag once;
  static bool ready = false;
  std::call_once(once, [] {
    try {
      if (!glslang::InitializeProcess()) return;
      glslang::TShader shader(EShLangFragment);
      ready = parse(shader, EShLangFragment, "#version 460\nvoid main() {}\n", kRules);
    } catch (const std::bad_alloc&) {
    }
  });
  return ready;
}

}  // namespace

std::string glsl_compiler_version() {
  const auto version = glslang::GetVersion();
  return fmt::format("glslang {}.{}.{}{} generator {}", version.major, version.minor, version.patch, version.flavor,
                     glslang::GetSpirvGeneratorVersion());
}

Result<std::vector<std::uint32_t>> compile_glsl(const std::string& glsl, const std::vector<std::string>& file_names,
                                                GlslStage stage, bool with_lines) {
  if (!begin_glslang()) return Error{ErrorKind::other, "the GLSL compiler cannot begin: there was not enough memory"};

  const EShLanguage language = stage == GlslStage::compute ? EShLangCompute : EShLangFragment;
  constexpr auto all_errors = static_cast<EShMessages>(kRules | EShMsgCascadingErrors);
  glslang::TShader shader(language);
  if (!parse(shader, language, glsl, kRules)) {
    glslang::TShader again(language);  // the first time it stops at the first error
    const bool more = !parse(again, language, glsl, all_errors);
    const std::string log = (more ? again : shader).getInfoLog();
    Error error = compile_error(log.c_str(), file_names);
    return error.file.empty() ? left_out_error(log, glsl, file_names).value_or(std::move(error)) : error;
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(kRules)) {
    if (auto recursion = recursion_error(program.getInfoLog(), glsl, file_names)) return *std::move(recursion);
    if (auto undefined = undefined_error(program.getInfoLog(), glsl, file_names)) return *std::move(undefined);
    return compile_error(program.getInfoLog(), file_names);
  }

  glslang::SpvOptions options;
  options.disableOptimizer = true;  // no gain was seen on lavapipe, and it takes longer than the compilation
  options.generateDebugInfo = with_lines;
  std::vector<std::uint32_t> spirv;
  spv::SpvBuildLogger logger;
  glslang::GlslangToSpv(*program.getIntermediate(language), spirv, &logger, &options);
  if (spirv.empty())
    return shader_error("", 0, "the shader gives no SPIR-V: " + shortened(trim(logger.getAllMessages())));
  return spirv;
}

}  // namespace afterglow
