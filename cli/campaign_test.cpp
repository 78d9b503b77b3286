// Subject: `fieldproof campaign` as its user meets it: plans that are refused, equal bytes for any number of
// workers and ranks, and what is left after kills, full disks and jobs that kill their process.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/campaign.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

constexpr const char* kSome = R"({
  "title": "some",
  "jobs": [
    { "verb": "run", "of": "valve_bus/node/read/is_answered", "volume": "quick", "seed": { "from": 1, "count": 4 } },
    { "verb": "run", "of": "valve_bus/node/write/drives_the_valves", "iut": ["ref", "mutant:valves_late"] },
    { "verb": "check", "of": ["valve_bus/node"], "cases": 5, "seed": [1, 2] },
    { "verb": "emc", "of": "valve_bus", "duration": "1s", "test_levels": [3, 4], "repetition": "5kHz", "polarity": "-" }
  ]
})";

class CampaignVerb : public ProgramFixture {
 protected:
  CampaignVerb() { write("some.json", kSome); }

  Called campaign(std::vector<std::string> words) const {
    words.insert(words.begin(), "campaign");
    return call(std::move(words));
  }
  // A shell with $F as the program.
  Called in_shell(const std::string& script) const {
    Call shell = prepared({"-c", script}, "/bin/bash");
    shell.environment = {{"F", FIELDPROOF_EXE}};
    return shell.run();
  }
  // The document of an undisturbed campaign.
  std::string whole() const {
    const Called called = campaign({"some.json", "--workers", "2", "--out", "whole"});
    EXPECT_EQ(called.exit_code, 1) << called.out << called.err;
    return read("whole/campaign.json");
  }
};

TEST_F(CampaignVerb, HasTheSameBytesForAnyNumberOfWorkers) {
  const std::string expected = whole();
  EXPECT_HOLDS(expected,
               "\"command\": \"fieldproof run valve_bus/node/read/is_answered --volume=quick --seed=4\"");
  EXPECT_EQ(campaign({"some.json", "--workers", "1", "--out", "one"}).exit_code, 1);
  EXPECT_EQ(read("one/campaign.json"), expected);
  // And whatever the environment says.
  const Called four = in_shell(
      "FIELDPROOF_SEED=99 FIELDPROOF_IUT=mutant:check_is_sum \"$F\" campaign some.json --workers 4 --out "
      "four");
  EXPECT_EQ(four.exit_code, 1) << four.err;
  EXPECT_EQ(read("four/campaign.json"), expected);
  const auto document = json("whole/campaign.json");
  EXPECT_EQ(document["counts"]["jobs"], 10);
  EXPECT_EQ(document["jobs"][5]["failed"][0], "valve_bus/node/write/drives_the_valves");
  EXPECT_EQ(document["ledger"]["accepted_wrong"][0]["total"], document["ledger"]["counts"]["sent"]);
  expect_valid({"whole/campaign.json"}, "../../campaign/campaign_result");
}

