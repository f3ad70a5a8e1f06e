// SPDX-License-Identifier: MIT
// Small text helpers that error messages share.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace afterglow {

/// The candidate with the smallest edit distance to `name` (two neighbours changed over are one edit). When none is
/// near (distance above a third of the longer name, rounded up), the shortest that begins with its letters or holds
/// them; else "". Ties go to the earlier candidate.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "a, b, c".
std::string join(std::span<const std::string> parts, std::string_view separator = ", ");

std::vector<std::string> split(std::string_view text, char separator);
bool starts_with_any(std::string_view text, std::span<const std::string_view> prefixes);
std::string trim(std::string_view text);
std::string lower(std::string_view text);

/// For XML and HTML, between tags and in attributes: & < > and quotation marks as entities.
std::string markup_text(std::string_view text);

/// Shortest decimal text that reads back as the same float ("0.2", not "0.20000000298").
std::string number_text(double value);

/// "6.0 GiB", "512 MiB", "3 KiB", "12 bytes".
std::string memory_text(std::uint64_t bytes);

}  // namespace afterglow
