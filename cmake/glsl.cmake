# SPDX-License-Identifier: MIT
# afterglow_glsl(TARGET a.frag b.vert …): shaders of the program's own (effects' are compiled at run time) as SPIR-V in headers:
# `view.frag` becomes "view.frag.h" with `constexpr std::uint32_t kViewFrag[]` in namespace afterglow.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
function(afterglow_glsl target)
  foreach(source ${ARGN})
    string(REGEX REPLACE "[._]" ";" words ${source})
    set(symbol k)
    foreach(word ${words})
      string(SUBSTRING ${word} 0 1 first)
      string(SUBSTRING ${word} 1 -1 rest)
      string(TOUPPER ${first} first)
      string(APPEND symbol ${first}${rest})
    endforeach()
    set(header ${CMAKE_CURRENT_BINARY_DIR}/${source}.h)
    add_custom_command(OUTPUT ${header}
      COMMAND ${GLSLANG_VALIDATOR} -V --quiet --target-env vulkan1.1 -x -o ${header}.words ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      COMMAND ${CMAKE_COMMAND} -D words=${header}.words -D header=${header} -D symbol=${symbol} -P ${PROJECT_SOURCE_DIR}/cmake/glsl_header.cmake
      DEPENDS ${source} ${PROJECT_SOURCE_DIR}/cmake/glsl_header.cmake
      COMMENT "Compiling ${source}" VERBATIM)
    target_sources(${target} PRIVATE ${header})
  endforeach()
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
