// The checker takes JSON and nothing else.
#include "tests/support/json_check.hpp"

#include <gtest/gtest.h>

namespace orcart::testing {
namespace {

TEST(JsonCheck, TakesEveryKindOfValue) {
  for (const char* good :
       {"{}", "[]", " [1, -2.5e-3, 0, 1E+9] ", R"({"a":{"b":[true,false,null,"\u00e4\n\""]}})", "\"\""})
    EXPECT_EQ(JsonCheck::fault_in(good), "") << good;
}

TEST(JsonCheck, SaysWhereATextStopsBeingJson) {
  for (const char* bad : {"", "{", "[1,]", "{\"a\":}", "{a:1}", "[nan]", "[inf]", "[01]", "[1.]", "\"\\x\"",
                          "\"", "[] []", "[1 2]", "\"\n\""})
    EXPECT_NE(JsonCheck::fault_in(bad), "") << bad;
  EXPECT_EQ(JsonCheck::fault_in("[1, nan]"), "byte 4: nan]");
}

}  // namespace
}  // namespace orcart::testing