// What a job leaves does what the job did.
TEST_F(CampaignVerb, LeavesTheCaseOfAFailureForReplay) {
  whole();
  const Called called =
      call({"replay", "whole/jobs/6/out/cases/valve_bus+node+write+drives_the_valves/case.json"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "equal: verdict, reason and fingerprint are those of the stored run");
}

struct Refusal {
  const char* plan;
  const char* sentence;
};

TEST_F(CampaignVerb, RefusesAPlanWhereItIsWrong) {
  for (const Refusal& one : std::vector<Refusal>{
           {R"({"jobs": []})", "/jobs"},
           {R"({"job": []})", "\"job\""},
           {R"({"jobs": [{"verb": "rum"}]})", "/jobs/0/verb"},
           {R"({"jobs": [{"verb": "run", "sed": 1}]})", "seed"},
           {R"({"jobs": [{"verb": "run", "out": "x"}]})", "/jobs/0/out"},
           {R"({"jobs": [{"verb": "run", "seed": [1, "x"]}]})", "/jobs/0/seed/1"},
           {R"({"jobs": [{"verb": "run", "seed": {"from": 1}}]})", "/jobs/0/seed"},
           {R"({"jobs": [{"verb": "run", "seed": {"from": 1, "count": 2000000}}]})", "/jobs/0/seed/count"},
           {R"({"jobs": [{"verb": "run", "volume": "ful"}]})", "/jobs/0/volume"},
           {R"({"jobs": [{"verb": "run", "of": "valve_bus/nod/**"}]})", "/jobs/0/of"},
           {R"({"jobs": [{"verb": "run", "of": "--json=x"}]})", "/jobs/0/of"},
           {R"({"jobs": [{"verb": "emc", "of": ["interbus", "profibus"]}]})", "/jobs/0/of/1"},
           {R"({"jobs": [{"verb": "check", "of": "valve_bus/nod"}]})", "/jobs/0/of"},
           {R"({"jobs": [{"verb": "check"}]})", "/jobs/0"},
           {R"({"jobs": [{"verb": "run", "strict": 1}]})", "/jobs/0/strict"},
           {R"({"jobs": [{"verb": "run", "seed": {"from": 1, "count": 1000000}, "confirm": [1, 2]}]})",
            "more than"},
           {R"({"jobs": [{"verb": "run"}], "budget": {"confidence": {"rate": 2}}})",
            "/budget/confidence/rate"},
           {R"({"jobs": [{"verb": "run"}], "budget": {"time": "fast"}})", "/budget/time"}}) {
    write("bad.json", one.plan);
    const Called called = campaign({"bad.json", "--out", "bad"});
    EXPECT_EQ(called.exit_code, 65) << one.plan << called.err;
    EXPECT_HOLDS(called.err, "bad.json:1: ") << one.plan;
    EXPECT_HOLDS(called.err, one.sentence);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "bad")) << one.plan;
  }
}

TEST_F(CampaignVerb, RefusesACallThatMeansNothing) {
  EXPECT_EQ(campaign({}).exit_code, 64);
  EXPECT_EQ(campaign({"some.json", "--workers", "0"}).exit_code, 64);
  EXPECT_EQ(campaign({"some.json", "--resume", "nowhere"}).exit_code, 65);
  whole();
  EXPECT_EQ(campaign({"some.json", "--out", "whole"}).exit_code, 65);
  write("other.json", R"({"jobs": [{"verb": "run", "of": "valve_bus/node/read/is_answered"}]})");
  const Called other = campaign({"other.json", "--resume", "whole"});
  EXPECT_EQ(other.exit_code, 64);
  EXPECT_HOLDS(other.err, "its plan says something else than this one; start a new campaign");
}

TEST_F(CampaignVerb, IsOnlyGoneOnWithWithTheSameFiles) {
  write("faults.json", R"({"rules": [{"effect": {"drop": {}}}]})");
  write(
      "plan.json",
      R"({"jobs": [{"verb": "run", "of": "valve_bus/node/read/is_answered", "volume": "quick", "faults": "faults.json"}]})");
  campaign({"plan.json", "--out", "faulty"});
  write("faults.json", R"({"rules": []})");
  const Called changed = campaign({"--resume", "faulty"});
  EXPECT_EQ(changed.exit_code, 64);
  EXPECT_HOLDS(changed.err, "faults.json has changed since");
}

// The whole of it, at random instants. FIELDPROOF_KILLS says how many, where 4 are too few.
// Of each kind: the campaign, one of its workers, a rank.
int kills_of_a_kind() {
  return static_cast<int>(kernel::campaign_count("FIELDPROOF_KILLS", 4));
}

TEST_F(CampaignVerb, GoesOnAfterAKillAtAnyInstant) {
  const std::string expected = whole();
  const int kills = kills_of_a_kind();
  kernel::Random random(5);
  int with_rest = 0;
  // On a busy machine some come before anything is written: then there are more of them.
  for (int n = 0; n < kills || (with_rest < kills / 4 && n < 10 * kills); ++n) {
    const std::string out = fmt::format("killed{}", n);
    const double seconds = static_cast<double>(random.between(5, 400)) / 1000;
    SCOPED_TRACE(fmt::format("{} after {} s", out, seconds));
    in_shell(fmt::format("\"$F\" campaign some.json --workers 2 --out {} & sleep {}; kill -KILL $!; wait $!",
                         out, seconds));
    if (!std::filesystem::exists(folder_ / out / "manifest.json")) continue;
    with_rest += std::filesystem::exists(folder_ / out / "campaign.json") ? 0 : 1;
    const Called resumed = campaign({"--resume", out, "--workers", "2"});
    EXPECT_EQ(resumed.exit_code, 1) << resumed.err;
    EXPECT_EQ(read(out + "/campaign.json"), expected);
  }
  EXPECT_GE(with_rest, kills / 4) << "most were killed after their end";
}

// What the journal says is done, but is not there, is done again, and ends in the same bytes.
TEST_F(CampaignVerb, DoesAgainWhatFilesOfAreGone) {
  const std::string expected = whole();
  const auto files_of = [&] {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "whole/jobs")) {
      const auto path = std::filesystem::relative(entry.path(), folder_).string();
      if (entry.is_regular_file()) files[path] = read(path);
    }
    return files;
  };
  const auto before = files_of();
  ASSERT_FALSE(before.empty());
  std::filesystem::remove_all(folder_ / "whole/jobs");
  const Called all = campaign({"--resume", "whole"});
  EXPECT_EQ(all.exit_code, 1) << all.err;
  EXPECT_HOLDS(all.err, " jobs are gone from whole/jobs; these are done again");
  EXPECT_EQ(files_of(), before);
  EXPECT_EQ(read("whole/campaign.json"), expected);
  std::filesystem::remove(folder_ / before.begin()->first);
  EXPECT_HOLDS(campaign({"--resume", "whole"}).err, "the files of 1 jobs are gone");
  EXPECT_EQ(files_of(), before);
  EXPECT_EQ(campaign({"--resume", "whole"}).err.find("are gone"), std::string::npos);
}

TEST_F(CampaignVerb, GoesOnAfterAnInterruption) {
  const std::string expected = whole();
  const Called stopped = in_shell(
      "\"$F\" campaign some.json --workers 1 --out stopped & until [ -s stopped/journal.jsonl ]; do sleep "
      "0.01; done; "
      "kill -TERM $!; wait $!");
  EXPECT_EQ(stopped.exit_code, 143) << stopped.err;
  EXPECT_HOLDS(stopped.out,
               "incomplete: interrupted by SIGTERM\ngo on: fieldproof campaign --resume stopped\n");
  EXPECT_HOLDS(read("stopped/campaign.json"), "\"is_complete\": false");
  EXPECT_EQ(campaign({"--resume", "stopped"}).exit_code, 1);
  EXPECT_EQ(read("stopped/campaign.json"), expected);
}

// A worker is a process of the program itself, so it is a child of the campaign.
// A worker that has just ended is killed in vain, so all are killed until a loss is noted; it is noted before
// the job is given out again, so none is killed three times.
TEST_F(CampaignVerb, DoesAJobAgainWhoseWorkerWasKilled) {
  const std::string expected = whole();
  const Called called = in_shell(
      "\"$F\" campaign some.json --workers 2 --out wounded & campaign=$!; "
      "until [ -s wounded/journal.jsonl ]; do :; done; "
      "until grep -q loss.:.was wounded/journal.jsonl || ! kill -0 $campaign; do "
      "for id in $(cat /proc/$campaign/task/*/children); do kill -KILL $id; done; sleep 0.01; done; "
      "wait $campaign");
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_EQ(read("wounded/campaign.json"), expected);
  EXPECT_HOLDS(read("wounded/journal.jsonl"), "\"loss\":\"was ended by signal 9 (Killed)\"");
}

TEST_F(CampaignVerb, DoesAJobAgainWhoseWorkerWasKilledAtAnyInstant) {
  const std::string expected = whole();
  kernel::Random random(6);
  for (int n = 0; n < kills_of_a_kind(); ++n) {
    const std::string out = fmt::format("wounded{}", n);
    const double seconds = static_cast<double>(random.between(5, 300)) / 1000;
    SCOPED_TRACE(fmt::format("{} after {} s", out, seconds));
    const Called called = in_shell(fmt::format(
        "\"$F\" campaign some.json --workers 2 --out {} & campaign=$!; sleep {}; "
        "for id in $(cat /proc/$campaign/task/*/children); do kill -KILL $id; break; done; wait $campaign",
        out, seconds));
    EXPECT_EQ(called.exit_code, 1) << called.err;
    EXPECT_EQ(read(out + "/campaign.json"), expected);
  }
}

TEST_F(CampaignVerb, FindsAJobThatKillsItsWorker) {
  write("device.sh", "kill -KILL $PPID\n");
  write("deadly.json", R"({"jobs": [
    {"verb": "run", "of": "valve_bus/node/read/is_answered", "volume": "quick", "iut": ["ref", "exec:sh ./device.sh", "ref"]}]})");
  for (const std::string out : {"deadly", "again"}) {
    const Called called = campaign({"deadly.json", "--workers", "2", "--out", out});
    EXPECT_EQ(called.exit_code, 1) << called.err;
    EXPECT_HOLDS(called.out, "job 2: its process was ended by signal 9 (Killed), 3 times");
    EXPECT_HOLDS(called.out, "--iut=exec:sh ./device.sh");
    EXPECT_HOLDS(called.out, "3 of 3 jobs: 2 with exit code 0, 1 with exit code 1");
  }
  EXPECT_EQ(read("again/campaign.json"), read("deadly/campaign.json"));
}

