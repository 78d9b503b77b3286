// Subject: a search of `fieldproof fuzz` that goes on where the last one ended, and an input of a fuzz target
// that becomes a case.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCounting = "plugin:" COUNTING_NODE "?in-process";

class FuzzCorpus : public ProgramFixture {
 protected:
  Called fuzz(std::vector<std::string> words, const std::string& uri = kCounting) const {
    words.insert(words.begin(), {"fuzz", "valve_bus/node", "--iut", uri});
    return call(std::move(words));
  }
};

TEST_F(FuzzCorpus, GoesOnWhereTheLastSearchEnded) {
  const Called first = fuzz({"--cases", "60", "--corpus", "kept", "--json", "first.json"});
  EXPECT_EQ(first.exit_code, 0) << first.out << first.err;
  EXPECT_HOLDS(first.out, "0 of 0 stored sequences run, 0 left out; ");
  EXPECT_HOLDS(first.out, "passed new edges; edges ");
  EXPECT_HOLDS(first.out, " after 60");
  const auto before = json("first.json");
  EXPECT_GT(before["edges"], 20);
  EXPECT_EQ(before["corpus"], read_all("kept").size());
  EXPECT_LT(before["corpus"], before["kept"]) << "what is not needed is left out";
  // No sequence more: the stored ones pass all that the search had passed.
  const Called again = fuzz({"--cases", "0", "--corpus", "kept", "--json", "again.json"});
  EXPECT_EQ(again.exit_code, 0) << again.out << again.err;
  EXPECT_EQ(json("again.json")["edges"], before["edges"]);
  EXPECT_EQ(json("again.json")["stored"]["run"], before["corpus"]);
  const auto smallest = read_all("kept");
  const Called more = fuzz({"--cases", "60", "--corpus", "kept", "--json", "more.json"});
  EXPECT_EQ(more.exit_code, 0) << more.out << more.err;
  EXPECT_GE(json("more.json")["edges"], before["edges"]);
  EXPECT_EQ(json("more.json")["growth"].back()["run"], 60 + smallest.size());
  expect_valid({"first.json", "again.json", "more.json"}, "../../cli/fuzz");
}

TEST_F(FuzzCorpus, IsTheSameForEqualSeedCorpusAndCode) {
  fuzz({"--cases", "30", "--corpus", "start"});
  for (const std::string name : {"one", "two"}) {
    const Called called =
        fuzz({"--cases", "40", "--corpus", "start", "--corpus-out", name, "--json", name + ".json"});
    EXPECT_EQ(called.exit_code, 0) << called.err;
  }
  EXPECT_EQ(read_all("one"), read_all("two"));
  // But for the folder in their commands.
  const auto without_command = [&](const std::string& name) {
    auto document = json(name);
    EXPECT_HOLDS(document.at("command").get<std::string>(), "--cases 40 --corpus start --corpus-out ");
    document.erase("command");
    return document;
  };
  EXPECT_EQ(without_command("one.json"), without_command("two.json"));
  // From another beginning other sequences are tried.
  fuzz({"--cases", "40", "--corpus-out", "three"});
  EXPECT_NE(read_all("one"), read_all("three"));
}

TEST_F(FuzzCorpus, NamesWhatItCannotRead) {
  fuzz({"--cases", "30", "--corpus", "kept"});
  const auto whole = read_all("kept");
  const std::string name = whole.begin()->first;
  write("kept/" + name, whole.begin()->second.substr(0, whole.begin()->second.size() / 2));
  write("kept/other.json",
        R"({"schema": "fieldproof/corpus_sequence/1", "role": "valve_bus/host", "commands": []})");
  const Called called = fuzz({"--cases", "5", "--corpus", "kept", "--json", "found.json"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_HOLDS(called.err, "left out: kept/" + name);
  EXPECT_HOLDS(called.err, "this is a sequence of valve_bus/host, not of valve_bus/node");
  EXPECT_EQ(json("found.json")["stored"]["left_out"].size(), 2U);
  const auto after = read_all("kept");
  EXPECT_TRUE(after.contains("other.json")) << "what is not ours stays";
  EXPECT_TRUE(after.contains(name));
}

TEST_F(FuzzCorpus, LosesNothingWithoutCoverageOrWithAFinding) {
  fuzz({"--cases", "30", "--corpus", "kept"});
  const auto whole = read_all("kept");
  const Called blind = fuzz({"--cases", "5", "--corpus", "kept"}, "ref");
  EXPECT_EQ(blind.exit_code, 0) << blind.err;
  EXPECT_EQ(read_all("kept"), whole);
  const Called called =
      fuzz({"--cases", "5", "--corpus", "kept", "--case", "found.json"}, "mutant:check_is_sum");
  EXPECT_EQ(called.exit_code, 1) << called.out << called.err;
  EXPECT_HOLDS(called.out, "the stored sequence kept/");
  EXPECT_EQ(read_all("kept"), whole);
  EXPECT_EQ(call({"replay", "found.json"}).exit_code, 1);
}

TEST_F(FuzzCorpus, RefusesWhatCannotBe) {
  EXPECT_HOLDS(fuzz({"--corpus", "none", "--corpus-out", "new"}).err, "there is no folder 'none'");
  EXPECT_HOLDS(fuzz({"--cases", "0"}).err, "cases");
  write("file", "x");
  EXPECT_EQ(fuzz({"--corpus", "file"}).exit_code, 64);
  EXPECT_HOLDS(fuzz({"--input", "file"}).err,
               "an input of a fuzz target has 2 to 512 octets, this one has 1");
  EXPECT_HOLDS(fuzz({"--input", "file", "--corpus", "kept"}).err, "one input is no search");
  EXPECT_EQ(fuzz({"--input", "nothing_here"}).exit_code, 65);
}

// The first octet is the seed, the next ones are commands: what a fuzz target of the role was given.
TEST_F(FuzzCorpus, MakesACaseOfAnInputOfAFuzzTarget) {
  std::size_t found = 0;
  std::string failing;
  for (const auto& entry : fs::directory_iterator(kSourceFolder / "fuzz/corpus/valve_node")) {
    if (!entry.path().filename().string().starts_with("read_answers_write")) continue;
    failing = entry.path().string();
    ++found;
  }
  ASSERT_EQ(found, 1U);
  const Called right = fuzz({"--input", failing, "--case", "right.json"}, "ref");
  EXPECT_EQ(right.exit_code, 0) << right.out << right.err;
  const Called wrong = fuzz({"--input", failing, "--case", "wrong.json"}, "mutant:read_answers_write");
  EXPECT_EQ(wrong.exit_code, 1) << wrong.out << wrong.err;
  const Called replayed = call({"replay", "wrong.json"});
  EXPECT_EQ(replayed.exit_code, 1) << replayed.err;
  EXPECT_HOLDS(replayed.out, "equal: verdict, reason and fingerprint are those of the stored run");
  EXPECT_NE(call({"shrink", "wrong.json", "--case", "small.json"}).exit_code, 65);
  EXPECT_EQ(call({"replay", "small.json"}).exit_code, 1);
}

TEST_F(FuzzCorpus, MakesACaseOfAStoredSequence) {
  fuzz({"--cases", "20", "--corpus", "kept"});
  const Called called =
      fuzz({"--input", "kept/" + read_all("kept").begin()->first, "--case", "one.json"}, kCounting);
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_EQ(call({"replay", "one.json"}).exit_code, 0);
}

}  // namespace
}  // namespace fieldproof::cli
