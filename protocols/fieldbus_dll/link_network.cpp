#include "protocols/fieldbus_dll/link_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/config/name.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/fieldbus_dll/ff_rules.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using config::ObjectReader;
using config::Value;
using kernel::Duration;
using kernel::Time;
using network::Outcome;

constexpr std::uint8_t kFirstNode = 0x10;
constexpr std::uint8_t kLastNode = 0xF7;
constexpr unsigned kMostStations = kLastNode - kFirstNode + 1;
constexpr std::int64_t kLeadOctets = 80;
// An item of the schedule is a call, its answer and what is kept free in front of the next one, with the
// longest frames that carry a word.
constexpr std::int64_t kItemOctets = 120;
// A node is found by a probe, one in each circulation of the token; a circulation visits all that are live.
constexpr std::int64_t kVisitOctets = 60;
constexpr std::int64_t kProbeOctets = 100;

LinkRules rules_at(std::int64_t bit_rate) {
  LinkRules rules;
  rules.bit_rate = bit_rate;
  return rules;
}

std::vector<std::uint8_t> read_nodes(const Value& value) {
  std::vector<std::uint8_t> nodes;
  for (const Value& node : value.as_array(0, kMostStations)) nodes.push_back(node.as_integer<std::uint8_t>());
  return nodes;
}

DataDescription read_data(const Value& value, Duration macrocycle) {
  return config::read_object(value, [macrocycle](ObjectReader& object) {
    return DataDescription{object.required("from").as_integer<std::uint8_t>(),
                           object.required("to").as_integer<std::uint8_t>(),
                           object.required("at").as_duration(Duration::zero(), macrocycle)};
  });
}

bool has(const std::vector<std::uint8_t>& nodes, std::uint8_t node) {
  return std::ranges::find(nodes, node) != nodes.end();
}

std::optional<config::Violation> violation_of_stations(const LinkDescription& link) {
  if (link.masters.empty()) return {{"/masters", "no link master: one must schedule the link"}};
  if (link.masters.size() + link.devices.size() > kMostStations) {
    return {{"/devices",
             fmt::format("{} stations: a link has at most {}, because nodes have the addresses {} to {}",
                         link.masters.size() + link.devices.size(), kMostStations, kFirstNode, kLastNode)}};
  }
  std::vector<std::uint8_t> all = link.masters;
  all.insert(all.end(), link.devices.begin(), link.devices.end());
  for (std::size_t n = 0; n < all.size(); ++n) {
    const std::size_t masters = link.masters.size();
    const std::string at =
        n < masters ? fmt::format("/masters/{}", n) : fmt::format("/devices/{}", n - masters);
    if (all[n] < kFirstNode || all[n] > kLastNode)
      return {
          {at, fmt::format("node {}: a node has an address from {} to {}", all[n], kFirstNode, kLastNode)}};
    if (std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), all[n]) > 0)
      return {{at, fmt::format("node {} is there twice; each has its own", all[n])}};
  }
  for (std::size_t n = 0; n < link.not_exposed.size(); ++n) {
    if (!has(all, link.not_exposed[n]))
      return {{fmt::format("/not_exposed/{}", n),
               fmt::format("node {} is not exposed, and no station has it", link.not_exposed[n])}};
  }
  return std::nullopt;
}

}  // namespace

LinkDescription LinkDescription::built_in(LinkProfile profile, std::int64_t bit_rate, unsigned devices) {
  LinkDescription link;
  link.profile = profile;
  link.bit_rate = bit_rate;
  link.masters = {0x10, 0x11};
  for (unsigned n = 0; n < devices; ++n) link.devices.push_back(static_cast<std::uint8_t>(0x12 + n));
  // A schedule counts in 1/32 ms.
  const Duration item = (2 * needed_by_item(link) / kTick + 1) * kTick;
  for (unsigned n = 0; n < devices; ++n) {
    link.data.push_back(
        {link.devices[n], link.devices[(n + 1) % devices], static_cast<std::int64_t>(n) * item});
  }
  link.macrocycle = std::max(link.macrocycle, static_cast<std::int64_t>(devices + 1) * item);
  link.macrocycle = link.macrocycle / kTick * kTick;
  link.name = fmt::format("two link masters and {} devices", devices);
  return link;
}

