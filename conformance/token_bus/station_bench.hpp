#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conformance/decoded_lines.hpp"
#include "conformance/line_bench.hpp"
#include "conformance/token_bus/driven_frames.hpp"
#include "protocols/token_bus/device.hpp"

// The bench of one case for a station of the token bus: a line with the implementation under test (IUT) and
// the lower tester in the place of every other station, and the upper tester as the IUT's user.
//
// The lower tester drives what the case says and receives what the IUT drives as it leaves it. Verdicts rest
// on that, and on what was reported to the user.
namespace fieldproof::conformance {

// Positions on the line are rounded to picoseconds, each for itself.
inline constexpr kernel::Duration kTokenRounding = kernel::kNanosecond;

// What a case needs around the IUT.
struct TokenNeeds {
  // What the case is about, or draws of the seed.
  std::function<void(token_bus::StationConfiguration&, kernel::Random&)> adjust{};
  bool is_powered = true;  // when the case begins
};

using TokenSetting = PlannedSetting<token_bus::StationDevice, token_bus::StationConfiguration>;

// What a user must get of data that were sent: nothing but the check is gone.
bool is_reported_as(const DrivenFrame& sent, const token_bus::Frame& frame);

// The IUT's user.
class TokenUser final : public token_bus::StationUser {
 public:
  void on_data(const token_bus::Frame& frame, kernel::Time) override { frames.push_back(frame); }
  void on_event(const token_bus::Event& event, kernel::Time when) override {
    events.push_back(event);
    all_events.push_back({event, when});
  }
  bool has_event(token_bus::EventKind kind, std::uint64_t about) const;

  std::vector<token_bus::Frame> frames;
  struct Reported {
    token_bus::Event event;
    kernel::Time when;
  };

  std::vector<token_bus::Event> events;  // of which a case has not disposed
  std::vector<Reported> all_events;
};

token_bus::StationConfiguration token_configuration(const TokenNeeds& needs, std::uint64_t seed,
                                                    const field::Settings& settings = {});

class TokenBench final : public LineBench {
 public:
  // Stations of the tester: the IUT's predecessor and successor where it is in a ring, and a stranger.
  static constexpr std::uint64_t kAbove = 0x000E;
  static constexpr std::uint64_t kBelow = 0x0004;
  static constexpr std::uint64_t kStranger = 0x0020;

  TokenBench(const TokenNeeds& needs, const TokenSetting& setting)
      : TokenBench(token_configuration(needs, setting.seed, setting.settings), needs.is_powered, setting) {}

  const token_bus::Rules& rules() const { return configuration_.rules; }
  std::uint64_t address() const { return configuration_.address; }
  kernel::Duration octets(std::int64_t count) const { return token_bus::octets(rules(), count); }
  kernel::Duration slots(std::int64_t count) const { return token_bus::slots(rules(), count); }
  kernel::Duration gap() const { return octets(rules().response_gap_octets); }

  // ---- upper tester ----
  TokenUser& user() { return user_; }
  void set_power(bool is_on);
  // False when the IUT refuses it.
  bool submit(const token_bus::DataRequest& request);
  void set_in_ring_desired(bool is_desired);
  void set_response(const Octets& data);
  // It is, or was, not to be in the ring.
  bool may_leave() const { return may_leave_; }
  token_bus::Counters counters() const { return station_->counters(); }
  // Data that no other has.
  Octets numbered_data(std::size_t size);

  // ---- lower tester ----
  Octets frame(TokenControl control, std::uint64_t destination, std::uint64_t source,
               std::optional<std::uint64_t> data = std::nullopt) const;
  Octets data_frame(std::uint8_t control, std::uint64_t destination, std::uint64_t source,
                    const Octets& data) const;
  // Octets with their check, from now on, and runs until they are over. Gives that instant.
  kernel::Time send(const Octets& octets, const FrameForm& form = {});
  kernel::Time send_half_bits(line::Levels half_bits);
  // MAC zeros, of which no receiver makes a frame.
  kernel::Time send_noise(std::size_t octet_times);
  void run_until(kernel::Time time);

  // The next frame that the IUT begins before `limit`, when it is over; none: it was silent.
  std::optional<DrivenFrame> next(kernel::Time limit);
  std::span<const DrivenFrame> driven() const { return driven_.all(); }
  const DrivenFrames& driven_frames() const { return driven_; }
  std::span<const DrivenFrame> sent() const { return sent_.all(); }

  // ---- stress ----
  void begin_stress(const fault::Stress& stress) {
    begin_stress_at(stress, place(), 2 * rules().phy_bit_rate, now());
  }

  segment::MediumPort& tester_place() { return tester(); }
  const token_bus::StationConfiguration& configuration() const { return configuration_; }
  // The frames of both around an instant, in words.
  std::vector<std::string> decode_lines(kernel::Time time);
  // What its user got.
  std::string user_text() const;
  void finish() { station_->end(); }
  // What it must answer: on an idle bus it claims the token.
  void ask();

 private:
  TokenBench(const token_bus::StationConfiguration& configuration, bool is_powered,
             const TokenSetting& setting);

  token_bus::StationConfiguration configuration_;
  TokenUser user_;
  DrivenFrames driven_;
  DrivenFrames sent_;
  std::unique_ptr<token_bus::StationDevice> station_;
  bool is_powered_ = false;
  DecodedLines supply_;
  bool may_leave_ = false;
  std::uint16_t number_ = 0;
};

}  // namespace fieldproof::conformance
