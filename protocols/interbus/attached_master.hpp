#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/iut/attached_case.hpp"
#include "harness/iut/served_station.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/master_settings.hpp"
#include "protocols/interbus/telegram_front.hpp"

// A master between the bench and an implementation outside, in both directions: AttachedMaster is a master of
// the bench that an iut::Device plays; ServedMaster is an iut::Device that a master of ours plays.
//
// Port 0 is the line, in levels or telegrams (telegram_front.hpp); a reception is told whole, when it begins.
// Port 1 is the application: its
// orders are told as characters whatever the unit, one order a call, each over at the instant of the call.
// The implementation keeps the words that its application may look at up to date within the call in which
// they change, and tells the end of each cycle after them. It is told the settings of master_settings.
namespace fieldproof::interbus {

inline constexpr unsigned kApplicationPort = 1;

// The first character of an order. What follows it, in one call: the word and its value for an output,
// nothing for the others.
enum class MasterOrder : std::uint16_t { start = 1, stop = 2, id_cycle = 3, output = 4 };

inline constexpr unsigned kMostErrorTexts = 32;

inline constexpr iut::Item kMasterState = 0;  // kept, in the order of MasterState
inline constexpr iut::Item kDataCycles = 1;   // kept, since the last start
inline constexpr iut::Item kIdCycles = 2;
inline constexpr iut::Item kRejectedCycles = 3;
inline constexpr iut::Item kRejectedDataCycles = 4;
inline constexpr iut::Item kConsecutiveBad = 5;
inline constexpr iut::Item kQualityBit = 6;    // kept: 0, 1
inline constexpr iut::Item kCycleTime = 7;     // kept, in force: ps
inline constexpr iut::Item kFaultPlace = 8;    // kept: 0, or 1 << 32 | from + 1 | (to + 1) << 16
inline constexpr iut::Item kStationCount = 9;  // kept
inline constexpr iut::Item kCycleEnd = 10;     // told: 1 data cycle | 2 accepted
// Read, after a cycle end: order | word << 16 | value << 32, 0 when there is none left.
inline constexpr iut::Item kNextOrder = 11;
// Kept, + n each.
inline constexpr iut::Item kErrorText = 0x100;         // of the configuration: octets 8n to 8n + 7, 8n lowest
inline constexpr iut::Item kFoundStation = 0x1000;     // as packed_station
inline constexpr iut::Item kStationMessages = 0x2000;  // 1 peripheral fault | 2 reconfiguration
inline constexpr iut::Item kInputImage = 0x3000;
inline constexpr iut::Item kOutputImage = 0x4000;
inline constexpr iut::Item kMasterItems = kOutputImage + kMostMasterWords;

class AttachedMaster final : public MasterDevice, private iut::Bench {
 public:
  // Throws iut::Misbehaviour when the implementation refuses the case.
  AttachedMaster(iut::Attachment attachment, const MasterConfiguration& configuration,
                 const std::string& case_id, std::uint64_t seed);

  void wire(segment::Port& out) override { out_ = &out; }
  // Also switches the supply on, once.
  void start(kernel::Time now) override;
  // What is ordered within the hook the implementation may read at once; what it does not is told after the
  // call in which the cycle has ended.
  void stop(kernel::Time now) override { order({MasterOrder::stop, {}, now}); }
  void request_id_cycle(kernel::Time now) override { order({MasterOrder::id_cycle, {}, now}); }
  void write_output(unsigned word, std::uint16_t value, kernel::Time now) override;
  std::uint16_t output(unsigned word) const override { return image(kOutputImage, word); }
  std::uint16_t input(unsigned word) const override { return image(kInputImage, word); }
  MasterStatus status() const override;
  void on_cycle_end(CycleHook hook) override { hook_ = std::move(hook); }

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;
  // Gives the implementation back; what it has told stays.
  void end() override;

 private:
  struct Order {
    MasterOrder order;
    std::vector<std::uint16_t> operands;
    kernel::Time now;
  };

  void order(Order order);
  void tell(const Order& order);
  template <typename Call>
  void call(kernel::Time now, Call&& call);
  template <typename Call>
  void call_and_order(kernel::Time now, Call&& call);

  void tell(std::span<const iut::Character> telegrams, kernel::Time now);
  void drive(unsigned port, line::Waveform& wave);
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override;
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(iut::Item item, kernel::Time when) override;
  void keep(iut::Item item, std::uint64_t value);
  void end_cycle(std::uint64_t value, kernel::Time when);
  std::uint16_t image(iut::Item first, unsigned word) const;
  std::string error_text() const;

  std::optional<iut::AttachedCase> attached_;
  std::unique_ptr<TelegramFront> front_;  // of one that hears telegrams
  segment::Port* out_ = nullptr;
  CycleHook hook_;
  bool is_supplied_ = false;
  bool is_called_ = false;
  bool has_driven_ = false;   // since the last cycle ended
  bool is_ordered_ = false;   // the call tells an order
  std::deque<Order> orders_;  // of the hook
  std::vector<std::uint64_t> kept_;
};

class ServedMaster final : public iut::ServedStation<MasterDevice> {
 public:
  using Make = std::function<std::unique_ptr<MasterDevice>(const MasterConfiguration&)>;
  explicit ServedMaster(Make make) : make_(std::move(make)) {}

  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override;
  void set_power(bool, kernel::Time) override {}
  void receive(unsigned port, const line::Waveform& reception) override {
    act(reception.start, [&] { station().receive(port, reception); });
  }
  // Throws kernel::Error for an order that there is not.
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override;

 private:
  void after_call() override { tell(); }
  void obey(MasterOrder order, unsigned word, std::uint16_t value, kernel::Time now);
  void tell();
  void tell_error(const std::string& sentence);
  void tell_stations(const MasterStatus& status);
  void tell_images(const MasterStatus& status);
  void keep(unsigned item, std::uint64_t value);

  Make make_;
  std::vector<std::uint64_t> told_;  // by item, as the bench was told them
  unsigned told_words_ = 0;
};

// The role as benches and attachments know it.
struct MasterRole {
  using Device = MasterDevice;
  using Configuration = MasterConfiguration;
  using Attached = AttachedMaster;
  using Served = ServedMaster;
  static constexpr const char* protocol = "interbus";
  static constexpr const char* role = "master";
};

}  // namespace fieldproof::interbus
