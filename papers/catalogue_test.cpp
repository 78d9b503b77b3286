#include "papers/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "harness/kernel/error.hpp"

namespace fieldproof::papers {
namespace {

TEST(PaperCatalogue, EachPaperHasANameOfItsOwnAndSections) {
  std::set<std::string_view> names;
  for (const Paper& paper : catalogue()) {
    EXPECT_TRUE(names.insert(paper.name).second) << paper.name;
    EXPECT_FALSE(paper.sections.empty()) << paper.name;
    EXPECT_GT(paper.shortest, kernel::Duration{}) << paper.name;
    EXPECT_EQ(&paper_named(paper.name), &paper);
  }
}

TEST(PaperCatalogue, AnUnknownNameIsRefusedWithThoseThatThereAre) {
  try {
    paper_named("profibus");
    FAIL() << "it was found";
  } catch (const kernel::Error& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("'interbus', 'valve_bus', 'foundation', 'fieldbus', 'bandwidth', "
                                   "'control_network'"));
  }
}

// Sections are functions of their settings: what is printed today is printed tomorrow.
TEST(PaperCatalogue, EqualSeedsReproduceEqually) {
  const Settings settings{.seed = 7, .duration = 2 * kernel::kMillisecond};
  for (const Reproduce reproduce : paper_named("interbus").sections) {
    const reports::PublishedSection first = reproduce(settings);
    const reports::PublishedSection second = reproduce(settings);
    ASSERT_EQ(first.rows.size(), second.rows.size()) << first.heading;
    for (std::size_t n = 0; n < first.rows.size(); ++n)
      EXPECT_EQ(first.rows[n].reproduced, second.rows[n].reproduced) << first.heading;
  }
}

}  // namespace
}  // namespace fieldproof::papers
