#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "harness/segment/process_words.hpp"
#include "protocols/interbus/device.hpp"

// The terminals of a simulated slave: its process words, and what it can be told about its periphery.
namespace fieldproof::interbus {

class TerminalBlock : public Terminals, public segment::ProcessWords {
 public:
  using Condition = std::function<bool(kernel::Time)>;
  using ProcessWords::output;
  using ProcessWords::ProcessWords;

  void set_peripheral_fault(Condition condition) { peripheral_fault_ = std::move(condition); }
  void set_reconfiguration(Condition condition) { reconfiguration_ = std::move(condition); }

  std::uint16_t input(unsigned word, kernel::Time when) override { return ProcessWords::input(word, when); }
  void output(unsigned word, std::uint16_t value, kernel::Time when) override { write(word, value, when); }
  bool has_peripheral_fault(kernel::Time when) override {
    return peripheral_fault_ && peripheral_fault_(when);
  }
  bool wants_reconfiguration(kernel::Time when) override {
    return reconfiguration_ && reconfiguration_(when);
  }

 private:
  Condition peripheral_fault_;
  Condition reconfiguration_;
};

}  // namespace fieldproof::interbus
