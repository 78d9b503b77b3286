#include "harness/iut/recorded_device.hpp"

#include <fmt/format.h>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::iut {
namespace {

// Between a device and its bench: passes everything on in both directions, and keeps it.
class Recorder final : public Device, private Bench {
 public:
  Recorder(Device& device, DeviceRecording& recording)
      : device_(device),
        recording_(recording),
        number_(recording.add({.unit = device.unit_kind(), .capabilities = device.capabilities()})) {}

  UnitKind unit_kind() const override { return device_.unit_kind(); }
  Capabilities capabilities() const override { return device_.capabilities(); }

  bool begin(const CaseBegin& begin, Bench& bench) override {
    bench_ = &bench;
    bool takes_case = false;
    kept(CallKind::begin, kernel::kStart, [&] { takes_case = device_.begin(begin, *this); });
    recording_.set_takes_case(number_, takes_case);
    return takes_case;
  }
  void set_power(bool is_on, kernel::Time now) override {
    kept(CallKind::power, now, [&] { device_.set_power(is_on, now); });
  }
  void receive(unsigned port, std::span<const Character> characters, kernel::Time now) override {
    kept(CallKind::characters, now, [&] { device_.receive(port, characters, now); });
  }
  void receive(unsigned port, const line::Waveform& reception) override {
    kept(CallKind::levels, reception.start, [&] { device_.receive(port, reception); });
  }
  void on_activity(unsigned port, bool begins, kernel::Time now) override {
    kept(CallKind::activity, now, [&] { device_.on_activity(port, begins, now); });
  }
  void on_time(kernel::Time now) override {
    kept(CallKind::time, now, [&] { device_.on_time(now); });
  }
  kernel::Time next_time() const override { return device_.next_time(); }
  void end() override {
    kept(CallKind::end, kernel::kStart, [&] { device_.end(); });
  }

 private:
  template <typename Call>
  void kept(CallKind kind, kernel::Time at, Call&& call) {
    recording_.begin_call(number_, kind, at);
    try {
      call();
    } catch (const Misbehaviour& done) {
      recording_.add(number_, Misbehaved{done.reason(), done.what(), done.evidence()});
      throw;
    } catch (const CannotBeDone& what) {
      recording_.add(number_, CouldNot{what.what(), dynamic_cast<const InDoubt*>(&what) != nullptr});
      throw;
    }
    recording_.end_call(number_, device_.next_time());
  }

  void set_driver(unsigned port, bool is_on, kernel::Time at) override {
    recording_.add(number_, SwitchedDriver{port, is_on, at});
    bench_->set_driver(port, is_on, at);
  }
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    recording_.add(number_, Sent{port, start, {characters.begin(), characters.end()}});
    bench_->send(port, start, characters);
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    recording_.add(number_, DroveLevels{port, wave});
    bench_->transmit(port, wave);
  }
  void write(Item item, std::uint64_t value, kernel::Time when) override {
    recording_.add(number_, Wrote{item, value, when});
    bench_->write(item, value, when);
  }
  std::uint64_t read(Item item, kernel::Time when) override {
    recording_.add(number_, WasRead{item, when});
    return bench_->read(item, when);
  }
  void set_uncertainty(TimingUncertainty uncertainty) override {
    recording_.add(number_, WasUncertain{uncertainty});
    bench_->set_uncertainty(uncertainty);
  }

  Device& device_;
  DeviceRecording& recording_;
  std::size_t number_;
  Bench* bench_ = nullptr;
};

class PlayedBack final : public Device {
 public:
  PlayedBack(const DeviceRecording& recording, const RecordedDevice& device, std::size_t number)
      : recording_(recording), device_(device), number_(number) {}

  UnitKind unit_kind() const override { return device_.unit; }
  Capabilities capabilities() const override { return device_.capabilities; }
  bool begin(const CaseBegin&, Bench& bench) override {
    bench_ = &bench;
    again(CallKind::begin, kernel::kStart);
    return device_.takes_case;
  }
  void set_power(bool, kernel::Time now) override { again(CallKind::power, now); }
  void receive(unsigned, std::span<const Character>, kernel::Time now) override {
    again(CallKind::characters, now);
  }
  void receive(unsigned, const line::Waveform& reception) override {
    again(CallKind::levels, reception.start);
  }
  void on_activity(unsigned, bool, kernel::Time now) override { again(CallKind::activity, now); }
  void on_time(kernel::Time now) override { again(CallKind::time, now); }
  kernel::Time next_time() const override { return next_; }
  void end() override { again(CallKind::end, kernel::kStart); }

