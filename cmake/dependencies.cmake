# SPDX-License-Identifier: MIT
# Everything comes from Debian packages (see `dev`).
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Vulkan 1.3 REQUIRED)
find_package(SPIRV-Tools REQUIRED)
find_package(SPIRV-Tools-opt REQUIRED)
find_package(glslang CONFIG REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(glm REQUIRED)
find_package(OpenImageIO REQUIRED)
# Debian's target names an include folder that does not exist.
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES /usr/include)
include(${CMAKE_CURRENT_LIST_DIR}/lua.cmake)
pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(MINIZIP REQUIRED IMPORTED_TARGET minizip)
# OpenEXR beside OpenImageIO: see engine/image/exr_file.h.
find_package(OpenEXR REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
pkg_check_modules(LCMS2 REQUIRED IMPORTED_TARGET lcms2)
# Videos: 5.1 (Debian 12) to 7.1 (Debian 13).
if(AFTERGLOW_FFMPEG)
  pkg_check_modules(FFMPEG REQUIRED IMPORTED_TARGET libavformat>=59.27 libavcodec>=59.37 libavutil>=57.28 libswscale>=6.7 zimg>=3.0.4)
endif()
