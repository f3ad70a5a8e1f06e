// SPDX-License-Identifier: MIT
// What is done to SPIR-V: of any valid module, each step makes a valid one. The module is what the compiler makes of a
// random shader, made other by passes of SPIRV-Tools (so that it is not as our compiler writes it), or the input
// itself. That the pixels stay: SpirvSteps in tests/unit/shader.
#include <algorithm>
#include <cstring>
#include <functional>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include "fuzz.h"
#include "random_shader.h"
#include "shader/cpu/defeat_uniform_inlining.h"
#include "shader/cpu/interleave.h"
#include "shader/cpu/merge_equal.h"
#include "shader/give_values.h"
#include "shader/glsl.h"
#include "shader/guard_loops.h"
#include "shader/kernel.h"
#include "shader/spirv_module.h"
#include "shader/unroll_arrays.h"

using namespace afterglow;

namespace {

bool is_valid(const Words& spirv) { return spvtools::SpirvTools(kSpirvEnvironment).Validate(spirv); }

std::string text_of(const Words& spirv) {
  std::string out;
  spvtools::SpirvTools(kSpirvEnvironment).Disassemble(spirv, &out);
  return out;
}

std::size_t loops_in(const Words& spirv) {
  const auto module = parse(spirv);
  return module ? static_cast<std::size_t>(std::ranges::count(module->code, spv::OpLoopMerge, &Instruction::op)) : 0;
}

void steps(const Words& spirv, const std::vector<AssembledKernel::UnsetVariable>& unset) {
  const std::vector<std::function<Words(const Words&)>> all{
      [](const Words& in) {
        const ArraysUnrolled out = unroll_over_arrays(in, 1);
        FUZZ_CLAIM(std::ranges::all_of(out.loops, [n = loops_in(in)](auto loop) { return loop < n; }), text_of(in));
        FUZZ_CLAIM(out.loops.size() == loops_in(out.spirv), text_of(in));
        return out.spirv;
      },
      [](const Words& in) { return guard_loops(in, 17).spirv; },
      [&unset](const Words& in) {
        for (const auto number : read_before_written(in, unset)) FUZZ_CLAIM(number < unset.size(), text_of(in));
        return give_values(in);
      },
      [](const Words& in) { return interleave_rows(in, 4).value_or(in); },
      [](const Words& in) { return merge_equal(in).spirv; },
      [](const Words& in) { return defeat_uniform_inlining(in); },
      [](const Words& in) {
        const auto flat = flat_parameters(in, 31);
        if (flat) FUZZ_CLAIM(is_valid(flat->vertex), "vertex shader\n" + text_of(flat->vertex));
        return flat ? flat->fragment : in;
      },
  };
  Words in_turn = spirv;
  for (std::size_t step = 0; step < all.size(); ++step) {
    FUZZ_CLAIM(is_valid(all[step](spirv)), "step " + std::to_string(step) + " alone\n" + text_of(spirv));
    in_turn = all[step](in_turn);
    FUZZ_CLAIM(is_valid(in_turn), "step " + std::to_string(step) + " behind the others\n" + text_of(spirv));
  }
}

/// Passes by the bits of `which`.
Words made_other(const Words& spirv, unsigned which) {
  spvtools::Optimizer optimizer(kSpirvEnvironment);
  optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
  if (which & 1) optimizer.RegisterPass(spvtools::CreateMergeReturnPass());
  if (which & 2) optimizer.RegisterPass(spvtools::CreateInlineExhaustivePass());
  if (which & 4) optimizer.RegisterPass(spvtools::CreateScalarReplacementPass());
  if (which & 8) optimizer.RegisterPass(spvtools::CreateSSARewritePass());
  if (which & 16) optimizer.RegisterPass(spvtools::CreateBlockMergePass());
  if (which & 32) optimizer.RegisterPass(spvtools::CreateLoopUnrollPass(false, 2));
  if (which & 64) optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass());
  if (which & 128) optimizer.RegisterPass(spvtools::CreateCompactIdsPass());
  Words out;
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  return optimizer.Run(spirv.data(), spirv.size(), &out, options) ? out : spirv;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint32_t kMagic = 0x07230203;
  if (size < 4) return 0;
  std::uint32_t first = 0;
  std::memcpy(&first, data, sizeof first);
  if (first == kMagic) {
    Words words(size / 4);
    std::memcpy(words.data(), data, words.size() * 4);
    if (is_valid(words)) steps(words, {});
    return 0;
  }
  const unsigned passes = data[0], rows = 1 + data[1] % 2 * 3;
  const std::string text = fuzz::RandomShader(data + 2, size - 2).text();
  fuzz::write("shaders/x.glsl", text);
  SearchPath path;
  path.user = {fuzz::scratch()};
  ShaderLibrary library(path);
  const auto shader = library.find("x");
  FUZZ_CLAIM(shader.ok(), shader.error().text() + "\n" + text);
  KernelDesc desc;
  desc.sample = KernelStage{*shader, {}, "x"};
  desc.config.rows = static_cast<int>(rows);
  const auto assembled = assemble(desc);
  FUZZ_CLAIM(assembled.ok(), assembled.error().text());
  const auto spirv = compile_glsl(assembled->glsl, assembled->file_names);
  FUZZ_CLAIM(spirv.ok(), spirv.error().text() + "\n" + text);
  const Words other = made_other(*spirv, passes);
  if (is_valid(other)) steps(other, assembled->unset);
  return 0;
}
