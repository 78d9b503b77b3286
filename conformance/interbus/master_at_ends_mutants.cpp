#include "conformance/interbus/master_at_ends_mutants.hpp"

#include <algorithm>

#include "conformance/interbus/master_at_ends_seeded_faults.hpp"

namespace fieldproof::conformance {
namespace {

std::vector<MasterMutants::Row> rows_of_settings() {
  using namespace seeded_faults;
  using interbus::Rules;
  return {{"receives_1024_telegrams", "", "has room for 1024 telegrams of a cycle that come back",
           mutant<Receives1024Telegrams>()},
          {"end_telegrams_in_8_bits", "", "sends as many end telegrams as eight bits of their number say",
           with_rules<interbus::Master>([](Rules& rules) { rules.end_telegrams &= 0xFFU; })},
          {"waits_for_usual_stations", "", "waits for stations of 3 bits each, whatever they are set to",
           with_rules<interbus::Master>([](Rules& rules) {
             rules.forward_delay_half_bits = rules.return_delay_half_bits = Rules{}.forward_delay_half_bits;
           })},
          {"waits_for_usual_cable", "", "waits for 12.8 km of cable at most, whatever is set",
           with_rules<interbus::Master>(
               [](Rules& rules) { rules.max_cable_m = std::min(rules.max_cable_m, Rules{}.max_cable_m); })},
          {"cycle_time_in_us", "", "keeps the cycle time that is requested in microseconds",
           mutant<CycleTimeInMicroseconds>()},
          {"silence_in_32_bits", "", "keeps the silence of a start in 32 bits of nanoseconds",
           with_rules<interbus::Master>(
               [](Rules& rules) { rules.silence_limit %= (std::int64_t{1} << 32) * kernel::kNanosecond; })},
          {"local_off_bit_kept", "", "switches OUT2 off by 0002h, whatever it is set to",
           with_rules<interbus::Master>(
               [](Rules& rules) { rules.control_local_off = Rules{}.control_local_off; })}};
}

std::vector<MasterMutants::Row> rows_of_rings_and_orders() {
  using namespace seeded_faults;
  return {{"guards_6_bits", "", "sees one telegram too many only within 6 bits after the last one",
           mutant<Guards6Bits>()},
          {"low_octet_and_length_compared", "", "compares the low octet and the length of an ID code",
           mutant<LowOctetAndLengthCompared>()},
          {"station_before_in_8_bits", "", "names the station before as eight bits of its number say",
           mutant<StationBeforeIn8Bits>()},
          {"located_by_id_code", "", "looks for a fault by ID codes, not by where stations hang",
           mutant<LocatedByIdCode>()},
          {"ring_delay_kept", "", "keeps the delay of the ring of its first start", mutant<RingDelayKept>()},
          {"counters_go_on", "", "goes on with its counters over a start", mutant<CountersGoOn>()},
          {"locates_at_once", "", "reports that it looks for a fault while the silence lasts",
           mutant<LocatesAtOnce>()},
          {"start_ignored_in_silence", "", "ignores a start in the silence of a bus stop",
           mutant<StartIgnoredInSilence>()},
          {"last_order_only", "", "of outputs that are ordered at one end of a cycle takes the last one only",
           mutant<LastOrderOnly>()},
          {"early_output_sent", "", "sends an output that was written before it ran, in one cycle",
           mutant<EarlyOutputSent>()}};
}

}  // namespace

std::vector<MasterMutants::Row> master_rows_at_ends() {
  std::vector<MasterMutants::Row> rows = rows_of_settings();
  for (MasterMutants::Row& row : rows_of_rings_and_orders()) rows.push_back(std::move(row));
  return rows;
}

}  // namespace fieldproof::conformance
