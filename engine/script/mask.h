// SPDX-License-Identifier: MIT
// Masks: fx.mask.NAME{…} and what operators make of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "script/lua.h"

namespace afterglow::script {

class TableReader;
struct DeclaredEntry;
struct Runtime;

/// Pushes `fx.mask`, whose fields are functions that make masks.
void push_masks(lua_State* lua);

/// The key `mask` of an entry: a mask or a number. Notes failures in `table`.
void read_mask(lua_State* lua, TableReader& table, DeclaredEntry& declared);

/// A new mask of Runtime::masks that is this number everywhere.
int make_number_mask(Runtime& runtime, double number);

/// Names of the parts of one mask, as they are met from left to right: "mask.luma", then "mask.luma#2".
class MaskNames {
 public:
  std::string next(const std::string& mask);

 private:
  std::map<std::string, int> met_;
};

/// The settings of its parts: "mask.luma.from".
std::vector<std::string> mask_setting_names(const Runtime& runtime, int mask);
/// Copies a mask, so that the part of this name can be changed for one entry alone. Null: it has no such part. The
/// pointer holds until another mask is made.
DeclaredEntry* own_mask_part(Runtime& runtime, int& mask, const std::string& part);

}  // namespace afterglow::script
