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
pkg_check_modules(LUA REQUIRED IMPORTED_TARGET lua5.4-c++)  # built as C++: errors run destructors
pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(MINIZIP REQUIRED IMPORTED_TARGET minizip)
# OpenEXR beside OpenImageIO: see engine/image/exr_file.h.
find_package(OpenEXR REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
pkg_check_modules(LCMS2 REQUIRED IMPORTED_TARGET lcms2)
