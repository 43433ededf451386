// Results carry a value or one sentence.
#include "realtime/base/result.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

Result<int> halve(int number) {
  if (number % 2 != 0) return fail(std::to_string(number) + " is odd; an even number is accepted");
  return number / 2;
}

TEST(Result, CarriesTheValue) {
  const Result<int> half = halve(8);
  ASSERT_TRUE(half.has_value());
  EXPECT_EQ(*half, 4);
}

TEST(Result, CarriesTheSentence) {
  const Result<int> half = halve(7);
  ASSERT_FALSE(half.has_value());
  EXPECT_EQ(half.error().message, "7 is odd; an even number is accepted");
}

enum class Fault { late };

TEST(Result, MayCarryACodeInsteadOfASentence) {
  const Result<int, Fault> missing = tl::unexpected(Fault::late);
  EXPECT_EQ(missing.error(), Fault::late);
}

}  // namespace
}  // namespace orcart
