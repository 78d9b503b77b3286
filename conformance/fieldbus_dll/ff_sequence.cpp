#include "conformance/fieldbus_dll/ff_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_model.hpp"
#include "conformance/fieldbus_dll/ff_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_scene.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

// Numbers that words choose from: which node, address or kind it is.
constexpr FfAddress kFfLink = 0x0001'0000;
constexpr FfAddress kLongPublished = kFfLink | FfBench::kPublished;
constexpr FfAddress kLongSubscribed = kFfLink | FfBench::kSubscribed;
constexpr FfAddress kMoreOfDevice = FfBench::kPublished + kFirstOfMore;
constexpr FfAddress kMoreOfOthers = FfBench::kSubscribed + kFirstOfMore;
constexpr unsigned kFfLongBit = 0x08;

constexpr std::int64_t kToUser = 0;  // of "to" of data
constexpr std::int64_t kToAnother = 3;

// What the words of a sequence send, from the numbers of a command.
class FfWords {
 public:
  explicit FfWords(FfBench& bench) : bench_(bench), codes_(bench.rules().codes) {}

  Octets octets_of(FfWord word, const std::vector<std::int64_t>& numbers) {
    switch (word) {
      case FfWord::token:
        return with_length(
            {control(codes_.pt, numbers[1], numbers[3] != 0), node(numbers[0]),
             static_cast<std::uint8_t>(numbers[2] >> 8), static_cast<std::uint8_t>(numbers[2])},
            numbers[4]);
      case FfWord::compel:
        return with_length(compelling(numbers), numbers[3]);
      case FfWord::probe:
        return with_length({codes_.pn, node(numbers[0])}, numbers[1]);
      case FfWord::other:
        return with_length(other(numbers[0], static_cast<std::uint8_t>(numbers[1])), numbers[2]);
      case FfWord::data:
        return data(numbers);
      case FfWord::published:
        return published(numbers);
      case FfWord::control:
        return {static_cast<std::uint8_t>(numbers[0]), node(0), 0x01, 0xF4};
      default:
        return activation(numbers);
    }
  }

  // Of a peer, to an address of the word "data".
  Octets user_data(std::int64_t to) {
    constexpr std::int64_t kUrgency = 2;
    constexpr std::int64_t kSize = 8;
    return data({to, 0, kUrgency, 0, 0, kSize});
  }

  FfAddress buffer(std::int64_t number) const {
    const auto own = static_cast<FfAddress>(bench_.node()) << 8;
    constexpr FfAddress kTopOfNode = 0x8000;
    const std::array<FfAddress, 13> all{FfBench::kPublished,
                                        FfBench::kPublished + 1,
                                        kLongPublished,
                                        FfBench::kPublished + 2,
                                        own,
                                        kLongPublished + kFfLink,
                                        FfBench::kSubscribed,
                                        FfBench::kPublished ^ kTopOfNode,
                                        kLongPublished + 1,
                                        FfBench::kPublished,
                                        kMoreOfDevice,
                                        kMoreOfDevice + 1,
                                        kMoreOfDevice + 2};
    return all.at(static_cast<std::size_t>(number));
  }
  FfAddress destination(std::int64_t number) const {
    const std::array<FfAddress, 5> all{FfBench::kPeersAddress, kFfLink | FfBench::kPeersAddress,
                                       fieldbus_dll::kEverybody, 0xFFFF'2230,
                                       kFfLink | fieldbus_dll::kEverybody};
    return all.at(static_cast<std::size_t>(number));
  }

