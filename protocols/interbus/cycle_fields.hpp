#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/fault/fields.hpp"
#include "harness/line/telegram_receiver.hpp"
#include "protocols/interbus/rules.hpp"

// Where the fields of INTERBUS lie on one link, for the rules of fault plans.
//
// Frames are "data_cycle", "id_cycle" and "status" (one status telegram), each counted from 1 on this
// receiver. Units are telegrams, counted from 0 within the cycle. Fields are the parts of a telegram,
// "start", "select", "control", "flag" and "stop", and its eight data levels under the name of what they
// carry at this place of the ring: "data" (or "id"), "lbw", "check", "status_word", "end".
namespace fieldproof::interbus {

class CycleFields final : public fault::FieldMap {
 public:
  // Octets that leave the ring in front of the loopback word at this receiver: those of the registers of all
  // stations before it, in a data cycle and in an ID cycle.
  struct InFront {
    unsigned data_octets = 0;
    unsigned id_octets = 0;
  };

  CycleFields(const Rules& rules, InFront in_front);

  // Every name that `locate` can give.
  static std::vector<std::string> frame_kinds();
  static std::vector<std::string> fields();

  void locate(const line::Waveform& sent, std::vector<fault::Span>& spans) override;

 private:
  void add(const line::Telegram& telegram, std::vector<fault::Span>& spans);
  std::string_view data_field(bool is_id) const;

  InFront in_front_;
  const line::TelegramCode& code_;
  std::int64_t bit_rate_;
  std::array<std::string_view, 3> header_fields_;  // in the order of the line
  bool is_checking_ = false;
  bool is_id_cycle_ = false;
  bool is_in_cycle_ = false;
  std::uint64_t data_cycles_ = 0;
  std::uint64_t id_cycles_ = 0;
  std::uint64_t status_telegrams_ = 0;
  std::uint32_t unit_ = 0;
  std::uint32_t check_unit_ = 0;
};

}  // namespace fieldproof::interbus
