#include "reports/timeline_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/kernel/arbitrary_text.hpp"
#include "reports/approved_text.hpp"
#include "reports/sample_recording.hpp"
#include "reports/sample_run.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::json;
using kernel::kMicrosecond;
using kernel::kStart;

Json timeline_of(const judge::CaseResult& result, const trace::Recording& recording) {
  return Json::parse(timeline_json(result, recording, SampleDissector()));
}

AjvJudgement judged(const std::vector<std::string>& documents) {
  static const TemporaryFolder folder;
  std::vector<std::filesystem::path> files;
  for (const std::string& document : documents) {
    files.push_back(folder.path() / (std::to_string(files.size()) + ".json"));
    write_text_file(files.back(), document);
  }
  const std::filesystem::path source = FIELDPROOF_SOURCE_DIR;
  return judge_with_ajv(source, schema_path("timeline"), files);
}

TEST(TimelineWriter, WritesTheApprovedDocument) {
  expect_approved("timeline.json", timeline_json(sample_failure(), sample_recording(), SampleDissector()));
}

TEST(TimelineWriter, IsValidForASchemaValidator) {
  trace::Recording hostile = sample_recording();
  hostile.channels[0] = "\x1b[31m\xff";
  hostile.records.emplace_back(trace::Fault{0, kernel::kNever, "\xc0\x80"});
  const AjvJudgement judgement =
      judged({timeline_json(sample_failure(), sample_recording(), SampleDissector()),
              timeline_json(sample_failure(), hostile, SampleDissector()),
              timeline_json(sample_case("a/b/c", judge::Verdict::pass), {}, trace::PlainDissector())});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
}

TEST(TimelineWriter, SchemaRefusesWhatIsNoTimeline) {
  const Json good = timeline_of(sample_failure(), sample_recording());
  std::vector<std::string> broken;
  for (const auto& [pointer, value] : std::map<std::string, Json>{
           {"/schema", "fieldproof/timeline/2"},
           {"/is_cut", 1},
           {"/transmissions/0/start_ps", 7},
           {"/transmissions/0/is_changed", "no"},
           {"/faults/0/time_ps", "1e3"},
           {"/observations/0/value", "12"},
           {"/windows/0/kind", "quiet"},
       }) {
    Json document = good;
    document[Json::json_pointer(pointer)] = value;
    broken.push_back(document.dump());
  }
  const AjvJudgement judgement = judged(broken);
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.output.find(": valid"), std::string::npos) << judgement.output;
}

TEST(TimelineWriter, AChangeWithoutAFaultOfTheTraceIsToldAsAFault) {
  const Json timeline = timeline_of(sample_failure(), sample_recording());
  std::string told;
  for (const Json& fault : timeline["faults"]) told += fault["text"].get<std::string>() + "\n";
  // The first change is explained by the faults that the trace has.
  EXPECT_EQ(told, "flip levels 3..3\nflip levels 4..4\nlost on the way\n");
  std::string changed;
  for (const Json& one : timeline["transmissions"]) changed += one["is_changed"].get<bool>() ? 'x' : '-';
  EXPECT_EQ(changed, "-xx-");
}

TEST(TimelineWriter, FaultsThatFollowOneAnotherCloselyAreABurst) {
  trace::Recording recording = sample_recording();
  recording.changes.clear();
  recording.records.clear();
  for (const int us : {0, 500, 1000, 1501, 9000, 9001}) {
    recording.records.emplace_back(trace::Fault{0, kStart + us * kMicrosecond, "flip"});
  }
  const Json windows = timeline_of(sample_failure(), recording)["windows"];
  ASSERT_EQ(windows.size(), 2U);
  EXPECT_EQ(windows[0]["from_ps"], "0");
  EXPECT_EQ(windows[0]["to_ps"], "1000000000");
  EXPECT_EQ(windows[1]["from_ps"], "9000000000");
}

// A long recording: transmission n begins n microseconds after the start.
trace::Recording long_recording(int count) {
  trace::Recording recording;
  recording.channels = {"line"};
  for (int n = 0; n < count; ++n) {
    line::Waveform wave{kStart + n * kMicrosecond, 1'000'000, {}};
    wave.levels.append(0, 1);
    recording.records.emplace_back(trace::Transmission{0, std::move(wave), std::nullopt});
  }
  return recording;
}

struct Span {
  std::size_t count;
  std::string first;
  bool is_cut;
  friend bool operator==(const Span&, const Span&) = default;
};

Span told_of(int count, std::optional<int> finding_us, bool was_cut = false) {
  judge::CaseResult result = sample_failure();
  if (!finding_us) result.findings.clear();
  if (finding_us) result.findings[0].time = kStart + *finding_us * kMicrosecond;
  trace::Recording recording = long_recording(count);
  recording.is_cut = was_cut;
  const Json timeline = timeline_of(result, recording);
  const Json& told = timeline["transmissions"];
  return {told.size(), told[0]["start_ps"].get<std::string>(), timeline["is_cut"].get<bool>()};
}

TEST(TimelineWriter, TellsWhatLiesAroundTheFirstFinding) {
  EXPECT_EQ(told_of(3000, 0), (Span{3000, "0", false}));
  EXPECT_EQ(told_of(3001, 0), (Span{3000, "0", true}));
  EXPECT_EQ(told_of(10, std::nullopt), (Span{10, "0", false}));
  EXPECT_EQ(told_of(10, std::nullopt, true), (Span{10, "0", true}));
  // 2500 up to and with the finding's instant, 500 after it.
  EXPECT_EQ(told_of(9000, 2499), (Span{3000, "0", true}));
  EXPECT_EQ(told_of(9000, 2500), (Span{3000, "1000000", true}));
  EXPECT_EQ(told_of(9000, 8999), (Span{2500, "6500000000", true}));
  EXPECT_EQ(told_of(9000, std::nullopt), (Span{2500, "6500000000", true}));
}

RC_GTEST_PROP(TimelineWriterProperty, AnyTextGivesADocument, ()) {
  trace::Recording recording = sample_recording();
  recording.channels[0] = *kernel::arbitrary_text();
  recording.records.emplace_back(trace::Fault{0, kStart, *kernel::arbitrary_text()});
  recording.records.emplace_back(trace::Observation{0, kStart, *kernel::arbitrary_text(), 1});
  judge::CaseResult result = sample_failure();
  result.findings[0].actual = *kernel::arbitrary_text();
  const Json timeline = timeline_of(result, recording);
  RC_ASSERT(timeline["channels"].size() == recording.channels.size());
}

}  // namespace
}  // namespace fieldproof::reports
