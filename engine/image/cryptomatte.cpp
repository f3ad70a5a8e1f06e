// SPDX-License-Identifier: MIT
#include "image/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "core/parse_number.h"
#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::string_view kPrefix = "cryptomatte/";

std::uint32_t murmur3(std::string_view text) {
  constexpr std::uint32_t c1 = 0xcc9e2d51, c2 = 0x1b873593;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  std::uint32_t hash = 0;
  std::size_t i = 0;
  for (; i + 4 <= text.size(); i += 4) {
    const std::uint32_t block = byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24;
    hash = std::rotl(hash ^ std::rotl(block * c1, 15) * c2, 13) * 5 + 0xe6546b64;
  }
  std::uint32_t rest = 0;
  for (std::size_t k = text.size(); k > i; --k) rest = rest << 8 | byte(k - 1);
  hash ^= std::rotl(rest * c1, 15) * c2;
  hash ^= static_cast<std::uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6b;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35;
  return hash ^ hash >> 16;
}

const std::string* text_of(const Metadata& metadata, const std::string& name) {
  const MetadataValue* value = find_metadata(metadata, name);
  return value ? std::get_if<std::string>(value) : nullptr;
}

/// "cryptomatte/9e7aab0/name" → "cryptomatte/9e7aab0", for each cryptomatte, with its layer.
std::vector<std::pair<std::string, std::string>> all_of(const Metadata& metadata) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& entry : metadata) {
    const auto* layer = std::get_if<std::string>(&entry.value);
    if (layer && entry.name.starts_with(kPrefix) && entry.name.ends_with("/name"))
      out.emplace_back(entry.name.substr(0, entry.name.size() - 5), *layer);
  }
  return out;
}

std::optional<std::uint32_t> read_id(std::string_view digits) { return parse_number<std::uint32_t>(digits, 16); }

/// Blender writes names as they are, and one with a quotation mark in it makes the manifest no JSON. What ends a name
/// is known all the same: a mark, a colon, eight digits in marks, then a comma or the end.
std::optional<std::map<std::string, std::uint32_t>> read_unescaped(std::string_view text) {
  constexpr std::string_view kBetween = "\":\"";
  constexpr std::size_t kDigits = 8;
  std::map<std::string, std::uint32_t> out;
  if (!text.starts_with("{\"") || !text.ends_with("\"}")) return {};
  for (std::size_t name = 2;;) {
    std::size_t end = text.find(kBetween, name);
    std::optional<std::uint32_t> id;
    for (; end != std::string_view::npos; end = text.find(kBetween, end + 1)) {
      const std::string_view rest = text.substr(end + kBetween.size());
      if (rest.size() < kDigits + 2 || rest[kDigits] != '"' || (rest[kDigits + 1] != ',' && rest.size() > kDigits + 2))
        continue;
      if ((id = read_id(rest.substr(0, kDigits)))) break;
    }
    if (!id) return {};
    out[std::string(text.substr(name, end - name))] = *id;
    const std::size_t behind = end + kBetween.size() + kDigits + 1;
    if (text.substr(behind) == "}") return out;
    if (text.substr(behind, 2) != ",\"") return {};
    name = behind + 2;
  }
}

}  // namespace

Result<std::map<std::string, std::uint32_t>> read_manifest(const std::string& text, const std::string& layer) {
  const auto wrong = [&](const std::string& what) {
    return Error{ErrorKind::io, fmt::format("the manifest of the cryptomatte '{}' {}", layer, what)};
  };
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded())
    if (auto names = read_unescaped(text)) return std::move(*names);
  if (!json.is_object()) return wrong("is no JSON object");
  std::map<std::string, std::uint32_t> out;
  for (const auto& [name, id] : json.items()) {
    const auto value = id.is_string() ? read_id(id.get_ref<const std::string&>()) : std::nullopt;
    if (!value) return wrong(fmt::format("has no id of eight hexadecimal digits for '{}'", name));
    out[name] = *value;
  }
  return out;
}

std::uint32_t cryptomatte_id(std::string_view name) {
  const std::uint32_t hash = murmur3(name), exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

std::vector<std::string> cryptomatte_names(std::string_view text) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == ' ' || text[i] == '\t' || text[i] == ',') continue;
    std::string name;
    if (text[i] == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i) {
        if (text[i] == '\\' && i + 1 < text.size()) ++i;
        name += text[i];
      }
      i = std::min(text.find(',', i), text.size());
    } else {
      const std::size_t end = std::min(text.find(',', i), text.size());
      name = trim(text.substr(i, end - i));
      i = end;
    }
    if (!name.empty()) out.push_back(std::move(name));
  }
  return out;
}

Result<std::optional<Cryptomatte>> find_cryptomatte(const Metadata& metadata, const std::string& layer) {
  for (const auto& [key, name] : all_of(metadata)) {
    if (name != layer && !name.ends_with("." + layer)) continue;
    Cryptomatte out{name, {}, {}};
    if (const std::string* manifest = text_of(metadata, key + "/manifest")) {
      AFTERGLOW_TRY(out.manifest, read_manifest(*manifest, name));
    } else if (const std::string* file = text_of(metadata, key + "/manif_file")) {
      out.manifest_file = *file;
    }
    return std::optional(std::move(out));
  }
  return std::optional<Cryptomatte>();
}

}  // namespace afterglow
