#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/kernel/time.hpp"
#include "protocols/interbus/rules.hpp"

// A network as a file describes it: the remote bus as a list of stations in the order of the cable, each with
// the stations after its second outgoing interface (local bus or branch), the cable lengths, the bit rate,
// the formula that its cycle time is held against, and the copy task of the master.
//
// Reading is strict (network.schema.json has the shape); an unknown key, an undefined length code, too many
// stations, levels or points is a kernel::Error that names line and pointer and says what would be right.
// A description that a program builds is free: `check` tells what a file with it would be refused for.
namespace fieldproof::interbus {

struct StationDescription {
  std::string name;
  std::uint16_t id_code = 0;                 // bits 0..12; the register length follows from its length code
  double cable_m = 0;                        // from the station before it; 0 on a local bus
  bool is_local = false;                     // behind a second outgoing interface on logic-level lines
  std::vector<StationDescription> branch{};  // behind the second outgoing interface, in order
  // What a program says of a station of its own, no file: the register length where the length code says
  // none, and a second outgoing interface with nothing plugged in.
  std::optional<unsigned> words{};
  bool has_branch = false;
};

// Input word `input_word` of station `from` goes to output word `output_word` of station `to`, after each
// valid data cycle.
struct CopyRule {
  std::string from;
  unsigned input_word = 0;
  std::string to;
  unsigned output_word = 0;
};

// The published cycle-time formulas, see timing.hpp.
enum class Formula { f1, f2, f3, f4, f5 };

struct NetworkDescription {
  std::string name;
  Rules rules;  // bit rate, software time, end telegrams ... as the file sets them
  Formula formula = Formula::f4;
  std::optional<kernel::Duration> cycle_time;  // requested; the shortest possible when absent
  std::vector<StationDescription> stations;
  std::vector<CopyRule> copy;

  // Throw kernel::Error(configuration) for what is not a network within its own limits.
  static NetworkDescription load(const std::filesystem::path& path);
  static NetworkDescription read(const config::Value& root);
};

// Why a description is no network: the place as the JSON pointer that it has in a file, and what is wrong
// and would be right.
struct Violation {
  std::string pointer;
  std::string sentence;
};

// The first violation in the order of the file: names (not empty, unique), length codes, the kind of bus, the
// limits of `network.rules` on stations, levels, points and cable, and the copy task (stations that exist,
// words that they have, from inputs to outputs, no output written twice).
std::optional<Violation> check(const NetworkDescription& network);

// A station in the order of the ring: a station, what lies after its second interface, then the next one.
struct RingPlace {
  const StationDescription* station = nullptr;
  int before = -1;         // index of the station whose outgoing interface it hangs on; -1: the master
  bool on_branch = false;  // on the second outgoing interface of `before`
  unsigned level = 0;      // depth of branches
  unsigned words = 0;      // register length; 0 also for an undefined length code
};

// The places point into `network`, which must outlive them and stay as it is.
std::vector<RingPlace> ring_order(const NetworkDescription& network);

// Direction bits of an ID code.
constexpr bool has_outputs(std::uint16_t id_code) {
  return (id_code & 0x1U) != 0;
}
constexpr bool has_inputs(std::uint16_t id_code) {
  return (id_code & 0x2U) != 0;
}

// `words` of a length code under these rules; nothing for an undefined code. And the code for a length.
std::optional<unsigned> words_of_id_code(std::uint16_t id_code, const Rules& rules);
std::optional<std::uint8_t> length_code_of(unsigned words, const Rules& rules);

}  // namespace fieldproof::interbus
