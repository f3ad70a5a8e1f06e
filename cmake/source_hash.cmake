# SPDX-License-Identifier: MIT
# Writes a C++ file with one hash of all sources in a folder: cmake -D folder=… -D output=… -P source_hash.cmake
file(GLOB_RECURSE files RELATIVE ${folder} ${folder}/*.cpp ${folder}/*.h)
list(SORT files)
set(all "")
foreach(file ${files})
  file(SHA256 ${folder}/${file} hash)
  string(APPEND all "${file} ${hash}\n")
endforeach()
string(SHA256 AFTERGLOW_SOURCE_HASH "${all}")
configure_file(${folder}/source_hash.cpp.in ${output} @ONLY)
