// Before Highway's foreach_target.h in files that use wide.hpp: vectors whose size is known only at run time
// cannot be members of its types.
#pragma once
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
