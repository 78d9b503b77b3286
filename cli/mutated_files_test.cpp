// Subject: files that somebody has damaged. Each kind of file that the program reads, changed in its octets
// and in its structure: it may be refused, in a sentence, and nothing else.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/probe/program_fixture.hpp"
#include "cli/program.hpp"
#include "cli/protocols.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

// Standard output goes nowhere, and what is said on standard error is kept.
class Streams {
 public:
  Streams()
      : kept_{::dup(STDOUT_FILENO), ::dup(STDERR_FILENO)},
        said_(::memfd_create("said", MFD_CLOEXEC)),
        nowhere_(::open("/dev/null", O_WRONLY | O_CLOEXEC)) {
    ::dup2(nowhere_, STDOUT_FILENO);
    ::dup2(said_, STDERR_FILENO);
  }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  ~Streams() {
    ::dup2(kept_[0], STDOUT_FILENO);
    ::dup2(kept_[1], STDERR_FILENO);
    for (const int number : {kept_[0], kept_[1], said_, nowhere_}) ::close(number);
  }

  std::string said() const {
    std::string text(static_cast<std::size_t>(::lseek(said_, 0, SEEK_CUR)), '\0');
    const ssize_t count = ::pread(said_, text.data(), text.size(), 0);
    text.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return text;
  }

 private:
  std::array<int, 2> kept_;
  int said_;
  int nowhere_;
};

std::size_t below(kernel::Random& random, std::size_t count) {
  return static_cast<std::size_t>(
      random.between(0, static_cast<std::int64_t>(std::max<std::size_t>(count, 1)) - 1));
}

std::string with_changed_octets(std::string text, kernel::Random& random) {
  const std::size_t at = below(random, text.size());
  const std::size_t length = 1 + below(random, 16);
  switch (below(random, 6)) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
      break;
    case 1:
      text[at] = static_cast<char>(below(random, 256));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, text.substr(below(random, text.size()), length));
      break;
    case 4:
      text.resize(at);
      break;
    default:
      text.insert(at, length * 1'000, "[{\"-9"[below(random, 5)]);
  }
  return text;
}

// Every value that lies somewhere in a document.
void collect(nlohmann::ordered_json& value, std::vector<nlohmann::ordered_json*>& all) {
  all.push_back(&value);
  if (!value.is_structured()) return;
  for (auto& inner : value) collect(inner, all);
}

