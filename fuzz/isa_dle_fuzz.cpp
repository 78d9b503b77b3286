// A data link entity of the profile ISA-D on a link, fed with arbitrary content.
//
// Input: a script. Its first octet chooses the link and whether the user works on replies, then each step is
// an octet that chooses what comes, and its parameters: tokens for one frame and for a duration, CD, replies
// and other data with a check that fits, any octets in a frame, several frames in one transmission, levels as
// wide as half bits or otherwise, all of them with a half bit flipped if the step says so, silence, what the
// user submits. Invariants: the entity says what the model (isa_dle_model.hpp) says, octet by octet, at its
// instants, and nothing else; so it tells its user; when the line is clean again, it uses and returns a
// token.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fuzz/isa_dle_model.hpp"
#include "fuzz/link_line.hpp"
#include "fuzz/octet_reader.hpp"
#include "fuzz/script.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/fieldbus_dll/isa_dle.hpp"

namespace {

using fieldproof::fieldbus_dll::IsaConfiguration;
using fieldproof::fieldbus_dll::IsaDle;
using fieldproof::fieldbus_dll::IsaDlpdu;
using fieldproof::fieldbus_dll::IsaEvent;
using fieldproof::fieldbus_dll::IsaEventKind;
using fieldproof::fieldbus_dll::IsaRequest;
using fieldproof::fieldbus_dll::IsaService;
using fieldproof::fieldbus_dll::Priority;
using fieldproof::fuzz::IsaDleModel;
using fieldproof::fuzz::IsaIndication;
using fieldproof::fuzz::LinkEar;
using fieldproof::fuzz::LinkLine;
using fieldproof::fuzz::LinkOctets;
using fieldproof::fuzz::OctetReader;
using fieldproof::kernel::Time;

constexpr unsigned kMostSteps = 48;
constexpr std::uint8_t kIsaNode = 0x21;
constexpr std::uint8_t kIsaScheduler = 0x10;
// Its own, others, all, and two that are none.
constexpr std::array<std::uint8_t, 6> kIsaNodes{kIsaNode, 0x22, kIsaScheduler, 0xFF, 0x00, 0xF8};

IsaConfiguration isa_configuration(std::uint8_t choice) {
  IsaConfiguration made;
  made.address = kIsaNode;
  auto& link = made.rules.link;
  constexpr std::array<unsigned, 4> kSilences{8, 0, 1, 24};
  link.inter_pdu_delay_octets = kSilences.at(choice % 4U);
  link.preamble_octets = (choice & 4U) != 0 ? 8 : 1;
  if ((choice & 8U) != 0) link.bit_rate = 2'500'000;
  return made;
}

class IsaUserLog final : public fieldproof::fieldbus_dll::IsaUser {
 public:
  void on_data(const IsaDlpdu& dlpdu, Time when) override {
    told.push_back({IsaIndication::Kind::data, when, octets_of(dlpdu, {})});
  }
  void on_event(const IsaEvent& event, Time when) override {
    const bool is_missing = event.kind == IsaEventKind::reply_missing;
    FIELDPROOF_CHECK(is_missing || event.kind == IsaEventKind::token_dropped,
                     "an entity tells of its own token and replies only");
    told.push_back({is_missing ? IsaIndication::Kind::reply_missing : IsaIndication::Kind::token_dropped,
                    when,
                    {event.node}});
  }
  bool is_reply_coming(Priority, Time) override { return works_on_reply; }

  std::vector<IsaIndication> told;
  bool works_on_reply = false;
};

class IsaDleWorld final : private LinkLine {
 public:
  explicit IsaDleWorld(std::uint8_t choice)
      : LinkLine(isa_configuration(choice).rules.link, choice),
        configuration_(isa_configuration(choice)),
        dle_(configuration_),
        model_(configuration_),
        ear_(configuration_.rules.link) {
    seat_ = segment().attach(dle_, "dle");
    auto& place = medium().attach("dle/in", seat_, 0, {});
    place.sense_activity();
    place.tap_arrived(model_);
    place.tap_driven(ear_);
    dle_.wire(place, user_);
    segment().refresh(seat_);
    if ((choice & 16U) != 0) work_on_reply();
  }

  void step(OctetReader& input) {
    act(input);
    compare();
  }
  void recover();

 private:
  void follow(Time now) override { model_.run_until(now); }
  void on_begin(Time now) override { model_.on_begin(now); }

  void work_on_reply() {
    user_.works_on_reply = !user_.works_on_reply;
    model_.set_works_on_reply(user_.works_on_reply);
  }
  void frame(unsigned type, OctetReader& input, std::uint8_t flip);
  void submit(const IsaRequest& request);
  void submit(OctetReader& input);
  void act(OctetReader& input);
  void compare();

