// SPDX-License-Identifier: MIT
#include "shader/loop_places.h"

#include <cstdio>

#include "core/text.h"
#include "shader/spirv_module.h"

namespace afterglow {

Result<std::vector<std::uint32_t>> loop_places(const std::string& glsl, GlslStage stage) {
  // The compiler's OpLine has lines, but no numbers of files: it counts the lines of the whole text, and the #line
  // directives that are taken out of it tell what they are.
  struct Place {
    std::uint32_t file = 0, line = 0;
  };
  std::vector<Place> places{{}};  // by line, from 1
  std::string counted;
  Place next{0, 1};
  for (const auto& line : split(glsl, '\n')) {
    places.push_back(next);
    unsigned number = 0, file = 0;
    if (std::sscanf(line.c_str(), "#line %u %u", &number, &file) == 2) {
      next = {file, number};
    } else {
      counted += line;
      ++next.line;
    }
    counted += '\n';
  }
  std::vector<std::uint32_t> out;
  AFTERGLOW_TRY(const auto spirv, compile_glsl(counted, {}, stage, true));
  const auto module = parse(spirv);
  if (!module) return Error{ErrorKind::other, "the compiled shader is no SPIR-V"};
  std::uint32_t line = 0;
  for (const auto& i : module->code) {
    if (i.op == spv::OpLine) line = i.words[2];
    if (i.op != spv::OpLoopMerge) continue;
    const Place place = line < places.size() ? places[line] : Place{};
    out.insert(out.end(), {place.file, place.line});
  }
  return out;
}

}  // namespace afterglow