 private:
  std::uint8_t control(unsigned code, std::int64_t priority, bool is_final, bool is_long = false) const {
    return static_cast<std::uint8_t>(code | static_cast<unsigned>(priority) |
                                     (is_final ? fieldbus_dll::kFinalBit : 0U) | (is_long ? kFfLongBit : 0U));
  }
  std::uint8_t node(std::int64_t number) const {
    const std::array<int, 5> all{bench_.node(), bench_.node() ^ 0x80, bench_.node() + 1, bench_.node() - 1,
                                 0xFF};
    return static_cast<std::uint8_t>(all.at(static_cast<std::size_t>(number)));
  }
  // The last one has L and no link, which makes it no address.
  Octets compelling(const std::vector<std::int64_t>& numbers) const {
    const FfAddress address = buffer(numbers[0]);
    const bool is_long = fieldbus_dll::is_long(address) || numbers[0] == 9;
    Octets octets{control(codes_.cd, numbers[1], numbers[2] != 0, is_long)};
    append_address(octets, address, is_long);
    return octets;
  }
  Octets other(std::int64_t kind, std::uint8_t value) const {
    const std::array<Octets, 12> all{Octets{codes_.td, 0, 0, 0, 1, 0, value},
                                     Octets{codes_.cl, value},
                                     Octets{codes_.tl, value, 0, 1},
                                     Octets{codes_.rt},
                                     Octets{codes_.sr, value},
                                     Octets{codes_.ri, 0, value},
                                     Octets{codes_.pr, value},
                                     Octets{codes_.ct, value},
                                     Octets{codes_.idle},
                                     Octets{0xE2, bench_.node(), value},
                                     Octets{codes_.ri, 0, 0},
                                     Octets{codes_.sr, 2}};
    return all.at(static_cast<std::size_t>(kind));
  }
  Octets data(const std::vector<std::int64_t>& numbers) {
    const auto own = static_cast<FfAddress>(bench_.node()) << 8;
    constexpr FfAddress kTopOfNode = 0x8000;
    const std::array<FfAddress, 10> to{own | 0x40,
                                       fieldbus_dll::kEverybody,
                                       own,
                                       FfBench::kPeersAddress,
                                       kFfLink | own | 1,
                                       kFfLink | own,
                                       kFfLink | fieldbus_dll::kEverybody,
                                       (own | 1) ^ kTopOfNode,
                                       0xFFFF'0000 | own | 0xFF,
                                       own | 1};
    const std::array<FfAddress, 5> from{FfBench::kPeersAddress, fieldbus_dll::address_of(FfBench::kScheduler),
                                        0x2100, 0x22FF, fieldbus_dll::address_of(FfBench::kPeer)};
    const FfAddress destination = to.at(static_cast<std::size_t>(numbers[0]));
    // The last of each has L, and one of its addresses no link.
    const bool is_long = fieldbus_dll::is_long(destination) || numbers[0] == 9;
    Octets octets{control(codes_.dt1, numbers[2], numbers[3] != 0, is_long)};
    append_address(octets, destination, is_long);
    append_address(
        octets, from.at(static_cast<std::size_t>(numbers[1])) | (is_long && numbers[1] != 4 ? kFfLink : 0U),
        is_long);
    const Octets data = content(numbers[4], numbers[5]);
    octets.insert(octets.end(), data.begin(), data.end());
    return octets;
  }
  Octets published(const std::vector<std::int64_t>& numbers) const {
    const std::array<FfAddress, 6> all{FfBench::kSubscribed,     kLongSubscribed,
                                       FfBench::kSubscribed + 1, kLongSubscribed + kFfLink,
                                       FfBench::kPublished,      FfBench::kSubscribed};
    const auto which = static_cast<std::size_t>(numbers[0]);
    const FfAddress from =
        which < all.size() ? all[which] : kMoreOfOthers + static_cast<FfAddress>(which - all.size());
    const bool is_long = fieldbus_dll::is_long(from) || numbers[0] == 5;
    Octets octets{control(codes_.dt3, numbers[1], numbers[2] != 0, is_long)};
    append_address(octets, from, is_long);
    octets.push_back(static_cast<std::uint8_t>(numbers[3]));
    const Octets data = bench_.numbered_data(static_cast<std::size_t>(numbers[4]));
    octets.insert(octets.end(), data.begin(), data.end());
    return octets;
  }
  Octets activation(const std::vector<std::int64_t>& numbers) const {
    const bool is_long = numbers[1] != 0;
    const FfAddress link = is_long ? kFfLink : 0U;
    Octets octets{control(codes_.dt1, numbers[0], false, is_long)};
    append_address(octets, link | fieldbus_dll::address_of(bench_.node()), is_long);
    append_address(octets, link | fieldbus_dll::address_of(FfBench::kScheduler), is_long);
    octets.push_back(static_cast<std::uint8_t>(fieldbus_dll::SpduKind::activation));
    octets.insert(octets.end(), static_cast<std::size_t>(numbers[2]), 0x5A);
    return octets;
  }
  // By its first octet it is what entities know, or do not.
  Octets content(std::int64_t first, std::int64_t size) {
    if (first == kSameAgain) return last_content_;
    Octets content = bench_.numbered_data(static_cast<std::size_t>(size));
    if (first > 0 && !content.empty()) content[0] = static_cast<std::uint8_t>(first - 1);
    return last_content_ = content;
  }

