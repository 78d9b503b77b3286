#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/iut/device.hpp"

// What implementations did in one run of a case: of each its calls in order, and of each call what the
// implementation did within it. A stored run is judged again from it without the implementation, in any role
// and by any attachment: the bench's own stimuli follow from the seed.
//
// Limits: at most kMostOctets of text by estimate; then `is_truncated`, and nothing more is kept.
namespace fieldproof::iut {

enum class CallKind : std::uint8_t { begin, power, characters, levels, activity, time, end };
// "begin", "power" ...
std::string_view name(CallKind kind);

// ---- what an implementation does within a call ----

struct SwitchedDriver {
  unsigned port = 0;
  bool is_on = false;
  kernel::Time at{};
};
struct Sent {
  unsigned port = 0;
  kernel::Time start{};
  std::vector<std::uint16_t> characters{};
};
struct DroveLevels {
  unsigned port = 0;
  line::Waveform wave{};
};
struct Wrote {
  Item item = 0;
  std::uint64_t value = 0;
  kernel::Time when{};
};
struct WasRead {
  Item item = 0;
  kernel::Time when{};
};
struct WasUncertain {
  TimingUncertainty uncertainty{};
};
// It did not keep to the contract, and the call ended there.
struct Misbehaved {
  std::string reason;
  std::string sentence;
  std::vector<std::string> evidence;
};
// Its attachment cannot do what the case asks for.
struct CouldNot {
  std::string sentence;
  bool is_in_doubt = false;  // what it did was too late for a verdict
};
using Act =
    std::variant<SwitchedDriver, Sent, DroveLevels, Wrote, WasRead, WasUncertain, Misbehaved, CouldNot>;

struct RecordedCall {
  CallKind kind = CallKind::begin;
  kernel::Time at{};                   // as the bench told it; the beginning for `begin`, `end`
  kernel::Time next = kernel::kNever;  // when it wanted to be called after this one
  std::vector<Act> acts{};
};

struct RecordedDevice {
  UnitKind unit = UnitKind::levels;
  Capabilities capabilities{};
  bool takes_case = true;               // the answer to `begin`
  std::optional<Misbehaved> failure{};  // it could not even be attached: there are no calls
  std::vector<RecordedCall> calls{};
};

// Devices in the order in which the case made them.
class DeviceRecording {
 public:
  static constexpr std::size_t kMostOctets = 32U << 20U;  // of the text; half of what `load` takes

  // The number of the device; none of those kept once it is truncated.
  std::size_t add(RecordedDevice device);
  // The last call of a device; later acts belong to it.
  void begin_call(std::size_t device, CallKind kind, kernel::Time at);
  void add(std::size_t device, Act act);
  void end_call(std::size_t device, kernel::Time next);
  void set_takes_case(std::size_t device, bool takes_case);

  const std::deque<RecordedDevice>& devices() const { return devices_; }
  bool is_truncated() const { return is_truncated_; }
  // The file that it was loaded from; empty for one that was recorded.
  const std::string& name() const { return name_; }

  std::string text() const;
  // Throws kernel::Error(configuration) with file, line and pointer for anything but such a text.
  static DeviceRecording load(const std::filesystem::path& path);

 private:
  bool has_room(std::size_t octets);

  std::string name_;
  std::deque<RecordedDevice> devices_;
  std::size_t octets_ = 0;
  bool is_truncated_ = false;
};

}  // namespace fieldproof::iut
