#pragma once

#include <array>
#include <string_view>

// What the upper tester sees of an INTERBUS network, by the names under which the trace is told: they enter
// the fingerprint, and the rules of fault plans can wait for them.
namespace fieldproof::interbus {

inline constexpr std::string_view kOutputChanged = "output";  // of a slave: see ring.hpp
// The end of a cycle as a master tells it to its application.
inline constexpr std::string_view kDataCycleAccepted = "data_cycle_accepted";
inline constexpr std::string_view kDataCycleRejected = "data_cycle_rejected";
inline constexpr std::string_view kIdCycleAccepted = "id_cycle_accepted";
inline constexpr std::string_view kIdCycleRejected = "id_cycle_rejected";

constexpr std::string_view observed_cycle_end(bool is_data_cycle, bool is_accepted) {
  if (is_data_cycle) return is_accepted ? kDataCycleAccepted : kDataCycleRejected;
  return is_accepted ? kIdCycleAccepted : kIdCycleRejected;
}

inline constexpr std::array<std::string_view, 5> kObservations = {
    kOutputChanged, kDataCycleAccepted, kDataCycleRejected, kIdCycleAccepted, kIdCycleRejected};

}  // namespace fieldproof::interbus