TEST_F(CampaignVerb, FindsAJobThatHangs) {
  write("device.sh", "exec sleep 100\n");
  write("slow.json", R"({"job_limit": "200ms", "jobs": [
    {"verb": "run", "of": "valve_bus/node/read/is_answered", "volume": "quick", "iut": "exec:sh ./device.sh", "call_limit": "1h"}]})");
  const Called called = campaign({"slow.json", "--out", "slow"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "its process did not end within its limit of 200 ms, 3 times");
}

// The first job of a row tells what is refused, and how long the others take.
TEST_F(CampaignVerb, IsEstimatedBeforeItRuns) {
  const Called called = campaign({"some.json", "--dry-run", "--workers", "4"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "         4  ");
  EXPECT_HOLDS(called.out, "fieldproof emc valve_bus --duration=1s --test-levels=3");
  EXPECT_HOLDS(called.out, "10 jobs, about ");
  EXPECT_HOLDS(called.out, " in 4 at a time");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "campaigns"));
  write("no.json",
        R"({"jobs": [{"verb": "run", "of": "valve_bus/node/read/is_answered", "iut": "exec:./nowhere"}]})");
  const Called refused = campaign({"no.json", "--dry-run"});
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_HOLDS(refused.out, "job 1: exit code 5: fieldproof: ");
}

