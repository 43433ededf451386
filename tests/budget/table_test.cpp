// The table in README.md and the tests agree: no budget without a test, no test without a budget.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "firmware-host/app/topology.hpp"

namespace orcart::testing {
namespace {

namespace fs = std::filesystem;

fs::path tests_folder() {
  return fs::path(std::getenv("ORCART_SOURCE_DIR")) / "tests";
}

std::string text_of(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

/// "Suite.Name" of every TEST, TEST_F and TEST_P under a folder.
std::set<std::string> tests_in(const fs::path& folder) {
  const std::regex pattern(R"(\bTEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\))");
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
      names.insert((*it)[1].str() + "." + (*it)[2].str());
  }
  return names;
}

/// Every `Suite.Name` in backquotes in the table's rows, and the rows' text.
struct Table {
  std::set<std::string> tests;
  std::string text;
  std::vector<std::string> rows;
};
Table table() {
  Table table;
  std::istringstream in(text_of(tests_folder() / "budget/README.md"));
  const std::regex pattern(R"(`(\w+\.\w+)`)");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| ")) continue;
    table.text += line + "\n";
    table.rows.push_back(line);
    for (std::sregex_iterator it(line.begin(), line.end(), pattern), end; it != end; ++it)
      table.tests.insert((*it)[1].str());
  }
  return table;
}

TEST(BudgetTable, NamesOnlyTestsThatExist) {
  const std::set<std::string> all = tests_in(tests_folder());
  for (const std::string& name : table().tests) EXPECT_TRUE(all.contains(name)) << name << " is no test";
}

TEST(BudgetTable, NamesEveryTestOfThisFolder) {
  const Table known = table();
  for (const std::string& name : tests_in(tests_folder() / "budget"))
    EXPECT_TRUE(known.tests.contains(name)) << name << " has no row in tests/budget/README.md";
}

TEST(BudgetTable, HasARowForEveryBudgetOfTheTopology) {
  const std::string text = table().text;
  std::vector<std::string> budgets{
      "wake-up",          "dequeue to submitted",  "dequeue to scan-out", "mid-exposure to pose",
      "pedal to painted", "pedal to acknowledged", "capture durable"};
  for (const StageRow& row : kStages) budgets.push_back("stage " + std::string(row.name));
  for (const std::string& budget : budgets)
    EXPECT_NE(text.find("| " + budget + " |"), std::string::npos) << budget;
}

TEST(BudgetTable, EveryRowHasATestAndATier) {
  for (const std::string& row : table().rows) {
    if (row.starts_with("| requirement") || row.starts_with("| figure") ||
        row.find("| T") == std::string::npos)
      continue;
    EXPECT_NE(row.find('`'), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace orcart::testing
