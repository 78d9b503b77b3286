#include "conformance/fieldbus_dll/isa_sequence_check.hpp"

#include <fmt/format.h>

#include <algorithm>
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

constexpr std::array<std::int64_t, 16> kIsaDurations{1,  9,  10,  17,  30,    31,     33,     34,
                                                     60, 61, 127, 200, 1'000, 32'768, 33'000, 65'535};
constexpr std::array<std::int64_t, 12> kIsaSizes{0, 1, 2, 8, 9, 10, 63, 64, 65, 128, 129, 256};
constexpr std::array<std::int64_t, 8> kIsaTimes{1, 1, 1, 1, 1, 1, 40, 150};
constexpr std::array<std::int64_t, 23> kIsaToStations{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                      0, 0, 0, 0, 1, 1, 2, 3, 4, 5, 6};
constexpr std::array<std::int64_t, 22> kIsaTo{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                              0, 0, 0, 0, 0, 1, 1, 2, 3, 4, 5};
constexpr std::array<std::int64_t, 18> kIsaFrom{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 1, 2, 3, 4, 5};
constexpr std::array<std::int64_t, 16> kIsaPriorities{1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 0};
constexpr std::array<std::int64_t, 4> kIsaRequestPriorities{1, 2, 3, 2};
constexpr std::array<std::int64_t, 18> kIsaWorks{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 12, 22, 24, 25, 60};
constexpr std::array<std::int64_t, 6> kIsaPeers{1, 1, 1, 2, 3, 4};
constexpr std::array<std::int64_t, 6> kIsaPeerAfter{8, 8, 8, 20, 30, 31};
constexpr std::uint8_t kStranger = 0x23;

enum class IsaWord : std::uint8_t {
  single,
  sequence,
  compel,
  other,
  data,
  reply,
  noise,
  submit,
  peer,
  supply,
  one,
  wait,
  framed
};

// What the tester does after a CD of the station.
enum class Peer : std::uint8_t {
  silent,
  replies,
  replies_empty,
  replies_without_final,
  stranger_replies,
  replies_to_stranger,
  sends_data,
  stranger_sends,
  compels,
  delegates,
  takes_back,
  sends_none,
  makes_noise
};

SequenceNumber isa_priority(std::string_view name = "priority") {
  return {name, 0, 3, 2, kIsaPriorities, true};
}
SequenceNumber isa_to() {
  return {"to", 0, 6, 0, kIsaToStations, true};
}
SequenceNumber isa_from() {
  return {"from", 0, 5, 0, kIsaFrom, true};
}
SequenceNumber isa_truth(std::string_view name) {
  return {name, 0, 1, 0};
}

// Of a DU and a DT.
std::vector<SequenceNumber> isa_numbers_of_data() {
  return {isa_to(),      isa_from(), isa_priority(), isa_truth("final"), {"size", 0, 260, 8, kIsaSizes},
          link_silence()};
}

// The tester does not wait longer for who waits for a reply.
constexpr std::array kBoundsOfIsaDle{SettingBound{"reply_wait_octets", {1, kLinkSettles / 2}}};

