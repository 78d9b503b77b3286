// The cycle decoders fed with arbitrary telegrams: what a master collects of a returned cycle and what it
// makes of it, and the section of the shift register through which a slave sees a cycle.
//
// Input: what is expected (words, kind of cycle, whether a check repairs itself), then a telegram in two
// octets each: header, data. With the repair the last four telegrams become a right check and a clean status,
// so that inputs get past the frame check. Invariants: a master accepts exactly what the definition of a
// cycle accepts; the octets are the ones that came; a register gives back what was put in, as many octets
// later as it is long; both checks are those of a bit-by-bit computation.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "fuzz/octet_reader.hpp"
#include "fuzz/reference_line.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/interbus/cycle_frame.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/returned_cycle.hpp"
#include "protocols/interbus/shift_line.hpp"

namespace {

using fieldproof::fuzz::check_bit_by_bit;
using fieldproof::fuzz::OctetReader;
using fieldproof::interbus::kTrailerOctets;
using fieldproof::interbus::Master;
using fieldproof::interbus::MasterConfiguration;
using fieldproof::interbus::ReturnedCycle;
using fieldproof::interbus::ShiftLine;
using fieldproof::line::Telegram;

constexpr std::size_t kMostTelegrams = 96;
constexpr std::size_t kMostTransferOctets = 64;
constexpr unsigned kLoopbackHigh = 0xA5;
constexpr unsigned kLoopbackLow = 0x5A;

// The decisions of the reference about a cycle, one by one.
class Judge final : public Master {
 public:
  Judge() : Master(MasterConfiguration{}) {}
  bool accepts(const ReturnedCycle& cycle, std::size_t loopback) const {
    return accepts_count(cycle) && accepts_framing(cycle) && accepts_phases(cycle) &&
           accepts_loopback(cycle, loopback) && accepts_status(cycle.status()) && accepts_check(cycle);
  }
  const fieldproof::line::FrameCheck16& frame_check() const { return check(); }
};

struct Telegrams {
  std::array<Telegram, kMostTelegrams> items;
  std::size_t count = 0;
};

struct Expectation {
  std::size_t transfer = 0;  // octets, loopback word included
  std::size_t loopback = 0;  // where that begins
  bool is_id_cycle = false;
  bool repairs = false;

