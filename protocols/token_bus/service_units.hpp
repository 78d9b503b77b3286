#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "harness/segment/station.hpp"
#include "protocols/token_bus/service_signals.hpp"

// What comes and goes on a side of a translator or of a channel manager, unit by unit: waves in, waves out.
namespace fieldproof::token_bus {

// One unit of an input.
struct ServiceUnit {
  kernel::Time begin{};
  kernel::Time end{};
  std::int64_t rate = 0;  // of its four levels
};

// What arrived on one side and has not been worked through.
class ServiceInput {
 public:
  void clear() { waves_.clear(); }
  void add(line::Waveform wave);
  bool empty() const { return waves_.empty(); }
  // Of the next unit.
  const ServiceUnit& front() const { return front_; }
  const line::Levels& levels() const { return waves_.front().levels; }
  std::size_t number() const { return taken_; }  // of the next unit, in these levels
  void pop();
  // Of so many units, or of those that follow each other.
  kernel::Time end_of_piece(std::size_t units) const;

 private:
  void begin_wave();

  std::deque<line::Waveform> waves_;
  std::size_t taken_ = 0;  // of the first wave
  ServiceUnit front_{};    // asked for far more often than it changes
};

// What is to be driven on one side: units that follow each other are one transmission.
class ServiceOutput {
 public:
  void wire(segment::Port& port) { port_ = &port; }
  void clear() { waves_.clear(); }
  void append(kernel::Time begin, std::int64_t rate, std::uint64_t levels, unsigned count);
  void drive(kernel::Time now);

 private:
  segment::Port* port_ = nullptr;
  std::vector<line::Waveform> waves_;
  kernel::Time driven_until_ = kernel::kStart;
};

}  // namespace fieldproof::token_bus
