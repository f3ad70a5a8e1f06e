// SPDX-License-Identifier: MIT
#include "shader/kernel_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace afterglow {
namespace {

AssembledKernel::UnsetVariable::Role role_of(Unset::Kind kind) {
  using Role = AssembledKernel::UnsetVariable::Role;
  return kind == Unset::Kind::argument ? Role::argument : kind == Unset::Kind::result ? Role::result : Role::variable;
}

/// Functions of GLSL that are the prelude's: a sampler interpolates or not, as the device is told for the engine's own
/// reads, and drivers fold constants in ways of their own. Halves are rounded as the device does,
/// wherever that is left open.
NameMap names_of_prelude() {
  return {{"texture", {"ag_texture"}},
          {"textureLod", {"ag_texture"}},
          {"textureOffset", {"ag_texture_offset"}},
          {"unpackHalf2x16", {"ag_unpack_half"}},
          {"packSnorm4x8", {"ag_pack_snorm"}},
          {"round", {"roundEven"}}};
}

NewName new_name(const std::string& prefix, const GlobalName& name) {
  return {prefix + name.name, name.macro, name.with_arguments, name.field_arguments};
}

}  // namespace

void KernelTexts::add(const ShaderSource& source, const std::string& prefix, const std::vector<std::string>& constants,
                      const StorageReaders& readers) {
  const ShaderScan& scanned = source.file->scan;
  NameMap names = names_of_prelude();
  std::vector<std::size_t> seen;  // include of the source → library of the kernel
  for (const auto& include : source.includes) {
    seen.push_back(library(include, seen));
    see(libraries_[seen.back()], names);
  }
  for (const auto& name : scanned.names) names.insert_or_assign(name.name, new_name(prefix, name));
  add_shared(scanned, prefix);
  stages_text_ += line_of(source.path) + rewrite(source.file->text, scanned, names, constants,
                                                 add_unset(scanned, source.path, prefix), readers);
}

std::string KernelTexts::zeros_of_shared(std::int64_t invocations) const {
  std::string out;
  for (const SharedVariable& shared : shared_)
    out += shared.array ? fmt::format(
                              "  for (uint ag_i = gl_LocalInvocationIndex; ag_i < uint({0}.length()); ag_i += "
                              "{2}u) {0}[ag_i] = {1}(0);\n",
                              shared.name, shared.type, invocations)
                        : fmt::format("  if (gl_LocalInvocationIndex == 0u) {} = {}(0);\n", shared.name, shared.type);
  return out;
}

void KernelTexts::see(const Library& library, NameMap& names) {
  for (const auto& name : library.file->scan.names) names.insert_or_assign(name.name, new_name(library.prefix, name));
}

/// The library of this kernel for an include; its text is added when it is new. `earlier` maps the includes before it.
/// One whose variables keep something is new to each stage: another stage would go on from what it left there.
std::size_t KernelTexts::library(const ShaderSource::Include& include, const std::vector<std::size_t>& earlier) {
  Library added{include.path, include.file, fmt::format("ag_l{}_", libraries_.size()), {}};
  for (const auto use : include.uses) added.uses.push_back(earlier.at(use));
  for (std::size_t i = 0; i < libraries_.size() && !include.file->scan.keeps_state; ++i)
    if (libraries_[i].path == added.path && libraries_[i].file->text == added.file->text &&
        libraries_[i].uses == added.uses)
      return i;
  const ShaderScan& scanned = include.file->scan;
  NameMap names = names_of_prelude();
  for (const auto use : added.uses) see(libraries_[use], names);
  see(added, names);
  add_shared(scanned, added.prefix);
  libraries_text_ += line_of(include.path) +
                     rewrite(include.file->text, scanned, names, {}, add_unset(scanned, include.path, added.prefix));
  libraries_.push_back(std::move(added));
  return libraries_.size() - 1;
}

std::size_t KernelTexts::file_index(const std::string& path) {
  const auto known = std::find(file_names_.begin() + 2, file_names_.end(), path);
  if (known != file_names_.end()) return static_cast<std::size_t>(known - file_names_.begin());
  file_names_.push_back(path);
  return file_names_.size() - 1;
}

std::string KernelTexts::line_of(const std::filesystem::path& file) {
  return fmt::format("#line 1 {}\n", file_index(file.string()));
}

void KernelTexts::add_shared(const ShaderScan& scanned, const std::string& prefix) {
  for (SharedVariable variable : scanned.shared) {
    variable.name = prefix + variable.name;
    shared_.push_back(std::move(variable));
  }
}

/// Numbers the file's variables without a value; returns the first number.
std::size_t KernelTexts::add_unset(const ShaderScan& scanned, const std::filesystem::path& file,
                                   const std::string& prefix) {
  const std::size_t first = unset_.size();
  for (const auto& unset : scanned.unset)
    unset_.push_back({unset.name, unset.kind == Unset::Kind::global ? prefix + unset.name : std::string(),
                      file.string(), unset.line, role_of(unset.kind)});
  return first;
}

}  // namespace afterglow
