#pragma once

#include <cstdint>

#include "conformance/valve_bus/host_side.hpp"

// What sequences do to a host at length, during an attempt, or with its supply. Everything has ended before
// each of them begins. `judge`: of what the reference need not show; null: of nothing.
namespace fieldproof::conformance {

// A write of which the first attempts are acknowledged wrongly, where the host waits for acknowledges.
void order_acknowledged(HostSide& side, std::uint8_t id, unsigned attempts, Acknowledge how);
// So many reads, one of which always waits, beside the refreshes of a write.
void poll_without_end(HostSide& side, std::uint8_t id, unsigned count);
// Two writes to a node, the second so much after the first, and so many refreshes: their period.
void follow_refreshes(HostSide& side, std::uint8_t id, kernel::Duration between, unsigned count,
                      CaseJudge* judge);
// The line is not silent while refreshes are due.
void talk_over_refreshes(HostSide& side);
// Each of so many nodes is written to, and refreshed.
void write_to_many(HostSide& side, unsigned nodes);
// Octets of a command, and the supply goes and comes.
void cut_part(HostSide& side, unsigned count);
// Two writes to a node at once; read back, the n-th is other data than written.
void write_twice(HostSide& side, std::uint8_t id, unsigned wrong);
// A read all attempts of which are answered wrongly; then comes another read, or a frame that is late.
void reject_all(HostSide& side, std::uint8_t id, bool is_late, CaseJudge* judge);
// A read that nobody answers, and so many frames after its end.
void say_late(HostSide& side, std::uint8_t id, unsigned count);
// While a read waits for its response the PC orders so many writes.
void order_meanwhile(HostSide& side, std::uint8_t id, unsigned tenths, unsigned count);

}  // namespace fieldproof::conformance