LinkDescription LinkDescription::read(const Value& root) {
  const LinkDescription link = config::read_object(root, [](ObjectReader& object) {
    LinkDescription read;
    read.name = config::read_name(object.required("name"));
    read.profile = object.required("profile").as_choice<LinkProfile>(
        {{"foundation", LinkProfile::foundation}, {"isa", LinkProfile::isa}});
    if (const auto rate = object.optional("bit_rate")) read.bit_rate = rate->as_bit_rate(31'250, 2'500'000);
    read.masters = read_nodes(object.required("masters"));
    read.devices = read_nodes(object.required("devices"));
    if (const auto cycle = object.optional("macrocycle"))
      read.macrocycle = cycle->as_duration(kernel::kMillisecond, 1000 * kernel::kSecond);
    for (const Value& item : object.required("data").as_array(1)) {
      read.data.push_back(read_data(item, read.macrocycle));
    }
    if (const auto spurs = object.optional("not_exposed")) read.not_exposed = read_nodes(*spurs);
    return read;
  });
  if (const auto violation = violation_of(link)) config::fail(root, *violation);
  return link;
}

LinkDescription LinkDescription::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return read(document.root());
}

Duration needed_by_item(const LinkDescription& link) {
  return octets(rules_at(link.bit_rate), kItemOctets);
}

std::optional<config::Violation> violation_of(const LinkDescription& link) {
  if (auto violation = violation_of_stations(link)) return violation;
  if (link.macrocycle % kTick != Duration{})
    return {{"/macrocycle", "the macrocycle is no multiple of 1/32 ms, in which link time counts"}};
  std::vector<std::uint8_t> all = link.masters;
  all.insert(all.end(), link.devices.begin(), link.devices.end());
  for (std::size_t n = 0; n < link.data.size(); ++n) {
    const DataDescription& item = link.data[n];
    const std::string at = fmt::format("/data/{}", n);
    if (!has(all, item.from) || !has(all, item.to) || item.from == item.to)
      return {
          {at + (has(all, item.from) ? "/to" : "/from"),
           fmt::format("data from {} to {}: both are stations of the link, and two", item.from, item.to)}};
    if (link.profile == LinkProfile::isa && !has(link.devices, item.from))
      return {{at + "/from", fmt::format("data from {}: the token is delegated to devices", item.from)}};
    if (item.at % kTick != Duration{})
      return {{at + "/at", "an instant is no multiple of 1/32 ms, in which link time counts"}};
    const Time next = kernel::kStart + (n + 1 < link.data.size() ? link.data[n + 1].at : link.macrocycle);
    if (kernel::kStart + item.at + needed_by_item(link) > next) {
      return {{at + "/at",
               fmt::format(
                   "data from {} at {}: an item of the schedule takes {}, and then the next one begins or "
                   "the macrocycle is over",
                   item.from, kernel::describe(item.at), kernel::describe(needed_by_item(link)))}};
    }
  }
  return std::nullopt;
}

// ---- the running link ----

LinkNetwork::LinkNetwork(const LinkDescription& description, const LinkRules& rules, std::uint64_t seed)
    : description_(description),
      rules_(rules),
      random_(seed),
      line_(segment_, "line", segment::ContentionRule::noise, random_),
      tester_(rules) {
  FIELDPROOF_CHECK(!violation_of(description_), "a link that runs is one within its limits");
  line_.tap_driven(*this);
  // A buffer has the latest word. A word that waits for a token outlives each one that is lost: it is late,
  // not wrong, however many that are.
  const bool has_buffers = description_.profile == LinkProfile::foundation;
  constexpr unsigned kMostWaiting = 16;
  for (const DataDescription& item : description_.data) {
    signals_.push_back({.name = fmt::format("word of node {} at node {}", item.from, item.to),
                        .admissible_words = has_buffers ? 2 : kMostWaiting});
    words_.add_signal();
  }
  samples_.assign(signals_.size(), kernel::kNever);
}

