#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/interbus/slave_model.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/rules.hpp"

// The lower tester of a master: one station of the segment that plays a whole ring of virtual stations. It
// decodes what the master sends, keeps the last cycles and statistics of all, and answers as a ring would:
// with the delay of its stations, with the contents of one long shift register and with a check of its own.
//
// It shares the line code with the stations of the bench, but neither the slave nor the frame check engine:
// the register is a string of bits with any length, the check is computed from the polynomial here.
//
// Faults are scripted: the script is asked at the start of each cycle and says what this cycle suffers.
// Limits: what a station would do with a disturbed forward line is not modelled beyond its check; use a ring
// of slaves for that.
namespace fieldproof::interbus {

struct VirtualStation {
  std::uint16_t id_code = 0;
  unsigned words = 0;
  int before = -1;  // index of the station it hangs on; -1: the master
  bool on_branch = false;
};

// A straight line of stations.
std::vector<VirtualStation> line_of(std::size_t count, std::uint16_t id_code, unsigned words);

// What one cycle suffers on its way. Telegrams count from 0 in the order of the returned data telegrams.
struct CycleFaults {
  struct Flip {
    std::size_t telegram;
    std::uint8_t mask;
    // In front of the last station's check, so that the check fits what comes back.
    bool check_fits = false;
  };
  std::vector<Flip> flips;
  struct LevelFlip {
    std::size_t telegram;
    unsigned level;  // of the telegram, its start level is 0
  };
  std::vector<LevelFlip> level_flips;
  int longer_bits = 0;  // the register is that much longer, or shorter when negative
  int dropped = -1;
  int duplicated = -1;
  int inserted = -1;  // a telegram in front of this one
  int stop_missing = -1;
  int flag_flipped = -1;  // of a data telegram
  int header_flipped = -1;
  bool status_flag_flipped = false;     // of the first status telegram behind the cycle
  bool trailing_telegram = false;       // one more data telegram behind the last
  unsigned trailing_gap_bits = 2;       // between them
  int marked_by = -1;                   // this station marks the status word and sets its message bit
  int also_marked_by = -1;              // and this one
  std::optional<std::uint16_t> mark{};  // the bits that it sets, instead of those of the rules
  std::optional<bool> stuck;            // the return line holds this level

  bool is_none() const;
};

// "octet 4 changed by 0Fh, with a check that fits; the register 8 bits longer".
std::string text_of(const CycleFaults& faults);

// A cycle of the master as it was seen on the line.
struct SeenCycle {
  std::uint64_t number = 0;  // from 0
  bool is_id_cycle = false;
  bool in_phase = true;  // headers as their phase requires
  bool check_good = false;
  bool status_clean = false;
  kernel::Time start{};
  kernel::Time end{};                // of the status word
  std::vector<std::uint8_t> octets;  // all data telegrams
  std::size_t transfer_octets = 0;   // with the loopback word

  // Nothing when the cycle was over before.
  std::optional<std::uint16_t> word(std::size_t octet) const {
    if (octet + 1 >= octets.size()) return std::nullopt;
    return static_cast<std::uint16_t>(octets[octet] << 8 | octets[octet + 1]);
  }
  std::string describe_word(std::size_t octet) const;
  std::string describe() const;
};

struct LineStatistics {
  std::uint64_t data_cycles = 0;
  std::uint64_t id_cycles = 0;
  std::uint64_t status_telegrams = 0;
  std::uint64_t bad_checks = 0;
  std::uint64_t wrong_phases = 0;  // telegrams with another SL than the cycle that they belong to
  kernel::Time first_telegram = kernel::kNever;
  kernel::Duration longest_silence{};  // between two telegrams, since `forget`
  // Between the starts of two data cycles that follow one another directly.
  kernel::Duration shortest_cycle = kernel::Duration::max();
  kernel::Duration longest_cycle{};
};

class RingEmulator : public segment::Station {
 public:
  struct CycleInfo {
    std::uint64_t number;       // from 0
    std::uint64_t data_number;  // data cycles before this one
    bool is_id_cycle;
    std::size_t octets;  // of the register
    kernel::Time start;
  };
  using Script = std::function<void(const CycleInfo&, CycleFaults&)>;
  using Signal = std::function<std::uint16_t(unsigned word, kernel::Time when)>;
  using OutputHook = std::function<void(std::span<const std::uint16_t> words, kernel::Time when)>;

  RingEmulator(const Rules& rules, std::vector<VirtualStation> stations);

  void wire(segment::Port& back) { back_ = &back; }

  // ---- the ring ----
  const std::vector<VirtualStation>& stations() const { return stations_; }
  // Another ring in place of this one, with every interface switched on.
  void replace_ring(std::vector<VirtualStation> stations);
  // The cable after station k (-1: after the master) is cut; nothing comes back while the ring includes it.
  void cut_after(int station) { cut_after_ = station; }
  void mend() { cut_after_.reset(); }
  // Message bits that stay until they are changed.
  void set_messages(std::size_t station, std::uint16_t bits) { steady_messages_.at(station) = bits; }
  void set_extra_delay(kernel::Duration delay) { extra_delay_ = delay; }
  // Clock of the return line against the nominal rate.
  void set_rate_error(std::int64_t per_mille) { rate_per_mille_ = 1000 + per_mille; }
  void set_script(Script script) { script_ = std::move(script); }
  std::size_t closed_stations() const { return active_.size(); }