  IsaConfiguration configuration_;
  IsaUserLog user_;
  IsaDle dle_;
  IsaDleModel model_;
  LinkEar ear_;
  std::size_t seat_ = 0;
};

// A DLPDU of this type: priority and addresses by one octet, then what the type has.
void IsaDleWorld::frame(unsigned type, OctetReader& input, std::uint8_t flip) {
  const std::uint8_t choice = input.octet();
  const bool carries_data = type == 2 || type == 3;
  const bool has_priority = type <= 5;
  const bool is_final = type == 6 || (carries_data && (choice & 0x80U) != 0);
  LinkOctets octets{
      static_cast<std::uint8_t>(type << 4 | (has_priority ? choice % 3U + 1 : 0U) | (is_final ? 4U : 0U)),
      kIsaNodes.at((choice >> 2) % kIsaNodes.size()),
      (choice & 0x40U) != 0 ? std::uint8_t{0x22} : kIsaScheduler};
  const std::size_t rest = carries_data             ? input.octet() % 16U
                           : type == 6              ? 1
                           : type == 5 || type == 7 ? 2
                                                    : 0;
  for (std::size_t n = 0; n < rest; ++n) octets.push_back(input.octet());
  send(octets, flip);
}

void IsaDleWorld::submit(const IsaRequest& request) {
  const bool is_taken = dle_.submit(request, now());
  FIELDPROOF_CHECK(is_taken == model_.submit(request), "a request is taken when it can be sent");
  segment().refresh(seat_);
  // A reply that is waited for may begin now.
  pass({});
}

void IsaDleWorld::submit(OctetReader& input) {
  const std::uint8_t choice = input.octet();
  const auto service = static_cast<IsaService>((choice >> 2) % 3U);
  const std::uint8_t size = input.octet();
  IsaRequest request{
      service, static_cast<Priority>(choice % 3U + 1), kIsaNodes.at((choice >> 4) % kIsaNodes.size()), {}};
  // The most is 256 octets.
  if (service != IsaService::compel) request.data = LinkOctets(size + (choice >> 7), size);
  submit(request);
}

void IsaDleWorld::act(OctetReader& input) {
  const auto [kind_of_step, flip] = fieldproof::fuzz::read_choice(input, 16);
  switch (kind_of_step) {
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:
    case 7:
      return frame(kind_of_step, input, flip);
    case 8:
      return send_together(input, flip);
    case 9:
      return levels(input, 2 * configuration_.rules.link.bit_rate, flip);
    case 10:
      return levels(input, fieldproof::fuzz::read_rate(input), flip);
    case 11:
      return pass(octet_times(input.octet()));
    case 12:
      return pass(octet_times(std::int64_t{input.octet()} * 64));
    case 13:
      // Parts of an octet, so that an instant of the entity is met, or just missed.
      return pass(octet_times(input.octet()) / 16);
    case 14:
      return submit(input);
    case 15:
      return work_on_reply();
    default:
      return send(input.take(input.octet() % 32U), flip);
  }
}

void IsaDleWorld::compare() {
  FIELDPROOF_CHECK(ear_.said() == model_.said(),
                   "an entity says what it must, when it must, and nothing else");
  FIELDPROOF_CHECK(user_.told == model_.told(), "a user is told what arrived for it, and what is missing");
}

void IsaDleWorld::recover() {
  constexpr std::uint16_t kLongest = 0xFFFF;
  constexpr std::uint8_t kTokenForAll = 0x51;
  pass(octet_times(kLongest));
  compare();
  const LinkOctets last{0x5A, 0xA5};
  submit({IsaService::unit_data, Priority::time_available, 0x22, last});
  send(LinkOctets{kTokenForAll, kIsaNode, kIsaScheduler, kLongest >> 8, kLongest & 0xFF}, 0);
  pass(octet_times(kLongest));
  compare();
  const auto& said = ear_.said();
  FIELDPROOF_CHECK(said.size() >= 2, "under a long token an entity sends and returns it");
  const LinkOctets& data = said[said.size() - 2].octets;
  FIELDPROOF_CHECK(data[0] == 0x31 && std::equal(last.rbegin(), last.rend(), data.rbegin()),
                   "under a long token an entity sends all that it has");
  FIELDPROOF_CHECK(said.back().octets == (LinkOctets{0x64, kIsaScheduler, kIsaNode, 0}),
                   "an entity returns a token for which it has nothing more");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fieldproof::fuzz::play_script<IsaDleWorld>(data, size, kMostSteps);
}