segment::MediumPort& LinkNetwork::seat(segment::Station& station, std::uint8_t node, const std::string& name,
                                       bool is_under_test, const std::string& why_silent) {
  const std::size_t number = segment_.attach(station, name);
  segment::MediumPort& place = line_.attach(name + "/in", number, 0, {});
  place.sense_activity();
  network::Attendance::Station* const attendance =
      is_under_test ? &attendance_.expect(name, why_silent) : nullptr;
  if (attendance != nullptr) place.tap_driven(*attendance);
  Seat& seat = seats_.emplace_back(Seat{&station, node, number, attendance, name});
  const bool is_called =
      std::ranges::find(description_.data, node, &DataDescription::from) != description_.data.end();
  if (is_under_test && is_called) {
    seat.turnaround.emplace(network::AnswerBegin::first_level, [this, &seat](Time asked, Time answered) {
      words_.end_delay(seat.turnaround_kind, asked, answered);
    });
    place.tap_driven(*seat.turnaround);
  }
  const bool is_exposed = !has(description_.not_exposed, node);
  // Levels are half bits.
  places_.push_back({.name = place.name(),
                     .receiver = &place,
                     .trace_channel = place.trace_channel(),
                     .level_rate = 2 * rules_.bit_rate,
                     .sampling = line::kMidBit,
                     .is_exposed = is_exposed,
                     .why_not = is_exposed ? "" : "its spur is declared to lie in no clamp"});
  return place;
}

void LinkNetwork::set_cycles(std::vector<network::CycleKind> cycles, Duration answer_limit,
                             const std::string& form) {
  cycles_ = std::move(cycles);
  for (Seat& seat : seats_) {
    if (!seat.turnaround) continue;
    seat.turnaround_kind = cycles_.size();
    cycles_.push_back({.name = "turnaround time of " + seat.name,
                       .theory = answer_limit,
                       .form = "from the end of what calls it to the beginning of its answer; " + form,
                       .is_bound = true,
                       .is_delay = true});
  }
}

void LinkNetwork::ask(std::uint8_t node, Time end) {
  const auto seat = std::ranges::find(seats_, node, &Seat::node);
  if (seat != seats_.end() && seat->turnaround) seat->turnaround->ask(end);
}

void LinkNetwork::refresh(std::uint8_t node) {
  const auto seat = std::ranges::find(seats_, node, &Seat::node);
  if (seat != seats_.end()) segment_.refresh(seat->number);
}

void LinkNetwork::take_part(std::uint8_t node) {
  const auto seat = std::ranges::find(seats_, node, &Seat::node);
  if (seat != seats_.end() && seat->attendance != nullptr) seat->attendance->take_part(segment_.now());
}

void LinkNetwork::start() {
  if (!std::exchange(has_tester_, true)) tester_number_ = segment_.attach(*this, "tester");
  if (is_on_) power_down(segment_.now());
  started_ = segment_.now();
  attendance_.begin();
  words_.begin();
  for (Seat& seat : seats_)
    if (seat.turnaround) seat.turnaround->forget();
  samples_.assign(signals_.size(), kernel::kNever);
  is_on_ = true;
  if (driven_until_ <= segment_.now()) return supply(segment_.now());
  supplied_at_ = driven_until_ + octets(rules_, rules_.inter_pdu_delay_octets);
  set_wake();
}

// What is on the line ends before: who comes up again at once would drive into it.
void LinkNetwork::supply(Time now) {
  supplied_at_ = kernel::kNever;
  power_up(now);
  for (std::size_t n = 0; n < words_.size(); ++n) give(n, words_.sample(n, now), now);
  for (const Seat& seat : seats_) segment_.refresh(seat.number);
}

void LinkNetwork::stop() {
  is_on_ = false;
  supplied_at_ = kernel::kNever;
  power_down(segment_.now());
  words_.cancel();
  samples_.assign(signals_.size(), kernel::kNever);
  set_wake();
  for (const Seat& seat : seats_) segment_.refresh(seat.number);
}

network::State LinkNetwork::state() const {
  const Time now = segment_.now();
  if (words_.has_all_arrived() && words_.last_call() && attendance_.is_complete()) {
    const bool is_called = now - *words_.last_call() <= acceptance().silence_cycles * description_.macrocycle;
    return is_called && attendance_.is_lasting(now, bring_up_limit()) ? network::State::exchanging
                                                                      : network::State::stopped;
  }
  return !is_on_ || now - started_ > bring_up_limit() ? network::State::stopped : network::State::coming_up;
}

