// SPDX-License-Identifier: MIT
// An author's shader with libraries: scanned, assembled alone and fused with itself, compiled.
#include "fuzz.h"
#include "shader/kernel.h"

using namespace afterglow;

namespace {

void check(const Result<CompiledKernel>& made) {
  if (!made) return fuzz::check_error(made.error(), {ErrorKind::script});
  FUZZ_CLAIM(!made->spirv.empty(), "");
  for (const auto& param : made->params) FUZZ_CLAIM(param.offset < made->block_size, param.name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = fuzz::split_files(fuzz::text_of(data, size));
  fuzz::write("shaders/x/x.glsl", files[0].text);
  for (std::size_t i = 1; i < 4; ++i)
    fuzz::write("shaders/lib/" + std::string(1, static_cast<char>('a' + i - 1)) + ".glsl",
                i < files.size() ? files[i].text : std::string_view());
  SearchPath path;
  path.user = {fuzz::scratch()};
  ShaderLibrary library(path);
  const auto shader = library.find("x/x");
  if (!shader) {
    fuzz::check_error(shader.error(), {ErrorKind::script});
    FUZZ_CLAIM(!shader.error().file.empty(), shader.error().text());
    return 0;
  }
  KernelCompiler compiler{std::filesystem::path()};
  const KernelStage stage{*shader, {}, "x"};
  const bool begins = info_of((*shader)->interface.kind).begins;
  KernelDesc alone;
  if (begins)
    alone.sample = stage;
  else
    alone.stages = {stage};
  if (const auto made = compiler.compile(alone); !made) {
    fuzz::check_error(made.error(), {ErrorKind::script});
    return 0;
  }
  KernelDesc fused;
  fused.target = size % 2 == 0 ? KernelTarget::unorm8 : KernelTarget::float16;
  fused.config.rows = 1 + static_cast<int>(size % 2);
  if ((*shader)->interface.kind == PassKind::compute) {  // plans make neither codes nor rows of these
    fused.target = KernelTarget::float16;
    fused.config.rows = 1;
  }
  if (begins)
    fused.sample = stage;
  else
    fused.stages = {stage, stage};
  check(compiler.compile(fused));
  return 0;
}
