// SPDX-License-Identifier: MIT
#include "shader/reflect.h"

#include <fmt/format.h>
#include <spirv_cross_c.h>

#include <algorithm>
#include <memory>

namespace afterglow {
namespace {

struct DestroyContext {
  void operator()(spvc_context context) const { spvc_context_destroy(context); }
};
using Context = std::unique_ptr<spvc_context_s, DestroyContext>;

Error reflection_error(const Context& context) {
  const char* reason = context ? spvc_context_get_last_error_string(context.get()) : nullptr;
  return Error{ErrorKind::other,
               fmt::format("the compiled shader cannot be read back: {}", reason ? reason : "out of memory")};
}

}  // namespace

Result<Reflection> reflect(const std::vector<std::uint32_t>& spirv) {
  spvc_context raw = nullptr;
  if (spvc_context_create(&raw) != SPVC_SUCCESS) return reflection_error(nullptr);
  const Context context(raw);
  spvc_parsed_ir ir = nullptr;
  spvc_compiler compiler = nullptr;
  spvc_resources resources = nullptr;
  if (spvc_context_parse_spirv(context.get(), spirv.data(), spirv.size(), &ir) != SPVC_SUCCESS ||
      spvc_context_create_compiler(context.get(), SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler) !=
          SPVC_SUCCESS ||
      spvc_compiler_create_shader_resources(compiler, &resources) != SPVC_SUCCESS)
    return reflection_error(context);

  Reflection out;
  const spvc_reflected_resource* list = nullptr;
  std::size_t count = 0;
  if (spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, &list, &count) !=
      SPVC_SUCCESS)
    return reflection_error(context);
  if (count > 1) return Error{ErrorKind::other, "the compiled shader has more than one uniform block"};
  for (std::size_t i = 0; i < count; ++i) {
    const spvc_type type = spvc_compiler_get_type_handle(compiler, list[i].base_type_id);
    std::size_t size = 0;
    if (spvc_compiler_get_declared_struct_size(compiler, type, &size) != SPVC_SUCCESS) return reflection_error(context);
    out.block_size = static_cast<std::uint32_t>((size + 15) / 16 * 16);
    for (unsigned m = 0; m < spvc_type_get_num_member_types(type); ++m) {
      Reflection::Member member;
      if (spvc_compiler_type_struct_member_offset(compiler, type, m, &member.offset) != SPVC_SUCCESS)
        return reflection_error(context);
      const spvc_type of = spvc_compiler_get_type_handle(compiler, spvc_type_get_member_type(type, m));
      member.components = spvc_type_get_vector_size(of);
      member.columns = spvc_type_get_columns(of);
      if (const unsigned dimensions = spvc_type_get_num_array_dimensions(of); dimensions > 1)
        return Error{ErrorKind::other, "the compiled shader has parameters that are arrays of arrays"};
      else if (dimensions == 1)
        member.elements = spvc_type_get_array_dimension(of, 0);
      out.members[spvc_compiler_get_member_name(compiler, list[i].base_type_id, m)] = member;
    }
  }
  for (const auto type : {SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, SPVC_RESOURCE_TYPE_STORAGE_IMAGE}) {
    if (spvc_resources_get_resource_list_for_type(resources, type, &list, &count) != SPVC_SUCCESS)
      return reflection_error(context);
    for (std::size_t i = 0; i < count; ++i)
      out.image_bindings.push_back(spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationBinding));
  }
  std::sort(out.image_bindings.begin(), out.image_bindings.end());
  return out;
}

}  // namespace afterglow
