// The malloc family of the tool: counts each call, then does what glibc's own does.
#include "tools/bench/heap_calls.hpp"

#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

namespace orcart {
std::optional<std::uint64_t> heap_calls_of_this_thread() noexcept {
  return std::nullopt;
}
}  // namespace orcart

#else

namespace {
constinit thread_local std::uint64_t calls = 0;
}  // namespace

namespace orcart {
std::optional<std::uint64_t> heap_calls_of_this_thread() noexcept {
  return calls;
}
}  // namespace orcart

extern "C" {

// glibc's own entry points, which the public names are aliases of.
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* pointer, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* malloc(std::size_t bytes) {
  ++calls;
  return __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) {
  ++calls;
  return __libc_calloc(count, bytes);
}

void* realloc(void* pointer, std::size_t bytes) {
  ++calls;
  return __libc_realloc(pointer, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  ++calls;
  return __libc_memalign(alignment, bytes);
}

int posix_memalign(void** pointer, std::size_t alignment, std::size_t bytes) {
  ++calls;
  if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* const memory = __libc_memalign(alignment, bytes);
  if (memory == nullptr) return ENOMEM;
  *pointer = memory;
  return 0;
}

}  // extern "C"

#endif
