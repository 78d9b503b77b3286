#include "conformance/interbus/slave_bench.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/interbus/slave_codings.hpp"
#include "harness/field/pics.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/cycle_fields.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/interbus/slave_settings.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::uint16_t kTwoWordsBothWays = 0x0203;
constexpr std::uint16_t kOneWordBothWays = 0x0103;
constexpr std::size_t kMostLines = 24;

interbus::StationDescription station(std::string name, std::uint16_t id_code) {
  interbus::StationDescription description;
  description.name = std::move(name);
  description.id_code = id_code;
  return description;
}

}  // namespace

interbus::NetworkDescription slave_network(const SlaveNeeds& needs, const SlaveSetting& setting) {
  interbus::NetworkDescription network;
  if (setting.network) network = *setting.network;
  const int available = setting.network ? static_cast<int>(ring_order(network).size())
                                        : static_cast<int>(network.rules.max_stations);
  if (setting.position < 1 || setting.position > available) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("there is no slave at position {}: {} {}", setting.position,
                    setting.network ? "the network has" : "a network has at most (max_stations)", available));
  }
  judge::Pics pics = setting.pics.value_or(judge::Pics{});
  field::declare_settings(interbus::kSlaveTable, setting.settings, pics);
  if (setting.network) {
    expect_as_declared(ring_order(network)[static_cast<std::size_t>(setting.position - 1)], pics);
    return network;
  }
  network.name = "slave bench";
  if (needs.change_rules != nullptr) needs.change_rules(network.rules);
  interbus::SlaveConfiguration iut;
  iut.rules = network.rules;
  field::take_settings(interbus::kSlaveTable, with_changed_places(setting.settings, iut), iut);
  network.rules = iut.rules;
  const int stations = std::max(setting.stations, setting.position);
  for (int position = 1; position <= stations; ++position) {
    const bool is_iut = position == setting.position;
    network.stations.push_back(station(fmt::format("station {}", position),
                                       is_iut || position % 2 == 0 ? kTwoWordsBothWays : kOneWordBothWays));
    if (!is_iut) continue;
    declare_station(network.stations.back(), pics, network.rules);
    if (needs.id_code) network.stations.back().id_code = *needs.id_code;
    if (needs.branch_neighbour) {
      network.stations.back().branch.push_back(station("local neighbour", kOneWordBothWays));
      network.stations.back().branch.back().is_local = true;
    }
    if (needs.remote_neighbour) network.stations.push_back(station("neighbour", kOneWordBothWays));
  }
  return network;
}

SlaveBench::SlaveBench(const SlaveNeeds& needs, const SlaveSetting& setting)
    : SlaveBench(slave_network(needs, setting), setting) {}

SlaveBench::SlaveBench(interbus::NetworkDescription network, const SlaveSetting& setting)
    : CaseBench(setting.seed, setting.volume, setting.stresses,
                LineWatch(interbus::shortest_telegram(network.rules))),
      network_(std::move(network)),
      position_(setting.position),
      seat_(segment().attach(*this, "tester")),
      ring_(segment(), network_, seat_,
            [&](int position,
                const interbus::SlaveConfiguration& configuration) -> std::unique_ptr<interbus::SlaveDevice> {
              if (position != setting.position) return nullptr;
              auto slave = setting.make_device ? setting.make_device(configuration)
                                               : std::make_unique<interbus::Slave>(configuration);
              return std::make_unique<SlaveInParts>(std::move(slave), configuration.rules, setting.returns);
            }),
      pics_(
          setting.pics.value_or(judge::Pics{}).completed_by(declared_slave(ring_.configuration(position_)))),
      train_(network_.rules),
      model_(network_.rules),
      channel_(&train_.code()),
      in_(segment(), train_.code(), network_.rules.bit_rate),
      out_(segment(), train_.code(), network_.rules.bit_rate),
      remote_(segment(), train_.code(), network_.rules.bit_rate),
      branch_(segment(), train_.code(), network_.rules.bit_rate),
      kept_alive_(network_.rules.silence_limit / 4),
      loopback_word_(network_.rules.loopback_word),
      inputs_(words()) {
  start_recording(setting, network_.rules);
  find_way();
  install(setting.plan);
}

bool SlaveBench::has_line_interface() {
  return ring_.slave(position_).has_line_interface();
}

void SlaveBench::require_line_interface() {
  if (has_line_interface()) return;
  throw iut::CannotBeDone(
      "the slave receives and sends telegrams; the levels of its lines are the bench's own");
}

