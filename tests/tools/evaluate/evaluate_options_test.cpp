// What the verbs of `orcart evaluate` make of options that stand in the wrong place.
#include "tools/orcart/evaluate_options.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

class InnerVerb : public ::testing::Test {
 protected:
  InnerVerb() {
    outer_.add_option("--scope", scope_);
    CLI::App* inner = outer_.add_subcommand("map", "");
    inner->add_option("--scope", inner_scope_);
    inner->add_option("--views", views_)->required();
    refuse_options_before(outer_);
  }
  std::string why(const std::string& line) {
    try {
      app_.parse(line);
    } catch (const CLI::Error& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string scope_, inner_scope_, views_;
  CLI::App app_;
  CLI::App& outer_ = *app_.add_subcommand("evaluate", "");
};

TEST_F(InnerVerb, TakesItsOwnOptions) {
  EXPECT_EQ(why("evaluate map --scope s.toml --views v.csv"), "accepted");
  EXPECT_EQ(inner_scope_, "s.toml");
  EXPECT_EQ(why("evaluate --scope s.toml"), "accepted");
}

TEST_F(InnerVerb, RefusesOptionsBeforeIt) {
  EXPECT_EQ(why("evaluate --scope s.toml map --views v.csv"), "--scope: put it behind map");
}

}  // namespace
}  // namespace orcart
