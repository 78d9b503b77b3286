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

// Numbers that words choose from: which node, address or kind it is.
constexpr FfAddress kFfLink = 0x0001'0000;
constexpr FfAddress kLongPublished = kFfLink | FfBench::kPublished;
constexpr FfAddress kLongSubscribed = kFfLink | FfBench::kSubscribed;
constexpr unsigned kFfLongBit = 0x08;

constexpr std::array<std::int64_t, 16> kFfNodes{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4};
constexpr std::array<std::int64_t, 10> kFfProbedNodes{0, 0, 0, 0, 2, 2, 2, 1, 3, 4};
constexpr std::array<std::int64_t, 24> kFfBuffers{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1,
                                                  1, 1, 2, 2, 2, 3, 4, 5, 6, 7, 8, 9};
constexpr std::array<std::int64_t, 11> kFfWritten{0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 3};
constexpr std::array<std::int64_t, 10> kFfWriteSizes{0, 1, 2, 8, 9, 63, 64, 65, 127, 128};
constexpr std::array<std::int64_t, 16> kFfPriorities{1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 0};
constexpr std::array<std::int64_t, 5> kFfRequestPriorities{1, 2, 3, 2, 3};
constexpr std::array<std::int64_t, 20> kFfDurations{
    1, 12, 13, 14, 15, 20, 28, 29, 30, 31, 60, 61, 127, 200, 256, 1'000, 4'096, 32'768, 33'000, 65'535};
constexpr std::array<std::int64_t, 12> kFfSizes{0, 1, 2, 8, 9, 10, 63, 64, 65, 128, 129, 256};
constexpr std::array<std::int64_t, 8> kFfTimes{1, 1, 1, 1, 1, 1, 40, 150};
constexpr std::array<std::int64_t, 8> kFfWrites{1, 1, 1, 1, 2, 2, 128, 255};

constexpr std::int64_t kToUser = 0;  // of "to" of data
constexpr std::int64_t kToAnother = 3;
constexpr std::int64_t kSameAgain = 4;  // of "first": the data of the DT1 before

enum class FfWord : std::uint8_t {
  token,
  compel,
  probe,
  other,
  data,
  published,
  activation,
  noise,
  submit,
  write,
  supply,
  one,
  wait,
  framed
};

SequenceNumber ff_priority(std::string_view name = "priority") {
  return {name, 0, 3, 2, kFfPriorities, true};
}
SequenceNumber ff_truth(std::string_view name) {
  return {name, 0, 1, 0};
}
SequenceNumber ff_node() {
  return {"node", 0, 4, 0, kFfNodes, true};
}

void expect_judgeable_device(const fieldbus_dll::FfConfiguration& device) {
  expect_time_for_answers(device.rules.link);
}

std::vector<SequenceWord> ff_device_words() {
  // In the order of FfWord.
  return {{.word = "token",
           .meaning = "a PT for what is at least as urgent; to the device, or to others",
           .numbers = {ff_node(),
                       ff_priority("least"),
                       {"octets", 0, 65'535, 200, kFfDurations},
                       ff_truth("first"),
                       link_length(),
                       link_silence()},
           .units = 8,
           .weight = 20},
          {.word = "compel",
           .meaning = "a CD for a buffer of the device, or for other addresses",
           .numbers = {{"buffer", 0, 9, 0, kFfBuffers, true},
                       ff_priority(),
                       ff_truth("final"),
                       link_length(),
                       link_silence()},
           .units = 7,
           .weight = 18},
          {.word = "probe",
           .meaning = "a PN, to the device, or to others",
           .numbers = {{"node", 0, 4, 0, kFfProbedNodes, true}, link_length(), link_silence()},
           .units = 6,
           .weight = 5},
          {.word = "other",
           .meaning = "TD, CL, TL, RT, SR, RI, PR, CT, IDLE, or what is none, with this in its last octet",
           .numbers = {{"kind", 0, 11, 0}, {"value", 0, 255, 1}, link_length(), link_silence()},
           .units = 7,
           .weight = 8},
          {.word = "data",
           .meaning = "a DT1 to the device, to all or to others, from a user or an entity",
           .numbers = {{"to", 0, 9, 0},
                       {"from", 0, 4, 0},
                       ff_priority(),
                       ff_truth("final"),
                       {"first", 0, kSameAgain, 0},
                       {"size", 0, 260, 8, kFfSizes},
                       link_silence()},
           .units = 11,
           .weight = 9},
          {.word = "published",
           .meaning = "a DT3 to which the device has subscribed, or another",
           .numbers = {{"from", 0, 5, 0},
                       ff_priority(),
                       ff_truth("final"),
                       {"number", 0, 255, 1},
                       {"size", 0, 260, 8, kFfSizes},
                       link_silence()},
           .units = 10,
           .weight = 6},
          {.word = "activation",
           .meaning = "a DT1 of the scheduler's entity to that of the device: 01, and more",
           .numbers = {ff_priority(), {"long", 0, 1, 0}, {"more", 0, 2, 0}, link_silence()},
           .units = 11,
           .weight = 6},
          {.word = "noise",
           .meaning = "levels on the line that are no frame",
           .numbers = {{"octets", 1, 60, 4}, link_silence()},
           .weight = 3,
           .is_no_frame = true},
          {.word = "submit",
           .meaning = "the user submits data for another node, so many times",
           .numbers = {{"priority", 1, 3, 2, kFfRequestPriorities},
                       {"to", 0, 4, 0},
                       {"size", 0, 260, 8, kFfSizes},
                       {"times", 1, 300, 1, kFfTimes, true}},
           .weight = 20},
          {.word = "write",
           .meaning = "the user writes a buffer, so many times",
           .numbers = {{"buffer", 0, 3, 0, kFfWritten, true},
                       {"size", 0, 257, 8, kFfWriteSizes},
                       {"times", 1, 300, 1, kFfWrites},
                       ff_truth("same")},
           .weight = 18},
          link_supply(),
          {.word = "one", .meaning = "until the device has sent one DLPDU, or does not", .weight = 8},
          {.word = "wait",
           .meaning = "silence of so many octet durations",
           .numbers = {link_wait()},
           .weight = 3},
          link_framed()};
}

// What a device has to send, holds, waits for or has lost.
std::vector<std::vector<NamedCommand>> states_of_a_device() {
  const NamedCommand large{"submit", {{"priority", 3}, {"size", 64}}};
  const NamedCommand usual{"submit"};
  const NamedCommand small{"submit", {{"priority", 1}, {"size", 1}}};
  const NamedCommand written{"write"};
  const NamedCommand token_held{"token", {{"silence", 4}}};
  const NamedCommand answer_due{"compel", {{"silence", 4}}};
  const NamedCommand lost{"supply"};
  return {{large, usual, small},  // data of each priority
          {written,
           {"write", {{"buffer", 1}, {"times", 2}, {"same", 1}}},
           {"write", {{"buffer", 2}}}},  // what it publishes
          {written, answer_due},
          {usual, token_held},
          {large, usual, written, token_held, lost},
          {large, usual, written, answer_due, lost, {"activation"}},
          {lost, {"activation", {{"priority", 3}, {"long", 1}, {"more", 2}}}},
          {{"published"}, {"data"}},
          {{"supply", {{"how", kSupplyGoes}}}}};
}

SequenceVocabulary ff_device_vocabulary() {
  const fieldbus_dll::FfConfiguration as_made;
  return {.words = ff_device_words(),
          .unit = "octet",
          .levels_per_unit = kFlipsOfAnOctet,
          .settings = sequence_settings(fieldbus_dll::kFfTable, &as_made, kFixedOfLink),
          .objection = objection_of(fieldbus_dll::kFfTable, as_made, expect_judgeable_device)};
}

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
    const std::array<FfAddress, 10> all{FfBench::kPublished,
                                        FfBench::kPublished + 1,
                                        kLongPublished,
                                        FfBench::kPublished + 2,
                                        own,
                                        kLongPublished + kFfLink,
                                        FfBench::kSubscribed,
                                        FfBench::kPublished ^ kTopOfNode,
                                        kLongPublished + 1,
                                        FfBench::kPublished};
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
    const FfAddress from = all.at(static_cast<std::size_t>(numbers[0]));
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
  void execute(const SequenceCommand& command) {
    const auto word = static_cast<FfWord>(command.word);
    switch (word) {
      case FfWord::wait:
        await_response_window();
        return bench_.wait(bench_.octets(command.numbers[0]));
      case FfWord::one:
        if (const auto one = bench_.next()) return object(model_.say(*one), bench_.words(*one), one->begin);
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
        send_framed(bench_, numbers[0], words_.user_data(kToAnother), words_.user_data(kToUser));
    for (const Octets& dlpdu : heard) model_.hear(dlpdu, bench_.now());
    if (heard.empty()) model_.hear_noise(bench_.now());
    settle(numbers.back());
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
      object(model_.say(one), bench_.words(one), one.begin);
    }
  }

  void await_response_window() {
    for (const DrivenDlpdu& one : bench_.listen()) object(model_.say(one), bench_.words(one), one.begin);
    object(model_.be_silent(), "silence", bench_.now());
    judge_reports();
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
       {DerivedKind::states, {"mute_after_activation", "token_not_returned"}},
       {DerivedKind::repetitions, {"tells_other_source", "delivered_otherwise"}},
       {DerivedKind::settings, {"tells_no_writes", "delivered_otherwise"}}}};
  return role;
}

FfNeeds ff_device_sequence_needs() {
  return {.change = [](fieldbus_dll::FfConfiguration& device) {
    device.published.push_back(kLongPublished);
    device.subscribed.push_back(kLongSubscribed);
  }};
}

void run_ff_device_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge) {
  FfSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
