// SPDX-License-Identifier: MIT
#include "core/confine_calls.h"

#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/fs.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace afterglow {
namespace {

#ifdef __x86_64__
constexpr std::uint32_t kProcessor = AUDIT_ARCH_X86_64, kOtherCalls = 0x40000000;  // those of x32
#else
constexpr std::uint32_t kProcessor = AUDIT_ARCH_AARCH64, kOtherCalls = ~0u;
#endif

/// Newer than the headers of Debian 12; these numbers are the same on all processors.
constexpr std::uint32_t kMemfdSecret = 447, kProcessMrelease = 448, kFchmodat2 = 452, kSetxattrat = 463,
                        kRemovexattrat = 466, kOpenTreeAttr = 467, kFileSetattr = 469;

// Other processes and the network.
constexpr std::uint32_t kOthers[] = {SYS_socket,
                                     SYS_socketpair,
                                     SYS_connect,
                                     SYS_bind,
                                     SYS_listen,
                                     SYS_execve,
                                     SYS_execveat,
                                     SYS_ptrace,
                                     SYS_process_vm_readv,
                                     SYS_process_vm_writev,
                                     SYS_process_madvise,
                                     kProcessMrelease,
                                     SYS_kcmp,
                                     SYS_tkill,
                                     SYS_rt_sigqueueinfo,
                                     SYS_rt_tgsigqueueinfo,
                                     SYS_pidfd_open,
                                     SYS_pidfd_getfd,
                                     SYS_pidfd_send_signal,
                                     SYS_migrate_pages,
                                     SYS_shmget,
                                     SYS_shmat,
                                     SYS_shmctl,
                                     SYS_semget,
                                     SYS_semop,
                                     SYS_semtimedop,
                                     SYS_semctl,
                                     SYS_msgget,
                                     SYS_msgsnd,
                                     SYS_msgrcv,
                                     SYS_msgctl,
                                     SYS_mq_open,
                                     SYS_mq_unlink,
                                     SYS_mq_notify};

// Files by their names, which Landlock does not ask about; its first two versions not about truncate either. The mode
// and the owner of a file that is open are left: an output keeps the mode of the file that it replaces.
constexpr std::uint32_t kFiles[] = {
    SYS_fchmodat,     kFchmodat2,    SYS_fchownat,   SYS_utimensat,   SYS_truncate,
    SYS_setxattr,     SYS_lsetxattr, SYS_fsetxattr,  SYS_removexattr, SYS_lremovexattr,
    SYS_fremovexattr, kSetxattrat,   kRemovexattrat, kFileSetattr,    SYS_open_by_handle_at,
#ifdef __x86_64__
    SYS_chmod,        SYS_chown,     SYS_lchown,     SYS_utime,       SYS_utimes,
    SYS_futimesat,
#endif
};

// The kernel itself.
constexpr std::uint32_t kKernel[] = {
    SYS_io_uring_setup,
    SYS_io_uring_enter,
    SYS_io_uring_register,
    SYS_bpf,
    SYS_perf_event_open,
    SYS_userfaultfd,
    SYS_keyctl,
    SYS_add_key,
    SYS_request_key,
    SYS_unshare,
    SYS_setns,
    SYS_mount,
    SYS_umount2,
    SYS_pivot_root,
    SYS_chroot,
    SYS_fsopen,
    SYS_fsconfig,
    SYS_fsmount,
    SYS_fspick,
    SYS_open_tree,
    SYS_move_mount,
    SYS_mount_setattr,
    kOpenTreeAttr,
    SYS_quotactl,
    SYS_quotactl_fd,
    SYS_kexec_load,
    SYS_init_module,
    SYS_finit_module,
    SYS_delete_module,
    SYS_reboot,
    SYS_swapon,
    SYS_swapoff,
    SYS_acct,
    SYS_syslog,
    SYS_settimeofday,
    SYS_clock_settime,
    SYS_adjtimex,
    SYS_clock_adjtime,
    SYS_sethostname,
    SYS_setdomainname,
    SYS_fanotify_init,
    kMemfdSecret,
    SYS_kexec_file_load,
#ifdef __x86_64__
    SYS_iopl,
    SYS_ioperm,
    SYS_modify_ldt,
#endif
};

/// A program of seccomp, whose accumulator holds the number of the call between the rules. Of arguments it looks at the
/// lower half: the kernel takes these as 32 bits, and what a caller puts above them must change nothing.
class CallFilter {
 public:
  CallFilter() {
    load(offsetof(seccomp_data, arch));
    when_not(kProcessor, SECCOMP_RET_ERRNO | EPERM);
    load(offsetof(seccomp_data, nr));
    add(BPF_JMP | BPF_JGE | BPF_K, kOtherCalls, 0, 1);
    give(SECCOMP_RET_ERRNO | EPERM);
  }
  template <std::size_t N>
  void forbid(const std::uint32_t (&calls)[N]) {
    for (const auto call : calls) when(call, SECCOMP_RET_ERRNO | EPERM);
  }
  /// As on a kernel without it: callers take the older way.
  void lacks(std::uint32_t call) { when(call, SECCOMP_RET_ERRNO | ENOSYS); }

