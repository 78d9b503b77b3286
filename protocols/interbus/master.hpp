#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/line/frame_check_16.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "protocols/interbus/cycle_frame.hpp"
#include "protocols/interbus/cycle_supervision.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/returned_cycle.hpp"
#include "protocols/interbus/topology.hpp"

// The INTERBUS master: recognises the ring, exchanges its process images with it cycle by cycle, and judges
// each cycle by what comes back.
//
//   off ──start──▶ ready ──▶ identification ──complete──▶ run ──too many bad cycles──▶ bus_stop
//                    ▲   no station  │  │ configuration error            silence, then │  ▲
//                    └───────────────┘  └──────────▶ bus_stop               locating ◀─┘  │
//                                                                               └─────────┘
//   stop: from run after one data cycle with outputs 0, from every other state at once, to off.
//   start: from off and bus_stop, after a silence in which the stations fall into reset.
//
// A cycle is one waveform, driven at its start: the summation frame and the status telegrams of the pause up
// to the next cycle. The verdict is taken one telegram after the end of what must come back, so that a
// telegram too many is seen; after an accepted data cycle the copy task and then the application's hook run.
// A rejected cycle leaves the inputs as they were; an ID cycle follows it, which shows through the message
// bits where the error lies. Cycles start at multiples of the cycle time; an ID cycle that does not fit takes
// a whole number of them.
//
// Each decision that a standard leaves no choice about is a virtual function, so that a mutant is the
// override of exactly one. Nothing is allocated in data cycles once the first ones have passed.
namespace fieldproof::interbus {

class Master : public MasterDevice, private TopologyDecisions {
 public:
  explicit Master(const MasterConfiguration& configuration);

  void wire(segment::Port& out) override { out_ = &out; }
  void start(kernel::Time now) override;
  void stop(kernel::Time now) override;
  void request_id_cycle(kernel::Time) override { id_cycle_requested_ = true; }
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override;
  std::uint16_t output(unsigned word) const override { return word < outputs_.size() ? outputs_[word] : 0; }
  std::uint16_t input(unsigned word) const override { return word < inputs_.size() ? inputs_[word] : 0; }
  MasterStatus status() const override;
  void on_cycle_end(CycleHook hook) override { hook_ = std::move(hook); }

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

 protected:
  const Rules& rules() const { return configuration_.rules; }
  const MasterConfiguration& configuration() const { return configuration_; }
  std::vector<std::uint16_t>& inputs() { return inputs_; }
  std::vector<std::uint16_t>& outputs() { return outputs_; }
  const std::vector<FoundStation>& stations() const { return stations_; }
  const CycleSupervision& supervision() const { return supervision_; }
  kernel::Duration ring_delay() const { return ring_delay_; }
  kernel::Duration data_frame_time() const { return writer_.frame_time(data_telegrams_); }
  const line::FrameCheck16& check() const { return check_; }

  // ---- decisions about a cycle that has come back; `octet` is where the loopback word must stand ----
  virtual bool accepts_count(const ReturnedCycle& returned) const { return returned.has_exact_count(); }
  virtual bool accepts_framing(const ReturnedCycle& returned) const { return !returned.is_stop_missing(); }
  virtual bool accepts_phases(const ReturnedCycle& returned) const { return returned.is_in_phase(); }
  virtual bool accepts_loopback(const ReturnedCycle& returned, std::size_t octet) const;
  virtual bool accepts_check(const ReturnedCycle& returned) const;
  virtual bool accepts_status(std::uint16_t status) const { return status == rules().status_clean; }
  virtual bool accepts_inputs(std::span<const std::uint16_t>) const { return true; }
  virtual bool accepts_silence() const { return false; }
  virtual bool hears(const line::Waveform&) const { return true; }
  // A telegram after the last one that begins within so many bits belongs to the cycle.
  virtual std::int64_t guard_bits() const { return line::kDataTelegramLevels; }

  // ---- decisions about what is sent ----
  virtual std::uint8_t id_select() const { return line::kSelect; }
  virtual std::uint16_t check_of(std::span<const std::uint8_t> sent, CycleHeaders headers) const;
  // Image words in the order in which a data cycle sends them.
  virtual std::vector<unsigned> output_order() const { return shift_order(); }
  virtual void take_outputs(std::span<const std::uint16_t> image, std::span<std::uint16_t> sent) const;
  virtual bool fills_pause(kernel::Duration) const { return true; }
  virtual kernel::Duration shortest_cycle_time() const;
  virtual kernel::Duration cycle_time_in_force(kernel::Duration shortest) const;
  virtual kernel::Duration lateness(std::uint64_t) const { return {}; }  // of the start of a cycle
  virtual bool clears_outputs_on_stop() const { return true; }
  // The one data cycle of a stop has come back, good or bad.
  virtual bool ends_stop(bool) const { return true; }

