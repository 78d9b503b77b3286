#include <fmt/format.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"
#include "harness/line/frame_check.hpp"
#include "harness/line/manchester.hpp"

// What is no token for the IUT.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;
using line::Symbol;

void queue_something(IsaBench& bench) {
  bench.submit_unit_data(Priority::urgent, bench.numbered_data(4));
}

void tokens_of_others_are_left(IsaBench& bench, CaseJudge& judge) {
  queue_something(bench);
  for (int n = 0; n < bench.volume(20, 246); ++n) {
    const auto other = static_cast<std::uint8_t>(1 + (bench.address() + n) % 247);
    if (other == bench.address()) continue;
    Octets et = bench.et(Priority::time_available);
    Octets es = bench.es(Priority::time_available, 1'000);
    et[1] = es[1] = other;
    bench.send(et);
    expect_silence(bench, judge, "acts_on_others", "the ET is for another station");
    bench.send(es);
    expect_silence(bench, judge, "acts_on_others", "the ES is for another station");
  }
  expect_serves(bench, judge);
}

void single_bit_errors_are_seen(IsaBench& bench, CaseJudge& judge) {
  queue_something(bench);
  const Octets right = with_frame_check(bench.et(Priority::time_available));
  for (std::size_t bit = 0; bit < 8 * right.size(); ++bit) {
    Octets wrong = right;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (0x80U >> bit % 8));
    bench.send_half_bits(half_bits_of_frame(wrong));
    expect_silence(bench, judge, "acts_on_wrong_check", fmt::format("bit {} of the ET is wrong", bit));
  }
  expect_serves(bench, judge);
}

// The two octets that another variant of the check would have.
Octets check_of_variant(line::FrameCheckParameters parameters, const Octets& octets) {
  const auto check = static_cast<unsigned>(line::FrameCheck(parameters).compute(octets));
  return {static_cast<std::uint8_t>(check >> 8), static_cast<std::uint8_t>(check & 0xFF)};
}

