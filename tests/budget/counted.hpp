// One step for callgrind to count: a dump of its own, named by the step and its size. One file a program.
#pragma once

#include <list>
#include <string>

#include <hwy/nanobenchmark.h>
#include <hwy/targets.h>
#include <valgrind/callgrind.h>

// Highway's library times its timer before main(), by an instruction that valgrind does not know on every
// machine; this takes the place of it, and nobody asks for the answer.
uint64_t hwy::platform::TimerResolution() {
  return 1;
}

namespace orcart::testing {

constexpr int kNoAvx2 = 77;  ///< exit status

/// One instruction set wherever it runs: the cutout picks its vector code by what the processor has, and so
/// do Embree and the C library, to which valgrind shows a processor with AVX2 wherever there is one. False:
/// none.
inline bool pin_to_avx2() {
  if ((hwy::SupportedTargets() & HWY_AVX2) == 0) return false;
  hwy::SetSupportedTargetsForTest(HWY_AVX2);
  return true;
}

template <class Step>
void count(const char* name, int size, Step&& step) {
  static std::list<std::string> names;  // callgrind reads a name when it writes the dump, later
  const std::string& dump = names.emplace_back(std::string(name) + "-" + std::to_string(size));
  CALLGRIND_ZERO_STATS;
  CALLGRIND_TOGGLE_COLLECT;
  step();
  CALLGRIND_TOGGLE_COLLECT;
  CALLGRIND_DUMP_STATS_AT(dump.c_str());
}

}  // namespace orcart::testing
