// SPDX-License-Identifier: MIT
#include "shader/lined_module.h"

#include <cstdio>
#include <utility>

#include "core/text.h"

namespace afterglow {

Result<LinedModule> compile_with_lines(const std::string& glsl, GlslStage stage) {
  // The compiler's OpLine has lines, but no numbers of files: it counts the lines of the whole text, and the #line
  // directives that are taken out of it tell what they are.
  std::vector<SourcePlace> of_line{{}};  // from 1
  std::string counted;
  SourcePlace next{0, 1};
  for (const auto& line : split(glsl, '\n')) {
    of_line.push_back(next);
    unsigned number = 0, file = 0;
    if (std::sscanf(line.c_str(), "#line %u %u", &number, &file) == 2) {
      next = {file, number};
    } else {
      counted += line;
      ++next.line;
    }
    counted += '\n';
  }
  AFTERGLOW_TRY(const auto spirv, compile_glsl(counted, {}, stage, true));
  auto module = parse(spirv);
  if (!module) return Error{ErrorKind::other, "the compiled shader is no SPIR-V"};
  LinedModule out{std::move(*module), {}};
  SourcePlace place;
  for (const auto& i : out.module.code) {
    if (i.op == spv::OpLine) place = i.words[2] < of_line.size() ? of_line[i.words[2]] : SourcePlace{};
    out.places.push_back(place);
  }
  return out;
}

}  // namespace afterglow
