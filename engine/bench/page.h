// SPDX-License-Identifier: MIT
// The parts of bench.html; see engine/bench/page/.
#pragma once

namespace afterglow::bench {

extern const char* const kPageHtml;    ///< with @chart@, @data@ and @script@
extern const char* const kPageScript;  ///< draws what @data@ holds
extern const char* const kPageChart;   ///< Chart.js

}  // namespace afterglow::bench
