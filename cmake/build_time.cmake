# SPDX-License-Identifier: MIT
# What keeps builds short: compiled files are kept by ccache; presets for clean builds compile ten files at once (CMakePresets.json).
find_program(CCACHE ccache)
if(CCACHE)
  # Objects are shared between checkouts in different folders: paths below the checkout count as relative.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
endif()

