# SPDX-License-Identifier: MIT
# Writes the header with the commit of the checkout, when it is another than it was. Empty where there is no checkout.
set(commit "")
if(EXISTS ${source}/.git)
  execute_process(COMMAND git -C ${source} describe --always --abbrev=12 --dirty=+changes --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
set(text "// Made by cmake/commit.cmake.\n#define AFTERGLOW_COMMIT \"${commit}\"\n")
if(EXISTS ${header})
  file(READ ${header} before)
endif()
if(NOT "${text}" STREQUAL "${before}")
  file(WRITE ${header} "${text}")
endif()