  FfBench& bench_;
  const fieldbus_dll::FfCodes& codes_;
  Octets last_content_{};
};

class FfSequenceRun {
 public:
  FfSequenceRun(FfBench& bench, CaseJudge& judge)
      : bench_(bench), judge_(judge), words_(bench), model_(bench.configuration()) {
    // That it was activated is known; when it last spoke is long ago.
    model_.hear_noise(bench.now());
    bench_.user().reports.clear();
  }

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) execute(command);
    await_response_window();
  }

 private:
  static constexpr std::int64_t kDuration = 100;  // of a token that is asked for
  static constexpr kernel::Duration kMinute = 60 * kernel::kSecond;

  void execute(const SequenceCommand& command) {
    keep_active();
    const auto word = static_cast<FfWord>(command.word);
    switch (word) {
      case FfWord::wait:
        await_response_window();
        return bench_.wait(bench_.octets(command.numbers[0]));
      case FfWord::one:
        if (const auto one = bench_.next()) return judge_one(*one);
        return await_response_window();
      case FfWord::supply:
        return switch_supply(command.numbers[0], bench_, model_);
      case FfWord::submit:
        return submit(command.numbers);
      case FfWord::write:
        return write(command.numbers);
      case FfWord::noise:
        send_noise(bench_, command.numbers[0]);
        model_.hear_noise(bench_.now());
        return settle(command.numbers.back());
      case FfWord::framed:
        return send_framed_data(command.numbers);
      case FfWord::checked:
        bench_.send_half_bits(half_bits_with_other_check(bench_.pt(Priority::time_available, kDuration),
                                                         static_cast<unsigned>(command.numbers[0])));
        model_.hear_noise(bench_.now());
        return settle(command.numbers.back());
      case FfWord::ended:
        return end_before_it_begins(command.numbers);
      case FfWord::busy:
        return answer_beside_its_end(command.numbers);
      case FfWord::room:
        return leave_room(command.numbers);
      case FfWord::many:
        for (std::int64_t n = 0; n < command.numbers[0]; ++n) send(words_.octets_of(FfWord::probe, {1, 0}));
        send(words_.octets_of(FfWord::probe, {0, 0}));
        return await_response_window();
      case FfWord::ask:
        return ask_for_nothing(command.numbers);
      case FfWord::beside:
        return submit_beside(command.numbers);
      case FfWord::idle:
        await_response_window();
        return bench_.wait(command.numbers[0] * kMinute);
      default:
        break;
    }
    const Octets octets = words_.octets_of(word, command.numbers);
    if (send_link_command(bench_, octets, command)) {
      model_.hear(octets, bench_.now());
    } else {
      model_.hear_noise(bench_.now());
    }
    settle(command.numbers.back());
  }

  void send_framed_data(const std::vector<std::int64_t>& numbers) {
    const std::vector<Octets> heard =
        send_framed(bench_, numbers[0], words_.user_data(numbers[0] == kTwoOfThem ? kToUser : kToAnother),
                    words_.user_data(kToUser));
    for (const Octets& dlpdu : heard) model_.hear(dlpdu, bench_.now());
    if (heard.empty()) model_.hear_noise(bench_.now());
    settle(numbers.back());
  }

  // A link master in standby claims a link on which nobody says anything.
  void keep_active() {
    constexpr std::int64_t kSilentOctets = 150;
    if (!bench_.is_link_master()) return;
    kernel::Time silent_since{};
    if (!bench_.heard().empty()) silent_since = bench_.heard().back().end;
    if (!bench_.driven().empty()) silent_since = std::max(silent_since, bench_.driven().back().end);
    if (bench_.now() > silent_since + bench_.octets(kSilentOctets)) send({bench_.rules().codes.idle});
  }

  void send(const Octets& octets) {
    bench_.send(octets);
    model_.hear(octets, bench_.now());
  }
  // 0: a PT, 1: a CD, 2: a PN for the device.
  Octets asked(std::int64_t what) {
    constexpr std::int64_t kUrgency = 2;
    if (what == 0) return words_.octets_of(FfWord::token, {0, kUrgency, kDuration, 0, 0});
    if (what == 1) return words_.octets_of(FfWord::compel, {0, kUrgency, 0, 0});
    return words_.octets_of(FfWord::probe, {0, 0});
  }
  kernel::Duration quarters_of_a_bit(std::int64_t count) const { return bench_.octets(count) / 32; }

  void end_before_it_begins(const std::vector<std::int64_t>& numbers) {
    await_response_window();
    send(asked(numbers[0]));
    send(words_.octets_of(FfWord::other, {numbers[1], numbers[2], 0}));
    await_response_window();
  }

  void keep_busy_until(kernel::Time until, DlpduIsNone kind) {
    if (keep_busy(bench_, until - bench_.least_gap(), kind)) model_.hear_noise(bench_.now());
    await_response_window();
  }

  // How soon it answers is seen first: as soon it can answer again.
  void answer_beside_its_end(const std::vector<std::int64_t>& numbers) {
    await_response_window();
    send(asked(numbers[0]));
    await_response_window();
    send(asked(numbers[0]));
    keep_busy_until(bench_.now() + bench_.response_delay() + quarters_of_a_bit(numbers[1]),
                    numbers[2] != 0 ? DlpduIsNone::by_its_check : DlpduIsNone::by_its_first_octet);
  }

  void leave_room(const std::vector<std::int64_t>& numbers) {
    constexpr std::int64_t kToPeer = 0;
    constexpr std::int64_t kUrgent = 3;
    constexpr std::int64_t kSize = 8;
    constexpr std::size_t kDt1Octets = 13;
    await_response_window();
    if (numbers[0] != 0) submit({kUrgent, kToPeer, kSize, 1});
    send(asked(0));
    const kernel::Time over = bench_.now() + bench_.octets(kDuration);
    keep_busy_until(over - bench_.frame(numbers[0] != 0 ? kDt1Octets : 1) + quarters_of_a_bit(numbers[1]),
                    DlpduIsNone::by_its_check);
  }

  void settle(std::int64_t silence) {
    if (silence >= bench_.link().inter_pdu_delay_octets || silence == kLinkSettles)
      return await_response_window();
    bench_.wait(bench_.octets(silence));
    judge_said();
  }

  // Who has no supply is asked for nothing.
  void submit(const std::vector<std::int64_t>& numbers) {
    for (std::int64_t n = 0; n < numbers[3] && model_.has_supply(); ++n) {
      const fieldbus_dll::FfRequest request{static_cast<Priority>(numbers[0]), words_.destination(numbers[1]),
                                            bench_.numbered_data(static_cast<std::size_t>(numbers[2]))};
      judge_taken(bench_.submit(request.priority, request.data, request.destination), model_.submit(request),
                  request.data);
    }
  }

  void ask_for_nothing(const std::vector<std::int64_t>& numbers) {
    if (!model_.has_supply()) return;
    Octets request{static_cast<std::uint8_t>(numbers[0])};
    request.resize(1 + static_cast<std::size_t>(numbers[1]), 0x02);
    const bool is_order = numbers[0] == kOrderOfAMaster;
    const bool is_taken = is_order ? bench_.order_transfer(FfBench::kPeer) : bench_.ask_user_request(request);
    judge_.expect(!is_taken, "unknown_request_taken", "a request that a device does not know is refused",
                  "it was taken");
  }

  // What is next was decided before it began to send; what is submitted then comes after it.
  void submit_beside(const std::vector<std::int64_t>& numbers) {
    await_response_window();
    send(asked(0));
    if (bench_.next_begins(bench_.now() + bench_.observation_timeout()) && model_.has_supply()) {
      bench_.wait(bench_.octets(2));
      const fieldbus_dll::FfRequest request{static_cast<Priority>(numbers[0]), words_.destination(0),
                                            bench_.numbered_data(static_cast<std::size_t>(numbers[1]))};
      const bool is_taken = bench_.submit(request.priority, request.data, request.destination);
      judge_one(*bench_.next());
      judge_taken(is_taken, model_.submit(request), request.data);
    }
    await_response_window();
    send(asked(0));
    await_response_window();
  }

  void write(const std::vector<std::int64_t>& numbers) {
    Octets data = bench_.numbered_data(static_cast<std::size_t>(numbers[1]));
    for (std::int64_t n = 0; n < numbers[2] && model_.has_supply(); ++n) {
      if (n > 0 && numbers[3] == 0) data = bench_.numbered_data(data.size());
      const FfAddress address = words_.buffer(numbers[0]);
      judge_taken(bench_.write(address, data), model_.write(address, data), data);
    }
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
      judge_one(one);
    }
  }

  void await_response_window() {
    for (const DrivenDlpdu& one : bench_.listen()) judge_one(one);
    object(model_.be_silent(), "silence", bench_.now());
    judge_reports();
  }

  void judge_one(const DrivenDlpdu& one) {
    object(model_.say(one), bench_.words(one), one.begin);
    const kernel::Duration length = one.end - one.begin;
    const kernel::Duration right = bench_.frame(one.octets.size());
    judge_.expect(length + kLinkRounding >= right && length <= right + kLinkRounding, "frame_length_wrong",
                  [&] {
                    return Mismatch{{fmt::format("{}: {} octets of preamble", kernel::describe(right),
                                                 bench_.link().preamble_octets)},
                                    kernel::describe(length),
                                    one.begin};
                  });
  }

  void object(const std::optional<LinkObjection>& objection, const std::string& actual, kernel::Time when) {
    if (objection) judge_.fail(objection->reason, {{objection->expected}, actual, when});
  }

  void judge_reports() {
    judge_reported(judge_, model_.take_reports(), std::exchange(bench_.user().reports, {}), bench_.now());
  }

  FfBench& bench_;
  CaseJudge& judge_;
  FfWords words_;
  FfModel model_;
};

