// The malloc family of the program: reports each call to the guard, then does what glibc's own does.
#include <cerrno>
#include <cstddef>

#include "tools/guards/thread_guard.hpp"

using orcart::guards::Ask;
using orcart::guards::note_call;

extern "C" {

extern const char orcart_interposed_heap;
const char orcart_interposed_heap = 1;

// glibc's own entry points, which the public names are aliases of.
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* pointer, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void* __libc_valloc(std::size_t bytes);
void __libc_free(void* pointer);

void* malloc(std::size_t bytes) {
  note_call(Ask::allocation, __builtin_return_address(0));
  return __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) {
  note_call(Ask::allocation, __builtin_return_address(0));
  return __libc_calloc(count, bytes);
}

void* realloc(void* pointer, std::size_t bytes) {
  note_call(Ask::allocation, __builtin_return_address(0));
  return __libc_realloc(pointer, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) {
  note_call(Ask::allocation, __builtin_return_address(0));
  return __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  note_call(Ask::allocation, __builtin_return_address(0));
  return __libc_memalign(alignment, bytes);
}

void* valloc(std::size_t bytes) {
  note_call(Ask::allocation, __builtin_return_address(0));
  return __libc_valloc(bytes);
}

int posix_memalign(void** pointer, std::size_t alignment, std::size_t bytes) {
  note_call(Ask::allocation, __builtin_return_address(0));
  if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* const memory = __libc_memalign(alignment, bytes);
  if (memory == nullptr) return ENOMEM;
  *pointer = memory;
  return 0;
}

void free(void* pointer) {
  if (pointer != nullptr) note_call(Ask::free, __builtin_return_address(0));
  __libc_free(pointer);
}

}  // extern "C"
