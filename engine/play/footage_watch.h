// SPDX-License-Identifier: MIT
// Footage that is still being rendered: new frames, and those that are rendered once more.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "core/whole_files.h"
#include "play/footage.h"

namespace afterglow {

/// Looks at the files on a thread of its own. Pictures are taken when they are whole. Footage with videos stays as it
/// is.
class FootageWatch {
 public:
  /// `changed` is called on that thread when `take` has something.
  FootageWatch(FootageOptions options, std::shared_ptr<const Footage> footage, std::function<void()> changed);
  ~FootageWatch();
  FootageWatch(const FootageWatch&) = delete;
  FootageWatch& operator=(const FootageWatch&) = delete;

  /// The footage as it is now, once; null: as it was. See Footage::anew.
  std::shared_ptr<const Footage> take();

 private:
  void look();

  FootageOptions options_;
  std::shared_ptr<const Footage> footage_;  ///< the newest; of the thread alone
  std::function<void()> changed_;
  WholeFiles whole_;  ///< of the thread alone
  std::mutex mutex_;
  bool ends_ = false;
  std::shared_ptr<const Footage> newer_;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace afterglow
