// What a person sees of an option's words and of a wrong line.
#include "firmware-host/app/command_line.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>
#include <sstream>

#include <gtest/gtest.h>

namespace orcart {
namespace {

enum class Fruit : std::uint8_t { apple, pear, plum };

/// A program "basket" with a verb "eat" that wants a fruit, and a verb "sell".
struct Basket {
  Basket() : app("A basket.", "/usr/bin/basket") {
    app.failure_message(in_a_sentence);
    app.require_subcommand(1);
    CLI::App* eat = app.add_subcommand("eat", "Eat a fruit");
    eat->add_option("--fruit", fruit, "which")
        ->transform(one_of<Fruit>({{"apple", Fruit::apple}, {"pear", Fruit::pear}, {"plum", Fruit::plum}}))
        ->required();
    app.add_subcommand("sell", "Sell all");
  }
  /// The exit code; what was said is in `said`.
  int run(std::vector<std::string> words) {
    std::reverse(words.begin(), words.end());
    try {
      app.parse(words);
    } catch (const CLI::ParseError& error) {
      std::ostringstream out, err;
      const bool wrong = app.exit(error, out, err) != 0;
      said = out.str() + err.str();
      return wrong ? 2 : 0;
    }
    return 0;
  }
  CLI::App app;
  Fruit fruit = Fruit::plum;
  std::string said;
};

TEST(CommandLine, AWordStandsForItsValueInCapitalsOrNot) {
  for (const auto& [word, fruit] :
       {std::pair("apple", Fruit::apple), std::pair("Pear", Fruit::pear), std::pair("plum", Fruit::plum)}) {
    Basket basket;
    EXPECT_EQ(basket.run({"eat", "--fruit", word}), 0) << basket.said;
    EXPECT_EQ(basket.fruit, fruit) << word;
  }
}

TEST(CommandLine, HelpShowsTheWordsAndNothingUnprintable) {
  Basket basket;
  EXPECT_EQ(basket.run({"eat", "--help"}), 0);
  EXPECT_NE(basket.said.find("{apple,pear,plum}"), std::string::npos) << basket.said;
  EXPECT_TRUE(std::all_of(basket.said.begin(), basket.said.end(),
                          [](unsigned char c) { return std::isprint(c) != 0 || c == '\n'; }));
}

TEST(CommandLine, AnotherWordIsRefusedInOneSentenceThatNamesThoseThatAreAccepted) {
  for (const char* word : {"nut", "", "\1", "1"}) {
    Basket basket;
    EXPECT_EQ(basket.run({"eat", "--fruit", word}), 2);
    EXPECT_EQ(basket.said,
              std::string("basket eat: --fruit: \"") + word +
                  "\" is none of its words; apple, pear or plum is accepted; see basket eat --help\n");
  }
}

TEST(CommandLine, SaysWhichVerbsThereAre) {
  Basket basket;
  EXPECT_EQ(basket.run({}), 2);
  EXPECT_EQ(basket.said, "basket: a verb is wanted, eat or sell; see basket --help\n");
}

TEST(CommandLine, NamesTheVerbWhoseLineIsWrong) {
  Basket basket;
  EXPECT_EQ(basket.run({"eat"}), 2);
  EXPECT_EQ(basket.said, "basket eat: --fruit is required; see basket eat --help\n");
}

}  // namespace
}  // namespace orcart
