# SPDX-License-Identifier: MIT
# What shells, `man` and desktops know of the program; the texts come from the program itself.
set(words ${CMAKE_BINARY_DIR}/words)
add_custom_command(OUTPUT ${words}/made DEPENDS afterglow ${CMAKE_CURRENT_LIST_DIR}/words.cmake
  COMMAND ${CMAKE_COMMAND} -D program=$<TARGET_FILE:afterglow> -D folder=${words} -P ${CMAKE_CURRENT_LIST_DIR}/words.cmake
  COMMENT "Writing manual pages and completions" VERBATIM)
if(NOT AFTERGLOW_FUZZ)
  add_custom_target(afterglow_words ALL DEPENDS ${words}/made)
  install(DIRECTORY ${words}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
  install(FILES ${words}/bash/afterglow DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  # Debian's zsh looks into the one for packages and into the other below /usr/local.
  set(zsh_folder site-functions)
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(zsh_folder vendor-completions)
  endif()
  install(FILES ${words}/zsh/_afterglow DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_folder} COMPONENT program)
  install(FILES ${words}/fish/afterglow.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
endif()
install(FILES packaging/org.afterglow.afterglow.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
install(FILES packaging/org.afterglow.afterglow.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT program)
install(FILES packaging/afterglow.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
install(FILES packaging/afterglow.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT program)
install(FILES packaging/afterglow.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/mimetypes
  RENAME text-x-afterglow-look.svg COMPONENT program)