 private:
  // A recording that was cut by a misbehaviour has no more calls, and is not asked for any.
  void again(CallKind kind, kernel::Time at) {
    const std::size_t n = done_++;
    if (n >= device_.calls.size()) refuse(n, kind, at, "there is no more");
    const RecordedCall& call = device_.calls[n];
    if (call.kind != kind || call.at != at) {
      refuse(n, kind, at, fmt::format("it was '{}' at {}", name(call.kind), kernel::describe(call.at)));
    }
    for (const Act& act : call.acts) std::visit([this](const auto& one) { perform(one); }, act);
    next_ = call.next;
  }

  [[noreturn]] void refuse(std::size_t n, CallKind kind, kernel::Time at, const std::string& was) const {
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format(
            "{}: call {} of device {} is '{}' at {}, and in the recording {}: case, seed or setup are "
            "not those of the recorded run",
            recording_.name(), n, number_, name(kind), kernel::describe(at), was));
  }

  void perform(const SwitchedDriver& driver) { bench_->set_driver(driver.port, driver.is_on, driver.at); }
  void perform(const Sent& sent) { bench_->send(sent.port, sent.start, sent.characters); }
  void perform(const DroveLevels& drove) {
    line::Waveform wave = drove.wave;
    bench_->transmit(drove.port, wave);
  }
  void perform(const Wrote& wrote) { bench_->write(wrote.item, wrote.value, wrote.when); }
  void perform(const WasRead& read) { bench_->read(read.item, read.when); }
  void perform(const WasUncertain& was) { bench_->set_uncertainty(was.uncertainty); }
  [[noreturn]] void perform(const Misbehaved& done) {
    throw Misbehaviour(done.reason, done.sentence, done.evidence);
  }
  [[noreturn]] void perform(const CouldNot& could) {
    if (could.is_in_doubt) throw InDoubt(could.sentence);
    throw CannotBeDone(could.sentence);
  }

  const DeviceRecording& recording_;
  const RecordedDevice& device_;
  std::size_t number_;
  Bench* bench_ = nullptr;
  std::size_t done_ = 0;
  kernel::Time next_ = kernel::kNever;
};

// A device that somebody else keeps, and what stands in front of it.
struct Kept {
  std::shared_ptr<void> lease;
  std::unique_ptr<Device> front;
};

}  // namespace

Attachment recorded(Attachment attachment, DeviceRecording& recording) {
  auto kept = std::make_shared<Kept>();
  kept->front = std::make_unique<Recorder>(*attachment.device, recording);
  kept->lease = std::move(attachment.lease);
  attachment.device = kept->front.get();
  attachment.lease = std::move(kept);
  return attachment;
}

void record_failure(DeviceRecording& recording, const kernel::Error& error) {
  RecordedDevice device;
  const auto* done = dynamic_cast<const Misbehaviour*>(&error);
  device.failure = done == nullptr ? Misbehaved{{}, error.what(), {}}
                                   : Misbehaved{done->reason(), done->what(), done->evidence()};
  recording.add(std::move(device));
}

Attachment played_back(const DeviceRecording& recording, std::size_t number) {
  if (number >= recording.devices().size()) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}: the case asks for implementation {}, and {} are recorded",
                                    recording.name(), number, recording.devices().size()));
  }
  const RecordedDevice& device = recording.devices()[number];
  if (device.failure) {
    if (device.failure->reason.empty())
      throw kernel::Error(kernel::ErrorKind::implementation, device.failure->sentence);
    throw Misbehaviour(device.failure->reason, device.failure->sentence, device.failure->evidence);
  }
  auto kept = std::make_shared<PlayedBack>(recording, device, number);
  return {kept.get(), kept, {}};
}

}  // namespace fieldproof::iut
