// The network reader fed with arbitrary octets. Invariants: a text is either a network or refused with
// kernel::Error(configuration) at a place in the file; what is read keeps its own limits, has a ring whose
// places refer to earlier ones, and has a cycle time under every formula.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "harness/config/document.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/timing.hpp"

namespace {

using fieldproof::config::Document;
using fieldproof::interbus::NetworkDescription;
using fieldproof::kernel::Duration;
using fieldproof::kernel::Error;
using fieldproof::kernel::ErrorKind;

constexpr std::string_view kName = "fuzz.json";

void check_ring(const NetworkDescription& network) {
  const auto ring = fieldproof::interbus::ring_order(network);
  FIELDPROOF_CHECK(ring.size() <= network.rules.max_stations, "a file keeps to the number of stations");
  std::size_t points = 0;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    FIELDPROOF_CHECK(ring[n].before >= -1 && ring[n].before < static_cast<int>(n),
                     "the ring only looks back");
    FIELDPROOF_CHECK(ring[n].level < network.rules.max_levels, "a file keeps to the number of levels");
    points += std::size_t{16} * ring[n].words;
  }
  FIELDPROOF_CHECK(points <= network.rules.max_io_points, "a file keeps to the number of points");
}

void check_times(const NetworkDescription& network) {
  const auto input = fieldproof::interbus::timing_input(network);
  for (const auto& description : fieldproof::interbus::formulas()) {
    FIELDPROOF_CHECK(fieldproof::interbus::cycle_time(description.formula, input) > Duration::zero(),
                     "every cycle takes time");
  }
  FIELDPROOF_CHECK(fieldproof::interbus::structural_cycle_time(network) >= network.rules.software_time,
                   "a cycle has the software time of the master in it");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const Document document =
        Document::parse(std::string(reinterpret_cast<const char*>(data), size), std::string(kName));
    const NetworkDescription network = NetworkDescription::read(document.root());
    FIELDPROOF_CHECK(!fieldproof::interbus::check(network), "what is read is a network");
    check_ring(network);
    check_times(network);
  } catch (const Error& error) {
    FIELDPROOF_CHECK(error.kind() == ErrorKind::configuration, "a bad file is a configuration error");
    FIELDPROOF_CHECK(std::string_view(error.what()).starts_with(std::string(kName) + ":"),
                     "an error of a file begins with its name");
  }
  return 0;
}
