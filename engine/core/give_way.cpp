// SPDX-License-Identifier: MIT
#include "core/give_way.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/parallel.h"

namespace afterglow {

void give_way() {
  constexpr int kNice = 15;  // Linux keeps it by thread; those that a thread makes are born with it
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
  loop_alone();
}

}  // namespace afterglow
