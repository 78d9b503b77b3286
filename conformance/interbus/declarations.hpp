#pragma once

#include <vector>

#include "harness/judge/pics.hpp"
#include "protocols/interbus/device.hpp"
#include "protocols/interbus/rules.hpp"

namespace fieldproof::interbus {
struct RingPlace;
struct StationDescription;
}  // namespace fieldproof::interbus

// What is declared of a slave and of a master in a PICS.
namespace fieldproof::conformance {

enum class OutputsWhileReset : std::uint8_t { held, cleared };

struct SlaveDeclaration {
  interbus::SlaveConfiguration configuration{};
  bool inputs = false;
  bool outputs = false;
  bool remote_interface = true;
  bool reconfiguration_button = true;
  bool peripheral_fault_input = true;
  bool any_length_code = true;
  bool other_settings = true;
  OutputsWhileReset outputs_while_outgoing_bus_is_reset = OutputsWhileReset::held;
};

// What a PICS of a slave may answer.
// Throws kernel::Error(configuration) for rules by which what no line can do without, the silence within a
// cycle and after it, is a reset already.
void expect_time_for_silences(const interbus::Rules& rules);

std::vector<judge::PicsItem> slave_pics_items();
// What a station of the bench declares about itself: an answer to each of these items.
judge::Pics declared_slave(const interbus::SlaveConfiguration& configuration);
// Gives a station the ID code, the register length and the second interface that a PICS declares; what is not
// answered stays. Throws kernel::Error for a length that the length code contradicts.
void declare_station(interbus::StationDescription& station, const judge::Pics& pics,
                     const interbus::Rules& rules);
// Throws kernel::Error for a station that is there and is not as declared.
void expect_as_declared(const interbus::RingPlace& place, const judge::Pics& pics);

enum class BelowMinimum : std::uint8_t { clipped, refused };
enum class OutputsAfterBusStop : std::uint8_t { zero, held };
enum class LineAfterStop : std::uint8_t { silent, status_telegrams };

struct MasterDeclaration {
  BelowMinimum request_below_minimum{};
  OutputsAfterBusStop outputs_after_bus_stop{};
  LineAfterStop line_after_stop{};
};

std::vector<judge::PicsItem> master_pics_items();
judge::Pics declared_master();

}  // namespace fieldproof::conformance