std::vector<PartialSource> ff_sequence_details() {
  std::vector<PartialSource> details = ff_details();
  details.push_back({link_sources::own("a token is returned by F or by RT as soon as nothing fits"),
                     {"token_not_returned", "data_held_back", "speaks_unasked"}});
  details.push_back({link_sources::own("of what is received its user is given this"),
                     {"not_delivered", "delivered_unasked", "delivered_otherwise", "last_without_final",
                      "returned_with_data"}});
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
      with_beginnings(ff_device_vocabulary(), states_of_a_device()),
      {{DerivedKind::values, {"tells_twice", "delivered_unasked"}},
       {DerivedKind::faults, {"no_probe_response", "no_answer"}},
       {DerivedKind::words, {"subscribed_to_none", "not_delivered"}},
       {DerivedKind::states, {"returns_twice", "speaks_unasked"}},
       {DerivedKind::repetitions, {"tells_other_source", "delivered_otherwise"}},
       {DerivedKind::settings, {"tells_no_writes", "delivered_otherwise"}},
       {DerivedKind::drawn, {"subscribed_to_none", "not_delivered"}}}};
  return role;
}

FfNeeds ff_device_sequence_needs() {
  return {.change = [](fieldbus_dll::FfConfiguration& device) {
    device.published.push_back(kLongPublished);
    device.subscribed.push_back(kLongSubscribed);
    for (FfAddress n = 0; n < kMorePublished; ++n) device.published.push_back(kMoreOfDevice + n);
    for (FfAddress n = 0; n < kMoreSubscribed; ++n) device.subscribed.push_back(kMoreOfOthers + n);
    // Longer than a buffer of most links.
    constexpr std::size_t kMostUrgent = 100;
    device.rules.link.most_data[2] = kMostUrgent;
  }};
}

void run_ff_device_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge) {
  FfSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
