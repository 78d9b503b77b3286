#include "protocols/valve_bus/attached_node.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr std::size_t kMostCharacters = 4096;
constexpr kernel::Duration kLongestDrive = 10 * kernel::kSecond;
constexpr kernel::Duration kFarthestAhead = 3600 * kernel::kSecond;

[[noreturn]] void refuse_impossible(const std::string& sentence) {
  throw iut::Misbehaviour(iut::reasons::kImpossible, "the implementation " + sentence);
}

}  // namespace

std::vector<std::pair<std::string, std::int64_t>> node_settings(const NodeConfiguration& configuration) {
  const Rules& rules = configuration.rules;
  return {{"bit_rate", rules.bit_rate},
          {"characters", static_cast<std::int64_t>(rules.characters)},
          {"address_tens", configuration.tens},
          {"address_units", configuration.units},
          {"boards", configuration.boards},
          {"answers_writes", rules.answers_writes ? 1 : 0},
          {"loss_limit_ms", rules.loss_limit / kernel::kMillisecond}};
}

NodeConfiguration node_configuration_of(const iut::CaseBegin& begin) {
  NodeConfiguration configuration;
  Rules& rules = configuration.rules;
  const auto setting = [&](std::string_view name, std::int64_t absent) {
    const auto found = std::ranges::find(begin.settings, name, [](const auto& one) { return one.first; });
    return found == begin.settings.end() ? absent : found->second;
  };
  rules.bit_rate = std::clamp<std::int64_t>(setting("bit_rate", rules.bit_rate), 1, 100'000'000);
  rules.characters = static_cast<CharacterProfile>(std::clamp<std::int64_t>(setting("characters", 0), 0, 2));
  configuration.tens = static_cast<unsigned>(setting("address_tens", configuration.tens));
  configuration.units = static_cast<unsigned>(setting("address_units", configuration.units));
  configuration.boards = static_cast<unsigned>(setting("boards", configuration.boards));
  rules.answers_writes = setting("answers_writes", 0) != 0;
  rules.loss_limit =
      std::clamp<std::int64_t>(setting("loss_limit_ms", 0), 0, 3'600'000) * kernel::kMillisecond;
  return configuration;
}

AttachedNode::AttachedNode(NodeAttachment attachment, const NodeConfiguration& configuration,
                           const std::string& case_id, std::uint64_t seed)
    : attachment_(std::move(attachment)),
      configuration_(configuration),
      codec_(configuration.rules),
      transmitter_(configuration.rules) {
  call(kernel::kStart, [&](iut::Device& device) {
    if (device.begin({case_id, seed, node_settings(configuration)}, *this)) return;
    throw iut::Misbehaviour(iut::reasons::kUnsupported,
                            "the implementation answers 'unsupported' to this case");
  });
}

AttachedNode::~AttachedNode() {
  try {
    end();
  } catch (const kernel::Error&) {
    // The case has ended before, with a verdict; the next one begins with a new implementation.
  }
}

void AttachedNode::end() {
  if (!is_well_ || has_ended_) return;
  has_ended_ = true;
  call(now_, [](iut::Device& device) { device.end(); });
  if (attachment_.on_well_ended) attachment_.on_well_ended();
}

// One that did not keep to the protocol once is not called again.
template <typename Call>
void AttachedNode::call(kernel::Time now, Call&& call) {
  if (!is_well_) return;
  is_well_ = false;
  now_ = now;
  call(*attachment_.device);
  is_well_ = true;
}

void AttachedNode::wire(segment::Port& line, NodeBoards& boards) {
  line_ = &line;
  boards_ = &boards;
}

void AttachedNode::set_power(bool is_on, kernel::Time now) {
  is_supplied_ = is_on;
  last_write_ = now;
  transmitter_.begin_at(now);
  call(now, [&](iut::Device& device) { device.set_power(is_on, now); });
}

void AttachedNode::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (attachment_.device->unit_kind() == iut::UnitKind::levels) {
    call(reception.end(), [&](iut::Device& device) { device.receive(port, reception); });
    return;
  }
  characters_.clear();
  codec_.hear(reception, [&](const HeardCharacter& heard) {
    characters_.push_back(
        {heard.start, heard.busy_until, heard.data, heard.is_parity_wrong, heard.is_stop_missing});
  });
  // What is no character an asynchronous receiver does not hear.
  for (std::span<const iut::Character> rest(characters_); !rest.empty();) {
    const auto part = rest.first(std::min(rest.size(), kMostCharacters));
    call(reception.end(), [&](iut::Device& device) { device.receive(port, part, reception.end()); });
    rest = rest.subspan(part.size());
  }
}

