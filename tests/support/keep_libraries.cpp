// Keeps every loaded library mapped until the process ends, so that LeakSanitizer can name the one that
// leaked.
extern "C" int dlclose(void*);

/// Takes the place of libc's in a test program under AddressSanitizer. A GL driver that was unmapped leaves
/// leaks of an "unknown module", which no suppression can match.
extern "C" int dlclose(void*) {
  return 0;
}