TEST_F(CampaignVerb, IsWatchedFromElsewhereUntilItEnds) {
  const Called watched = in_shell(
      "\"$F\" campaign some.json --workers 1 --out seen >/dev/null & until [ -s seen/manifest.json ]; do "
      "sleep 0.01; done; "
      "\"$F\" campaign --watch seen");
  EXPECT_EQ(watched.exit_code, 1) << watched.err;
  EXPECT_HOLDS(watched.out, "job 6: exit code 1\n");
  EXPECT_HOLDS(watched.out, "10 of 10 jobs done, ");
  EXPECT_HOLDS(watched.out, "ended with exit code 1\n");
  std::filesystem::remove(folder_ / "seen/campaign.json");
  const Called left = campaign({"--watch", "seen"});
  EXPECT_EQ(left.exit_code, 2);
  EXPECT_HOLDS(left.out, "nobody works on it any more; go on: fieldproof campaign --resume seen\n");
}

TEST_F(CampaignVerb, HasTheMatrixOfSequencesOfARole) {
  write("kills.json", R"({"jobs": [{"verb": "matrix", "of": "valve_bus/node", "sequences": true, "seeds": 1,
    "commands": 20, "seed": {"from": 1, "count": 2}}]})");
  const Called called = campaign({"kills.json", "--out", "kills"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  const nlohmann::json jobs = nlohmann::json::parse(read("kills/campaign.json"))["jobs"];
  ASSERT_EQ(jobs.size(), 2U);
  for (const auto& job : jobs) EXPECT_EQ(job["headline"].get<std::string>().find("found "), 0U) << job;
  write("no.json", R"({"jobs": [{"verb": "matrix", "of": "valve_bus/nobody", "sequences": true}]})");
  const Called refused = campaign({"no.json", "--out", "no"});
  EXPECT_EQ(refused.exit_code, 65);
  EXPECT_HOLDS(refused.err, "valve_bus/nobody");
}

TEST_F(CampaignVerb, HasNoDefaultFolderTwice) {
  write("one.json",
        R"({"jobs": [{"verb": "run", "of": "valve_bus/node/read/is_answered", "volume": "quick"}]})");
  EXPECT_EQ(campaign({"one.json"}).exit_code, 0);
  EXPECT_EQ(campaign({"one.json"}).exit_code, 0);
  EXPECT_EQ(read("campaigns/one/campaign.json"), read("campaigns/one-2/campaign.json"));
}

TEST_F(CampaignVerb, EndsWhenEnoughIsKnown) {
  write("goal.json", R"({"budget": {"confidence": {"rate": 0.02}}, "jobs": [
    {"verb": "emc", "of": "valve_bus", "duration": "1s", "test_levels": 2, "repetition": "5kHz", "polarity": "+",
     "seed": {"from": 1, "count": 1000}}]})");
  EXPECT_EQ(campaign({"goal.json", "--workers", "3", "--out", "goal"}).exit_code, 0);
  const auto document = json("goal/campaign.json");
  EXPECT_EQ(document["confidence"]["decision"], "below");
  EXPECT_LT(document["counts"]["jobs"], 1000);
  EXPECT_EQ(campaign({"goal.json", "--workers", "1", "--out", "one"}).exit_code, 0);
  EXPECT_EQ(read("one/campaign.json"), read("goal/campaign.json"));
}

