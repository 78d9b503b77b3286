#include "papers/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"

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

// Each number and limit that a paper publishes, moved beyond its tolerance: the row says so. Where a paper
// contradicts itself, at least so many rows do already.
TEST(PaperCatalogue, APublishedValueThatIsMovedDiffers) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  const std::map<std::string_view, std::size_t> contradictions = {{"interbus", 2},   {"valve_bus", 7},
                                                                  {"foundation", 9}, {"bandwidth", 5},
                                                                  {"fieldbus", 0},   {"control_network", 1}};
  for (const Paper& paper : catalogue()) {
    std::size_t published = 0;
    std::size_t differing = 0;
    for (const Reproduce reproduce : paper.sections) {
      const reports::PublishedSection section = reproduce({.seed = 2, .duration = 10 * kernel::kSecond});
      for (const reports::PublishedRow& row : section.rows) {
        if (!row.compared || row.compared->is_own) continue;
        ++published;
        EXPECT_FALSE(row.published.empty()) << row.what;
        EXPECT_FALSE(row.compared->is_too_few) << row.what;
        if (reproduction_of(row.compared) == reports::Reproduction::differs) {
          ++differing;
          continue;
        }
        reports::Compared moved = *row.compared;
        const double step = moved.tolerance > 0 ? 2 * moved.tolerance : 1;
        if (moved.relation == reports::Compared::Relation::within) {
          moved.reference += moved.ours > moved.reference ? -step : step;
        } else {
          moved.reference = moved.ours;
          moved.reference -= moved.relation == reports::Compared::Relation::at_most ? step : 0;
        }
        EXPECT_EQ(reproduction_of(moved), reports::Reproduction::differs) << row.what;
      }
    }
    EXPECT_GT(published, 0U) << paper.name;
    EXPECT_EQ(differing, contradictions.at(paper.name)) << paper.name;
  }
}

}  // namespace
}  // namespace fieldproof::papers