void other_checks_are_refused(IsaBench& bench, CaseJudge& judge) {
  queue_something(bench);
  const line::FrameCheckParameters right = line::frame_check_named("CRC-16/PROFIBUS");
  line::FrameCheckParameters no_complement = right;
  no_complement.xorout = 0;
  line::FrameCheckParameters from_zero = right;
  from_zero.init = 0;
  line::FrameCheckParameters plain = from_zero;
  plain.xorout = 0;
  line::FrameCheckParameters reflected = right;
  reflected.refin = reflected.refout = true;
  const struct {
    std::string_view name;
    line::FrameCheckParameters parameters;
  } variants[]{
      {"without complement", no_complement},
      {"beginning with 0", from_zero},
      {"beginning with 0, without complement", plain},
      {"reflected", reflected},
      {"CCITT", line::frame_check_named("CRC-16/IBM-3740")},
      {"CCITT with complement", line::frame_check_named("CRC-16/GENIBUS")},
  };
  for (const Octets& dlpdu :
       {bench.et(Priority::time_available), bench.es(Priority::time_available, 1'000)}) {
    for (const auto& variant : variants) {
      Octets octets = dlpdu;
      for (const std::uint8_t octet : check_of_variant(variant.parameters, dlpdu)) octets.push_back(octet);
      bench.send_half_bits(half_bits_of_frame(octets));
      expect_silence(bench, judge, "acts_on_other_check", fmt::format("its check is one {}", variant.name));
    }
    Octets swapped = with_frame_check(dlpdu);
    std::swap(swapped[swapped.size() - 2], swapped[swapped.size() - 1]);
    bench.send_half_bits(half_bits_of_frame(swapped));
    expect_silence(bench, judge, "acts_on_other_check", "the octets of its check are exchanged");
  }
  expect_serves(bench, judge);
}

// The half bits of an ET with symbols that are no data in place of a bit of its second octet.
line::Levels with_violation(const line::Levels& frame, std::size_t bit, bool high) {
  constexpr std::size_t kBeforeOctets = 32;  // preamble and start delimiter
  line::Levels levels = frame;
  const std::size_t first = kBeforeOctets + 16 + 2 * bit;
  levels.set(first, high);
  levels.set(first + 1, high);
  return levels;
}

void broken_frames_are_left(IsaBench& bench, CaseJudge& judge) {
  queue_something(bench);
  const line::Levels right = half_bits_of_frame(with_frame_check(bench.et(Priority::time_available)));
  for (std::size_t bit = 0; bit < 8; ++bit) {
    for (const bool high : {true, false}) {
      bench.send_half_bits(with_violation(right, bit, high));
      expect_silence(bench, judge, "acts_on_violation",
                     fmt::format("bit {} of the address is N{}", bit, high ? '+' : '-'));
    }
  }
  bench.send_half_bits(right.slice(0, right.size() - 16));
  expect_silence(bench, judge, "acts_without_end", "the frame has no end delimiter");
  // Seven bits in the last octet: the last one is left out, the end delimiter follows.
  line::Levels short_octet = right.slice(0, right.size() - 18);
  short_octet.append(right, right.size() - 16, 16);
  bench.send_half_bits(short_octet);
  expect_silence(bench, judge, "acts_on_part_of_octet", "the last octet has seven bits");
  expect_serves(bench, judge);
}

void unknown_control_octets_are_left(IsaBench& bench, CaseJudge& judge) {
  queue_something(bench);
  constexpr unsigned kPriorities = 4;
  for (unsigned control = 0; control < 256; ++control) {
    const unsigned code = control & 0xF0U;
    const bool is_right = (control & 0x0CU) == 0 && control % kPriorities != 0 &&
                          (code == bench.rules().codes.et || code == bench.rules().codes.cd);
    if (is_right) continue;
    bench.send({static_cast<std::uint8_t>(control), bench.address(), IsaBench::kScheduler});
    expect_silence(bench, judge, "acts_on_unknown",
                   fmt::format("{:02X} with addresses is no token", control));
  }
  expect_serves(bench, judge);
}

void other_lengths_are_left(IsaBench& bench, CaseJudge& judge) {
  queue_something(bench);
  for (const Octets& right :
       {bench.et(Priority::time_available), bench.es(Priority::time_available, 1'000)}) {
    for (std::size_t size = 1; size <= right.size() + 3; ++size) {
      if (size == right.size()) continue;
      Octets wrong = right;
      wrong.resize(size);
      bench.send(wrong);
      expect_silence(bench, judge, "acts_on_other_length", fmt::format("it has {} octets", size));
    }
  }
  expect_serves(bench, judge);
}

}  // namespace

std::vector<IsaCase> isa_rejection_cases() {
  using link_sources::isa_paper;
  using link_sources::line;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/isa_dle/rejection/tokens_of_others_are_left",
        .purpose = "ISA-14",
        .requirement = "A station acts on tokens that are delegated to it, and on no others.",
        .reference = isa_paper("the token is delegated to a station"),
        .stimulus = "Data, and ET and ES to other stations.",
        .expected = "Silence.",
        .tags = {"must"},
        .catches = {{"takes_any_token", "acts_on_others"}}},
       tokens_of_others_are_left},
      {{.id = "fieldbus_dll/isa_dle/rejection/single_bit_errors_are_seen",
        .purpose = "ISA-15",
        .requirement = "A DLPDU whose frame check does not fit is ignored.",
        .reference = line("frame check 1DCF"),
        .stimulus = "An ET, each of its 40 bits wrong in turn.",
        .expected = "Silence; a right ET is served then.",
        .tags = {"must"},
        .catches = {{"short_frames_not_checked", "acts_on_wrong_check"}}},
       single_bit_errors_are_seen},
      {{.id = "fieldbus_dll/isa_dle/rejection/other_checks_are_refused",
        .purpose = "ISA-16",
        .requirement = "The frame check is that of the line: 1DCF, preset to ones, complemented, the high "
                       "octet first.",
        .reference = line("frame check 1DCF"),
        .stimulus = "ET and ES with checks of other kinds.",
        .expected = "Silence; a right ET is served then.",
        .tags = {"must"},
        .catches = {{"check_from_zero_too", "acts_on_other_check"}}},
       other_checks_are_refused},
      {{.id = "fieldbus_dll/isa_dle/rejection/broken_frames_are_left",
        .purpose = "ISA-17",
        .requirement =
            "A frame with symbols that are no data between its delimiters, without an end or with a "
            "part of an octet is ignored.",
        .reference = line("delimiters"),
        .stimulus = "N+ and N- in place of each bit of the second octet; no end delimiter; seven bits in the "
                    "last octet.",
        .expected = "Silence; a right ET is served then.",
        .tags = {"must"},
        .catches = {{"violations_are_bits", "acts_on_violation"},
                    {"stuck_behind_violation", "does_not_recover"}}},
       broken_frames_are_left},
      {{.id = "fieldbus_dll/isa_dle/rejection/unknown_control_octets_are_left",
        .purpose = "ISA-18",
        .requirement = "A DLPDU with a reserved bit or an unknown control octet is ignored.",
        .reference = own("control octets of the profile"),
        .stimulus = "All 250 control octets that make no ET and no CD, with right checks.",
        .expected = "Silence; a right ET is served then.",
        .tags = {"must"},
        .catches = {{"reserved_bit_ignored", "acts_on_unknown"}, {"priority_zero_taken", "acts_on_unknown"}}},
       unknown_control_octets_are_left},
      {{.id = "fieldbus_dll/isa_dle/rejection/other_lengths_are_left",
        .purpose = "ISA-18",
        .requirement = "An ET has five octets, an ES seven, with their checks.",
        .reference = own("encoding of the profile"),
        .stimulus = "ET and ES from one octet to three too many, with right checks.",
        .expected = "Silence; a right ET is served then.",
        .tags = {"must"},
        .catches = {{"length_not_checked", "acts_on_other_length"}}},
       other_lengths_are_left},
  };
}

}  // namespace fieldproof::conformance