  // ---- terminals: words station by station in the order of the ring ----
  void set_input(unsigned word, std::uint16_t value) { inputs_.at(word) = value; }
  std::uint16_t input(unsigned word) const { return inputs_.at(word); }
  void set_signal(Signal signal) { signal_ = std::move(signal); }
  std::uint16_t output(unsigned word) const { return outputs_.at(word); }
  std::size_t word_count() const { return outputs_.size(); }
  // Called with all outputs whenever they are latched.
  void on_outputs(OutputHook hook) { on_outputs_ = std::move(hook); }

  // ---- what was seen ----
  const LineStatistics& statistics() const { return statistics_; }
  void forget_statistics();
  std::uint64_t cycle_count() const { return cycle_count_; }
  bool has_cycle(std::uint64_t number) const;
  const SeenCycle& cycle(std::uint64_t number) const;
  const SeenCycle& last_cycle() const { return cycle(cycle_count_ - 1); }
  const SeenCycle& first_cycle() const;
  std::vector<std::string> describe_last(std::size_t count) const;
  // Idle since the end of the last telegram.
  kernel::Duration silence_until(kernel::Time now) const;

  std::uint16_t check_of(std::span<const std::uint8_t> octets) const { return check_.of(octets); }

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return receiver_.pending_until(); }

 private:
  enum class Phase { pause, transfer, check };
  static constexpr std::size_t kKept = 64;

  void on_telegram(const line::Waveform& wave, const line::Telegram& telegram);
  void note_wrong_phase();
  void on_status();
  void begin_cycle(const line::Waveform& wave, const line::Telegram& telegram);
  void load_register(kernel::Time when);
  void on_transfer(const line::Telegram& telegram);
  void on_check(const line::Waveform& wave, const line::Telegram& telegram);
  void finish_cycle();
  void latch(kernel::Time when);
  void apply_control_words();
  void emit(const line::Telegram& telegram, std::uint8_t octet);
  // The bit of what leaves at which a telegram belongs: counted from the start of the reception.
  std::size_t bit_of(const line::Waveform& wave, std::uint32_t level) const;
  // At a bit of the reception, or right after what was sent before.
  void emit_levels(std::size_t bit, std::uint64_t levels, unsigned count) {
    const std::size_t at = std::max(bit > answered_bits_ ? bit - answered_bits_ : 0, out_.levels.size());
    out_.levels.make_room(at + count);
    out_.levels.place(at, levels, count);
  }
  // A pause is that much shorter, so that the next cycle comes back in time.
  void emit_status(std::uint64_t levels, unsigned count) {
    if (telegram_bit_ >= answered_bits_) emit_levels(telegram_bit_, levels, count);
  }
  std::uint8_t shifted_octet(std::size_t index) const;
  void note_gap(kernel::Time start, kernel::Time last_end);
  void begin_answer(kernel::Time from);
  void answer();
  void reset_stations();
  void close_ring();
  bool is_open() const;
  kernel::Duration delay() const;
  SeenCycle& open_cycle() { return kept_[(cycle_count_ - 1) % kKept]; }

  Rules rules_;
  const line::TelegramCode& code_;
  conformance::BitwiseCheck check_;
  line::TelegramReceiver receiver_;
  std::uint64_t status_levels_;
  unsigned flag_level_ = 3;
  segment::Port* back_ = nullptr;
  std::vector<VirtualStation> stations_;
  std::vector<unsigned> first_words_;
  std::vector<std::uint16_t> inputs_;
  std::vector<std::uint16_t> outputs_;
  std::vector<std::uint16_t> steady_messages_;
  std::vector<std::uint16_t> error_messages_;
  std::vector<std::uint16_t> interfaces_;  // control bits "off" in force
  std::vector<std::size_t> active_;        // stations of the closed ring, in order
  std::vector<unsigned> word_order_;       // of the closed ring, in the order of the line
  std::optional<int> cut_after_;
  kernel::Duration extra_delay_{};
  std::int64_t rate_per_mille_ = 1000;
  Script script_;
  Signal signal_;
  OutputHook on_outputs_;

  // The cycle in work.
  Phase phase_ = Phase::pause;
  bool is_id_cycle_ = false;
  bool own_error_ = false;
  bool is_marked_ = false;
  bool expects_status_ = false;  // no status telegram since the cycle
  CycleFaults faults_;
  bool is_faulted_ = false;
  std::vector<std::uint8_t> stream_;    // the register, and behind it what came in
  std::vector<std::uint8_t> returned_;  // what left in the transfer phase
  std::size_t register_octets_ = 0;
  std::size_t transferred_ = 0;
  std::size_t checked_ = 0;
  std::uint16_t received_check_ = 0;
  std::uint16_t sent_check_ = 0;
  line::Waveform out_;
  // A telegram too many stays on the line when the master drives the next one by itself.
  kernel::Time answered_until_ = kernel::kStart;
  std::size_t answered_bits_ = 0;  // which out_ begins later for that

  // The log.
  std::vector<SeenCycle> kept_{kKept};
  SeenCycle first_;
  std::uint64_t cycle_count_ = 0;
  LineStatistics statistics_;
  kernel::Time last_end_{kernel::Duration::min()};
  kernel::Time heard_from_{};     // start of the reception
  std::size_t heard_bits_ = 0;    // end of its last telegram, counted from there
  std::size_t telegram_bit_ = 0;  // begin of the one in work
  std::optional<kernel::Time> last_data_start_;
};

}  // namespace fieldproof::interbus
