#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/case_bench.hpp"
#include "conformance/interbus/declarations.hpp"
#include "conformance/interbus/slave_in_parts.hpp"
#include "conformance/interbus/slave_line.hpp"
#include "conformance/interbus/slave_model.hpp"
#include "harness/fault/channel_chain.hpp"
#include "harness/fault/scripted_channel.hpp"
#include "protocols/interbus/ring.hpp"

// The bench of one case for a slave: a ring with the implementation under test (IUT) at its position, the
// lower tester at the master's place, and the upper tester at the IUT's terminals.
//
// The lower tester drives what the case says and has views on every line of the IUT: `in` is what arrived at
// its receiver, `out` what it drove towards the master, `remote` and `branch` what it drove on its outgoing
// interfaces. Verdicts rest on what lies between `in` and `out`, so a case reads the same at any position:
// the stations in front of the IUT are references, which `bring_up` lets through. Faults are put on the
// IUT's own receiver: by `channel()` on what comes through the ring, or by driving its incoming line
// directly (`drive_at_receiver`) while the ring is idle.
//
// Limits: stations on branches in front of the IUT that do not lie on the way to it stay switched off.
namespace fieldproof::conformance {

// What a case needs around the IUT.
struct SlaveNeeds {
  std::optional<std::uint16_t> id_code{};            // absent: as declared, or 0203h, two words
  bool remote_neighbour = false;                     // a station of one word behind OUT1
  bool branch_neighbour = false;                     // a station of one word behind OUT2
  void (*change_rules)(interbus::Rules&) = nullptr;  // settings of the case; null: the usual ones
};

class SlaveBench;

// Who plays, where, and how it is given what comes back.
struct SlaveSetting : PlannedSetting<interbus::SlaveDevice, interbus::SlaveConfiguration> {
  int position = 1;
  int stations = 1;  // of the bench's own network, at least `position`
  ReturnParts returns = ReturnParts::whole;
  std::optional<interbus::NetworkDescription> network{};  // instead of the bench's own
};

// The network of a case. Throws kernel::Error for a position that the network does not have.
interbus::NetworkDescription slave_network(const SlaveNeeds& needs, const SlaveSetting& setting);
class SlaveBench final : public CaseBench, private segment::Station {
 public:
  SlaveBench(const SlaveNeeds& needs, const SlaveSetting& setting);

  const interbus::Rules& rules() const { return network_.rules; }
  const judge::Pics& pics() const { return pics_; }
  std::uint16_t id_code() const { return ring_.configuration(position_).id_code; }
  unsigned words() const { return ring_.configuration(position_).words; }
  kernel::Duration bits(std::int64_t count) const { return kernel::levels_duration(count, rules().bit_rate); }
  interbus::Ring& ring() { return ring_; }
  int position() const { return position_; }
  // Register length of the station after OUT1 or OUT2; 0 without one.
  unsigned neighbour_words(bool on_branch) const { return neighbour_words_[on_branch ? 1 : 0]; }
  SlaveModel& model() { return model_; }

  // For a case about nothing but finding telegrams in levels and making levels of them. Throws
  // iut::CannotBeDone for an implementation that leaves both to the bench.
  bool has_line_interface();
  void require_line_interface();

  // ---- upper tester ----
  interbus::TerminalBlock& terminals() { return ring_.terminals(position_); }
  // What stands at the outputs now; a value that the slave gave for a later instant does not stand there yet.
  const std::vector<std::uint16_t>& outputs();
  const std::vector<interbus::TerminalBlock::Change>& changes() { return terminals().changes(); }
  void set_inputs(std::span<const std::uint16_t> words);
  void set_bridge(bool on_branch, bool present);
  // Without supply nothing stands at the outputs.
  void set_power(bool is_on);
  std::vector<std::uint16_t> random_words();

  // ---- cycles through the ring ----
  // Opens the way to the IUT, whose interfaces stay closed, and identifies it: ID cycles, a status telegram.
  // Judges nothing.
  void bring_up();
  void ask() { bring_up(); }
  void id_cycle(std::uint16_t control) { return id_cycle(control, {}); }
  // `after`: for stations after the IUT, the last one first.
  void id_cycle(std::uint16_t control, std::span<const std::uint16_t> behind);
  void data_cycle(std::span<const std::uint16_t> words) { return data_cycle(words, {}); }
  void data_cycle(std::span<const std::uint16_t> words, std::span<const std::uint16_t> behind);
  void status_telegrams(std::size_t count);
  void silence(kernel::Duration duration);
  std::uint16_t interfaces_off() const { return rules().control_remote_off | rules().control_local_off; }

