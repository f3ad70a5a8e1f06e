# SPDX-License-Identifier: MIT
# Turns the numbers that glslangValidator writes into a header.
file(READ ${words} numbers)
file(WRITE ${header} "#pragma once\n#include <cstdint>\nnamespace afterglow {\ninline constexpr std::uint32_t ${symbol}[] = {\n${numbers}};\n}\n")
