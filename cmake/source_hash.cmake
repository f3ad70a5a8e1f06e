# SPDX-License-Identifier: MIT
# Writes a C++ file with one hash of many files: cmake -D root=… -D "globs=…;…" -D template=… -D output=… -P source_hash.cmake
set(patterns ${globs})
list(TRANSFORM patterns PREPEND ${root}/)
file(GLOB_RECURSE files RELATIVE ${root} ${patterns})
list(SORT files)
set(all "")
foreach(file ${files})
  file(SHA256 ${root}/${file} hash)
  string(APPEND all "${file} ${hash}\n")
endforeach()
string(SHA256 AFTERGLOW_SOURCE_HASH "${all}")
configure_file(${template} ${output} @ONLY)
