// SPDX-License-Identifier: MIT
// Python's other threads run while this one is busy.
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

namespace afterglow::python {

/// While it lives, this thread must not touch Python. Where Python has ended meanwhile, as it does without waiting for
/// daemon threads, the thread never comes back: Python would end it from here (by an exception that must not pass
/// destructors), and nothing that it holds may be let go of any more.
class OthersRun {
 public:
  OthersRun() : thread_(PyEval_SaveThread()) {}
  ~OthersRun() {
    try {
      PyEval_RestoreThread(thread_);
    } catch (abi::__forced_unwind&) {
      for (;;) ::pause();
    }
  }
  OthersRun(const OthersRun&) = delete;

 private:
  PyThreadState* thread_;
};

}  // namespace afterglow::python