std::string with_changed_structure(const std::string& text, kernel::Random& random) {
  auto document = nlohmann::ordered_json::parse(text, nullptr, false, true);
  if (document.is_discarded()) return with_changed_octets(text, random);
  std::vector<nlohmann::ordered_json*> all;
  collect(document, all);
  nlohmann::ordered_json& value = *all[below(random, all.size())];
  const std::vector<nlohmann::ordered_json> others = {nullptr,
                                                      true,
                                                      -1,
                                                      0,
                                                      9'007'199'254'740'993,
                                                      18'446'744'073'709'551'615U,
                                                      1e300,
                                                      0.5,
                                                      "",
                                                      "1 Gbit/s",
                                                      "\xC3\xA4",
                                                      "-0 s",
                                                      "99999999999999999999 s",
                                                      std::string(5'000, 'a'),
                                                      nlohmann::ordered_json::array(),
                                                      nlohmann::ordered_json::object(),
                                                      nlohmann::ordered_json::array({1, "a", nullptr})};
  if (value.is_object() && !value.empty() && below(random, 2) == 0) {
    const auto chosen = std::next(value.begin(), static_cast<std::ptrdiff_t>(below(random, value.size())));
    const nlohmann::ordered_json moved = chosen.value();
    const std::string key = chosen.key();
    value.erase(key);
    if (below(random, 2) == 0) value[key + "x"] = moved;
  } else if (value.is_array() && !value.empty() && below(random, 2) == 0) {
    const nlohmann::ordered_json again = value[below(random, value.size())];
    for (std::size_t n = below(random, 300); n > 0; --n) value.push_back(again);
  } else {
    value = others[below(random, others.size())];
  }
  return document.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

// A file, and a call that reads it.
struct ReadFile {
  fs::path file;
  std::vector<std::string> call;
  unsigned mutations;
};

class MutatedFiles : public ProgramFixture {
 protected:
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::string example(const std::string& name) const {
    fs::copy_file(fs::path(kSourceFolder) / "examples" / name, folder_ / name,
                  fs::copy_options::overwrite_existing);
    return at(name);
  }

  std::vector<ReadFile> files() const {
    const std::string run = at("run");
    const std::string found = at("found.json");
    write("pics.json", R"({ "items": { "bit_rate": 9600, "address_tens": 0, "address_units": 5 } })");
    // As a part of a whole, so that a report joins it.
    call({"run", kCase, "--iut", "mutant:check_is_sum", "--record", "all", "--shard", "1/1", "--out", "run"});
    call(
        {"check", "valve_bus/node", "--iut", "mutant:check_is_sum", "--cases", "40", "--case", "found.json"});
    call({"measure", "interbus", "--duration", "1ms", "--json", "measured.json"});
    call({"residual", "--fcs", "CRC-16/IBM-3740", "--bits", "64", "--json", "residual.json"});
    call({"paper", "interbus", "--duration", "1ms", "--json", "paper.json"});
    write("accepted.json", "{\"expected\": [{\"case\": \"" + kCase +
                               "\", \"finding\": \"no_answer\", \"reason\": \"known\", "
                               "\"expires\": \"2099-01-01\"}]}");
    write("campaign.json",
          R"({"title": "x", "job_limit": "1min", "budget": {"jobs": 1, "time": "1h"}, "jobs": [
      {"verb": "run", "of": "valve_bus/node/read/*", "volume": "quick", "seed": {"from": 1, "count": 3}},
      {"verb": "emc", "of": ["valve_bus"], "iut": [["node@1=ref"], "ref"], "duration": "1s"}]})");
    call({"campaign", "campaign.json", "--out", "campaign"});
    const std::vector<std::string> resume = {"campaign", at("campaign.json"), "--resume", at("campaign")};
    const auto verify = [](std::string option, std::string file) {
      return std::vector<std::string>{"verify",          kCase,          "--volume", "quick",
                                      std::move(option), std::move(file)};
    };
    const auto measure = [](std::string protocol, std::string file) {
      return std::vector<std::string>{
          "measure", std::move(protocol), "--network", std::move(file), "--duration",
          "1ms",     "--signal",          "50Hz",      "--max-time",    "2s"};
    };
    const std::vector<std::string> differ = {"diff", run, run};
    const std::vector<std::string> formats = {"report",       run,          "--sarif",
                                              at("ci.sarif"), "--ctrf",     at("ctrf.json"),
                                              "--junit",      at("ci.xml"), "--github"};
    const fs::path of_case = folder_ / "run/cases/valve_bus+node+read+is_answered";
    std::vector<ReadFile> all = {
        {example("flipped_check_bit.plan.json"), verify("--faults", at("flipped_check_bit.plan.json")), 200},
        {at("pics.json"), verify("--pics", at("pics.json")), 150},
        {run + "/configuration.json", verify("--config", run + "/configuration.json"), 150},
        {example("paper.json"), measure("interbus", at("paper.json")), 100},
        {example("mixed_line.json"), measure("interbus", at("mixed_line.json")), 100},
        {example("valve_bus.json"), measure("valve_bus", at("valve_bus.json")), 100},
        {example("foundation_link.json"), measure("fieldbus_dll", at("foundation_link.json")), 100},
        {example("picnet.json"), measure("token_bus", at("picnet.json")), 50},
        {run + "/results.json", differ, 150},
        {run + "/manifest.json", differ, 100},
        {run + "/timings.json", differ, 50},
        {run + "/results.json", formats, 100},
        {run + "/manifest.json", formats, 50},
        {run + "/configuration.json", formats, 100},
        {of_case / "timeline.json", formats, 100},
        {run + "/journal.jsonl", {"judge", run}, 150},
        {found, {"replay", found}, 150},
        {at("campaign.json"), resume, 100},
        {at("campaign/manifest.json"), resume, 50},
        {at("accepted.json"),
         {"run", kCase, "--volume", "quick", "--baseline", at("accepted.json"), "--out", at("again")},
         100},
    };
    for (const char* document : {"measured.json", "residual.json", "paper.json"}) {
      if (fs::exists(folder_ / document))
        all.push_back({at(document), {"report", at(document), "--html", at("page.html")}, 50});
    }
    // What a run stores of its case.
    for (const auto& entry : fs::directory_iterator(of_case)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".pcapng") || name.ends_with(".txt")) continue;
      const bool is_case = name == "case.json";
      all.push_back({entry.path(),
                     is_case ? std::vector<std::string>{"replay", entry.path().string()}
                             : std::vector<std::string>{"judge", run},
                     is_case ? 150U : 75U});
    }
    return all;
  }

  static constexpr const char* kNode = "valve_bus/node/read/is_answered";
  static inline const std::string kCase = kNode;
};

TEST_F(MutatedFiles, AreReadOrRefusedInASentence) {
  constexpr std::chrono::seconds kLongest{kernel::kIsSanitized ? 200 : 20};
  constexpr unsigned kFewer = kernel::kIsSanitized ? 20 : 1;
  constexpr std::size_t kLongestSentence = 8'000;
  unsigned tried = 0;
  unsigned refused = 0;
  for (const ReadFile& one : files()) {
    SCOPED_TRACE(one.file.string());
    const std::string right = reports::read_text_file(one.file);
    kernel::Random random = kernel::Random(7).split(one.file.filename().string());
    for (unsigned n = 0; n < (one.mutations + kFewer - 1) / kFewer; ++n) {
      const std::string wrong =
          n % 2 == 0 ? with_changed_octets(right, random) : with_changed_structure(right, random);
      reports::write_text_file(one.file, wrong);
      fs::remove_all(folder_ / "again");
      std::vector<const char*> words = {"fieldproof"};
      for (const std::string& word : one.call) words.push_back(word.c_str());
      const auto begin = std::chrono::steady_clock::now();
      int code = 0;
      std::string said;
      {
        const Streams streams;
        code = run_program(static_cast<int>(words.size()), words.data(), built_in_protocols());
        said = streams.said();
      }
      ++tried;
      ASSERT_LT(std::chrono::steady_clock::now() - begin, kLongest) << n << wrong.substr(0, kLongestSentence);
      ASSERT_NE(code, 70) << n << ": " << said << wrong.substr(0, kLongestSentence);
      if (code < 64) continue;
      ++refused;
      ASSERT_TRUE(said.starts_with("fieldproof: ")) << n << ": " << code << said;
      ASSERT_LT(said.size(), kLongestSentence) << n << ": " << said.substr(0, kLongestSentence);
    }
    reports::write_text_file(one.file, right);
  }
  RecordProperty("tried", static_cast<int>(tried));
  RecordProperty("refused", static_cast<int>(refused));
  EXPECT_GE(tried, 2'000U / kFewer);
  EXPECT_GT(refused, tried / 4);
  std::printf("%u files changed, %u of them refused\n", tried, refused);
}

}  // namespace
}  // namespace fieldproof::cli
