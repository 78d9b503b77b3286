#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "protocols/interbus/device.hpp"

// What an implementation did in one run of a case, as the bench met it at its ports, its terminals and its
// application interface; and a device that does the same again at the same instants. So a stored run is
// judged again without the implementation: the bench's own stimuli follow from the seed.
//
// Limits: at most kMostEvents events and kMostOctets a run, then the recording says so. A played-back device
// answers nothing that it was not asked in the recorded run: it is for the same case, seed and setup only.
namespace fieldproof::conformance {

struct DriveEvent {
  unsigned port = 0;  // 0 upstream (or the master's output), 1 branch, 2 remote
  line::Waveform wave;
};
struct OutputEvent {
  unsigned word = 0;
  std::uint16_t value = 0;
  kernel::Time when{};
};
struct HookEvent {
  bool data_cycle = false;
  bool accepted = false;
};
// The application's view of a master, when it has changed.
struct ViewEvent {
  interbus::MasterStatus status;
  std::vector<std::uint16_t> inputs;
  std::vector<std::uint16_t> outputs;
};

struct DeviceEvent {
  kernel::Time at{};       // when the device acted
  std::uint64_t call = 0;  // within which call of the bench, counted from 1; 0: because a time had come
  std::variant<DriveEvent, OutputEvent, HookEvent, ViewEvent> what;
};

// Devices in the order in which the case made them.
class DeviceRecording {
 public:
  static constexpr std::size_t kMostEvents = 20'000;
  static constexpr std::size_t kMostOctets = 32U
                                             << 20U;  // of the text, by estimate: half of what `load` takes

  std::size_t add_device() {
    devices_.emplace_back();
    return devices_.size() - 1;
  }
  void add(std::size_t device, DeviceEvent event);
  const std::vector<DeviceEvent>& events(std::size_t device) const { return devices_.at(device); }
  std::size_t device_count() const { return devices_.size(); }
  bool is_truncated() const { return is_truncated_; }

  // The file that it was loaded from; empty for one that was recorded.
  const std::string& name() const { return name_; }

  std::string text() const;
  // Throws kernel::Error(configuration) with file, line and pointer for anything but such a text.
  static DeviceRecording load(const std::filesystem::path& path);

 private:
  std::string name_;
  std::deque<std::vector<DeviceEvent>> devices_;
  std::size_t event_count_ = 0;
  std::size_t octets_ = 0;
  bool is_truncated_ = false;
};

// Wraps a device so that what it does is recorded. The recording must outlive the device.
std::unique_ptr<interbus::SlaveDevice> recorded(std::unique_ptr<interbus::SlaveDevice> device,
                                                DeviceRecording& recording);
std::unique_ptr<interbus::MasterDevice> recorded(std::unique_ptr<interbus::MasterDevice> device,
                                                 DeviceRecording& recording);

// The device number `device` of a recording; one that the recording does not have stays silent. The recording
// must outlive the device. Throws kernel::Error(configuration) for an event that no such device has: of the
// other role, or of a word that a slave with so many words does not have.
std::unique_ptr<interbus::SlaveDevice> played_back_slave(const DeviceRecording& recording, std::size_t device,
                                                         unsigned words);
std::unique_ptr<interbus::MasterDevice> played_back_master(const DeviceRecording& recording,
                                                           std::size_t device);

}  // namespace fieldproof::conformance
