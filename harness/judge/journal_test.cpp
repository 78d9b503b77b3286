#include "harness/judge/journal.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "harness/judge/arbitrary_result.hpp"
#include "harness/judge/result_json.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::judge {
namespace {

namespace fs = std::filesystem;

class JournalFile {
 public:
  JournalFile() {
    std::string folder = (fs::temp_directory_path() / "fieldproof-journal-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary directory");
    folder_ = folder;
  }
  ~JournalFile() { fs::remove_all(folder_); }
  JournalFile(const JournalFile&) = delete;
  JournalFile& operator=(const JournalFile&) = delete;

  fs::path path() const { return folder_ / "journal.jsonl"; }
  std::string text() const {
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void set_text(const std::string& text) const {
    std::ofstream(path(), std::ios::binary | std::ios::trunc) << text;
  }

 private:
  fs::path folder_;
};

CaseResult result_of(const std::string& id, Verdict verdict = Verdict::pass) {
  CaseResult result;
  result.id = id;
  result.verdict = verdict;
  return result;
}

std::vector<std::string> ids(const JournalContent& content) {
  std::vector<std::string> all;
  for (const CaseResult& result : content.results) all.push_back(result.id);
  return all;
}

std::string sentence_of_reading(const fs::path& path) {
  try {
    read_journal(path);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    return error.what();
  }
  return "no error";
}

RC_GTEST_PROP(Journal, ReadsBackEveryResult, ()) {
  const JournalFile file;
  auto results = *rc::gen::scale(0.3, rc::gen::container<std::vector<CaseResult>>(arbitrary_result()));
  for (std::size_t i = 0; i < results.size(); ++i) results.at(i).id += std::to_string(i);
  {
    Journal journal(file.path());
    for (const CaseResult& result : results) journal.append(result);
  }
  const JournalContent content = read_journal(file.path());
  RC_ASSERT(!content.is_torn);
  RC_ASSERT(content.results.size() == results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    RC_ASSERT(to_json(content.results.at(i), WallTime::included) ==
              to_json(results.at(i), WallTime::included));
  }
}

TEST(Journal, IsValidJsonLineByLine) {
  const JournalFile file;
  Journal(file.path(), Durability::synced).append(result_of("a"));
  const auto line = nlohmann::json::parse(file.text());
  EXPECT_EQ(line.at("result").at("id"), "a");
  EXPECT_EQ(line.at("size"), line.at("result").dump().size());
}

// Wherever a kill cuts the file, every whole line before the cut is read, and the run can go on.
TEST(Journal, DropsATornLastLineAtEveryCutAndGoesOnAfterIt) {
  const JournalFile file;
  {
    Journal journal(file.path());
    journal.append(result_of("first"));
    journal.append(result_of("second"));
  }
  const std::string whole = file.text();
  const std::size_t first_line = whole.find('\n') + 1;
  for (std::size_t cut = first_line; cut < whole.size(); ++cut) {
    file.set_text(whole.substr(0, cut));
    const JournalContent content = read_journal(file.path());
    ASSERT_EQ(ids(content), std::vector<std::string>{"first"}) << cut;
    ASSERT_EQ(content.is_torn, cut != first_line) << cut;
    ASSERT_EQ(content.intact_size, first_line) << cut;
    Journal(file.path()).append(result_of("third"));
    ASSERT_EQ(ids(read_journal(file.path())), (std::vector<std::string>{"first", "third"})) << cut;
  }
}

TEST(Journal, DropsALastLineOfOtherOctets) {
  const JournalFile file;
  Journal(file.path()).append(result_of("first"));
  const std::string whole = file.text();
  for (const std::string& tail : {std::string(300, '\0'), std::string("\n"), std::string("{}\n")}) {
    file.set_text(whole + tail);
    EXPECT_TRUE(read_journal(file.path()).is_torn);
    EXPECT_EQ(ids(read_journal(file.path())), std::vector<std::string>{"first"});
  }
}

TEST(Journal, NamesTheDamagedLineInTheMiddle) {
  const JournalFile file;
  {
    Journal journal(file.path());
    for (const char* id : {"first", "second", "third"}) journal.append(result_of(id));
  }
  std::string text = file.text();
  text.at(text.find("second")) = 'S';
  file.set_text(text);
  const std::string sentence =
      file.path().string() +
      ":2: the line is damaged; its check and size do not fit its result (only the last "
      "line may be incomplete)";
  EXPECT_EQ(sentence_of_reading(file.path()), sentence);
  EXPECT_THROW(Journal{file.path()}, kernel::Error);
  EXPECT_EQ(file.text(), text);
}

TEST(Journal, SaysWhichFileCannotBeRead) {
  const JournalFile file;
  EXPECT_EQ(sentence_of_reading(file.path()),
            file.path().string() + ": the file cannot be read: No such file or directory");
  EXPECT_THROW(Journal(file.path() / "below"), kernel::Error);
}

TEST(Journal, CountsTheLastLineOfACaseAtThePlaceOfTheFirst) {
  const JournalFile file;
  Journal journal(file.path());
  journal.append(result_of("a", Verdict::fail));
  journal.append(result_of("b"));
  journal.append(result_of("a", Verdict::pass));
  const JournalContent content = read_journal(file.path());
  EXPECT_EQ(ids(content), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(content.results.front().verdict, Verdict::pass);
}

// A child announces each id after `append`, as a run prints a verdict, and is killed at an arbitrary moment.
TEST(Journal, KeepsEveryAnnouncedVerdictWhenTheWriterIsKilled) {
  for (int delay_us : {300, 1'000, 3'000, 10'000}) {
    const JournalFile file;
    std::array<int, 2> announced{};
    ASSERT_EQ(::pipe(announced.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      Journal journal(file.path());
      for (std::uint32_t i = 0;; ++i) {
        journal.append(result_of("case/" + std::to_string(i)));
        if (::write(announced.at(1), &i, sizeof i) != sizeof i) ::_exit(1);
      }
    }
    ::close(announced.at(1));
    std::uint32_t last = 0;
    ASSERT_EQ(::read(announced.at(0), &last, sizeof last), static_cast<ssize_t>(sizeof last));
    ::usleep(static_cast<useconds_t>(delay_us));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    for (std::uint32_t i = 0; ::read(announced.at(0), &i, sizeof i) == static_cast<ssize_t>(sizeof i);)
      last = i;
    ::close(announced.at(0));
    const JournalContent content = read_journal(file.path());
    ASSERT_GE(content.results.size(), std::size_t{last} + 1);
    EXPECT_EQ(content.results.at(last).id, "case/" + std::to_string(last));
  }
}

// A full disk takes a part of the line. What was appended before stays readable, and so does what comes
// after.
TEST(Journal, LeavesNoHalfLineWhenTheDiskIsFull) {
  const JournalFile file;
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    Journal journal(file.path());
    journal.append(result_of("first"));
    const rlimit narrow{static_cast<rlim_t>(file.text().size() + 40), RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &narrow);
    try {
      journal.append(result_of("second"));
      ::_exit(1);
    } catch (const kernel::Error&) {
      const rlimit wide{RLIM_INFINITY, RLIM_INFINITY};
      ::setrlimit(RLIMIT_FSIZE, &wide);
    }
    journal.append(result_of("third"));
    ::_exit(0);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  EXPECT_EQ(ids(read_journal(file.path())), (std::vector<std::string>{"first", "third"}));
}

}  // namespace
}  // namespace fieldproof::judge
