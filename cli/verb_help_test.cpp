#include "cli/verb_help.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/probe/program_fixture.hpp"
#include "cli/protocols.hpp"
#include "cli/verbs.hpp"

namespace fieldproof::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

// As a shell does it; examples quote with ' only.
std::vector<std::string> words_of(const std::string& command) {
  std::vector<std::string> words{"fieldproof", ""};
  bool is_quoted = false;
  for (const char c : command) {
    if (c == '\'') {
      is_quoted = !is_quoted;
    } else if (c == ' ' && !is_quoted) {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

TEST(VerbHelpTest, EachExampleIsACallOfItsVerb) {
  use_protocols(built_in_protocols());
  for (const Verb& verb : verbs()) {
    for (const Example& example : help_of_verb(verb.name).examples) {
      const std::vector<std::string> words = words_of(command_of(example));
      if (words[1] == "help") {
        EXPECT_FALSE(parse_command_line(words).text.empty()) << example.command;
        continue;
      }
      const Parsed parsed = parse_command_line(words);
      ASSERT_TRUE(parsed.command) << example.command;
      EXPECT_EQ(parsed.command->verb, verb.name) << example.command;
    }
  }
}

TEST(VerbHelpTest, SaysWhatIsTypedAndHowAnImplementationIsNamed) {
  use_protocols(built_in_protocols());
  for (const Verb& verb : verbs()) {
    const std::string text = parse_command_line({"fieldproof", "help", std::string(verb.name)}).text;
    EXPECT_THAT(text, HasSubstr("Usage: fieldproof " + std::string(verb.name)));
    EXPECT_THAT(text, Not(HasSubstr("operands")));
    EXPECT_THAT(text, HasSubstr("Examples:"));
    if (text.find("\n  --iut ") == std::string::npos) continue;
    for (const char* kind : {"mutant:", "exec:", "unix:", "tcp:", "plugin:", "serial:", "ROLE@N="})
      EXPECT_THAT(text, HasSubstr(kind)) << verb.name;
  }
}

class HelpVerb : public ProgramFixture {};

TEST_F(HelpVerb, IsTheSameAsTheOption) {
  EXPECT_EQ(call({"help"}).out, call({"--help"}).out);
  EXPECT_EQ(call({"help", "run"}).out, call({"run", "--help"}).out);
}

TEST_F(HelpVerb, HasThePagesThatItNames) {
  const std::string overview = call({"help"}).out;
  for (const HelpTopic& topic : help_topics()) {
    EXPECT_THAT(overview, HasSubstr("help " + std::string(topic.name)));
    EXPECT_THAT(call({"help", std::string(topic.name)}).out, HasSubstr(std::string(topic.text)));
  }
}

TEST_F(HelpVerb, NamesTheNearestForAPageThatIsNone) {
  const Called called = call({"help", "exitcodes"});
  EXPECT_EQ(called.exit_code, 64);
  EXPECT_THAT(called.err, HasSubstr("exit-codes"));
}

}  // namespace
}  // namespace fieldproof::cli
