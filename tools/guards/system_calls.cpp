// Seccomp RET_TRAP on one thread. The filter allows one address: that of the trampoline below, by which the
// handler carries out what was trapped.
#include "tools/guards/system_calls.hpp"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

#include "tools/guards/thread_guard.hpp"

namespace orcart::guards {

std::string name_of_system_call(int number) {
  constexpr std::pair<int, const char*> kNames[] = {
      {SYS_read, "read"},         {SYS_write, "write"},
      {SYS_pread64, "pread64"},   {SYS_ppoll, "ppoll"},
      {SYS_futex, "futex"},       {SYS_clock_nanosleep, "clock_nanosleep"},
      {SYS_ioctl, "ioctl"},       {SYS_clock_gettime, "clock_gettime"},
      {SYS_mmap, "mmap"},         {SYS_munmap, "munmap"},
      {SYS_madvise, "madvise"},   {SYS_brk, "brk"},
      {SYS_mprotect, "mprotect"}, {SYS_sched_yield, "sched_yield"},
      {SYS_openat, "openat"},     {SYS_close, "close"},
      {SYS_getpid, "getpid"},     {SYS_gettid, "gettid"},
      {SYS_fstat, "fstat"},       {SYS_restart_syscall, "restart_syscall"},
      {SYS_mremap, "mremap"},     {SYS_writev, "writev"},
  };
  const auto* const found = std::ranges::find(kNames, number, &std::pair<int, const char*>::first);
  return found != std::end(kNames) ? found->second : "system call " + std::to_string(number);
}

#if defined(__x86_64__) && ORCART_GUARDS

asm(R"(
.text
.globl orcart_unwatched_call
.type orcart_unwatched_call, @function
orcart_unwatched_call:
  .cfi_startproc
  mov %rdi, %rax
  mov %rsi, %rdi
  mov %rdx, %rsi
  mov %rcx, %rdx
  mov %r8, %r10
  mov %r9, %r8
  mov 8(%rsp), %r9
  syscall
.globl orcart_unwatched_return
orcart_unwatched_return:
  ret
  .cfi_endproc
.size orcart_unwatched_call, .-orcart_unwatched_call
)");

extern "C" {
long orcart_unwatched_call(long number, long a, long b, long c, long d, long e, long f);
extern const char orcart_unwatched_return[];
}

namespace {

thread_local constinit bool filtered = false;

// A mask that blocks SIGSYS would turn the next trap into the end of the process, so that bit never gets in;
// and a mask set inside a handler ends with it, so it goes into the context that the thread returns to.
void carry_over_mask(ucontext_t& context) noexcept {
  std::uint64_t mask = 0;
  orcart_unwatched_call(SYS_rt_sigprocmask, SIG_SETMASK, 0, reinterpret_cast<long>(&mask), sizeof mask, 0, 0);
  mask &= ~(std::uint64_t{1} << (SIGSYS - 1));
  for (int signal = 1; signal <= 64; ++signal) {
    if ((mask >> (signal - 1) & 1) != 0)
      sigaddset(&context.uc_sigmask, signal);
    else
      sigdelset(&context.uc_sigmask, signal);
  }
}

void on_trap(int, siginfo_t* info, void* raw_context) {
  const int saved = errno;
  auto& context = *static_cast<ucontext_t*>(raw_context);
  greg_t* const registers = context.uc_mcontext.gregs;
  note_system_call(info->si_syscall, std::bit_cast<const void*>(registers[REG_RIP]));
  registers[REG_RAX] =
      orcart_unwatched_call(info->si_syscall, registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                            registers[REG_R10], registers[REG_R8], registers[REG_R9]);
  if (info->si_syscall == SYS_rt_sigprocmask) carry_over_mask(context);
  errno = saved;
}

constexpr sock_filter load(std::size_t offset) {
  return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}
constexpr sock_filter answer(std::uint32_t what) {
  return BPF_STMT(BPF_RET | BPF_K, what);
}
/// Equal: skips `then` instructions; else: skips `otherwise`.
constexpr sock_filter equals(std::uint32_t value, std::uint8_t then, std::uint8_t otherwise) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, then, otherwise);
}

}  // namespace

bool trap_system_calls_of_this_thread() noexcept {
  if (filtered) return true;
  struct sigaction action {};
  action.sa_sigaction = on_trap;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  const auto allowed = reinterpret_cast<std::uint64_t>(&orcart_unwatched_return);
  // A new thread cannot begin inside a handler, and the return from one is no call: these pass by number.
  sock_filter program[] = {
      load(offsetof(seccomp_data, arch)),
      equals(AUDIT_ARCH_X86_64, 0, 9),
      load(offsetof(seccomp_data, nr)),
      equals(SYS_rt_sigreturn, 7, 0),
      equals(SYS_clone, 6, 0),
      equals(SYS_clone3, 5, 0),
      equals(SYS_vfork, 4, 0),
      load(offsetof(seccomp_data, instruction_pointer)),
      equals(static_cast<std::uint32_t>(allowed), 0, 3),
      load(offsetof(seccomp_data, instruction_pointer) + 4),
      equals(static_cast<std::uint32_t>(allowed >> 32), 0, 1),
      answer(SECCOMP_RET_ALLOW),
      answer(SECCOMP_RET_TRAP),
  };
  const sock_fprog filter{.len = static_cast<unsigned short>(std::size(program)), .filter = program};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  filtered = syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &filter) == 0;
  return filtered;
}

long unwatched_call(long number, const std::array<long, 6>& arguments) noexcept {
  return orcart_unwatched_call(number, arguments[0], arguments[1], arguments[2], arguments[3], arguments[4],
                               arguments[5]);
}

#else

bool trap_system_calls_of_this_thread() noexcept {
  return false;
}

long unwatched_call(long number, const std::array<long, 6>& arguments) noexcept {
  const long answer =
      syscall(number, arguments[0], arguments[1], arguments[2], arguments[3], arguments[4], arguments[5]);
  return answer == -1 ? -errno : answer;
}

#endif

}  // namespace orcart::guards
