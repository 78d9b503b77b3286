#include "campaign/job.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace fieldproof::campaign {
namespace {

TEST(JobTest, ComesBackFromItsText) {
  const Job job{.id = 7,
                .verb = "run",
                .arguments = {"a/b/**", "--iut=exec:./x 'y z'"},
                .manner = {"--quiet"},
                .outputs = {{"--json", kDocument}},
                .inputs = {{"network.json", judge::hash_of("{}")}},
                .limit = std::chrono::milliseconds(1500)};
  EXPECT_EQ(to_json(job_from_json(to_json(job))), to_json(job));
  EXPECT_EQ(command_of(job), R"(fieldproof run 'a/b/**' '--iut=exec:./x '\''y z'\''')");
}

// Whatever a process has said, its result can be sent and is one line.
RC_GTEST_PROP(JobProperty, ResultsComeBackFromTheirText, ()) {
  JobResult result;
  result.id = *rc::gen::arbitrary<std::uint64_t>();
  result.exit_code = *rc::gen::inRange(0, 256);
  result.log = *rc::gen::arbitrary<std::string>();
  result.files.push_back({"a.json", "{\n}"});
  const std::string text = to_json(result);
  RC_ASSERT(text.find('\n') == std::string::npos);
  RC_ASSERT(to_json(result_from_json(text)) == text);
}

}  // namespace
}  // namespace fieldproof::campaign
