// SPDX-License-Identifier: MIT
// Why a look does what it does at one frame, as text and data.
#pragma once

#include <string>

#include "apps/look.h"
#include "script/explanation.h"

namespace afterglow {

struct ExplainView {
  const Look& look;
  std::string file;
  BuildContext context;          ///< of the frame that was built
  std::set<std::string> moving;  ///< moving_passes
  std::string entry, setting;    ///< show these alone; empty: all
};

std::string explain_text(const ExplainView& view);
std::string explain_json(const ExplainView& view);

}  // namespace afterglow
