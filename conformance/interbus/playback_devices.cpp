#include <fmt/format.h>

#include <array>
#include <span>
#include <utility>

#include "conformance/interbus/playback.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::MasterDevice;
using interbus::MasterStatus;
using interbus::SlaveDevice;

// ---- recording ----

// Where one device's events go, what time it is for the device, and why it acts: within a call of the bench,
// or because a time has come.
class Log {
 public:
  Log(DeviceRecording& recording, std::size_t device) : recording_(recording), device_(device) {}

  void begin_call() { call_ = ++calls_; }
  void begin_call(kernel::Time now) {
    now_ = now;
    begin_call();
  }
  void begin_time(kernel::Time now) {
    now_ = now;
    call_ = 0;
  }
  template <typename Event>
  void add(Event event) {
    recording_.add(device_, {now_, call_, std::move(event)});
  }
  bool is_full() const { return recording_.is_truncated(); }

 private:
  DeviceRecording& recording_;
  std::size_t device_;
  kernel::Time now_ = kernel::kStart;
  std::uint64_t calls_ = 0;
  std::uint64_t call_ = 0;
};

class RecordingPort final : public segment::Port {
 public:
  RecordingPort(Log& log, unsigned number) : log_(log), number_(number) {}
  void connect(segment::Port* port) { port_ = port; }
  segment::Port* as_port() { return port_ == nullptr ? nullptr : this; }

  void drive(line::Waveform& wave) override {
    log_.add(DriveEvent{number_, wave});
    port_->drive(wave);
  }

 private:
  Log& log_;
  unsigned number_;
  segment::Port* port_ = nullptr;
};

class RecordedSlave final : public SlaveDevice, private interbus::Terminals {
 public:
  RecordedSlave(std::unique_ptr<SlaveDevice> device, DeviceRecording& recording)
      : device_(std::move(device)), log_(recording, recording.add_device()) {}

  void wire(const interbus::SlavePorts& ports, interbus::Terminals& terminals) override {
    log_.begin_call();
    terminals_ = &terminals;
    ports_[0].connect(ports.upstream);
    ports_[1].connect(ports.branch);
    ports_[2].connect(ports.remote);
    device_->wire({ports_[0].as_port(), ports_[1].as_port(), ports_[2].as_port()}, *this);
  }
  void set_next_present(bool on_branch, bool present) override {
    device_->set_next_present(on_branch, present);
  }
  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    log_.begin_call(reception.start);
    device_->receive(port, reception);
  }
  void on_time(kernel::Time now) override {
    log_.begin_time(now);
    device_->on_time(now);
  }
  kernel::Time next_time() const override { return device_->next_time(); }
  void end() override { device_->end(); }

 private:
  std::uint16_t input(unsigned word, kernel::Time when) override { return terminals_->input(word, when); }
  void output(unsigned word, std::uint16_t value, kernel::Time when) override {
    log_.add(OutputEvent{word, value, when});
    terminals_->output(word, value, when);
  }
  bool has_peripheral_fault(kernel::Time when) override { return terminals_->has_peripheral_fault(when); }
  bool wants_reconfiguration(kernel::Time when) override { return terminals_->wants_reconfiguration(when); }

  std::unique_ptr<SlaveDevice> device_;
  Log log_;
  std::array<RecordingPort, 3> ports_{RecordingPort{log_, 0}, RecordingPort{log_, 1}, RecordingPort{log_, 2}};
  interbus::Terminals* terminals_ = nullptr;
};

std::size_t word_count(const MasterStatus& status) {
  std::size_t words = 0;
  for (const interbus::FoundStation& station : status.stations) words += station.words;
  return words;
}

class RecordedMaster final : public MasterDevice {
 public:
  RecordedMaster(std::unique_ptr<MasterDevice> device, DeviceRecording& recording)
      : device_(std::move(device)), log_(recording, recording.add_device()) {
    device_->on_cycle_end([this](kernel::Time now, bool data_cycle, bool accepted) {
      look();
      log_.add(HookEvent{data_cycle, accepted});
      if (hook_) hook_(now, data_cycle, accepted);
    });
  }

