// SPDX-License-Identifier: MIT
/* afterglow.h is C11 without a warning. */
#include "afterglow.h"

size_t afterglow_header_check(void);
size_t afterglow_header_check(void) { return afterglow_stack_options_default().struct_size; }
