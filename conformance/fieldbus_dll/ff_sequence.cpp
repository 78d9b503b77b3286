#include "conformance/fieldbus_dll/ff_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_model.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/sequence_settings.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

constexpr std::array<std::int64_t, 4> kFfBuffers{0, 0, 1, 2};
constexpr std::array<std::int64_t, 3> kFfDestinations{0, 1, 2};
constexpr std::array<std::int64_t, 7> kFfDurations{12, 14, 28, 29, 60, 200, 1000};
constexpr std::array<std::int64_t, 6> kFfSizes{0, 1, 8, 64, 65, 129};
constexpr std::array<std::int64_t, 3> kFfWaits{1, 40, 1000};

enum class FfWord : std::uint8_t {
  token,
  compel,
  probe,
  token_elsewhere,
  probe_elsewhere,
  time,
  data,
  published,
  submit,
  write,
  wait
};

SequenceNumber ff_priority(std::string_view name = "priority") {
  return {name, 1, 3, 1};
}

void expect_judgeable_device(const fieldbus_dll::FfConfiguration& device) {
  expect_time_for_answers(device.rules.link);
}

SequenceVocabulary ff_device_vocabulary() {
  const fieldbus_dll::FfConfiguration as_made;
  // In the order of FfWord.
  return {
      .words = {{.word = "token",
                 .meaning = "a PT for the device, for what is at least as urgent",
                 .numbers = {ff_priority("least"), {"octets", 1, 2000, 200, kFfDurations}, link_silence()},
                 .units = 8,
                 .weight = 6},
                {.word = "compel",
                 .meaning = "a CD for buffer 0, 1 or for one that does not exist",
                 .numbers = {{"buffer", 0, 2, 0, kFfBuffers}, ff_priority(), link_silence()},
                 .units = 7,
                 .weight = 4},
                {.word = "probe",
                 .meaning = "a PN for the device",
                 .numbers = {link_silence()},
                 .units = 6,
                 .weight = 1},
                {.word = "token_elsewhere",
                 .meaning = "a PT for another node",
                 .numbers = {link_silence()},
                 .units = 8,
                 .weight = 1},
                {.word = "probe_elsewhere",
                 .meaning = "a PN for another node",
                 .numbers = {link_silence()},
                 .units = 6,
                 .weight = 2},
                {.word = "time", .meaning = "a TD", .numbers = {link_silence()}, .units = 11, .weight = 1},
                {.word = "data",
                 .meaning = "a DT1 for the user, for all or for another node",
                 .numbers = {{"to", 0, 2, 0, kFfDestinations}, {"size", 2, 32, 2}, link_silence()},
                 .units = 11,
                 .weight = 2},
                {.word = "published",
                 .meaning = "a DT3 to which the device has subscribed, or another",
                 .numbers = {{"from", 0, 1, 0}, {"size", 2, 32, 2}, link_silence()},
                 .units = 10,
                 .weight = 2},
                {.word = "submit",
                 .meaning = "the user submits data for another node",
                 .numbers = {ff_priority(), {"size", 0, 260, 8, kFfSizes}},
                 .weight = 8},
                {.word = "write",
                 .meaning = "the user writes buffer 0 or 1",
                 .numbers = {{"buffer", 0, 1, 0}, {"size", 0, 66, 8, kFfSizes}},
                 .weight = 4},
                {.word = "wait",
                 .meaning = "silence of so many octet durations",
                 .numbers = {{"octets", 1, 10'000, 40, kFfWaits}},
                 .weight = 1}},
      .unit = "octet",
      .levels_per_unit = kFlipsOfAnOctet,
      .settings = sequence_settings(fieldbus_dll::kFfTable, &as_made, kFixedOfLink),
      .objection = objection_of(fieldbus_dll::kFfTable, as_made, expect_judgeable_device)};
}

class FfSequenceRun {
 public:
  FfSequenceRun(FfBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), model_(bench.configuration()) {
    // That it was activated is known; when it last spoke is long ago.
    model_.hear_noise(bench.now());
  }

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) execute(command);
    await_response_window();
    judge_user();
  }

 private:
  void execute(const SequenceCommand& command) {
    const auto word = static_cast<FfWord>(command.word);
    if (word == FfWord::wait) {
      await_response_window();
      return bench_.wait(bench_.octets(command.numbers[0]));
    }
    if (word == FfWord::submit) return submit(command);
    if (word == FfWord::write) return write(command);
    if (send_link_command(bench_, octets_of(word, command), command)) {
      hear(word, command);
    } else {
      model_.hear_noise(bench_.now());
    }
    const std::int64_t silence = command.numbers.back();
    if (silence >= bench_.link().inter_pdu_delay_octets) return await_response_window();
    bench_.wait(bench_.octets(silence));
    judge_said();
  }

  FfAddress buffer(std::int64_t number) const { return FfBench::kPublished + static_cast<FfAddress>(number); }

  Octets octets_of(FfWord word, const SequenceCommand& command) {
    const auto& codes = bench_.rules().codes;
    const auto number = [&](std::size_t n) { return command.numbers.at(n); };
    const auto priority = [&](std::size_t n) { return static_cast<Priority>(number(n)); };
    content_ = word == FfWord::data || word == FfWord::published
                   ? bench_.numbered_data(static_cast<std::size_t>(number(1)))
                   : Octets{};
    switch (word) {
      case FfWord::token:
        return bench_.pt(priority(0), static_cast<unsigned>(number(1)));
      case FfWord::compel: {
        Octets cd = bench_.cd(buffer(number(0)));
        cd[0] = bench_.control(codes.cd, priority(1));
        return cd;
      }
      case FfWord::probe:
        return {codes.pn, bench_.node()};
      case FfWord::token_elsewhere:
        return {bench_.control(codes.pt, Priority::normal), FfBench::kPeer, 0, 200};
      case FfWord::probe_elsewhere:
        return {codes.pn, FfBench::kPeer};
      case FfWord::time:
        return {codes.td, 0, 0, 0, 1, 0, 0};
      case FfWord::data:
        return bench_.dt1(Priority::normal, destination(number(0)), FfBench::kPeersAddress, content_);
      default:
        return bench_.dt3(FfBench::kSubscribed + static_cast<FfAddress>(number(0)), content_);
    }
  }

  FfAddress destination(std::int64_t number) const {
    constexpr FfAddress kUserSelector = 0x40;
    const std::array<FfAddress, 3> all{fieldbus_dll::address_of(bench_.node(), kUserSelector),
                                       fieldbus_dll::kEverybody, FfBench::kPeersAddress};
    return all.at(static_cast<std::size_t>(number));
  }

  void hear(FfWord word, const SequenceCommand& command) {
    const kernel::Time end = bench_.now();
    const auto number = [&](std::size_t n) { return command.numbers.at(n); };
    switch (word) {
      case FfWord::token:
        return model_.hear_token(static_cast<Priority>(number(0)), static_cast<unsigned>(number(1)), end);
      case FfWord::compel:
        return model_.hear_cd(buffer(number(0)), static_cast<Priority>(number(1)), end);
      case FfWord::probe:
        return model_.hear_probe(end);
      case FfWord::data:
        if (number(0) < 2) data_.push_back(content_);
        return model_.hear_other(false, end);
      case FfWord::published:
        if (number(0) == 0) published_.push_back(content_);
        return model_.hear_other(false, end);
      default:
        return model_.hear_other(true, end);
    }
  }

  void submit(const SequenceCommand& command) {
    const auto priority = static_cast<Priority>(command.numbers[0]);
    const Octets data = bench_.numbered_data(static_cast<std::size_t>(command.numbers[1]));
    judge_taken(bench_.submit(priority, data), model_.submit(priority, data), data);
  }

  void write(const SequenceCommand& command) {
    const Octets data = bench_.numbered_data(static_cast<std::size_t>(command.numbers[1]));
    const FfAddress address = buffer(command.numbers[0]);
    judge_taken(bench_.write(address, data), model_.write(address, data), data);
  }

  void judge_taken(bool is_taken, bool is_right, const Octets& data) {
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("data of {} octets is {}", data.size(), is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
  }

  void judge_said() {
    while (bench_.next_begins(bench_.now())) {
      const DrivenDlpdu one = *bench_.next();
      object(model_.say(one), one.text(), one.begin);
    }
  }

  void await_response_window() {
    for (const DrivenDlpdu& one : bench_.listen()) object(model_.say(one), one.text(), one.begin);
    object(model_.be_silent(), "silence", bench_.now());
  }

  void object(const std::optional<LinkObjection>& objection, const std::string& actual, kernel::Time when) {
    if (objection) judge_.fail(objection->reason, {{objection->expected}, actual, when});
  }

  void judge_user() {
    const auto contents = [](const std::vector<fieldbus_dll::FfDlpdu>& dlpdus) {
      std::vector<Octets> all;
      for (const auto& one : dlpdus) all.push_back(one.data);
      return all;
    };
    judge_.expect(contents(bench_.user().data) == data_, "data_not_delivered",
                  "the user gets the data of each DT1 for it or for all", "other data, or none");
    judge_.expect(contents(bench_.user().published) == published_, "published_not_delivered",
                  "the user gets what it has subscribed to, and nothing else", "other data, or none");
  }

  FfBench& bench_;
  CaseJudge& judge_;
  FfModel model_;
  Octets content_;
  std::vector<Octets> data_;
  std::vector<Octets> published_;
};

std::vector<PartialSource> ff_sequence_details() {
  std::vector<PartialSource> details = ff_details();
  details.push_back({link_sources::own("a token is returned by F or by RT as soon as nothing fits"),
                     {"token_not_returned", "data_held_back", "speaks_unasked"}});
  details.push_back(
      {link_sources::own("a published buffer has the number of its writes"), {"published_wrong"}});
  return details;
}

}  // namespace

const SequenceRole& ff_device_sequence_role() {
  static const SequenceRole role{
      {.id = "fieldbus_dll/ff_device/check/follows_the_model",
       .purpose = "check",
       .requirement =
           "Whatever comes in whatever order, a device says what the last token, CD or probe for it "
           "allows, in time, and nothing else.",
       .reference = link_sources::memory("functions of a basic device"),
       .details = ff_sequence_details(),
       .stimulus =
           "Commands at random, with half bits and bits that are flipped and octets that are missing.",
       .expected = "What a model of the rules says.",
       .tags = {},
       .catches = {}},
      ff_device_vocabulary(),
      {{DerivedKind::values, {"tells_twice", "data_not_delivered"}},
       {DerivedKind::faults, {"tells_live_lists", "data_not_delivered"}},
       {DerivedKind::words, {"subscribed_to_none", "published_not_delivered"}},
       {DerivedKind::repetitions, {"tells_other_source", "told_otherwise"}},
       {DerivedKind::settings, {"tells_no_writes", "told_otherwise"}}}};
  return role;
}

void run_ff_device_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge) {
  FfSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
