// SPDX-License-Identifier: MIT
#include "exec/parameters.h"

#include <fmt/format.h>

#include <cstring>

namespace afterglow {

namespace {

/// Whether it has as many numbers as the shader reads.
bool is_of(const ParamValue& value, const KernelParam& param) {
  const int numbers = component_count(param.type) * std::max(param.elements, 1);
  return value.elements == param.elements && value.v.size() == static_cast<std::size_t>(numbers);
}

Result<void> check_parameters(const Graph& graph, const KernelBlock& block) {
  for (const auto& param : block.compiled->params) {
    const Pass& pass = pass_of_stage(graph, block.kernel, param.stage);
    const auto given = pass.params.find(param.name);
    const char* wrong = given == pass.params.end()    ? "lacks"
                        : is_of(given->second, param) ? nullptr
                                                      : "has another type of";
    if (wrong)
      return Error{ErrorKind::script,
                   fmt::format("pass '{}' {} the parameter '{}' of its shader", pass.name, wrong, param.name),
                   pass.file, pass.line};
  }
  return {};
}

bool is_integer(ParamType type) {
  return type == ParamType::int1 || type == ParamType::int2 || type == ParamType::bool1;
}

/// 4 bytes; a bool is a 32-bit 0 or 1.
void write_number(double value, ParamType type, std::byte* to) {
  if (is_integer(type)) {
    const auto number = type == ParamType::bool1 ? std::int32_t{value != 0} : static_cast<std::int32_t>(value);
    std::memcpy(to, &number, 4);
  } else {
    const auto number = static_cast<float>(value);
    std::memcpy(to, &number, 4);
  }
}

/// std140: components of a vector follow each other; columns of a matrix and elements of an array are 16 bytes apart.
void write_value(const ParamValue& value, const KernelParam& param, std::byte* to) {
  constexpr std::size_t kApart = 16;
  const auto vector = static_cast<std::size_t>(vector_length(param.type));
  for (std::size_t i = 0; i < value.v.size(); ++i)
    write_number(value.v[i], param.type, to + i / vector * kApart + i % vector * 4);
}

}  // namespace

Result<ParameterBuffer> ParameterBuffer::create(const Device& device, const Graph& graph, const Plan& plan,
                                                const std::vector<const CompiledKernel*>& compiled) {
  const auto& limits = device.properties().limits;
  const VkDeviceSize alignment = std::max<VkDeviceSize>(limits.minUniformBufferOffsetAlignment, 16);
  ParameterBuffer out;
  VkDeviceSize size = 0;
  for (std::size_t i = 0; i < plan.kernels.size(); ++i) {
    KernelBlock block{.kernel = plan.kernels[i], .compiled = compiled[i], .offset = size};
    AFTERGLOW_CHECK(check_parameters(graph, block));
    if (block.compiled->block_size > limits.maxUniformBufferRange) {
      return Error{ErrorKind::device,
                   fmt::format("kernel '{}' has {} bytes of parameters, the device allows {}", plan.kernels[i].name,
                               block.compiled->block_size, limits.maxUniformBufferRange)};
    }
    size += (block.compiled->block_size + alignment - 1) / alignment * alignment;
    out.blocks_.push_back(std::move(block));
  }
  if (size > 0) {
    AFTERGLOW_TRY(out.buffer_,
                  Buffer::create(device, size, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, HostAccess::write, "parameters"));
    std::memset(out.buffer_.data(), 0, size);
    out.values_.resize(size);
    AFTERGLOW_CHECK(out.write(graph));
  }
  return out;
}

Result<void> ParameterBuffer::write(const Graph& graph) {
  if (values_.empty()) return {};
  for (const KernelBlock& block : blocks_) {
    for (const auto& param : block.compiled->params) {
      const Pass& pass = pass_of_stage(graph, block.kernel, param.stage);
      const auto value = pass.params.find(param.name);
      if (value == pass.params.end()) continue;
      write_value(value->second, param, values_.data() + block.offset + param.offset);
    }
  }
  std::memcpy(buffer_.data(), values_.data(), values_.size());
  return buffer_.memory().flush();
}

std::string_view ParameterBuffer::bytes(std::size_t kernel) const {
  const KernelBlock& block = blocks_[kernel];
  if (block.compiled->block_size == 0) return {};
  return {reinterpret_cast<const char*>(values_.data()) + block.offset, block.compiled->block_size};
}

}  // namespace afterglow
