

#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/network_bench.hpp"
#include "conformance/interbus/slave_mutants.hpp"

// Networks that misbehave: one of their stations is a mutant of its role, or one number of the rules is
// not that of the description.
namespace fieldproof::conformance {
namespace {

NetworkParts with_master(std::string_view mutant) {
  return {.make_master = master_mutants().maker(mutant), .make_slave = nullptr, .change_network = nullptr};
}

// The mutant sits at the end of the ring.
NetworkParts with_last_slave(std::string_view mutant, std::size_t stations) {
  const auto last = static_cast<int>(stations);
  return {.make_master = nullptr,
          .make_slave =
              [mutant, last](int position, const interbus::SlaveConfiguration& configuration) {
                return position == last ? slave_mutants().make(mutant, configuration) : nullptr;
              },
          .change_network = nullptr};
}

NetworkParts with_change(std::function<void(interbus::NetworkDescription&)> change) {
  return {.make_master = nullptr, .make_slave = nullptr, .change_network = std::move(change)};
}

interbus::StationDescription& last_station(std::vector<interbus::StationDescription>& stations) {
  interbus::StationDescription& last = stations.back();
  return last.branch.empty() ? last : last_station(last.branch);
}

std::vector<NetworkMutants::Row> network_rows() {
  return {
      {"slave_declares_another_id_code", "", "the last station has another type in its ID code",
       [](std::size_t) {
         return with_change(
             [](interbus::NetworkDescription& n) { last_station(n.stations).id_code ^= 0x0010; });
       }},
      {"master_misses_branches", "", "the master never looks after a second outgoing interface",
       [](std::size_t) { return with_master("branches_not_searched"); }},
      {"master_sends_first_station_first", "", "the master sends the outputs of the first station first",
       [](std::size_t) { return with_master("first_station_first"); }},
      {"slave_swaps_octets", "", "the last station swaps the octets of its output words",
       [](std::size_t stations) { return with_last_slave("output_octets_swapped", stations); }},
      {"master_copies_one_cycle_late", "", "the master copies the inputs of the cycle before",
       [](std::size_t) { return with_master("copied_one_cycle_late"); }},
      {"master_has_generation_3", "", "the master's chip is of generation 3: 700 us of software time",
       [](std::size_t) {
         return with_change(
             [](interbus::NetworkDescription& n) { n.rules.software_time = 700 * kernel::kMicrosecond; });
       }},
      {"master_leaves_no_gaps", "", "the master leaves no gap between telegrams",
       [](std::size_t) { return with_master("telegrams_without_gap"); }},
      {"master_wanders", "", "the master starts every second cycle late",
       [](std::size_t) { return with_master("cycle_start_wanders"); }},
      {"slave_sends_check_of_what_it_received", "", "the last station sends the check of what it received",
       [](std::size_t stations) { return with_last_slave("sends_check_of_received_bits", stations); }},
      {"slave_latches_in_spite_of_its_check", "", "the last station takes over what comes with a wrong check",
       [](std::size_t stations) { return with_last_slave("latches_in_spite_of_own_error", stations); }},
      {"master_does_not_check", "", "the master does not compare the check of what came back",
       [](std::size_t) { return with_master("own_check_ignored"); }},
      {"master_falls_silent", "", "the master sends nothing any more after the first cycle that it rejects",
       [](std::size_t) { return with_master("silent_after_error"); }},
      {"master_identifies_for_ever", "",
       "the master sends ID cycles only after the first cycle that it rejects",
       [](std::size_t) { return with_master("id_cycles_for_ever_after_error"); }},
      {"master_rejects_large_changes", "",
       "the master rejects cycles in which more than three input bits change",
       [](std::size_t) { return with_master("implausible_inputs_rejected"); }},
      {"master_rejects_first_cycles", "", "the master rejects the first data cycles of a run",
       [](std::size_t) { return with_master("first_cycles_rejected"); }},
  };
}

}  // namespace

const NetworkMutants& network_mutants() {
  static const NetworkMutants table("network", {network_rows});
  return table;
}

}  // namespace fieldproof::conformance
