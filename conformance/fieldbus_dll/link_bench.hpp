#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/decoded_lines.hpp"
#include "conformance/fieldbus_dll/driven_dlpdus.hpp"
#include "conformance/line_bench.hpp"
#include "protocols/fieldbus_dll/link_rules.hpp"

// A link with one station under test (IUT) and the lower tester in the place of every other station, whatever
// the profile: what the benches of both have in common.
//
// The lower tester drives what the case says and hears what the IUT drives as it leaves it.
namespace fieldproof::conformance {

// Positions on the line are rounded to picoseconds, each for itself: limits are held to a nanosecond.
inline constexpr kernel::Duration kLinkRounding = kernel::kNanosecond;
// Of what fits exactly: by how much two sums of the same durations may differ. Nothing where an octet lasts
// whole picoseconds, as with all usual bit rates.
inline kernel::Duration rounding_of_sums(const fieldbus_dll::LinkRules& rules) {
  const bool is_whole = fieldbus_dll::octets(rules, 1) * rules.bit_rate == 8 * kernel::kSecond;
  return is_whole ? kernel::Duration{} : kLinkRounding;
}

// What schedules count in: an octet duration at 31.25 kbit/s.
inline constexpr kernel::Duration kOctetAt31250 = 256 * kernel::kMicrosecond;

// For lines of a bit rate each; a bench at another rate has none.
using LinkStresses = std::map<std::int64_t, std::vector<fault::Stress>>;

class LinkBench : public LineBench {
 public:
  // Who is on the line besides the IUT, and when.
  struct Heard {
    kernel::Time begin;
    kernel::Time end;
  };

  // ---- times of the link ----
  const fieldbus_dll::LinkRules& link() const { return link_; }
  kernel::Duration octets(std::int64_t count) const { return fieldbus_dll::octets(link_, count); }
  kernel::Duration slot() const { return octets(link_.slot_time_octets); }
  kernel::Duration least_gap() const { return octets(link_.inter_pdu_delay_octets); }
  // V(MRD) x V(ST): who does not begin to answer until then says nothing any more.
  kernel::Duration response_delay() const {
    return octets(std::int64_t{link_.response_delay_slots} * link_.slot_time_octets);
  }
  // Of a frame around so many octets and their check, as the tester sends it.
  kernel::Duration frame(std::size_t count_without_check) const {
    return fieldbus_dll::frame_time(link_, count_without_check + 2);
  }

  // ---- lower tester ----
  // The octets with their check from now on, and runs until they are over. Gives that instant.
  kernel::Time send(std::span<const std::uint8_t> octets);
  kernel::Time send(std::initializer_list<std::uint8_t> octets) {
    return send(std::span(octets.begin(), octets.size()));
  }
  // Half bits, levels as they are.
  kernel::Time send_half_bits(line::Levels half_bits);
  kernel::Time send_wave(line::Waveform wave);
  // At an instant that lies ahead, else now; does not run. Gives its end.
  kernel::Time send_at(kernel::Time start, std::span<const std::uint8_t> octets);
  kernel::Time send_at(kernel::Time start, std::initializer_list<std::uint8_t> octets) {
    return send_at(start, std::span(octets.begin(), octets.size()));
  }
  void run_until(kernel::Time time);

  // Runs until the IUT begins a DLPDU that has not been taken by `next`; false: it was silent until `limit`.
  bool next_begins(kernel::Time limit);
  // The next DLPDU that the IUT begins before `limit`, when it is over; none: it was silent.
  std::optional<DrivenDlpdu> next(kernel::Time limit);
  std::optional<DrivenDlpdu> next() { return next(now() + observation_timeout()); }
  // All that it drives until it has been silent for `patience()`; at most a thousand DLPDUs.
  std::vector<DrivenDlpdu> listen();
  // Twice V(MRD) x V(ST): a station that has something to do does it sooner.
  kernel::Duration observation_timeout() const { return 2 * response_delay(); }
  // Data that no other has, so that what is on the line tells whose it is.
  Octets numbered_data(std::size_t size);

  // Everything that the IUT has driven, and when others were on the line.
  std::span<const DrivenDlpdu> driven() const { return driven_.all(); }
  // Everything that the lower tester has.
  std::span<const DrivenDlpdu> sent() const { return sent_.all(); }
  std::span<const Heard> heard() const { return ear_.heard; }

  // ---- stress ----
  // From so much later on, until it is ended.
  void begin_stress(const fault::Stress& stress, kernel::Duration later);
  // What has arrived under stress with a check that fits, though nobody sent it: no station can know better.
  std::vector<DrivenDlpdu> arrived_unsent() const;

  // A DLPDU as a person reads it; of what is none its octets.
  virtual std::string words(const DrivenDlpdu& dlpdu) const = 0;
  // The DLPDUs of both around an instant, in words.
  std::vector<std::string> decode_lines(kernel::Time time);

 protected:
  // Stresses must outlive the bench; null: there are none.
  LinkBench(const fieldbus_dll::LinkRules& link, std::uint64_t seed, Volume volume,
            const LinkStresses* stresses);
  ~LinkBench() override = default;

  // The place of the IUT, which is wired to it.
  segment::MediumPort& attach_station(segment::Station& station, const fault::Plan& plan);
  void note_supply(bool is_on) { supply_.add_supply(now(), is_on); }

 private:
  struct Ear final : segment::Tap {
    void on_wave(const line::Waveform& wave) override { heard.push_back({wave.start, wave.end()}); }
    std::vector<Heard> heard;
  };

  fieldbus_dll::LinkRules link_;
  DrivenDlpdus driven_;
  DrivenDlpdus sent_;
  DrivenDlpdus arrived_;  // under stress, and from the first one on
  Ear ear_;
  DecodedLines supply_;
  std::uint16_t number_ = 0;
};

}  // namespace fieldproof::conformance
