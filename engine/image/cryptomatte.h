// SPDX-License-Identifier: MIT
// Cryptomatte (Psyop's specification 1.2.0): which objects, materials or assets cover a pixel, and by how much. Pure
// data.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "image/metadata.h"

namespace afterglow {

/// The id of a name, as its bits stand in a 32-bit float: MurmurHash3 (x86, 32 bits), with exponents that are neither 0
/// nor 255, so that it is an ordinary number.
std::uint32_t cryptomatte_id(std::string_view name);

/// One cryptomatte of a file, as its header says.
struct Cryptomatte {
  std::string layer;                              ///< "ViewLayer.CryptoObject"
  std::map<std::string, std::uint32_t> manifest;  ///< ids by name; empty: the file has none in its header
  std::string manifest_file;                      ///< that has them instead, beside the file; empty: none
};

/// An object that is asked for by a name that no manifest knows.
struct CryptomatteObject {
  std::string layer, name;
  std::uint32_t id = 0;
};

/// The one whose layer is called so or ends so ("CryptoObject"); nothing: there is none. Errors: io (its manifest is no
/// JSON of names and ids).
Result<std::optional<Cryptomatte>> find_cryptomatte(const Metadata& metadata, const std::string& layer);

/// Ids by name. Errors: io (it is no JSON of names and ids).
Result<std::map<std::string, std::uint32_t>> read_manifest(const std::string& text, const std::string& layer);

/// The names in a text that has commas between them. A name in quotation marks may have commas, and \" for such a mark;
/// marks inside of a name without them are its own.
std::vector<std::string> cryptomatte_names(std::string_view text);

}  // namespace afterglow