TEST_F(CampaignVerb, KeepsWhatIsJudgedWhenTheDiskIsFull) {
  const Called mounted = in_shell("unshare -m true && echo can");
  if (mounted.out != "can\n") GTEST_SKIP() << "not applicable: only root makes a small disk";
  const std::string expected = whole();
  const Called called = in_shell(
      "mkdir small; exec unshare -m bash -c 'mount -t tmpfs -o size=48k none small; "
      "\"$F\" campaign some.json --workers 2 --out small/x; code=$?; mount -o remount,size=50m small; "
      "\"$F\" campaign --resume small/x >resumed.txt 2>&1; echo $? >resumed_code.txt; "
      "cp small/x/campaign.json after.json; exit $code'");
  EXPECT_EQ(called.exit_code, 74) << called.out;
  EXPECT_HOLDS(called.err, "No space left on device");
  EXPECT_EQ(read("resumed_code.txt"), "1\n") << read("resumed.txt");
  EXPECT_HOLDS(read("resumed.txt"), " of 10 jobs are done already");
  EXPECT_EQ(read("after.json"), expected);
}

class CampaignOverRanks : public CampaignVerb {
 protected:
  void SetUp() override {
    if (kernel::kIsSanitized) GTEST_SKIP() << "not applicable: MPI is left out under sanitizers";
    const std::filesystem::path module =
        std::filesystem::path(FIELDPROOF_EXE).parent_path() / "libfieldproof_mpi.so";
    if (!std::filesystem::exists(module) || !std::filesystem::exists("/usr/bin/mpirun"))
      GTEST_SKIP() << "not installed: libopenmpi-dev openmpi-bin";
  }
  // mpirun itself may wait for ever, for ranks that are all gone, when one of them is killed while MPI comes
  // up.
  Called mpirun(const std::string& words) const {
    return in_shell(
        "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; ulimit -c 0; "
        "timeout 60 mpirun --oversubscribe " +
        words);
  }
};

TEST_F(CampaignOverRanks, HasTheSameBytes) {
  const std::string expected = whole();
  for (const int ranks : {2, 4}) {
    const Called called = mpirun(fmt::format("-n {0} \"$F\" campaign some.json --out ranks{0}", ranks));
    EXPECT_EQ(called.exit_code, 1) << called.out << called.err;
    EXPECT_EQ(read(fmt::format("ranks{}/campaign.json", ranks)), expected);
  }
}

