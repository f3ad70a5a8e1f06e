# SPDX-License-Identifier: MIT
# afterglow_room(NAME SOURCES a.cpp … USES core … LIBRARIES fmt::fmt …)
# One static library a folder of engine/. `USES` are rooms whose headers its own headers include; `LIBRARIES` stay private.
function(afterglow_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  add_library(afterglow_${name} STATIC ${ROOM_SOURCES})
  target_include_directories(afterglow_${name} PUBLIC ${PROJECT_SOURCE_DIR}/engine)
  target_compile_options(afterglow_${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
  foreach(used ${ROOM_USES})
    target_link_libraries(afterglow_${name} PUBLIC afterglow_${used})
  endforeach()
  target_link_libraries(afterglow_${name} PRIVATE ${ROOM_LIBRARIES})
endfunction()

# afterglow_test(NAME SOURCES a.cpp … USES core …): one GoogleTest binary, its cases known to ctest.
function(afterglow_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;USES;LIBRARIES;PROPERTIES" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  foreach(used ${TEST_USES})
    target_link_libraries(test_${name} PRIVATE afterglow_${used})
  endforeach()
  target_link_libraries(test_${name} PRIVATE ${TEST_LIBRARIES} GTest::gmock GTest::gtest_main)
  target_compile_options(test_${name} PRIVATE -Wall -Wextra)
  target_compile_definitions(test_${name} PRIVATE
    AFTERGLOW_TEST_FOLDER="${PROJECT_SOURCE_DIR}/tests"
    AFTERGLOW_PROJECT_FOLDER="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(test_${name} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60 PROPERTIES ${TEST_PROPERTIES})
endfunction()