  void wire(segment::Port& out) override {
    port_.connect(&out);
    device_->wire(port_);
  }
  void start(kernel::Time now) override {
    log_.begin_call(now);
    device_->start(now);
    look();
  }
  void stop(kernel::Time now) override {
    log_.begin_call(now);
    device_->stop(now);
    look();
  }
  void request_id_cycle(kernel::Time now) override {
    log_.begin_call(now);
    device_->request_id_cycle(now);
    look();
  }
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override {
    // Also from within the hook, whose events come before and after.
    log_.begin_call(now);
    device_->write_output(word, value, now);
    look();
  }
  std::uint16_t output(unsigned word) const override { return device_->output(word); }
  std::uint16_t input(unsigned word) const override { return device_->input(word); }
  MasterStatus status() const override { return device_->status(); }
  void on_cycle_end(CycleHook hook) override { hook_ = std::move(hook); }

  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    log_.begin_call(reception.start);
    device_->receive(port, reception);
    look();
  }
  void on_time(kernel::Time now) override {
    log_.begin_time(now);
    device_->on_time(now);
    look();
  }
  kernel::Time next_time() const override { return device_->next_time(); }
  void end() override { device_->end(); }

 private:
  void look() {
    if (log_.is_full()) return;
    ViewEvent view{device_->status(), {}, {}};
    const std::size_t words = word_count(view.status);
    for (unsigned word = 0; word < words; ++word) {
      view.inputs.push_back(device_->input(word));
      view.outputs.push_back(device_->output(word));
    }
    if (has_view_ && view.status == last_.status && view.inputs == last_.inputs &&
        view.outputs == last_.outputs) {
      return;
    }
    has_view_ = true;
    last_ = view;
    log_.add(std::move(view));
  }

  std::unique_ptr<MasterDevice> device_;
  Log log_;
  RecordingPort port_{log_, 0};
  CycleHook hook_;
  ViewEvent last_;
  bool has_view_ = false;
};

// ---- playing back ----

// The events of one device and how far they have been played: what it did because a time had come at that
// time, what it did within a call of the bench within the call of the same number. The two are followed apart
// from one another, so that a call that the bench makes later, or never, does not keep the device from
// acting. Within one instant they keep the order in which they were recorded: the bench may have done
// something at that very instant, before it.
class Reel {
 public:
  Reel(const DeviceRecording& recording, std::size_t device)
      : events_(device < recording.device_count() ? std::span<const DeviceEvent>(recording.events(device))
                                                  : std::span<const DeviceEvent>()) {
    skip_to_call();
    skip_to_timed();
  }

  kernel::Time next_time() const {
    return timed_ == events_.size() || waits_for_call() ? kernel::kNever : events_[timed_].at;
  }

  template <typename Play>
  void play_call(Play&& play) {
    ++calls_;
    while (call_ < events_.size() && events_[call_].call <= calls_) {
      while (timed_ < call_) play_timed(play);
      const DeviceEvent& event = events_[call_++];
      skip_to_call();
      play(event);
    }
  }
  template <typename Play>
  void play_until(kernel::Time now, Play&& play) {
    while (next_time() <= now && timed_ < events_.size()) play_timed(play);
  }

 private:
  // Playing an event may make the bench call, so the next one is found first.
  template <typename Play>
  void play_timed(Play&& play) {
    const DeviceEvent& event = events_[timed_++];
    skip_to_timed();
    play(event);
  }
  bool waits_for_call() const {
    for (std::size_t n = timed_; n > call_ && events_[n - 1].at == events_[timed_].at; --n) {
      if (events_[n - 1].call != 0) return true;
    }
    return false;
  }
  void skip_to_call() {
    while (call_ < events_.size() && events_[call_].call == 0) ++call_;
  }
  void skip_to_timed() {
    while (timed_ < events_.size() && events_[timed_].call != 0) ++timed_;
  }

  std::span<const DeviceEvent> events_;
  std::size_t call_ = 0;   // the next event of a call
  std::size_t timed_ = 0;  // the next event of a time
  std::uint64_t calls_ = 0;
};

// Refuses the event at its place in the file.
[[noreturn]] void refuse(const DeviceRecording& recording, std::size_t device, std::size_t event,
                         std::string_view sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("{}: /devices/{}/{}: {}", recording.name(), device, event, sentence));
}

// What a file says that no device of this role did.
template <typename IsOwn>
void check_events(const DeviceRecording& recording, std::size_t device, IsOwn is_own,
                  std::string_view sentence) {
  if (device >= recording.device_count()) return;
  const std::vector<DeviceEvent>& events = recording.events(device);
  for (std::size_t n = 0; n < events.size(); ++n) {
    if (!is_own(events[n].what)) refuse(recording, device, n, sentence);
  }
}

void drive_again(segment::Port* port, const DriveEvent& event) {
  if (port == nullptr) return;
  line::Waveform wave = event.wave;
  port->drive(wave);
}

