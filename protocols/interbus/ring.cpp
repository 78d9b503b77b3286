#include "protocols/interbus/ring.hpp"

#include <algorithm>
#include <cmath>

#include "harness/kernel/check.hpp"
#include "protocols/interbus/observation.hpp"
#include "protocols/interbus/slave.hpp"

namespace fieldproof::interbus {
namespace {

std::string receiver_name(int before, bool on_branch) {
  if (before < 0) return "master/in";
  return "slave@" + std::to_string(before + 1) + (on_branch ? "/branch_return" : "/return");
}

}  // namespace

Ring::Ring(segment::Segment& segment, const NetworkDescription& network, std::size_t master_seat,
           const MakeSlave& make_slave)
    : segment_(segment), master_seat_(master_seat) {
  const std::vector<RingPlace> places = ring_order(network);
  FIELDPROOF_CHECK(!places.empty(), "a ring has at least one station");
  for (const RingPlace& place : places) add_station(network, place, make_slave);
  for (std::size_t n = 0; n < places.size(); ++n) lay_cable(network, places[n], n);
  find_last_behind(places);
  for (Place& place : slaves_) {
    place.device->wire(place.ports, place.terminals);
    segment_.refresh(place.seat);  // with the supply it may want something
  }
}

void Ring::add_station(const NetworkDescription& network, const RingPlace& place,
                       const MakeSlave& make_slave) {
  SlaveConfiguration configuration{.rules = network.rules,
                                   .name = place.station->name,
                                   .id_code = place.station->id_code,
                                   .words = place.words,
                                   .is_local = place.station->is_local,
                                   .has_branch = place.station->has_branch || !place.station->branch.empty()};
  const int position = static_cast<int>(slaves_.size()) + 1;
  std::unique_ptr<SlaveDevice> device = make_slave ? make_slave(position, configuration) : nullptr;
  if (device == nullptr) device = std::make_unique<Slave>(configuration);
  const std::string station = "slave@" + std::to_string(position);
  const std::size_t seat = segment_.attach(*device, station);
  slaves_.push_back(
      {std::move(device), configuration, TerminalBlock(place.words), SlavePorts{}, seat, word_count_});
  slaves_.back().terminals.on_change(
      [&trace = segment_.trace(),
       place = segment_.trace().add_channel(station)](const TerminalBlock::Change& change) {
        trace.observe(place, change.when, kOutputChanged, std::uint64_t{change.word} << 16 | change.after);
      });
  word_count_ += place.words;
}

void Ring::lay_cable(const NetworkDescription& network, const RingPlace& place, std::size_t n) {
  const auto delay = kernel::Duration{static_cast<std::int64_t>(
      std::llround(place.station->cable_m * static_cast<double>(network.rules.cable_delay_ps_per_m)))};
  Place& station = slaves_[n];
  Cable cable;
  cable.forward =
      &segment_.connect("slave@" + std::to_string(n + 1) + "/in", station.seat, kFromUpstream, delay);
  const std::size_t above =
      place.before < 0 ? master_seat_ : slaves_[static_cast<std::size_t>(place.before)].seat;
  const segment::PortIndex port = place.before < 0 ? 0 : (place.on_branch ? kFromBranch : kFromRemote);
  cable.back = &segment_.connect(receiver_name(place.before, place.on_branch), above, port, delay);
  station.ports.upstream = cable.back;
  if (place.before >= 0) {
    SlavePorts& ports = slaves_[static_cast<std::size_t>(place.before)].ports;
    (place.on_branch ? ports.branch : ports.remote) = cable.forward;
  }
  links_.push_back(cable);
}

// What hangs after a station follows it in the ring without a break.
void Ring::find_last_behind(const std::vector<RingPlace>& places) {
  last_behind_.resize(places.size());
  for (std::size_t n = places.size(); n-- > 0;) {
    last_behind_[n] = std::max(last_behind_[n], n);
    if (places[n].before >= 0) {
      std::size_t& last = last_behind_[static_cast<std::size_t>(places[n].before)];
      last = std::max(last, last_behind_[n]);
    }
  }
}

segment::Link* Ring::find_link(std::string_view receiver) {
  for (const Receiver& candidate : receivers()) {
    if (candidate.link->name() == receiver) return candidate.link;
  }
  return nullptr;
}

// A return link carries what has passed its station and everything after it; after a station with a branch
// that is not a run of neighbours, so the ring is followed from each station to the last one after it.
std::vector<Ring::Receiver> Ring::receivers() {
  std::vector<Receiver> all;
  for (std::size_t n = 0; n < slaves_.size(); ++n) {
    all.push_back({links_[n].forward, in_front_of(n)});
    all.push_back({links_[n].back, in_front_of(last_behind_[n] + 1)});
  }
  return all;
}

std::vector<segment::Link*> Ring::links() {
  std::vector<segment::Link*> all;
  for (const Receiver& receiver : receivers()) all.push_back(receiver.link);
  return all;
}

fault::KnownNames Ring::known_names() {
  fault::KnownNames known;
  for (const segment::Link* link : links()) known.receivers.push_back(link->name());
  known.frame_kinds = CycleFields::frame_kinds();
  known.fields = CycleFields::fields();
  for (const std::string_view name : kObservations) known.observations.emplace_back(name);
  return known;
}

std::vector<segment::Link*> Ring::remote_links() {
  std::vector<segment::Link*> links;
  for (int position = 1; position <= static_cast<int>(size()); ++position) {
    if (configuration(position).is_local) continue;
    links.push_back(&link_to(position));
    links.push_back(&link_from(position));
  }
  return links;
}

void Ring::install(fault::InstalledPlan& plan) {
  fault::expect_known_names(plan.plan(), known_names());
  const Rules& rules = slaves_.front().configuration.rules;
  for (const Receiver& receiver : receivers()) {
    receiver.link->set_channel(
        plan.channel_for({receiver.link->name(), receiver.link->trace_channel(), rules.bit_rate},
                         std::make_unique<CycleFields>(rules, receiver.in_front)));
  }
}

CycleFields::InFront Ring::in_front_of(std::size_t station) const {
  const unsigned words = station < slaves_.size() ? slaves_[station].first_word : word_count_;
  return {2 * words, 2 * static_cast<unsigned>(station)};
}

void Ring::end() {
  for (Place& place : slaves_) place.device->end();
}

void Ring::set_cable(int position, bool connected) {
  link_to(position).set_connected(connected);
  link_from(position).set_connected(connected);
}

MasterConfiguration master_configuration(const NetworkDescription& network) {
  MasterConfiguration configuration;
  configuration.rules = network.rules;
  if (network.cycle_time) configuration.cycle_time = *network.cycle_time;
  const std::vector<RingPlace> places = ring_order(network);
  std::vector<unsigned> first_words;
  unsigned words = 0;
  for (const RingPlace& place : places) {
    configuration.expected.push_back({place.station->id_code, place.words, place.before, place.on_branch});
    first_words.push_back(words);
    words += place.words;
  }
  const auto first_word_of = [&](const std::string& name) {
    for (std::size_t n = 0; n < places.size(); ++n) {
      if (places[n].station->name == name) return first_words[n];
    }
    FIELDPROOF_CHECK(false, "a copy rule names a station of the network");
    return 0U;
  };
  for (const CopyRule& rule : network.copy) {
    configuration.copy.push_back(
        {first_word_of(rule.from) + rule.input_word, first_word_of(rule.to) + rule.output_word});
  }
  return configuration;
}

}  // namespace fieldproof::interbus
