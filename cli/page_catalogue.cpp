#include "cli/page_catalogue.hpp"

#include <fmt/format.h>

#include "cli/run_setup.hpp"

namespace fieldproof::cli {

reports::PageCatalogue page_catalogue(const conformance::Catalogue& catalogue) {
  reports::PageCatalogue page;
  page.suite_version = suite_version(catalogue);
  for (const conformance::Entry& entry : catalogue.entries()) {
    const conformance::TestCase& test_case = *entry.test_case;
    if (conformance::is_canary(test_case)) continue;
    reports::CaseStory story{test_case.stimulus, test_case.expected, test_case.steps, {}};
    for (const conformance::MustCatch& caught : test_case.catches) {
      story.catches.push_back(fmt::format("{}, with the finding {}", caught.mutant, caught.reason));
    }
    page.stories.emplace(test_case.id, std::move(story));
  }
  return page;
}

}  // namespace fieldproof::cli