std::vector<SequenceWord> isa_dle_words() {
  // In the order of IsaWord.
  return {{.word = "single",
           .meaning = "an ET for what is at least as urgent, to the station or to others",
           .numbers = {isa_to(), isa_from(), isa_priority("least"), link_length(), link_silence()},
           .units = 7,
           .weight = 12},
          {.word = "sequence",
           .meaning = "an ES for what is at least as urgent, to the station or to others",
           .numbers = {isa_to(),
                       isa_from(),
                       isa_priority("least"),
                       {"octets", 0, 65'535, 200, kIsaDurations},
                       link_length(),
                       link_silence()},
           .units = 9,
           .weight = 18},
          {.word = "compel",
           .meaning = "a CD, to the station or to others; its user works on data until so many octets after "
                      "it, 0: it does not",
           .numbers = {isa_to(),
                       isa_from(),
                       isa_priority("least"),
                       {"works", 0, 60, 0, kIsaWorks, true},
                       link_length(),
                       link_silence()},
           .units = 7,
           .weight = 15},
          {.word = "other",
           .meaning = "EE, TL, or what is none, with this in its last octet",
           .numbers =
               {{"kind", 0, 6, 0}, isa_to(), isa_from(), {"value", 0, 255, 0}, link_length(), link_silence()},
           .units = 8,
           .weight = 6},
          {.word = "data", .meaning = "a DU", .numbers = isa_numbers_of_data(), .units = 9, .weight = 8},
          {.word = "reply",
           .meaning = "a DT, for which the station has not asked",
           .numbers = isa_numbers_of_data(),
           .units = 9,
           .weight = 5},
          {.word = "noise",
           .meaning = "levels on the line that are no frame",
           .numbers = {{"octets", 1, 60, 4}, link_silence()},
           .weight = 3,
           .is_no_frame = true},
          {.word = "submit",
           .meaning = "the user submits: 0 data, 1 a CD, 2 data for a CD; so many times",
           .numbers = {{"service", 0, 2, 0},
                       {"priority", 1, 3, 2, kIsaRequestPriorities},
                       {"to", 0, 5, 0, kIsaTo, true},
                       {"size", 0, 260, 0, kIsaSizes},
                       {"times", 1, 300, 1, kIsaTimes, true}},
           .weight = 27},
          {.word = "peer",
           .meaning = "what the tester does so many octets after a CD of the station",
           .numbers = {{"does", 0, 12, 0, kIsaPeers}, {"after", 8, 60, 8, kIsaPeerAfter}},
           .weight = 10},
          link_supply(),
          {.word = "one", .meaning = "until the station has sent one DLPDU, or does not", .weight = 8},
          {.word = "wait",
           .meaning = "silence of so many octet durations",
           .numbers = {link_wait()},
           .weight = 3},
          link_framed()};
}

// What an entity has to send, holds, waits for or has lost.
std::vector<std::vector<NamedCommand>> states_of_an_entity() {
  const NamedCommand data{"submit"};
  const NamedCommand asks{"submit", {{"service", 1}}};
  const NamedCommand reply{"submit", {{"service", 2}}};
  const NamedCommand token_held{"sequence", {{"silence", 4}}};
  const NamedCommand answer_due{"compel", {{"silence", 4}}};
  const NamedCommand lost{"supply"};
  return {{{"submit", {{"priority", 3}, {"size", 64}}}, data, {"submit", {{"priority", 1}}}},
          {reply, reply},
          {data, token_held},
          {reply, answer_due},
          {asks, {"single", {{"silence", 4}}}, {"one"}},  // its CD is out, and nobody has replied
          {asks, token_held, {"one"}},
          {{"peer", {{"does", 1}}}, asks},
          {{"submit", {{"times", 150}}}},
          {data, asks, reply, token_held, lost},
          {data, reply, answer_due, lost},
          {{"supply", {{"how", kSupplyGoes}}}}};
}

SequenceVocabulary isa_dle_vocabulary() {
  const fieldbus_dll::IsaConfiguration as_made;
  return {.words = isa_dle_words(),
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
  }

 private:
  using Numbers = std::vector<std::int64_t>;

  void execute(const SequenceCommand& command) {
    const Numbers& numbers = command.numbers;
    switch (static_cast<IsaWord>(command.word)) {
      case IsaWord::wait:
        await_response_window();
        return bench_.wait(bench_.octets(numbers[0]));
      case IsaWord::one:
        if (const auto one = bench_.next()) return judge_next(*one);
        return await_response_window();
      case IsaWord::supply:
        return switch_supply(numbers[0], bench_, model_);
      case IsaWord::peer:
        await_response_window();
        peer_ = static_cast<Peer>(numbers[0]);
        peer_after_ = std::max(numbers[1], std::int64_t{bench_.link().inter_pdu_delay_octets});
        return;
      case IsaWord::submit:
        return submit(numbers);
      case IsaWord::noise:
        send_noise(bench_, numbers[0]);
        model_.hear_noise(bench_.now());
        return settle(numbers.back());
      case IsaWord::compel:
        return compel(command);
      case IsaWord::framed:
        return send_framed_data(numbers);
      default:
        send(command);
        return settle(numbers.back());
    }
  }

  void send(const SequenceCommand& command) {
    const Octets octets = octets_of(static_cast<IsaWord>(command.word), command.numbers);
    const kernel::Time begin = bench_.now();
    if (send_link_command(bench_, octets, command)) {
      model_.hear(octets, begin, bench_.now());
    } else {
      model_.hear_noise(bench_.now());
    }
  }

  void send_framed_data(const Numbers& numbers) {
    constexpr std::int64_t kToAnother = 1;
    const auto data_to = [&](std::int64_t to) {
      return octets_of(IsaWord::data, {to, 1, static_cast<std::int64_t>(Priority::normal), 0, 8});
    };
    const kernel::Time begin = bench_.now();
    const std::vector<Octets> heard = send_framed(bench_, numbers[0], data_to(kToAnother), data_to(0));
    for (const Octets& dlpdu : heard) model_.hear(dlpdu, begin, bench_.now());
    if (heard.empty()) model_.hear_noise(bench_.now());
    settle(numbers.back());
  }

  // Its user has the data so many octets after the CD, or has said that there are none.
  void compel(const SequenceCommand& command) {
    const std::int64_t works = command.numbers[3];
    work_on_reply(works > 0);
    send(command);
    if (works > 0) {
      const kernel::Time there = bench_.now() + bench_.octets(works);
      while (bench_.next_begins(there)) judge_next(*bench_.next());
      submit_one(IsaService::reply_data, Priority::urgent, IsaBench::kPeer, bench_.numbered_data(4));
    }
    if (works > 0) return await_response_window();
    settle(command.numbers.back());
  }

  void work_on_reply(bool works) {
    bench_.user().works_on_reply = works;
    model_.work_on_reply(works);
  }

  void settle(std::int64_t silence) {
    if (silence >= bench_.link().inter_pdu_delay_octets || silence == kLinkSettles)
      return await_response_window();
    const kernel::Time until = bench_.now() + bench_.octets(silence);
    while (bench_.next_begins(until)) judge_next(*bench_.next());
  }

  Octets octets_of(IsaWord word, const Numbers& numbers) {
    const auto& codes = bench_.rules().codes;
    switch (word) {
      case IsaWord::single:
        return with_length(header(codes.et, numbers[2], numbers), numbers[3]);
      case IsaWord::sequence: {
        Octets es = header(codes.es, numbers[2], numbers);
        es.push_back(static_cast<std::uint8_t>(numbers[3] >> 8));
        es.push_back(static_cast<std::uint8_t>(numbers[3]));
        return with_length(std::move(es), numbers[4]);
      }
      case IsaWord::compel:
        return with_length(header(codes.cd, numbers[2], numbers), numbers[4]);
      case IsaWord::other:
        return with_length(other(numbers), numbers[4]);
      default: {
        const unsigned code = word == IsaWord::data ? codes.du : codes.dt;
        Octets octets = header(code | (numbers[3] != 0 ? fieldbus_dll::kFinalBit : 0U), numbers[2], numbers);
        const Octets content = bench_.numbered_data(static_cast<std::size_t>(numbers[4]));
        octets.insert(octets.end(), content.begin(), content.end());
        return octets;
      }
    }
  }

  std::uint8_t to(std::int64_t number) const {
    const auto& rules = bench_.rules();
    const std::array<int, 7> all{bench_.address(),        IsaBench::kPeer,         rules.everybody,
                                 bench_.address() ^ 0x80, rules.first_address - 1, rules.last_address + 1,
                                 rules.last_address};
    return static_cast<std::uint8_t>(all.at(static_cast<std::size_t>(number)));
  }
  std::uint8_t from(std::int64_t number) const {
    const auto& rules = bench_.rules();
    const std::array<int, 6> all{IsaBench::kScheduler, IsaBench::kPeer,        kStranger,
                                 rules.first_address,  rules.last_address + 1, 0};
    return static_cast<std::uint8_t>(all.at(static_cast<std::size_t>(number)));
  }
  Octets header(unsigned code, std::int64_t priority, const Numbers& numbers) const {
    return {static_cast<std::uint8_t>(code | static_cast<unsigned>(priority)), to(numbers[0]),
            from(numbers[1])};
  }
  Octets other(const Numbers& numbers) const {
    const auto& codes = bench_.rules().codes;
    const std::uint8_t destination = to(numbers[1]);
    const std::uint8_t source = from(numbers[2]);
    const auto value = static_cast<std::uint8_t>(numbers[3]);
    const std::array<Octets, 7> all{
        Octets{static_cast<std::uint8_t>(codes.ee | fieldbus_dll::kFinalBit), destination, source, value},
        Octets{codes.tl, destination, source, 0, value},
        Octets{codes.ee, destination, source, value},
        Octets{0x8A, destination, source, value},
        Octets{codes.tl, destination, source, 0},
        Octets{codes.tl, destination, source, 0, 1, value},
        Octets{static_cast<std::uint8_t>(codes.ee | fieldbus_dll::kFinalBit), destination, source, 3}};
    return all.at(static_cast<std::size_t>(numbers[0]));
  }

  // Who has no supply is asked for nothing.
  void submit(const Numbers& numbers) {
    const auto service = static_cast<IsaService>(numbers[0]);
    const std::array<int, 6> all{IsaBench::kPeer,
                                 bench_.rules().everybody,
                                 bench_.rules().first_address,
                                 bench_.rules().first_address - 1,
                                 bench_.rules().last_address + 1,
                                 bench_.rules().last_address};
    const auto destination = static_cast<std::uint8_t>(all.at(static_cast<std::size_t>(numbers[2])));
    // A CD has data where these are many.
    constexpr std::int64_t kMany = 128;
    const std::int64_t size = service == IsaService::compel && numbers[3] < kMany ? 0 : numbers[3];
    for (std::int64_t n = 0; n < numbers[4] && model_.has_supply(); ++n)
      submit_one(service, static_cast<Priority>(numbers[1]), destination,
                 bench_.numbered_data(static_cast<std::size_t>(size)));
  }

  void submit_one(IsaService service, Priority priority, std::uint8_t destination, const Octets& data) {
    if (!model_.has_supply()) return;
    const bool is_taken = bench_.submit(service, priority, data, destination);
    const bool is_right = model_.submit(service, priority, destination, data, bench_.now());
    judge_.expect(is_taken == is_right, is_right ? "data_refused" : "data_too_long_taken", [&] {
      return Mismatch{{fmt::format("data of {} octets to {:02X} are {}", data.size(), destination,
                                   is_right ? "taken" : "refused")},
                      is_taken ? "taken" : "refused"};
    });
  }

  void await_response_window() {
    while (const auto one = bench_.next()) judge_next(*one);
    object(model_.be_silent(), "silence", bench_.now());
    work_on_reply(false);
    judge_reports();
  }

  void judge_next(const DrivenDlpdu& one) {
    object(model_.say(one), bench_.words(one), one.begin);
    const auto node = model_.compelled();
    if (!node || peer_ == Peer::silent) return;
    // Who is compelled may be as late as its time-out, or later.
    const kernel::Time begin = one.end + bench_.octets(peer_after_);
    if (bench_.next_begins(begin)) return judge_next(*bench_.next());
    if (peer_ == Peer::makes_noise) {
      send_noise(bench_, 4);
      return model_.hear_noise(bench_.now());
    }
    const Octets octets = octets_of_peer(*node);
    const kernel::Time sent = bench_.now();
    bench_.send(octets);
    model_.hear(octets, sent, bench_.now());
  }

  Octets octets_of_peer(std::uint8_t node) {
    const auto& codes = bench_.rules().codes;
    const Octets content = bench_.numbered_data(4);
    const auto first = [&](std::uint8_t code) { return bench_.control(code, Priority::normal); };
    Octets dt = bench_.dt(Priority::normal, content, node);
    switch (peer_) {
      case Peer::replies_empty:
        return bench_.dt(Priority::time_available, {}, node);
      case Peer::replies_without_final:
        dt[0] = first(codes.dt);
        return dt;
      case Peer::stranger_replies:
        dt[2] = kStranger;
        return dt;
      case Peer::replies_to_stranger:
        dt[1] = kStranger;
        return dt;
      case Peer::sends_data:
        dt[0] = first(codes.du);
        return dt;
      case Peer::stranger_sends:
        return {first(codes.du), IsaBench::kPeer, kStranger, 0x55};
      case Peer::compels:
        return {first(codes.cd), bench_.address(), node};
      case Peer::delegates:
        return bench_.et(Priority::time_available);
      case Peer::takes_back:
        return {first(codes.et), IsaBench::kPeer, IsaBench::kScheduler};
      case Peer::sends_none:
        return {first(codes.et), bench_.address(), node, 0};
      default:
        return dt;
    }
  }

  void object(const std::optional<LinkObjection>& objection, const std::string& actual, kernel::Time when) {
    if (objection) judge_.fail(objection->reason, {{objection->expected}, actual, when});
  }

  void judge_reports() {
    judge_reported(judge_, model_.take_reports(), std::exchange(bench_.user().reports, {}), bench_.now());
  }

  IsaBench& bench_;
  CaseJudge& judge_;
  IsaModel model_;
  Peer peer_ = Peer::silent;
  std::int64_t peer_after_ = 0;
};

std::vector<PartialSource> isa_check_details() {
  std::vector<PartialSource> details = isa_details();
  details.push_back({link_sources::own("encoding of the profile ISA-D, and what is returned when"),
                     {"not_delivered", "delivered_unasked", "delivered_otherwise", "does_not_wait_for_user",
                      "waits_too_long_for_reply", "end_wrong", "reply_wrong", "data_held_back",
                      "speaks_unasked", "sends_other_data"}});
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
      with_beginnings(isa_dle_vocabulary(), states_of_an_entity()),
      {{DerivedKind::values, {"no_end_when_empty", "token_not_returned"}},
       {DerivedKind::faults, {"short_silence", "answers_too_early"}},
       {DerivedKind::words, {"sends_no_preamble", "frame_malformed"}},
       {DerivedKind::states, {"end_sent_twice", "speaks_unasked"}},
       {DerivedKind::repetitions, {"replies_twice", "speaks_unasked"}},
       {DerivedKind::settings, {"no_frame_under_et", "data_held_back"}}}};
  return role;
}

void run_isa_dle_sequence(const Sequence& sequence, IsaBench& bench, CaseJudge& judge) {
  IsaSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
