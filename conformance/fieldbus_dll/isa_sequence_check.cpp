#include "conformance/fieldbus_dll/isa_sequence_check.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_model.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/sequence_settings.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

constexpr std::array<std::int64_t, 7> kIsaDurations{10, 17, 30, 31, 60, 200, 1000};
constexpr std::array<std::int64_t, 6> kIsaSizes{0, 1, 8, 64, 65, 129};
constexpr std::array<std::int64_t, 3> kIsaWaits{1, 40, 1000};
constexpr std::uint8_t kStranger = 0x23;

enum class IsaWord : std::uint8_t {
  single,
  sequence,
  compel,
  token_elsewhere,
  data,
  reply,
  submit,
  submit_compel,
  submit_reply,
  peer,
  wait
};

// What the tester does after a CD of the station.
enum class Peer : std::uint8_t { silent, replies, stranger_replies, stranger_sends };

SequenceNumber isa_priority(std::string_view name = "priority") {
  return {name, 1, 3, 1};
}

// The tester does not wait longer for who waits for a reply.
constexpr std::array kBoundsOfIsaDle{SettingBound{"reply_wait_octets", {1, kLinkSettles / 2}}};

SequenceVocabulary isa_dle_vocabulary() {
  const fieldbus_dll::IsaConfiguration as_made;
  // In the order of IsaWord.
  return {
      .words = {{.word = "single",
                 .meaning = "an ET for the station, for what is at least as urgent",
                 .numbers = {isa_priority("least"), link_silence()},
                 .units = 7,
                 .weight = 4},
                {.word = "sequence",
                 .meaning = "an ES for the station, for what is at least as urgent",
                 .numbers = {isa_priority("least"), {"octets", 1, 2000, 200, kIsaDurations}, link_silence()},
                 .units = 9,
                 .weight = 6},
                {.word = "compel",
                 .meaning = "a CD for the station",
                 .numbers = {isa_priority("least"), link_silence()},
                 .units = 7,
                 .weight = 4},
                {.word = "token_elsewhere",
                 .meaning = "an ET for another station",
                 .numbers = {link_silence()},
                 .units = 7,
                 .weight = 2},
                {.word = "data",
                 .meaning = "a DU for the station, for all or for another",
                 .numbers = {{"to", 0, 2, 0}, {"size", 2, 32, 2}, link_silence()},
                 .units = 9,
                 .weight = 2},
                {.word = "reply",
                 .meaning = "a DT for the station, for which it has not asked",
                 .numbers = {{"size", 2, 32, 2}, link_silence()},
                 .units = 9,
                 .weight = 1},
                {.word = "submit",
                 .meaning = "the user submits data for another station",
                 .numbers = {isa_priority(), {"size", 0, 260, 8, kIsaSizes}},
                 .weight = 7},
                {.word = "submit_compel",
                 .meaning = "the user compels another station",
                 .numbers = {isa_priority()},
                 .weight = 3},
                {.word = "submit_reply",
                 .meaning = "the user submits data for who compels",
                 .numbers = {isa_priority(), {"size", 0, 260, 8, kIsaSizes}},
                 .weight = 4},
                {.word = "peer",
                 .meaning = "who is compelled is silent, replies, or another does, or sends data to a third",
                 .numbers = {{"does", 0, 3, 0}},
                 .weight = 2},
                {.word = "wait",
                 .meaning = "silence of so many octet durations",
                 .numbers = {{"octets", 1, 10'000, 40, kIsaWaits}},
                 .weight = 1}},
      .unit = "octet",
      .levels_per_unit = kFlipsOfAnOctet,
      .settings = sequence_settings(fieldbus_dll::kIsaTable, &as_made, kFixedOfLink, kBoundsOfIsaDle),
      .objection = objection_of(fieldbus_dll::kIsaTable, as_made, expect_judgeable_isa)};
}

class IsaSequenceRun {
 public:
  IsaSequenceRun(IsaBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), model_(bench.rules(), bench.address()) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) execute(command);
    await_response_window();
    std::vector<Octets> delivered;
    for (const auto& one : bench_.user().deliveries) delivered.push_back(one.dlpdu.data);
    judge_.expect(delivered == data_, "data_not_delivered",
                  "the user gets the data of each DU and DT for it or for all", "other data, or none");
  }

 private:
  void execute(const SequenceCommand& command) {
    const auto word = static_cast<IsaWord>(command.word);
    const auto priority = static_cast<Priority>(command.numbers[0]);
    switch (word) {
      case IsaWord::wait:
        await_response_window();
        return bench_.wait(bench_.octets(command.numbers[0]));
      case IsaWord::peer:
        await_response_window();
        peer_ = static_cast<Peer>(command.numbers[0]);
        return;
      case IsaWord::submit:
        return submit(IsaService::unit_data, priority, command.numbers[1]);
      case IsaWord::submit_compel:
        return submit(IsaService::compel, priority, 0);
      case IsaWord::submit_reply:
        return submit(IsaService::reply_data, priority, command.numbers[1]);
      default:
        return send(word, command);
    }
  }

  void send(IsaWord word, const SequenceCommand& command) {
    if (send_link_command(bench_, octets_of(word, command), command)) {
      hear(word, command);
    } else {
      model_.hear_noise(bench_.now());
    }
    const std::int64_t silence = command.numbers.back();
    if (silence >= bench_.link().inter_pdu_delay_octets) return await_response_window();
    bench_.wait(bench_.octets(silence));
    while (bench_.next_begins(bench_.now())) judge_next(*bench_.next());
  }

  Octets octets_of(IsaWord word, const SequenceCommand& command) {
    const auto& numbers = command.numbers;
    const auto& codes = bench_.rules().codes;
    switch (word) {
      case IsaWord::single:
        return bench_.et(static_cast<Priority>(numbers[0]));
      case IsaWord::sequence:
        return bench_.es(static_cast<Priority>(numbers[0]), static_cast<unsigned>(numbers[1]));
      case IsaWord::compel:
        return bench_.cd(static_cast<Priority>(numbers[0]));
      case IsaWord::token_elsewhere:
        return {bench_.control(codes.et, Priority::normal), IsaBench::kPeer, IsaBench::kScheduler};
      case IsaWord::reply:
        content_ = bench_.numbered_data(static_cast<std::size_t>(numbers[0]));
        return bench_.dt(Priority::normal, content_, kStranger);
      default: {
        content_ = bench_.numbered_data(static_cast<std::size_t>(numbers[1]));
        const std::array<std::uint8_t, 3> to{bench_.address(), bench_.rules().everybody, IsaBench::kPeer};
        Octets du{bench_.control(codes.du, Priority::normal), to.at(static_cast<std::size_t>(numbers[0])),
                  kStranger};
        du.insert(du.end(), content_.begin(), content_.end());
        return du;
      }
    }
  }

  void hear(IsaWord word, const SequenceCommand& command) {
    const kernel::Time end = bench_.now();
    const auto least = static_cast<Priority>(command.numbers[0]);
    switch (word) {
      case IsaWord::single:
        return model_.hear_token(least, {}, IsaBench::kScheduler, end);
      case IsaWord::sequence:
        return model_.hear_token(least, static_cast<unsigned>(command.numbers[1]), IsaBench::kScheduler, end);
      case IsaWord::compel:
        return model_.hear_cd(least, IsaBench::kPeer, end);
      case IsaWord::reply:
        data_.push_back(content_);
        return model_.hear_dt(kStranger, end);
      case IsaWord::data:
        if (command.numbers[0] < 2) data_.push_back(content_);
        return model_.hear_other(false, end);
      default:
        return model_.hear_other(true, end);
    }
  }

  void submit(IsaService service, Priority priority, std::int64_t size) {
    const Octets data =
        service == IsaService::compel ? Octets{} : bench_.numbered_data(static_cast<std::size_t>(size));
    const bool is_taken = bench_.submit(service, priority, data);
    const bool is_right = model_.submit(service, priority, IsaBench::kPeer, data);
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("data of {} octets is {}", data.size(), is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
  }

  void await_response_window() {
    while (const auto one = bench_.next()) judge_next(*one);
    object(model_.be_silent(), "silence", bench_.now());
  }

  void judge_next(const DrivenDlpdu& one) {
    object(model_.say(one), one.text(), one.begin);
    const auto node = model_.compelled();
    if (!node || peer_ == Peer::silent) return;
    const std::uint8_t from = peer_ == Peer::replies ? *node : kStranger;
    const Octets content = bench_.numbered_data(4);
    bench_.wait(bench_.least_gap());
    if (peer_ == Peer::stranger_sends) {
      bench_.send(
          {bench_.control(bench_.rules().codes.du, Priority::normal), IsaBench::kPeer, kStranger, 0x55});
      return model_.hear_other(false, bench_.now());
    }
    bench_.send(bench_.dt(Priority::normal, content, from));
    // What is no reply costs the token, and is nothing else.
    if (peer_ == Peer::replies) data_.push_back(content);
    model_.hear_dt(from, bench_.now());
  }

  void object(const std::optional<LinkObjection>& objection, const std::string& actual, kernel::Time when) {
    if (objection) judge_.fail(objection->reason, {{objection->expected}, actual, when});
  }

  IsaBench& bench_;
  CaseJudge& judge_;
  IsaModel model_;
  Peer peer_ = Peer::silent;
  Octets content_;
  std::vector<Octets> data_;
};

std::vector<PartialSource> isa_check_details() {
  std::vector<PartialSource> details = isa_details();
  details.push_back({link_sources::own("encoding of the profile ISA-D, and what is returned when"),
                     {"end_wrong", "reply_wrong", "data_held_back", "speaks_unasked", "sends_other_data"}});
  return details;
}

}  // namespace

const SequenceRole& isa_dle_sequence_role() {
  static const SequenceRole role{
      {.id = "fieldbus_dll/isa_dle/check/follows_the_model",
       .purpose = "check",
       .requirement =
           "Whatever comes in whatever order, a station says what the last token or CD for it allows, "
           "in time, and nothing else.",
       .reference = link_sources::isa_paper("tokens, compelled data and their timers"),
       .details = isa_check_details(),
       .stimulus =
           "Commands at random, with half bits and bits that are flipped and octets that are missing.",
       .expected = "What a model of the rules says.",
       .tags = {},
       .catches = {}},
      isa_dle_vocabulary(),
      {{DerivedKind::values, {"no_end_when_empty", "token_not_returned"}},
       {DerivedKind::faults, {"short_silence", "answers_too_early"}},
       {DerivedKind::words, {"sends_no_preamble", "frame_malformed"}},
       {DerivedKind::repetitions, {"tells_other_source", "told_otherwise"}},
       {DerivedKind::settings, {"takes_any_token", "speaks_unasked"}}}};
  return role;
}

void run_isa_dle_sequence(const Sequence& sequence, IsaBench& bench, CaseJudge& judge) {
  IsaSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
