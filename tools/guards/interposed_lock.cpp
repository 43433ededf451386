// pthread_mutex_lock of the program: reports each call to the guard, then calls the C library's.
#include <dlfcn.h>
#include <pthread.h>

#include "tools/guards/thread_guard.hpp"

namespace {

using MutexCall = int (*)(pthread_mutex_t*);

// Constant-initialised: locks are taken before any constructor of this program has run. Two threads may both
// look the name up; they find the same address.
constinit MutexCall real_lock = nullptr;
constinit MutexCall real_trylock = nullptr;

MutexCall resolve(MutexCall& slot, const char* name) {
  MutexCall found = __atomic_load_n(&slot, __ATOMIC_RELAXED);  // no partner: the address is all there is
  if (found == nullptr) {
    found = reinterpret_cast<MutexCall>(dlsym(RTLD_NEXT, name));
    __atomic_store_n(&slot, found, __ATOMIC_RELAXED);
  }
  return found;
}

}  // namespace

extern "C" {

extern const char orcart_interposed_lock;
const char orcart_interposed_lock = 1;

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  orcart::guards::note_call(orcart::guards::Ask::lock, __builtin_return_address(0));
  return resolve(real_lock, "pthread_mutex_lock")(mutex);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  orcart::guards::note_call(orcart::guards::Ask::lock, __builtin_return_address(0));
  return resolve(real_trylock, "pthread_mutex_trylock")(mutex);
}

}  // extern "C"
