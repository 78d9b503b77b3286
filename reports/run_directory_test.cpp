#include "reports/run_directory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "harness/judge/journal.hpp"
#include "harness/kernel/arbitrary_text.hpp"
#include "harness/kernel/error.hpp"
#include "reports/approved_text.hpp"
#include "reports/json_writer.hpp"
#include "reports/sample_run.hpp"

namespace fieldproof::reports {
namespace {

namespace fs = std::filesystem;

TEST(RunDirectory, IsNamedByTimeAndSeedAndNeverShared) {
  const TemporaryFolder folder;
  const fs::path runs = folder.path() / "runs";
  const reports::Run run = sample_run();
  const auto first = RunDirectory::create(runs, sample_manifest(), run.identity);
  const auto second = RunDirectory::create(runs, sample_manifest(), run.identity);
  EXPECT_EQ(first.path().filename(), "20260102T030405Z-7");
  EXPECT_EQ(second.path().filename(), "20260102T030405Z-7-2");
  EXPECT_EQ(fs::read_symlink(runs / "latest"), second.path().filename());
  EXPECT_TRUE(fs::equivalent(RunDirectory::open(runs).path(), second.path()));
}

TEST(RunDirectory, KeepsARun) {
  const TemporaryFolder folder;
  const reports::Run run = sample_run();
  const auto directory = RunDirectory::create_at(folder.path() / "x", sample_manifest(), run.identity);
  directory.store(sample_manifest(), run);
  const StoredRun stored = RunDirectory::open(folder.path() / "x").load();
  EXPECT_EQ(results_json(stored.run), results_json(run));
  EXPECT_EQ(manifest_json(stored.manifest, run), manifest_json(sample_manifest(), run));
  EXPECT_EQ(stored.run.cases.at(0).wall_time_us, 1'250U);
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
}

TEST(RunDirectory, OfAKilledRunHasEveryJournaledVerdict) {
  const TemporaryFolder folder;
  reports::Run run = sample_run();
  run.identity.incomplete_because.clear();
  const auto directory = RunDirectory::create(folder.path(), sample_manifest(), run.identity);
  {
    judge::Journal journal(directory.journal());
    for (const judge::CaseResult& result : run.cases) journal.append(result);
  }
  const std::string text = read_text_file(directory.journal());
  write_text_file(directory.journal(), std::string_view(text).substr(0, text.size() - 5));
  const StoredRun stored = directory.load();
  EXPECT_TRUE(stored.journal_was_torn);
  EXPECT_FALSE(stored.run.is_complete());
  EXPECT_EQ(stored.run.identity.incomplete_because, "the run did not end");
  EXPECT_EQ(stored.run.cases.size(), run.cases.size() - 1);
  EXPECT_EQ(count(stored.run).not_run(), 2U);
}

TEST(RunDirectory, RefusesWhatIsNoRun) {
  const TemporaryFolder folder;
  const std::string here = folder.path().string();
  EXPECT_EQ(refusal_of([&] { RunDirectory::open(folder.path()); }),
            here + ": this is no directory of a run: it has no manifest.json");
  EXPECT_EQ(refusal_of([&] { RunDirectory::open(folder.path() / "none"); }),
            here + "/none: there is no such directory of a run");
  write_text_file(folder.path() / "file", "x");
  EXPECT_EQ(refusal_of([&] { RunDirectory::create_at(folder.path(), {}, {}); }),
            here + ": the path is taken; name one that does not exist, or an empty directory");
  EXPECT_NE(refusal_of([&] { RunDirectory::create(folder.path() / "file", {}, {}); }, 74), "no error");
  EXPECT_EQ(refusal_of([&] { read_text_file(folder.path() / "none"); }),
            here + "/none: the file cannot be read: No such file or directory");
  EXPECT_EQ(refusal_of([&] { read_text_file(folder.path()); }),
            here + ": the file cannot be read: it is a folder; name a file in it");
}

TEST(RunDirectory, OneOfManyThatBeginInOneFolderHasIt) {
  const TemporaryFolder folder;
  std::atomic<int> begun = 0;
  {
    std::vector<std::jthread> threads;
    for (int n = 0; n < 8; ++n) {
      threads.emplace_back([&] {
        try {
          RunDirectory::create_at(folder.path() / "x", sample_manifest(), sample_run().identity);
          ++begun;
        } catch (const kernel::Error&) {
        }
      });
    }
  }
  EXPECT_EQ(begun, 1);
}

TEST(WrittenFile, ALinkStaysAndAPipeIsWrittenTo) {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "target.json";
  const fs::path link = folder.path() / "link.json";
  write_text_file(target, "before");
  fs::create_symlink("target.json", link);
  write_text_file(link, "after");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_text_file(target), "after");
  fs::remove(target);
  write_text_file(link, "there is nothing yet");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_text_file(target), "there is nothing yet");
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  check_writable(pipe);
  write_text_file(pipe, "through");
  char octets[16] = {};
  EXPECT_EQ(::read(reader, octets, sizeof octets), 7);
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(WrittenFile, ASocketIsWrittenToAndOneThatNobodyListensAtIsRefused) {
  const TemporaryFolder folder;
  const fs::path place = folder.path() / "socket";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(place.native(), static_cast<char*>(address.sun_path));
  const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_NE(refusal_of([&] { write_text_file(place, "lost"); }, 74).find("Connection refused"),
            std::string::npos);
  ASSERT_EQ(::listen(listener, 1), 0);
  write_text_file(place, "through");
  const int reader = ::accept(listener, nullptr, nullptr);
  char octets[16] = {};
  EXPECT_EQ(::read(reader, octets, sizeof octets), 7);
  ::close(reader);
  ::close(listener);
  EXPECT_TRUE(fs::is_socket(place));
}

TEST(RunDirectory, KeepsCasesApart) {
  const TemporaryFolder folder;
  const auto directory = RunDirectory::create_at(folder.path() / "x", {}, {});
  directory.write_case("interbus/slave/a", "trace.txt", "1");
  directory.write_case("interbus/slave+a", "trace.txt", "2");
  EXPECT_EQ(directory.read_case("interbus/slave/a", "trace.txt"), "1");
  EXPECT_EQ(directory.read_case("interbus/slave+a", "trace.txt"), "2");
  EXPECT_EQ(directory.case_directory("interbus/slave/a"), folder.path() / "x/cases/interbus+slave+a");
}

RC_GTEST_PROP(RunDirectory, NamesOfCasesAreOnePlainWordAndDiffer, ()) {
  const std::string one = *kernel::arbitrary_text();
  const std::string other = *kernel::arbitrary_text();
  const std::string name = case_directory_name(one);
  RC_ASSERT(!name.empty() && name.front() != '.');
  RC_ASSERT(name.find('/') == std::string::npos && name.find('\0') == std::string::npos);
  RC_ASSERT((name == case_directory_name(other)) == (one == other));
}

}  // namespace
}  // namespace fieldproof::reports
