#pragma once

#include <cstddef>
#include <cstdint>

#include "conformance/fieldbus_dll/driven_dlpdus.hpp"
#include "protocols/fieldbus_dll/ff_dlpdu.hpp"

// How the model of a scheduler reads the octets of what is said: it shares nothing with the stations but
// their numbers.
namespace fieldproof::conformance {

inline constexpr unsigned kLongOfLas = 0x08;

inline bool has_las_code(const DrivenDlpdu& dlpdu, std::uint8_t code, unsigned free_bits) {
  return !dlpdu.octets.empty() && (dlpdu.octet(0) & ~free_bits) == code;
}

inline fieldbus_dll::FfAddress address_at(const DrivenDlpdu& dlpdu, std::size_t first, std::size_t count) {
  fieldbus_dll::FfAddress address = 0;
  for (std::size_t n = first; n < first + count; ++n) address = address << 8 | dlpdu.octet(n);
  return address;
}

inline fieldbus_dll::Priority priority_said(const DrivenDlpdu& dlpdu) {
  return static_cast<fieldbus_dll::Priority>(dlpdu.octet(0) & fieldbus_dll::kPriorityBits);
}

inline fieldbus_dll::FfAddress source_of_dt1(const DrivenDlpdu& dt1) {
  const std::size_t octets = (dt1.octet(0) & kLongOfLas) != 0 ? 4 : 2;
  return address_at(dt1, 1 + octets, octets);
}

inline unsigned grant_said(const DrivenDlpdu& pt) {
  return static_cast<unsigned>(pt.octet(2) << 8 | pt.octet(3));
}

}  // namespace fieldproof::conformance