class PlayedBackSlave final : public SlaveDevice {
 public:
  PlayedBackSlave(const DeviceRecording& recording, std::size_t device) : reel_(recording, device) {}

  void wire(const interbus::SlavePorts& ports, interbus::Terminals& terminals) override {
    ports_ = {ports.upstream, ports.branch, ports.remote};
    terminals_ = &terminals;
    play_call();
  }
  void set_next_present(bool, bool) override {}
  void receive(segment::PortIndex, const line::Waveform&) override { play_call(); }
  void on_time(kernel::Time now) override {
    reel_.play_until(now, [this](const DeviceEvent& event) { play(event); });
  }
  kernel::Time next_time() const override { return reel_.next_time(); }

 private:
  void play_call() {
    reel_.play_call([this](const DeviceEvent& event) { play(event); });
  }
  void play(const DeviceEvent& event) {
    if (const auto* drive = std::get_if<DriveEvent>(&event.what)) {
      drive_again(ports_.at(drive->port), *drive);
    } else if (const auto* output = std::get_if<OutputEvent>(&event.what)) {
      terminals_->output(output->word, output->value, output->when);
    }
  }

  Reel reel_;
  std::array<segment::Port*, 3> ports_{};
  interbus::Terminals* terminals_ = nullptr;
};

class PlayedBackMaster final : public MasterDevice {
 public:
  PlayedBackMaster(const DeviceRecording& recording, std::size_t device) : reel_(recording, device) {}

  void wire(segment::Port& out) override { out_ = &out; }
  void start(kernel::Time) override { play_call(); }
  void stop(kernel::Time) override { play_call(); }
  void request_id_cycle(kernel::Time) override { play_call(); }
  void write_output(unsigned, std::uint16_t, kernel::Time) override { play_call(); }
  std::uint16_t output(unsigned word) const override {
    return word < view_.outputs.size() ? view_.outputs[word] : 0;
  }
  std::uint16_t input(unsigned word) const override {
    return word < view_.inputs.size() ? view_.inputs[word] : 0;
  }
  MasterStatus status() const override { return view_.status; }
  void on_cycle_end(CycleHook hook) override { hook_ = std::move(hook); }

  void receive(segment::PortIndex, const line::Waveform&) override { play_call(); }
  void on_time(kernel::Time now) override {
    reel_.play_until(now, [this](const DeviceEvent& event) { play(event); });
  }
  kernel::Time next_time() const override { return reel_.next_time(); }

 private:
  void play_call() {
    reel_.play_call([this](const DeviceEvent& event) { play(event); });
  }
  void play(const DeviceEvent& event) {
    if (const auto* drive = std::get_if<DriveEvent>(&event.what)) {
      drive_again(out_, *drive);
    } else if (const auto* view = std::get_if<ViewEvent>(&event.what)) {
      view_ = *view;
    } else if (const auto* hook = std::get_if<HookEvent>(&event.what)) {
      if (hook_) hook_(event.at, hook->data_cycle, hook->accepted);
    }
  }

  Reel reel_;
  segment::Port* out_ = nullptr;
  CycleHook hook_;
  ViewEvent view_;
};

}  // namespace

std::unique_ptr<SlaveDevice> recorded(std::unique_ptr<SlaveDevice> device, DeviceRecording& recording) {
  return std::make_unique<RecordedSlave>(std::move(device), recording);
}

std::unique_ptr<MasterDevice> recorded(std::unique_ptr<MasterDevice> device, DeviceRecording& recording) {
  return std::make_unique<RecordedMaster>(std::move(device), recording);
}

std::unique_ptr<SlaveDevice> played_back_slave(const DeviceRecording& recording, std::size_t device,
                                               unsigned words) {
  const auto is_own = [words](const auto& what) {
    const auto* output = std::get_if<OutputEvent>(&what);
    return output != nullptr ? output->word < words : std::holds_alternative<DriveEvent>(what);
  };
  check_events(
      recording, device, is_own,
      fmt::format("a slave with {} words drives, and sets words below {}; the recording is of another "
                  "case, or was changed",
                  words, words));
  return std::make_unique<PlayedBackSlave>(recording, device);
}

std::unique_ptr<MasterDevice> played_back_master(const DeviceRecording& recording, std::size_t device) {
  check_events(
      recording, device, [](const auto& what) { return !std::holds_alternative<OutputEvent>(what); },
      "a master sets no outputs of a slave; the recording is of another case, or was changed");
  return std::make_unique<PlayedBackMaster>(recording, device);
}

}  // namespace fieldproof::conformance
