// SPDX-License-Identifier: MIT
// Zips that were read already: what minizip sees is what was hashed, whatever lies on disk by now.
#pragma once

#include <minizip/unzip.h>

#include <memory>
#include <string>

namespace afterglow {

struct CloseZip {
  void operator()(void* zip) const { unzClose(zip); }
};
using Zip = std::unique_ptr<void, CloseZip>;

/// Null: it is none. `bytes` must outlive it.
Zip open_zip_bytes(const std::string& bytes);

}  // namespace afterglow
