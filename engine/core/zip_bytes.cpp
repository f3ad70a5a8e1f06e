// SPDX-License-Identifier: MIT
#include "core/zip_bytes.h"

#include <algorithm>
#include <cstring>

namespace afterglow {
namespace {

struct Stream {
  const std::string& bytes;
  std::size_t at = 0;
};

Stream& stream_of(voidpf stream) { return *static_cast<Stream*>(stream); }

voidpf open_stream(voidpf bytes, const void*, int) { return new Stream{*static_cast<const std::string*>(bytes)}; }

uLong read_stream(voidpf, voidpf given, void* buffer, uLong size) {
  Stream& stream = stream_of(given);
  const std::size_t got = std::min<std::size_t>(size, stream.bytes.size() - stream.at);
  std::memcpy(buffer, stream.bytes.data() + stream.at, got);
  stream.at += got;
  return static_cast<uLong>(got);
}

uLong write_stream(voidpf, voidpf, const void*, uLong) { return 0; }
ZPOS64_T tell_stream(voidpf, voidpf stream) { return stream_of(stream).at; }

long seek_stream(voidpf, voidpf given, ZPOS64_T offset, int origin) {
  Stream& stream = stream_of(given);
  const std::size_t from = origin == ZLIB_FILEFUNC_SEEK_CUR   ? stream.at
                           : origin == ZLIB_FILEFUNC_SEEK_END ? stream.bytes.size()
                                                              : 0;
  const std::uint64_t to = from + offset;  // wraps where it would be before the beginning
  if (to > stream.bytes.size()) return -1;
  stream.at = static_cast<std::size_t>(to);
  return 0;
}

int close_stream(voidpf, voidpf stream) {
  delete &stream_of(stream);
  return 0;
}

int error_of_stream(voidpf, voidpf) { return 0; }

}  // namespace

Zip open_zip_bytes(const std::string& bytes) {
  zlib_filefunc64_def functions{open_stream, read_stream,  write_stream,    tell_stream,
                                seek_stream, close_stream, error_of_stream, const_cast<std::string*>(&bytes)};
  return Zip(unzOpen2_64("", &functions));
}

}  // namespace afterglow