// The chain of stations from the master to the IUT, each with the interface that leads on.
void SlaveBench::find_way() {
  const std::vector<interbus::RingPlace> places = ring_order(network_);
  int at = position_ - 1;
  while (at >= 0) {
    const interbus::RingPlace& place = places[static_cast<std::size_t>(at)];
    if (place.before >= 0) way_.push_back({place.before + 1, place.on_branch});
    at = place.before;
  }
  std::reverse(way_.begin(), way_.end());
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (places[n].before != position_ - 1) continue;
    const int position = static_cast<int>(n) + 1;
    ring_.link_to(position).tap_driven(places[n].on_branch ? branch_ : remote_);
    watch(ring_.link_to(position));
    neighbour_words_.at(places[n].on_branch ? 1 : 0) = places[n].words;
    neighbours_.at(places[n].on_branch ? 1 : 0) = position;
  }
}

void SlaveBench::install(const fault::Plan& plan) {
  channels_.add(channel_);
  if (fault::InstalledPlan* const made = make_plan(plan)) {
    ring_.install(*made);
    if (fault::Channel* planned = ring_.link_to(position_).channel()) channels_.add(*planned);
  }
  ring_.link_to(position_).set_channel(plan.empty() ? static_cast<fault::Channel*>(&channel_) : &channels_);
  ring_.link_to(position_).tap_arrived(in_);
  ring_.link_from(position_).tap_driven(out_);
  watch(ring_.link_from(position_));
  kernel::Duration cables{};
  for (segment::Link* link : ring_.links()) cables += link->delay();
  // What went out comes back after the delays of all stations and cables; a cut telegram ends one later.
  const std::int64_t station = std::max<std::int64_t>(
      4, (std::int64_t{rules().forward_delay_half_bits} + rules().return_delay_half_bits) / 2 + 1);
  settling_ =
      cables + bits(station * static_cast<std::int64_t>(ring_.size()) + 4 * line::kDataTelegramLevels);
}

void SlaveBench::begin_stress(const fault::Stress& stress) {
  segment::Link& link = ring_.link_to(position_);
  begin_stress_at(stress, link, rules().bit_rate, now());
}

void SlaveBench::set_inputs(std::span<const std::uint16_t> words) {
  for (unsigned word = 0; word < words.size(); ++word) {
    inputs_.at(word) = words[word];
    terminals().set_input(word, words[word]);
  }
}

const std::vector<std::uint16_t>& SlaveBench::outputs() {
  outputs_.resize(words());
  for (unsigned word = 0; word < words(); ++word) outputs_[word] = terminals().output_at(word, now());
  return outputs_;
}

void SlaveBench::set_bridge(bool on_branch, bool present) {
  ring_.slave(position_).set_next_present(on_branch, present);
  segment().refresh(ring_.seat(position_));
}

void SlaveBench::set_power(bool is_on) {
  ring_.slave(position_).set_power(is_on, now());
  segment().refresh(ring_.seat(position_));
  if (is_on) return;
  for (unsigned word = 0; word < words(); ++word) terminals().write(word, 0, now());
}

std::vector<std::uint16_t> SlaveBench::random_words() {
  std::vector<std::uint16_t> drawn(words());
  for (std::uint16_t& word : drawn) word = static_cast<std::uint16_t>(random().next());
  return drawn;
}

// ---- cycles ----

void SlaveBench::put_word(std::uint16_t word) {
  octets_.push_back(static_cast<std::uint8_t>(word >> 8));
  octets_.push_back(static_cast<std::uint8_t>(word & 0xFF));
}

std::span<const std::uint8_t> SlaveBench::data_octets(std::span<const std::uint16_t> words,
                                                      std::span<const std::uint16_t> behind) {
  octets_.clear();
  put_word(loopback_word_);
  for (const std::uint16_t word : behind) put_word(word);
  for (const std::uint16_t word : words) put_word(word);
  for (auto place = way_.rbegin(); place != way_.rend(); ++place) {
    const unsigned count = ring_.configuration(place->position).words;
    for (unsigned word = 0; word < count; ++word) put_word(static_cast<std::uint16_t>(0x1100 + word));
  }
  return octets_;
}

void SlaveBench::append_cycle(bool is_id_cycle) {
  train_.cycle(is_id_cycle, octets_, model_.check().of(octets_), rules().status_clean);
}

const CyclePlace& SlaveBench::append_data_cycle(std::span<const std::uint16_t> words,
                                                std::span<const std::uint16_t> behind) {
  data_octets(words, behind);
  append_cycle(false);
  return train_.cycles().back();
}