  std::size_t telegrams() const { return transfer + kTrailerOctets; }
};

Expectation read_expectation(OctetReader& input) {
  const std::uint8_t first = input.octet();
  Expectation expected;
  expected.is_id_cycle = (first & 0x80) != 0;
  expected.repairs = (first & 0x40) != 0;
  expected.transfer = 2 + std::size_t{first & 0x1FU} * 2;
  expected.loopback = expected.transfer - 2;
  if ((first & 0x20) != 0 && expected.is_id_cycle) expected.loopback = input.octet() % expected.transfer;
  return expected;
}

void read_telegrams(OctetReader& input, Telegrams& telegrams) {
  for (telegrams.count = 0; telegrams.count < kMostTelegrams && input.size() >= 2; ++telegrams.count) {
    Telegram& telegram = telegrams.items[telegrams.count];
    telegram.header = (input.octet() & 0xF) ^ fieldproof::line::kDataTelegram;
    telegram.data = input.octet();
    telegram.level = 0;
  }
}

FIELDPROOF_UNINSTRUMENTED std::uint16_t check_of(const Telegrams& telegrams, std::size_t count) {
  std::array<std::uint8_t, kMostTelegrams> octets;
  for (std::size_t n = 0; n < count; ++n) octets[n] = telegrams.items[n].data;
  return check_bit_by_bit({octets.data(), count});
}

// Gives the last four telegrams of an expected cycle the check of those before and a clean status.
FIELDPROOF_UNINSTRUMENTED void repair(Telegrams& telegrams, const Expectation& expected) {
  if (!expected.repairs || telegrams.count < expected.transfer) return;
  telegrams.count = std::max(telegrams.count, expected.telegrams());
  const std::uint16_t check = check_of(telegrams, expected.transfer);
  for (std::size_t n = 0; n < kTrailerOctets; ++n) {
    Telegram& telegram = telegrams.items[expected.transfer + n];
    telegram.header = static_cast<std::uint8_t>(6 | (expected.is_id_cycle ? 1 : 0));
    telegram.data = static_cast<std::uint8_t>(n == 0 ? check >> 8 : n == 1 ? check & 0xFF : 0);
  }
}

// By the definition: exactly these telegrams, each complete and of its phase, the loopback word in its place,
// the check of all octets before it, a clean status.
FIELDPROOF_UNINSTRUMENTED bool is_acceptable(const Telegrams& telegrams, const Expectation& expected) {
  if (telegrams.count != expected.telegrams()) return false;
  const unsigned select = expected.is_id_cycle ? 1 : 0;
  for (std::size_t n = 0; n < telegrams.count; ++n) {
    const unsigned control = n < expected.transfer ? 0 : 2;
    if ((telegrams.items[n].header & ~4U) != (select | control)) return false;
  }
  const auto octet = [&](std::size_t n) FIELDPROOF_UNINSTRUMENTED { return telegrams.items[n].data; };
  const std::size_t t = expected.transfer;
  return octet(expected.loopback) == kLoopbackHigh && octet(expected.loopback + 1) == kLoopbackLow &&
         (octet(t) << 8 | octet(t + 1)) == check_of(telegrams, t) && octet(t + 2) == 0 && octet(t + 3) == 0;
}

void collect(ReturnedCycle& cycle, const Telegrams& telegrams, const Expectation& expected) {
  cycle.begin(expected.telegrams(), expected.transfer, expected.is_id_cycle);
  for (std::size_t n = 0; n < telegrams.count; ++n) {
    const bool is_last = cycle.add(telegrams.items[n]);
    FIELDPROOF_CHECK(is_last == (n + 1 == expected.telegrams()), "one telegram is the last expected one");
  }
  cycle.finish();
  FIELDPROOF_CHECK(cycle.count() == telegrams.count, "every data telegram counts once");
}

void check_octets(const ReturnedCycle& cycle, const Telegrams& telegrams) {
  const auto transfer = cycle.transfer();
  for (std::size_t n = 0; n < transfer.size(); ++n) {
    const unsigned right = n < telegrams.count ? telegrams.items[n].data : 0;
    FIELDPROOF_CHECK(transfer[n] == right, "the octets are the ones that came, and 0 for the others");
  }
}

void shift_through(ShiftLine& line, const Telegrams& telegrams, std::size_t length,
                   const fieldproof::line::FrameCheck16& check) {
  std::array<std::uint8_t, kMostTransferOctets + kMostTelegrams> octets{};
  const auto loaded = line.load(length, check.start());
  for (std::size_t n = 0; n < length; ++n) {
    loaded[n] = octets[n] = static_cast<std::uint8_t>(n * 37 + length);
  }
  for (std::size_t n = 0; n < telegrams.count; ++n) {
    octets[length + n] = telegrams.items[n].data;
    FIELDPROOF_CHECK(line.shift(telegrams.items[n].data, check) == octets[n],
                     "an octet leaves a register as late as it is long");
  }
  const std::size_t count = telegrams.count;
  FIELDPROOF_CHECK(std::ranges::equal(line.held(), std::span(octets).subspan(count, length)),
                   "a register holds the last octets");
  FIELDPROOF_CHECK(check.finish(line.received_check(check)) == check_bit_by_bit({&octets[length], count}),
                   "the received check is that of what came in");
  FIELDPROOF_CHECK(check.finish(line.sent_check(check)) == check_bit_by_bit({octets.data(), count}),
                   "the sent check is that of what went out");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 2 * kMostTelegrams + 2) return -1;
  static const Judge judge;
  static ReturnedCycle cycle;
  static ShiftLine line(kMostTransferOctets);
  static Telegrams telegrams;
  OctetReader input(data, size);
  const Expectation expected = read_expectation(input);
  read_telegrams(input, telegrams);
  repair(telegrams, expected);
  collect(cycle, telegrams, expected);
  check_octets(cycle, telegrams);
  FIELDPROOF_CHECK(judge.accepts(cycle, expected.loopback) == is_acceptable(telegrams, expected),
                   "a cycle is accepted when it is one");
  shift_through(line, telegrams, expected.loopback, judge.frame_check());
  return 0;
}
