// Makes every system call of one thread known to its guard, by a seccomp filter that traps and a handler that
// carries the call out.
#pragma once

#include <array>
#include <string>

namespace orcart::guards {

/// Puts the filter on the calling thread, for as long as it lives; further calls do nothing. False: the
/// kernel refuses it, or this is no x86-64.
bool trap_system_calls_of_this_thread() noexcept;

/// A system call that the filter lets pass unseen: for the guard's own. The kernel's answer, negative errno
/// included.
long unwatched_call(long number, const std::array<long, 6>& arguments) noexcept;

/// "clock_nanosleep", or "system call 230" where the name is not known.
std::string name_of_system_call(int number);

}  // namespace orcart::guards