  // ---- decisions after a cycle ----
  // What a data cycle brought, in the order of the input image; by default nothing of a rejected one.
  virtual void on_rejected_inputs(std::span<const std::uint16_t>) {}
  virtual void run_copy_task();
  virtual bool needs_id_cycle_after_error() const { return true; }
  virtual bool counts_as_consecutive(bool) const { return true; }
  virtual bool clears_consecutive() const { return true; }
  virtual bool reaches_stop(unsigned consecutive) const {
    return consecutive >= rules().stop_after_bad_cycles;
  }
  virtual bool is_same_id(std::uint16_t found, std::uint16_t configured) const { return found == configured; }
  // What to do when a good ID cycle shows another ring than the configured one: false to go on with it.
  virtual bool refuses_changed_ring() const { return true; }
  virtual bool searches_fault() const { return true; }
  virtual bool is_same_station(const FoundStation& found, const FoundStation& configured) const {
    return found == configured;
  }
  virtual FaultLocation locate(int first_marked) const;
  virtual bool restarts_with_recognition() const { return true; }
  virtual bool reports_peripheral_fault() const { return true; }
  virtual bool reports_reconfiguration() const { return true; }

  // ---- decisions of the recognition ----
  std::optional<unsigned> words_of(std::uint16_t id_code) const override;
  bool searches_branches() const override { return true; }

  std::vector<unsigned> shift_order() const;

 private:
  // Time line.
  void act(kernel::Time now);
  void drive_status(kernel::Time now);
  void start_cycle(kernel::Time now);
  void write_data_cycle();
  void write_id_cycle();
  void append_pause(std::size_t end_level);
  void drive_cycle(kernel::Time now, kernel::Duration span, std::size_t end_level);
  kernel::Duration return_time(kernel::Duration frame) const;
  kernel::Duration id_cycle_span(kernel::Duration frame) const;
  std::size_t levels_within(kernel::Duration span) const;
  kernel::Duration silence() const;

  // Reception.
  void on_telegram(const line::Waveform& wave, const line::Telegram& telegram);

  // Verdicts.
  void finish_cycle(kernel::Time now);
  void finish_data_cycle(kernel::Time now);
  void finish_id_cycle(kernel::Time now);
  bool accepts_trailer() const;
  std::optional<std::size_t> loopback_position() const;
  void read_inputs();
  std::span<const std::uint16_t> read_ids(std::size_t count);
  bool judge_id_cycle(kernel::Time now);
  void on_run_ids(std::span<const std::uint16_t> ids, kernel::Time now);
  void on_rejected(bool data_cycle, kernel::Time now);
  void report_messages(std::span<const std::uint16_t> ids);
  void read_messages(std::span<const std::uint16_t> ids);
  void on_recognition_ids(std::span<const std::uint16_t> ids);
  void on_recognition_rejected();
  void on_fault_found(int station);

  // States.
  void enter_off();
  void enter_ready(kernel::Time from);
  void enter_recognition();
  void enter_run();
  void enter_bus_stop();
  void abort_bus(kernel::Time now);
  void refuse(std::string sentence);
  void finish_recognition();
  void finish_locating();
  std::string difference_to(std::span<const FoundStation> expected,
                            std::span<const FoundStation> found) const;
  void set_images();

  MasterConfiguration configuration_;
  CycleWriter writer_;
  const line::FrameCheck16& check_;
  line::TelegramReceiver receiver_;
  Topology topology_;
  CycleSupervision supervision_;
  segment::Port* out_ = nullptr;
  CycleHook hook_;

  MasterState state_ = MasterState::off;
  std::vector<FoundStation> stations_;
  std::string configuration_error_;
  std::optional<FaultLocation> fault_location_;
  std::vector<int> peripheral_faults_;
  std::vector<int> reconfigurations_;
  std::vector<std::uint16_t> acknowledged_;  // control bits for the next ID cycle, by station

  // Images, and the words of the cycle in work.
  std::vector<std::uint16_t> inputs_;
  std::vector<std::uint16_t> outputs_;
  std::vector<std::uint16_t> sent_words_;
  std::vector<std::uint16_t> returned_words_;
  std::vector<unsigned> input_order_;
  std::vector<unsigned> output_order_;
  std::vector<std::uint8_t> octets_;
  line::Waveform wave_;
  ReturnedCycle returned_;

  // The cycle in work.
  bool is_id_cycle_ = false;
  bool is_collecting_ = false;
  bool is_id_cycle_needed_ = false;
  bool is_fault_open_ = false;  // a cycle was rejected and its place is not known yet
  bool id_cycle_requested_ = false;
  bool is_stopping_ = false;
  kernel::Time cycle_start_{};
  kernel::Time first_returned_{};
  std::uint64_t run_cycles_ = 0;

  // Timing.
  std::size_t data_telegrams_ = 0;
  kernel::Duration data_frame_{};
  kernel::Duration cycle_time_{};
  std::size_t data_end_level_ = 0;
  line::Levels data_pause_;  // empty before the first data cycle
  kernel::Duration ring_delay_{};
  kernel::Time verdict_at_ = kernel::kNever;
  kernel::Time deadline_ = kernel::kNever;
  kernel::Time action_at_ = kernel::kNever;
  kernel::Time recognise_at_ = kernel::kNever;
  kernel::Time driven_until_{kernel::Duration::min()};
};

std::string_view name(MasterState state);

}  // namespace fieldproof::interbus