// Whichever rank it is, mpirun ends all; what is left goes on without it.
TEST_F(CampaignOverRanks, GoesOnAfterTheKillOfARank) {
  const std::string expected = whole();
  for (const int rank : {0, 1}) {
    const std::string out = fmt::format("rank{}", rank);
    mpirun(
        fmt::format("-n 2 bash -c 'if [ $OMPI_COMM_WORLD_RANK = {0} ]; then "
                    "(until [ -s {1}/journal.jsonl ]; do sleep 0.01; done; kill -KILL $$) & fi; "
                    "exec \"$F\" campaign some.json --out {1}'",
                    rank, out));
    ASSERT_TRUE(std::filesystem::exists(folder_ / out / "journal.jsonl"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / out / "campaign.json"));
    EXPECT_EQ(campaign({"--resume", out}).exit_code, 1);
    EXPECT_EQ(read(out + "/campaign.json"), expected);
  }
}

TEST_F(CampaignOverRanks, GoesOnAfterTheKillOfARankAtAnyInstant) {
  const std::string expected = whole();
  kernel::Random random(7);
  for (int n = 0; n < kills_of_a_kind(); ++n) {
    const std::string out = fmt::format("rank_killed{}", n);
    const auto rank = random.between(0, 2);
    const double seconds = static_cast<double>(random.between(50, 900)) / 1000;
    SCOPED_TRACE(fmt::format("{}: rank {} after {} s", out, rank, seconds));
    mpirun(
        fmt::format("-n 3 bash -c 'if [ $OMPI_COMM_WORLD_RANK = {0} ]; then (sleep {1}; kill -KILL $$) & fi; "
                    "exec \"$F\" campaign some.json --out {2}'",
                    rank, seconds, out));
    if (!std::filesystem::exists(folder_ / out / "manifest.json")) continue;
    EXPECT_EQ(campaign({"--resume", out}).exit_code, 1);
    EXPECT_EQ(read(out + "/campaign.json"), expected);
  }
}

// Each rank sees its own folder: the second one has another file in it.
TEST_F(CampaignOverRanks, SaysWhichRankCannotReadAFile) {
  write("faults.json", R"({"rules": [{"effect": {"drop": {}}}]})");
  std::filesystem::create_directory(folder_ / "other");
  write(
      "plan.json",
      R"({"jobs": [{"verb": "run", "of": "valve_bus/node/read/is_answered", "volume": "quick", "faults": "faults.json", "seed": {"from": 1, "count": 40}}]})");
  const Called called = mpirun(
      "-n 2 bash -c 'if [ $OMPI_COMM_WORLD_RANK = 1 ]; then cd other; fi; exec \"$F\" campaign plan.json "
      "--out ranks'");
  EXPECT_EQ(called.exit_code, 65) << called.out << called.err;
  EXPECT_HOLDS(called.err, " cannot be done: rank 1 on ");
  EXPECT_HOLDS(called.err, "faults.json");
  EXPECT_HOLDS(read("ranks/campaign.json"), "\"is_complete\": false");
}

TEST_F(CampaignOverRanks, LosesNothingByAWrongHostFileOrATermination) {
  // mpirun itself says what is wrong, and gives its ranks no time to write more than they have.
  const std::string expected = whole();
  write("hosts", "no.such.host.invalid slots=2\n");
  EXPECT_NE(mpirun("-n 2 --hostfile hosts \"$F\" campaign --resume whole").exit_code, 0);
  EXPECT_EQ(read("whole/campaign.json"), expected);
  mpirun(
      "-n 2 \"$F\" campaign some.json --out ended & until [ -s ended/journal.jsonl ]; do sleep 0.01; done; "
      "kill -TERM $!; wait $!");
  const Called resumed = campaign({"--resume", "ended"});
  EXPECT_EQ(resumed.exit_code, 1) << resumed.err;
  EXPECT_EQ(read("ended/campaign.json"), expected);
}

TEST_F(CampaignOverRanks, TellsWhereMpiIsMissing) {
  const Called called = in_shell("cp \"$F\" ./alone; OMPI_COMM_WORLD_SIZE=2 ./alone campaign some.json");
  EXPECT_EQ(called.exit_code, 64);
  EXPECT_HOLDS(called.err, "built without MPI");
}

}  // namespace
}  // namespace fieldproof::cli
