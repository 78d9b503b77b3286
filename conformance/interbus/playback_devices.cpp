#include <array>
#include <utility>

#include "conformance/interbus/playback.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::MasterDevice;
using interbus::MasterStatus;
using interbus::SlaveDevice;

// ---- recording ----

// Where one device's events go, and what time it is for the device.
struct Log {
  DeviceRecording& recording;
  std::size_t device;
  kernel::Time now = kernel::kStart;

  template <typename Event>
  void add(Event event) {
    recording.add(device, {now, std::move(event)});
  }
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
      : device_(std::move(device)), log_{recording, recording.add_device()} {}

  void wire(const interbus::SlavePorts& ports, interbus::Terminals& terminals) override {
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
    log_.now = reception.start;
    device_->receive(port, reception);
  }
  void on_time(kernel::Time now) override {
    log_.now = now;
    device_->on_time(now);
  }
  kernel::Time next_time() const override { return device_->next_time(); }

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
      : device_(std::move(device)), log_{recording, recording.add_device()} {
    device_->on_cycle_end([this](kernel::Time now, bool data_cycle, bool accepted) {
      log_.now = now;
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
    log_.now = now;
    device_->start(now);
    look();
  }
  void stop(kernel::Time now) override {
    log_.now = now;
    device_->stop(now);
    look();
  }
  void request_id_cycle() override { device_->request_id_cycle(); }
  void write_output(unsigned word, std::uint16_t value) override {
    device_->write_output(word, value);
    look();
  }
  std::uint16_t output(unsigned word) const override { return device_->output(word); }
  std::uint16_t input(unsigned word) const override { return device_->input(word); }
  MasterStatus status() const override { return device_->status(); }
  void on_cycle_end(CycleHook hook) override { hook_ = std::move(hook); }

  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    log_.now = reception.start;
    device_->receive(port, reception);
    look();
  }
  void on_time(kernel::Time now) override {
    log_.now = now;
    device_->on_time(now);
    look();
  }
  kernel::Time next_time() const override { return device_->next_time(); }

 private:
  void look() {
    if (log_.recording.is_truncated()) return;
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

// The events of one device and how far they have been played.
class Reel {
 public:
  Reel(const DeviceRecording& recording, std::size_t device)
      : events_(device < recording.device_count() ? &recording.events(device) : nullptr) {}

  kernel::Time next_time() const { return is_over() ? kernel::kNever : (*events_)[next_].at; }

  template <typename Play>
  void play_until(kernel::Time now, Play&& play) {
    while (!is_over() && (*events_)[next_].at <= now) play((*events_)[next_++].what);
  }

 private:
  bool is_over() const { return events_ == nullptr || next_ == events_->size(); }

  const std::vector<DeviceEvent>* events_;
  std::size_t next_ = 0;
};

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
  }
  void set_next_present(bool, bool) override {}
  void receive(segment::PortIndex, const line::Waveform& reception) override { play(reception.start); }
  void on_time(kernel::Time now) override { play(now); }
  kernel::Time next_time() const override { return reel_.next_time(); }

 private:
  void play(kernel::Time now) {
    reel_.play_until(now, [&](const auto& what) {
      if (const auto* drive = std::get_if<DriveEvent>(&what)) {
        drive_again(ports_.at(drive->port), *drive);
      } else if (const auto* output = std::get_if<OutputEvent>(&what)) {
        terminals_->output(output->word, output->value, output->when);
      }
    });
  }

  Reel reel_;
  std::array<segment::Port*, 3> ports_{};
  interbus::Terminals* terminals_ = nullptr;
};

class PlayedBackMaster final : public MasterDevice {
 public:
  PlayedBackMaster(const DeviceRecording& recording, std::size_t device) : reel_(recording, device) {}

  void wire(segment::Port& out) override { out_ = &out; }
  void start(kernel::Time now) override { play(now); }
  void stop(kernel::Time now) override { play(now); }
  void request_id_cycle() override {}
  void write_output(unsigned, std::uint16_t) override {}
  std::uint16_t output(unsigned word) const override {
    return word < view_.outputs.size() ? view_.outputs[word] : 0;
  }
  std::uint16_t input(unsigned word) const override {
    return word < view_.inputs.size() ? view_.inputs[word] : 0;
  }
  MasterStatus status() const override { return view_.status; }
  void on_cycle_end(CycleHook hook) override { hook_ = std::move(hook); }

  void receive(segment::PortIndex, const line::Waveform& reception) override { play(reception.start); }
  void on_time(kernel::Time now) override { play(now); }
  kernel::Time next_time() const override { return reel_.next_time(); }

 private:
  void play(kernel::Time now) {
    reel_.play_until(now, [&](const auto& what) {
      if (const auto* drive = std::get_if<DriveEvent>(&what)) {
        drive_again(out_, *drive);
      } else if (const auto* view = std::get_if<ViewEvent>(&what)) {
        view_ = *view;
      } else if (const auto* hook = std::get_if<HookEvent>(&what)) {
        if (hook_) hook_(now, hook->data_cycle, hook->accepted);
      }
    });
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

std::unique_ptr<SlaveDevice> played_back_slave(const DeviceRecording& recording, std::size_t device) {
  return std::make_unique<PlayedBackSlave>(recording, device);
}

std::unique_ptr<MasterDevice> played_back_master(const DeviceRecording& recording, std::size_t device) {
  return std::make_unique<PlayedBackMaster>(recording, device);
}

}  // namespace fieldproof::conformance
