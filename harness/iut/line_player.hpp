#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <variant>
#include <vector>

#include "harness/iut/device.hpp"
#include "harness/iut/serial_line.hpp"
#include "harness/iut/uart_line.hpp"
#include "harness/line/character.hpp"

// Plays a station on a serial line in wall-clock time, as a box would: what WallClockDevice is attached to
// when there is no box. The station lives in instants of its own: characters have ended when they were read,
// what it wants to do at an instant is done as soon as the clock of the machine is there. How late the system
// made it is reported through the upper channel, of which this is the Device.
namespace fieldproof::iut {

class LinePlayer final : public Device, private Bench {
 public:
  // Of levels, in the role.
  using MakeStation = std::function<std::unique_ptr<Device>(const CaseBegin& begin)>;

  // The line must outlive the player. `inputs`: the items that a station of the role reads.
  LinePlayer(SerialLine& line, MakeUartLine make_uart, std::vector<Item> inputs, MakeStation make_station)
      : line_(line),
        make_uart_(make_uart),
        inputs_(std::move(inputs)),
        make_station_(std::move(make_station)) {}

  // Without an upper channel: this station, powered from now on.
  void begin_alone(const CaseBegin& begin);
  // Goes on until the descriptor can be read; for ever with -1.
  void play(int descriptor);

  // ---- the upper channel ----
  UnitKind unit_kind() const override { return UnitKind::characters; }
  bool begin(const CaseBegin& begin, Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(unsigned port, std::span<const Character> characters, kernel::Time now) override;
  void receive(unsigned port, const line::Waveform& reception) override;
  // Has gone on until then, and reports what has happened.
  void on_time(kernel::Time until) override;
  kernel::Time next_time() const override;
  void end() override;

 private:
  // Characters without a gap, with the driver around them.
  struct Block {
    UartTransmission transmission;
    kernel::Time end{};  // of the last stop bit
  };
  struct Write {
    Item item;
    std::uint64_t value;
    kernel::Time when;
  };
  using Report = std::variant<Write, UartTransmission>;

  bool start(const CaseBegin& begin);
  void set_line(const CaseBegin& begin);
  void look_at_inputs();
  // Waits until then at most, or for what comes first, and does what is due.
  void turn(kernel::Time until, int descriptor);
  void receive(const Arrival& arrival);
  // The station acts up to this instant; characters that are over are put on the line.
  void advance(kernel::Time until);
  void put_on_line(const Block& block);
  void add(Report report);
  void report();

  // ---- the station ----
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override;
  void transmit(unsigned port, line::Waveform& wave) override;
  void write(Item item, std::uint64_t value, kernel::Time when) override;
  std::uint64_t read(Item item, kernel::Time when) override;

  SerialLine& line_;
  MakeUartLine make_uart_;
  std::vector<Item> inputs_;
  MakeStation make_station_;
  WallClock clock_;
  std::unique_ptr<Device> station_;
  UartLine uart_;
  std::unique_ptr<line::CharacterCode> code_;
  std::unique_ptr<line::CharacterReceiver> receiver_;
  Bench* bench_ = nullptr;
  bool is_supplied_ = false;
  kernel::Time now_{};  // of the station
  kernel::Time driven_until_{};
  kernel::Time driver_on_{};
  std::map<Item, std::uint64_t> values_;  // of the inputs, as they were last looked at
  std::deque<Block> blocks_;
  std::deque<Report> reports_;
  std::uint64_t received_ = 0;  // octets
  std::uint64_t sent_ = 0;
};

}  // namespace fieldproof::iut
