#include "conformance/fieldbus_dll/isa_sequence_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_model.hpp"
#include "conformance/fieldbus_dll/isa_reasons.hpp"
#include "conformance/fieldbus_dll/isa_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

constexpr std::uint8_t kStranger = 0x23;

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
        if (const auto one = next()) return judge_next(*one);
        return await_response_window();
      case IsaWord::supply:
        return switch_supply(numbers[0], bench_, model_);
      case IsaWord::peer:
        await_response_window();
        peer_ = static_cast<Peer>(numbers[0]);
        peer_after_ = bench_.octets(std::max(numbers[1], std::int64_t{bench_.link().inter_pdu_delay_octets}));
        return;
      case IsaWord::answered:
        await_response_window();
        peer_ = static_cast<Peer>(numbers[0]);
        peer_after_ = bench_.reply_wait() + quarters_of_a_bit(numbers[1]);
        return;
      case IsaWord::late:
        return compel_late(command);
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
      case IsaWord::received:
        return send_by_line(numbers);
      case IsaWord::checked:
        bench_.send_half_bits(half_bits_with_other_check(bench_.et(Priority::time_available),
                                                         static_cast<unsigned>(numbers[0])));
        model_.hear_noise(bench_.now());
        return settle(numbers.back());
      default:
        send(command);
        return settle(numbers.back());
    }
  }

  void send(const SequenceCommand& command) {
    const Octets octets = octets_of(static_cast<IsaWord>(command.word), command.numbers);
    // It would not be in standby any more.
    const bool is_tl = !octets.empty() && octets[0] == bench_.rules().codes.tl;
    if (bench_.is_in_standby() && is_tl && octets.size() > 1 && octets[1] == bench_.address()) return;
    keep_off_end_of_token(octets);
    const kernel::Time begin = bench_.now();
    if (send_link_command(bench_, octets, command)) {
      model_.hear(octets, begin, bench_.now());
    } else {
      model_.hear_noise(bench_.now());
    }
  }

  // What ends when the duration of its token does is heard by a holder or by none: which one is decided by
  // less than any clock is right by.
  void keep_off_end_of_token(const Octets& octets) {
    const auto over = model_.token_end();
    if (!over) return;
    constexpr std::int64_t kAround = 2;  // octets
    const std::size_t length = half_bits_of_frame(with_frame_check(octets)).size() / kHalfBitsOfAnOctet;
    const kernel::Time end = bench_.now() + bench_.octets(static_cast<std::int64_t>(length));
    const kernel::Duration apart = end > *over ? end - *over : *over - end;
    if (apart < bench_.octets(kAround)) settle(2 * kAround);
  }

  void send_framed_data(const Numbers& numbers) {
    constexpr std::int64_t kToAnother = 1;
    const auto data_to = [&](std::int64_t to) {
      return octets_of(IsaWord::data, {to, 1, static_cast<std::int64_t>(Priority::normal), 0, 8});
    };
    const kernel::Time begin = bench_.now();
    const std::vector<Octets> heard =
        send_framed(bench_, numbers[0], data_to(numbers[0] == kTwoOfThem ? 0 : kToAnother), data_to(0));
    for (const Octets& dlpdu : heard) model_.hear(dlpdu, begin, bench_.now());
    if (heard.empty()) model_.hear_noise(bench_.now());
    settle(numbers.back());
  }

  void send_by_line(const Numbers& numbers) {
    constexpr std::int64_t kSize = 200;
    const Octets octets =
        octets_of(IsaWord::data, {0, 1, static_cast<std::int64_t>(Priority::time_available), 0, kSize});
    const kernel::Time begin = bench_.now();
    send_received(bench_, octets, numbers[0]);
    model_.hear(octets, begin, bench_.now());
    settle(numbers.back());
  }

  kernel::Duration quarters_of_a_bit(std::int64_t count) const { return bench_.octets(count) / 32; }

  // When V(FD) is over, or a little before it or after it.
  void compel_late(const SequenceCommand& command) {
    const Numbers& numbers = command.numbers;
    await_response_window();
    work_on_reply(true);
    const Octets cd = header(bench_.rules().codes.cd, numbers[1], {0, 0});
    const kernel::Time begin = bench_.now();
    bench_.send(cd);
    model_.hear(cd, begin, bench_.now());
    const kernel::Time there = bench_.now() + bench_.reply_forming() + quarters_of_a_bit(numbers[0]);
    while (bench_.next_begins(there)) judge_next(*bench_.next());
    submit_one(IsaService::reply_data, Priority::urgent, IsaBench::kPeer, bench_.numbered_data(4));
    await_response_window();
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
      case IsaWord::control:
        return {static_cast<std::uint8_t>(numbers[0]), bench_.address(), IsaBench::kScheduler};
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

  // Who waits for a reply is silent for longer.
  std::optional<DrivenDlpdu> next() {
    const kernel::Duration silence = std::max(bench_.observation_timeout(), 2 * bench_.reply_wait());
    return bench_.next(bench_.now() + silence);
  }

  void await_response_window() {
    while (const auto one = next()) judge_next(*one);
    object(model_.be_silent(), "silence", bench_.now());
    work_on_reply(false);
    judge_reports();
  }

  void judge_next(const DrivenDlpdu& one) {
    object(model_.say(one), bench_.words(one), one.begin);
    const auto node = model_.compelled();
    if (!node || peer_ == Peer::silent) return;
    // Who is compelled may be as late as its time-out, or later.
    const kernel::Time begin = one.end + peer_after_;
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
  kernel::Duration peer_after_{};
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
       .rules = isa_reasons(),
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
       {DerivedKind::walks, {"end_sent_twice", "speaks_unasked"}},
       {DerivedKind::repetitions, {"replies_twice", "speaks_unasked"}},
       {DerivedKind::settings, {"no_frame_under_et", "data_held_back"}},
       {DerivedKind::drawn, {"sends_no_preamble", "frame_malformed"}}}};
  return role;
}

void run_isa_dle_sequence(const Sequence& sequence, IsaBench& bench, CaseJudge& judge) {
  IsaSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