std::span<const std::uint8_t> SlaveBench::id_octets(std::uint16_t control,
                                                    std::span<const std::uint16_t> behind) {
  octets_.clear();
  put_word(loopback_word_);
  for (const std::uint16_t word : behind) put_word(word);
  put_word(control);
  for (auto place = way_.rbegin(); place != way_.rend(); ++place)
    put_word(place->next_on_branch ? rules().control_remote_off : rules().control_local_off);
  return octets_;
}

const CyclePlace& SlaveBench::append_id_cycle(std::uint16_t control, std::span<const std::uint16_t> behind) {
  id_octets(control, behind);
  append_cycle(true);
  return train_.cycles().back();
}

// An ID cycle that reaches the first `stations` of the way and lets them through to the next one.
void SlaveBench::open_way(std::size_t stations) {
  begin();
  octets_.clear();
  put_word(loopback_word_);
  for (std::size_t n = stations; n > 0; --n)
    put_word(way_[n - 1].next_on_branch ? rules().control_remote_off : rules().control_local_off);
  append_cycle(true);
  send();
}

void SlaveBench::bring_up() {
  status_telegrams(4);
  for (std::size_t n = 1; n <= way_.size(); ++n) open_way(n);
  id_cycle(interfaces_off());
  clear_views();
  terminals().forget_changes();
}

void SlaveBench::id_cycle(std::uint16_t control, std::span<const std::uint16_t> behind) {
  begin();
  append_id_cycle(control, behind);
  send();
}

void SlaveBench::data_cycle(std::span<const std::uint16_t> words, std::span<const std::uint16_t> behind) {
  begin();
  append_data_cycle(words, behind);
  send();
}

void SlaveBench::status_telegrams(std::size_t count) {
  begin();
  train_.status(count);
  send();
}

void SlaveBench::silence(kernel::Duration duration) {
  segment().run_for(duration);
}

void SlaveBench::send() {
  clear_views();
  sent_at_ = last_sent_ = now();
  line::Waveform wave{now(), rules().bit_rate, {}};
  std::swap(wave.levels, train_.levels());
  const kernel::Time end = wave.end();
  ring_.out().drive(wave);
  std::swap(wave.levels, train_.levels());
  segment().run_until(end + settling_);
}

void SlaveBench::send_back(bool on_branch) {
  line::Waveform wave{now(), rules().bit_rate, {}};
  std::swap(wave.levels, train_.levels());
  send_back(on_branch, wave);
  std::swap(wave.levels, train_.levels());
}

void SlaveBench::send_back(bool on_branch, line::Waveform& wave) {
  clear_views();
  sent_at_ = wave.start = now();
  const kernel::Time end = wave.end();
  drive_return(on_branch, wave);
  segment().run_until(end + settling_);
}

std::unique_ptr<SlaveBench> SlaveBench::twin(int side) const {
  interbus::NetworkDescription network = network_;
  const kernel::Duration tolerance = network.rules.silence_tolerance;
  network.rules.silence_limit += side * tolerance;
  network.rules.silence_tolerance += side * (tolerance / 8 - tolerance);
  SlaveSetting setting;
  setting.position = position_;
  setting.returns = side < 0 ? ReturnParts::telegrams : ReturnParts::whole;
  setting.pics = pics_;  // it decides what is sent, too
  std::unique_ptr<SlaveBench> made(new SlaveBench(std::move(network), setting));
  made->kept_alive_ = kept_alive_;
  return made;
}

void SlaveBench::clear_views() {
  for (LineView* view : {&in_, &out_, &remote_, &branch_}) view->clear();
}

// ---- faults ----

std::size_t SlaveBench::code_word_level(const CyclePlace& cycle, std::size_t bit) const {
  const std::size_t first = cycle.octets + 2 - code_word_bits() / 8;
  return cycle.level_of(first + bit / 8, train_.data_level(static_cast<unsigned>(bit % 8)));
}

// The stations in front hear nothing of what is driven directly.
void SlaveBench::keep_way_alive() {
  if (way_.empty() || now() - last_sent_ < kept_alive_) return;
  status_telegrams(2);
}

void SlaveBench::drive_at_receiver(line::Waveform& wave) {
  keep_way_alive();
  clear_views();
  sent_at_ = wave.start = now();
  const kernel::Time end = wave.end();
  ring_.link_to(position_).drive(wave);
  segment().run_until(end + settling_);
}

void SlaveBench::drive_at_receiver(const line::Levels& levels, std::span<const std::size_t> cuts) {
  keep_way_alive();
  clear_views();
  sent_at_ = now();
  const line::Waveform whole{now(), rules().bit_rate, levels};
  for (std::size_t n = 0; n <= cuts.size(); ++n) {
    const std::size_t begin = n == 0 ? 0 : cuts[n - 1];
    const std::size_t end = n == cuts.size() ? levels.size() : cuts[n];
    line::Waveform part{whole.time_of(begin), whole.rate, levels.slice(begin, end - begin)};
    ring_.link_to(position_).drive(part);
  }
  segment().run_until(whole.end() + settling_);
}

