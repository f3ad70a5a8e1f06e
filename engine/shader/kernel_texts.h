// SPDX-License-Identifier: MIT
// The texts of a kernel's shaders and of the libraries that they include, each with names of its own. Internal to the
// room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "shader/kernel.h"
#include "shader/rename.h"

namespace afterglow {

class KernelTexts {
 public:
  /// Adds a stage behind the libraries that it includes, those that are not there yet. `prefix` is that of its names;
  /// `constants` and `readers`: see rewrite.
  void add(const ShaderSource& source, const std::string& prefix, const std::vector<std::string>& constants,
           const StorageReaders& readers);

  /// Libraries, then stages, with #line directives into `file_names`.
  std::string text() const { return libraries_text_ + stages_text_; }
  const std::vector<std::string>& file_names() const { return file_names_; }
  const std::vector<AssembledKernel::UnsetVariable>& unset() const { return unset_; }
  /// Statements that make zeros of what the workgroup's so many invocations share.
  std::string zeros_of_shared(std::int64_t invocations) const;

 private:
  struct Library {
    std::filesystem::path path;
    std::shared_ptr<const ShaderFile> file;
    std::string prefix;
    std::vector<std::size_t> uses;  ///< libraries of this kernel that it sees
  };

  static void see(const Library& library, NameMap& names);
  std::size_t library(const ShaderSource::Include& include, const std::vector<std::size_t>& earlier);
  std::size_t file_index(const std::string& path);
  std::string line_of(const std::filesystem::path& file);
  void add_shared(const ShaderScan& scanned, const std::string& prefix);
  std::size_t add_unset(const ShaderScan& scanned, const std::filesystem::path& file, const std::string& prefix);

  std::vector<Library> libraries_;
  std::string libraries_text_, stages_text_;
  std::vector<std::string> file_names_{"", "lib/prelude.glsl"};
  std::vector<AssembledKernel::UnsetVariable> unset_;
  std::vector<SharedVariable> shared_;  ///< by the names that they have in the kernel
};

}  // namespace afterglow
