// Stands in for tests whose tool was not there when the build was configured: skipped, never passed.
#include <gtest/gtest.h>

namespace orcart::testing {
namespace {

TEST(Absent, SaysWhichToolIsMissing) {
  GTEST_SKIP() << ORCART_ABSENT << " is not installed; install it and configure again";
}

}  // namespace
}  // namespace orcart::testing