void SlaveBench::drive_until_lost(line::Waveform& wave) {
  keep_way_alive();
  clear_views();
  sent_at_ = wave.start = now();
  const kernel::Time end = wave.end() + ring_.link_to(position_).delay();
  ring_.link_to(position_).drive(wave);
  segment().run_until(end);
  set_power(false);
}

void SlaveBench::drive_return(bool on_branch, line::Waveform& wave) {
  const int neighbour = neighbours_.at(on_branch ? 1 : 0);
  FIELDPROOF_CHECK(neighbour > 0, "a case drives only what its needs have put there");
  wave.start = now();
  ring_.link_from(neighbour).drive(wave);
}

line::Levels SlaveBench::direct_data_cycle(std::span<const std::uint16_t> words, unsigned gap_bits) {
  TrainWriter writer(rules());
  writer.set_gap(gap_bits);
  octets_.clear();
  put_word(loopback_word_);
  for (const std::uint16_t word : words) put_word(word);
  writer.cycle(false, octets_, model_.check().of(octets_), rules().status_clean);
  return writer.levels();
}

line::Levels SlaveBench::direct_id_cycle(std::uint16_t control) {
  TrainWriter writer(rules());
  octets_.clear();
  put_word(loopback_word_);
  put_word(control);
  writer.cycle(true, octets_, model_.check().of(octets_), rules().status_clean);
  return writer.levels();
}

// ---- views ----

std::optional<CycleOnLine> SlaveBench::cycle_on(LineView& view, std::size_t n) {
  const CyclePlace& place = train_.cycles()[n];
  const std::span<const SeenTelegram> telegrams = view.data_telegrams();
  if (telegrams.size() < place.first + place.telegrams()) return std::nullopt;
  return CycleOnLine{telegrams.subspan(place.first, place.telegrams()), place.octets, place.is_id_cycle};
}

std::vector<std::uint8_t> SlaveBench::data_load() const {
  std::vector<std::uint8_t> load;
  for (const std::uint16_t word : inputs_) {
    load.push_back(static_cast<std::uint8_t>(word >> 8));
    load.push_back(static_cast<std::uint8_t>(word & 0xFF));
  }
  return load;
}

std::vector<std::uint8_t> SlaveBench::id_load(std::uint16_t messages) const {
  const auto id = static_cast<unsigned>(id_code() | messages);
  return {static_cast<std::uint8_t>(id >> 8), static_cast<std::uint8_t>(id & 0xFF)};
}

void SlaveBench::add_lines(std::vector<std::string>& lines, std::string_view name, LineView& view) const {
  for (const line::Waveform& wave : view.waves()) {
    if (lines.size() >= kMostLines) return;
    lines.push_back(fmt::format(
        "{} levels at {}, {} per bit: {}", name, kernel::describe(wave.start),
        fmt::format("{:.4g}", static_cast<double>(wave.rate) / static_cast<double>(rules().bit_rate)),
        wave.levels.slice(0, std::min<std::size_t>(wave.levels.size(), 160)).text()));
  }
  const std::span<const SeenTelegram> telegrams = view.telegrams();
  const std::size_t shown = std::min(telegrams.size(), kMostLines);
  for (std::size_t n = 0; n < shown; ++n)
    lines.push_back(fmt::format("{} {}", name, describe(view, telegrams[n], sent_at_)));
  if (shown < telegrams.size())
    lines.push_back(fmt::format("{} and {} telegrams more", name, telegrams.size() - shown));
  FoundCycle cycle;
  find_last_cycle(view.data_telegrams(), cycle);
  if (!cycle.is_found) return;
  std::string octets;
  for (const std::uint8_t octet : cycle.octets) octets += fmt::format(" {:02X}", octet);
  lines.push_back(fmt::format("{} fields of its last cycle: {} transfer{}, check {:04X}, status word {:04X}",
                              name, cycle.is_id_cycle ? "ID" : "data", octets, cycle.check, cycle.status));
}

std::vector<std::string> SlaveBench::decode_lines() {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("last stimulus at {}", kernel::describe(sent_at_)));
  add_lines(lines, "in", in_);
  std::vector<std::string> driven;
  add_lines(driven, "out", out_);
  add_lines(driven, "OUT1", remote_);
  add_lines(driven, "OUT2", branch_);
  lines.insert(lines.end(), driven.begin(), driven.end());
  return lines;
}

}  // namespace fieldproof::conformance