  struct Is {
    unsigned argument;
    std::uint32_t value, mask = ~0u;
  };
  void forbid_if(std::uint32_t call, std::initializer_list<Is> any) {
    block(call, any, SECCOMP_RET_ERRNO | EPERM, SECCOMP_RET_ALLOW);
  }
  void allow_only_if(std::uint32_t call, std::initializer_list<Is> any) {
    block(call, any, SECCOMP_RET_ALLOW, SECCOMP_RET_ERRNO | EPERM);
  }
  void forbid_bits(std::uint32_t call, unsigned argument, std::uint32_t bits) {
    add(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 4);
    load_argument(argument);
    add(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1);
    give(SECCOMP_RET_ERRNO | EPERM);
    give(SECCOMP_RET_ALLOW);
  }

  bool install() {
    give(SECCOMP_RET_ALLOW);
    const sock_fprog filter{.len = static_cast<unsigned short>(program_.size()), .filter = program_.data()};
    return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &filter) == 0;
  }

 private:
  void add(unsigned code, std::uint32_t k, std::uint8_t if_true = 0, std::uint8_t if_false = 0) {
    program_.push_back({static_cast<std::uint16_t>(code), if_true, if_false, k});
  }
  void load(std::size_t offset) { add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)); }
  void load_argument(unsigned which) { load(offsetof(seccomp_data, args) + which * sizeof(std::uint64_t)); }
  void give(std::uint32_t result) { add(BPF_RET | BPF_K, result); }
  void when(std::uint32_t value, std::uint32_t result) {
    add(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1);
    give(result);
  }
  void when_not(std::uint32_t value, std::uint32_t result) {
    add(BPF_JMP | BPF_JEQ | BPF_K, value, 1, 0);
    give(result);
  }
  void block(std::uint32_t call, std::initializer_list<Is> any, std::uint32_t then, std::uint32_t otherwise) {
    constexpr std::size_t kEach = 4;  // instructions
    add(BPF_JMP | BPF_JEQ | BPF_K, call, 0, static_cast<std::uint8_t>(any.size() * kEach + 1));
    for (const Is& is : any) {
      load_argument(is.argument);
      add(BPF_ALU | BPF_AND | BPF_K, is.mask);
      when(is.value, then);
    }
    give(otherwise);
  }

  std::vector<sock_filter> program_;
};

}  // namespace

Result<void> confine_calls() {
  const auto own = static_cast<std::uint32_t>(getpid());
  CallFilter filter;
  filter.forbid(kOthers);
  filter.forbid(kFiles);
  filter.forbid(kKernel);
  // Itself alone; signal 0 only asks whether a process is there.
  filter.allow_only_if(SYS_kill, {{0, own}, {1, 0}});
  filter.allow_only_if(SYS_tgkill, {{0, own}});
  filter.allow_only_if(SYS_prlimit64, {{0, 0}, {0, own}});
  filter.allow_only_if(SYS_setpriority, {{1, 0}});
  filter.forbid_if(SYS_fcntl, {{1, F_SETOWN}, {1, F_SETOWN_EX}, {1, F_SETSIG}});
  // Typing into the terminal, and flags of files.
  filter.forbid_if(SYS_ioctl, {{1, TIOCSTI},
                               {1, TIOCLINUX},
                               {1, TIOCCONS},
                               {1, TIOCSETD},
                               {1, static_cast<std::uint32_t>(FS_IOC_SETFLAGS)},
                               {1, static_cast<std::uint32_t>(FS_IOC_FSSETXATTR)}});
  // Opened to read, and yet emptied.
  constexpr std::uint32_t kEmptied = O_TRUNC | O_ACCMODE;
  filter.forbid_if(SYS_openat, {{2, O_TRUNC | O_RDONLY, kEmptied}});
#ifdef __x86_64__
  filter.forbid_if(SYS_open, {{1, O_TRUNC | O_RDONLY, kEmptied}});
#endif
  // New processes and threads, in no namespaces of their own. What stands in memory a filter cannot see.
  filter.forbid_bits(
      SYS_clone, 0,
      CLONE_NEWNS | CLONE_NEWCGROUP | CLONE_NEWUTS | CLONE_NEWIPC | CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET);
  filter.lacks(SYS_clone3);
  filter.lacks(SYS_openat2);
  if (filter.install()) return {};
  return Error{ErrorKind::device,
               std::string("this kernel cannot confine a process: seccomp: ") + std::strerror(errno)};
}

}  // namespace afterglow
#endif