std::string LinkNetwork::complaint() const {
  const std::string absent = attendance_.complaint();
  return absent.empty() ? attendance_.complaint_about_gone(segment_.now(), bring_up_limit()) : absent;
}

Duration LinkNetwork::bring_up_limit() const {
  const auto stations = static_cast<std::int64_t>(seats_.size());
  // Twice: the schedule takes its part of the line.
  const Duration circulations =
      stations * stations * octets(rules_, kVisitOctets) / 2 + stations * octets(rules_, kProbeOctets);
  return acceptance().least_bring_up + 3 * circulations + 4 * description_.macrocycle;
}

network::RecoveryLimit LinkNetwork::recovery_limit() const {
  const unsigned cycles = acceptance().recovery_cycles;
  return {cycles * words_.size(), cycles * description_.macrocycle, "recovery_cycles, each a macrocycle",
          judge::Standing::own};
}

network::ExchangeWords LinkNetwork::exchange_words() const {
  return {"items of the schedule", "", "items without their word"};
}

std::vector<measure::Condition> LinkNetwork::conditions() const {
  return {{"profile", description_.profile == LinkProfile::foundation ? "Foundation Fieldbus" : "ISA"},
          {"stations", fmt::format("{} link masters, {} devices", description_.masters.size(),
                                   description_.devices.size())},
          {"bit rate", fmt::format("{} bit/s", description_.bit_rate)},
          {"macrocycle", kernel::describe(description_.macrocycle)},
          {"a word is sampled before it is called for by", kernel::describe(lead())}};
}

void LinkNetwork::set_source(std::size_t signal, std::uint16_t word) {
  words_.set_word(signal, word);
  give(signal, word, segment_.now());
  refresh(description_.data[signal].from);
}

void LinkNetwork::set_source_function(std::size_t signal, std::function<std::uint16_t(Time)> word) {
  words_.set_function(signal, std::move(word));
}

std::uint16_t LinkNetwork::image(std::size_t) const {
  FIELDPROOF_CHECK(false, "no signal of a link has an image");
  return 0;
}

std::vector<network::CopiedPath> LinkNetwork::paths() const {
  std::vector<network::CopiedPath> paths;
  for (std::size_t n = 0; n < description_.data.size(); ++n) {
    const DataDescription& item = description_.data[n];
    paths.push_back({.name = fmt::format("node {} to node {}", item.from, item.to),
                     .from = item.from,
                     .to = item.to,
                     .source = n,
                     .sink = n,
                     .is_image_of_its_own = true,
                     .theory = network::PathTheory{description_.macrocycle, least_delay(n)}});
  }
  return paths;
}

void LinkNetwork::end() {
  for (const Seat& seat : seats_) seat.station->end();
}

Duration LinkNetwork::lead() const {
  return octets(rules_, kLeadOctets);
}

// ---- the lower tester and the applications ----

void LinkNetwork::on_wave(const line::Waveform& wave) {
  driven_until_ = std::max(driven_until_, wave.end());
  for (const Arrived& arrived : tester_.receive(wave)) {
    for (Seat& seat : seats_)
      if (seat.turnaround) seat.turnaround->expire(wave.start);
    on_driven(arrived.octets, arrived.begin, arrived.end);
  }
}

void LinkNetwork::on_called(std::size_t signal, Time begin, Time end) {
  if (words_.is_called(signal)) words_.close(signal, segment_.now());
  words_.call(signal, begin, end + answer_time());
  if (signal == 0) begin_cycle(0, begin);
  if (words_.has_function(signal)) samples_[signal] = begin + description_.macrocycle - lead();
  set_wake();
}

void LinkNetwork::set_wake() {
  wakes_at_ = std::min(supplied_at_, words_.next_close());
  for (const Time sampled_at : samples_) wakes_at_ = std::min(wakes_at_, sampled_at);
  if (has_tester_) segment_.refresh(tester_number_);
}

void LinkNetwork::on_time(Time now) {
  if (supplied_at_ <= now) supply(now);
  words_.close_due(now, [](std::size_t) {});
  for (std::size_t n = 0; n < samples_.size(); ++n) {
    if (samples_[n] > now) continue;
    samples_[n] = kernel::kNever;
    give(n, words_.sample(n, now), now);
    refresh(description_.data[n].from);
  }
  set_wake();
}

}  // namespace fieldproof::fieldbus_dll
