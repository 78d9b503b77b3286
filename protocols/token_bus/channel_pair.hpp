#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "harness/segment/segment.hpp"
#include "protocols/token_bus/channel_selection.hpp"

// A dual channel manager between a MAC and its places on two lines, in whole transmissions instead of
// symbols: the levels of both lines go in, those of the selected channel come out.
//
//   from the MAC   goes out on both channels
//   to the MAC     the transmission that ChannelSelection selects; where none has a start delimiter, what the
//                  preferred channel has. The skew later, and once the other channel is silent too
//   activity       of either channel, the skew later
namespace fieldproof::token_bus {

// What of a transmission a selection is shown, read once for all who receive the same levels.
class ChannelReader {
 public:
  struct Shown {
    std::vector<std::size_t> start_delimiters{};  // half bits from the begin until each is complete
    std::optional<std::size_t> bad_signal{};      // the first
    Carried carried = Carried::clean;
  };

  explicit ChannelReader(const Rules& rules) : rules_(rules), reader_(rules) {}
  const Shown& read(const line::Waveform& wave);

 private:
  Rules rules_;
  FrameReader reader_;
  line::Levels last_{};
  Shown shown_{};
};

class ChannelPair final : public segment::Station, public segment::Port, private ChannelUser {
 public:
  using OnEvent = std::function<void(const ChannelEvent& event, kernel::Time when)>;

  // `mac`: the number of its station on the segment.
  ChannelPair(segment::Segment& segment, std::size_t mac, const Rules& rules, ChannelReader& reader,
              OnEvent on_event);

  void wire(segment::Port& a, segment::Port& b) { lines_ = {&a, &b}; }
  // The supply comes, or fails.
  void reset();
  bool has_fault(Channel channel) const { return selection_.has_fault(channel); }

  // ---- from the MAC ----
  void drive(line::Waveform& wave) override;

  // ---- from the channels, whose numbers are the ports ----
  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

 private:
  struct Received {
    Channel channel;
    line::Waveform wave;
    std::vector<kernel::Time> start_delimiters;
  };
  enum class Show : std::uint8_t { start_delimiter, bad_signal, end };
  struct Event {
    kernel::Time when;
    Show what;
    Channel channel;
    Carried carried;
  };
  // What the MAC is told, in the order of time: a transmission, or that activity begins or ends.
  struct Told {
    kernel::Time due;
    std::optional<line::Waveform> wave;
    bool begins;
  };

  bool is_silent() const { return !is_active_[0] && !is_active_[1]; }
  void settle(kernel::Time now);
  void give(const line::Waveform& wave);
  void on_selected(Channel channel, kernel::Time start_delimiter) override;
  void on_channel_event(const ChannelEvent& event, kernel::Time when) override { on_event_(event, when); }

  segment::Segment& segment_;
  std::size_t mac_;
  Rules rules_;
  ChannelRules channels_{};
  ChannelReader& reader_;
  OnEvent on_event_;
  ChannelSelection selection_;
  std::array<segment::Port*, 2> lines_{};
  std::array<bool, 2> is_active_{};
  std::vector<Received> received_{};  // since both were silent
  std::vector<Event> events_{};       // of these, not shown yet
  bool is_given_ = false;             // one of these, to the MAC
  bool is_settled_ = false;           // they are what was received until then
  kernel::Time settled_at_{};
  std::deque<Told> told_{};
};

}  // namespace fieldproof::token_bus