  // ---- trains: several cycles as one waveform ----
  TrainWriter& train() { return train_; }
  void begin() { train_.clear(); }
  const CyclePlace& append_data_cycle(std::span<const std::uint16_t> words,
                                      std::span<const std::uint16_t> behind = {});
  const CyclePlace& append_id_cycle(std::uint16_t control, std::span<const std::uint16_t> behind = {});
  // The loopback word of the cycles that follow, instead of the one of the rules.
  void set_loopback_word(std::uint16_t word) { loopback_word_ = word; }
  // Octets of a data cycle as they are sent, loopback word included, and their check.
  std::span<const std::uint8_t> data_octets(std::span<const std::uint16_t> words,
                                            std::span<const std::uint16_t> behind = {});
  // The same for an ID cycle.
  std::span<const std::uint8_t> id_octets(std::uint16_t control, std::span<const std::uint16_t> behind = {});
  // Sends the train now, and runs until everything has come back. Clears the views before.
  void send();
  // The same on the line that comes back from the station after OUT1 or OUT2; and this waveform, now.
  void send_back(bool on_branch);
  void send_back(bool on_branch, line::Waveform& wave);

  // ---- faults at the IUT's receiver ----
  fault::ScriptedChannel& channel() { return channel_; }
  // A stress in place of these, from now on.
  void begin_stress(const fault::Stress& stress);
  // The code word whose last bits are loopback word, register and check: its bit n, as a level of the train.
  // The stations in front of the IUT put their registers before it.
  std::size_t code_word_bits() const { return 8 * (2 + 2 * words() + 2); }
  std::size_t code_word_level(const CyclePlace& cycle, std::size_t bit) const;
  // Drives the IUT's incoming line itself and runs until it has answered. Clears the views before; the start
  // is set to now. After other stations it may send status telegrams through the ring first.
  void drive_at_receiver(line::Waveform& wave);
  // The same with these levels in several transmissions without a gap between them, which begin at these.
  void drive_at_receiver(const line::Levels& levels, std::span<const std::size_t> cuts);
  // The same, but the supply goes when the waveform ends.
  void drive_until_lost(line::Waveform& wave);
  // Drives the line that comes back from the station after OUT1 or OUT2, now, beside whatever else is driven.
  void drive_return(bool on_branch, line::Waveform& wave);
  // A whole data cycle as the station in front of the IUT would send it, alone in the ring.
  line::Levels direct_data_cycle(std::span<const std::uint16_t> words, unsigned gap_bits);
  line::Levels direct_id_cycle(std::uint16_t control);

  // ---- a twin ----
  // The same ring with a reference slave at the IUT's position. It takes silence for a reset as early (-1) or
  // as late (1) as the tolerance lets it, and ends the time of control_reset an eighth of it earlier or
  // later. Where the ways change while something comes back, the early one passes on what comes after that
  // the new way, the late one all of a transmission as it began.
  std::unique_ptr<SlaveBench> twin(int side) const;

  // The case is over. What the IUT does then is still its verdict.
  void finish() { ring_.end(); }

  // ---- views ----
  LineView& in() { return in_; }
  LineView& out() { return out_; }
  LineView& remote() { return remote_; }
  LineView& branch() { return branch_; }
  void clear_views();
  // Cycle n of the train on a line; nothing when its telegrams did not pass there.
  std::optional<CycleOnLine> cycle_on(LineView& view, std::size_t n);
  std::vector<std::uint8_t> data_load() const;
  std::vector<std::uint8_t> id_load(std::uint16_t messages = 0) const;
  // The last cycles in layers: levels, telegrams, fields.
  std::vector<std::string> decode_lines();

 private:
  SlaveBench(interbus::NetworkDescription network, const SlaveSetting& setting);

  struct OnTheWay {
    int position;
    bool next_on_branch;
  };

  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  void find_way();
  void install(const fault::Plan& plan);
  void open_way(std::size_t stations);
  void keep_way_alive();
  void append_cycle(bool is_id_cycle);
  void put_word(std::uint16_t word);
  void add_lines(std::vector<std::string>& lines, std::string_view name, LineView& view) const;

  interbus::NetworkDescription network_;
  int position_;
  std::size_t seat_;
  interbus::Ring ring_;
  judge::Pics pics_;
  std::array<unsigned, 2> neighbour_words_{};
  std::array<int, 2> neighbours_{};  // positions of the stations after OUT1 and OUT2; 0 without one
  std::vector<OnTheWay> way_;        // stations in front of the IUT, from the master on
  TrainWriter train_;
  SlaveModel model_;
  fault::ScriptedChannel channel_;
  fault::ChannelChain channels_;  // at the IUT's receiver: of the case, then of the plan
  LineView in_;
  LineView out_;
  LineView remote_;
  LineView branch_;
  kernel::Duration settling_{};
  kernel::Duration kept_alive_{};  // how long the way to the IUT is left without telegrams
  std::uint16_t loopback_word_;
  std::vector<std::uint16_t> inputs_;
  std::vector<std::uint16_t> outputs_;  // see outputs()
  std::vector<std::uint8_t> octets_;
  kernel::Time sent_at_{};
  kernel::Time last_sent_{};  // through the ring
};

}  // namespace fieldproof::conformance