void AttachedNode::on_time(kernel::Time now) {
  call(now, [&](iut::Device& device) { device.on_time(now); });
}

kernel::Time AttachedNode::next_time() const {
  return is_well_ ? attachment_.device->next_time() : kernel::kNever;
}

// ---- what the implementation does ----

// A case begins without supply, and before there is a line.
void AttachedNode::expect_supplied() const {
  if (line_ == nullptr) refuse_impossible("acts while the case begins; it has no supply yet");
  if (!is_supplied_) refuse_impossible("acts without supply");
}

void AttachedNode::transmit(const iut::Transmission& transmission) {
  expect_supplied();
  if (transmission.port != 0)
    refuse_impossible(fmt::format("drives port {}; a node has port 0", transmission.port));
  const std::size_t count = transmission.characters.size();
  if (count > kMostCharacters) refuse_impossible(fmt::format("sends {} characters at once", count));
  // In this order: none of the sums is further than time reaches.
  const bool is_near = now_ <= transmission.driver_on && transmission.driver_on <= transmission.start &&
                       transmission.start <= transmission.driver_off &&
                       transmission.driver_off.time_since_epoch() <= kFarthestAhead &&
                       transmission.driver_off - transmission.driver_on <= kLongestDrive;
  const kernel::Duration length = half_characters(configuration_.rules, 2 * static_cast<unsigned>(count));
  if (!is_near || transmission.start + length > transmission.driver_off + kernel::kNanosecond) {
    refuse_impossible(fmt::format("drives from {} to {}, with {} of characters from {} on",
                                  kernel::describe(transmission.driver_on),
                                  kernel::describe(transmission.driver_off), kernel::describe(length),
                                  kernel::describe(transmission.start)));
  }
  transmitter_.drive(*line_, transmission);
}

void AttachedNode::transmit(unsigned port, line::Waveform& wave) {
  expect_supplied();
  if (port != 0) refuse_impossible(fmt::format("drives port {}; a node has port 0", port));
  if (wave.levels.empty()) refuse_impossible("drives no level at all");
  const bool is_near = now_ <= wave.start && wave.start.time_since_epoch() <= kFarthestAhead;
  if (!is_near || wave.end() - wave.start > kLongestDrive) {
    refuse_impossible(
        fmt::format("drives from {} to {}", kernel::describe(wave.start), kernel::describe(wave.end())));
  }
  transmitter_.drive(*line_, wave);
}

void AttachedNode::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  if (item != kValves || value > 0xFFFF) {
    refuse_impossible(
        fmt::format("writes {} to item {}; a node has 16 valves, item {}", value, item, kValves));
  }
  expect_supplied();
  if (when < now_ || when.time_since_epoch() > kFarthestAhead) {
    refuse_impossible(
        fmt::format("moves its valves at {} when it is {}", kernel::describe(when), kernel::describe(now_)));
  }
  if (when < last_write_) refuse_impossible("moves its valves at an instant that lies before the last one");
  last_write_ = when;
  boards_->drive_valves(static_cast<std::uint16_t>(value), when);
}

std::uint64_t AttachedNode::read(iut::Item item, kernel::Time when) {
  if (item != kLimitSwitches) {
    refuse_impossible(
        fmt::format("reads item {}; a node has its limit switches, item {}", item, kLimitSwitches));
  }
  expect_supplied();
  if (when < now_ || when.time_since_epoch() > kFarthestAhead) {
    refuse_impossible(fmt::format("reads its limit switches at {} when it is {}", kernel::describe(when),
                                  kernel::describe(now_)));
  }
  return boards_->limit_switches(when);
}

// ---- a node of ours ----

bool ServedNode::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  bench_ = &bench;
  now_ = kernel::kStart;
  node_ = make_node_(node_configuration_of(begin));
  node_->wire(*this, *this);
  return true;
}

void ServedNode::receive(unsigned, std::span<const iut::Character>, kernel::Time) {
  FIELDPROOF_CHECK(false, "a served node has asked for levels");
}

}  // namespace fieldproof::valve_bus
