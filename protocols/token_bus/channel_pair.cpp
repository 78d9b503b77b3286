#include "protocols/token_bus/channel_pair.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::token_bus {
namespace {

constexpr std::size_t kHalfBitsOfDelimiter = 32;

}  // namespace

const ChannelReader::Shown& ChannelReader::read(const line::Waveform& wave) {
  const bool is_as_driven = wave.rate == 2 * rules_.phy_bit_rate;
  if (!last_.empty() && is_as_driven && wave.levels == last_) return shown_;
  last_ = is_as_driven ? wave.levels : line::Levels{};
  shown_ = {};
  const std::vector<Indication> indications = indications_in(wave, rules_.phy_bit_rate);
  const std::vector<Reception> receptions = reader_.read(indications);
  for (const Reception& one : receptions) {
    if (one.kind != ReceptionKind::non_silence)
      shown_.start_delimiters.push_back(one.first_half_bit + kHalfBitsOfDelimiter);
  }
  const auto bad = std::ranges::find(indications, MacSymbol::bad_signal, &Indication::symbol);
  if (bad != indications.end()) shown_.bad_signal = bad->half_bit;
  shown_.carried = carried_by(receptions);
  return shown_;
}

ChannelPair::ChannelPair(segment::Segment& segment, std::size_t mac, const Rules& rules,
                         ChannelReader& reader, OnEvent on_event)
    : segment_(segment),
      mac_(mac),
      rules_(rules),
      reader_(reader),
      on_event_(std::move(on_event)),
      selection_(rules, channels_) {
  selection_.wire(*this);
}

void ChannelPair::reset() {
  selection_.reset();
  received_.clear();
  events_.clear();
  std::erase_if(told_, [](const Told& one) { return one.wave.has_value(); });
}

void ChannelPair::drive(line::Waveform& wave) {
  line::Waveform copy = wave;
  lines_[0]->drive(copy);
  lines_[1]->drive(wave);
}

// ---- from the channels ----

void ChannelPair::on_activity(segment::PortIndex port, bool begins, kernel::Time now) {
  const bool was_silent = is_silent();
  is_active_.at(port) = begins;
  const kernel::Time due = now + mac_symbols(rules_, channels_.skew_symbols);
  if (was_silent && begins) told_.push_back({due, std::nullopt, true});
  if (was_silent || !is_silent()) return;
  settle(now);
  told_.push_back({due, std::nullopt, false});
}

void ChannelPair::receive(segment::PortIndex port, const line::Waveform& reception) {
  if (std::exchange(is_settled_, false)) received_.clear();
  const Channel channel = kChannels.at(port);
  const ChannelReader::Shown& shown = reader_.read(reception);
  Received& one = received_.emplace_back(channel, reception, std::vector<kernel::Time>{});
  for (const std::size_t at : shown.start_delimiters) {
    one.start_delimiters.push_back(reception.time_of(at));
    events_.push_back({one.start_delimiters.back(), Show::start_delimiter, channel, {}});
  }
  if (shown.bad_signal)
    events_.push_back({reception.time_of(*shown.bad_signal), Show::bad_signal, channel, {}});
  events_.push_back({reception.end(), Show::end, channel, shown.carried});
  // Nobody drives it: a disturbance.
  if (is_silent()) settle(segment_.now());
}

// Both are silent: what they had is shown in the order of time.
void ChannelPair::settle(kernel::Time now) {
  settled_at_ = now;
  is_settled_ = true;
  is_given_ = false;
  std::ranges::stable_sort(events_, {}, &Event::when);
  for (const Event& one : std::exchange(events_, {})) {
    switch (one.what) {
      case Show::start_delimiter:
        selection_.on_start_delimiter(one.channel, one.when);
        break;
      case Show::bad_signal:
        selection_.on_bad_signal(one.channel, one.when);
        break;
      case Show::end:
        selection_.on_end(one.channel, one.carried, one.when);
        break;
    }
  }
  if (selection_.next_time() <= now) selection_.on_time(now);
  const bool has_start =
      std::ranges::any_of(received_, [](const Received& one) { return !one.start_delimiters.empty(); });
  if (is_given_ || has_start) return;
  for (const Received& one : received_) {
    if (one.channel == selection_.preferred()) give(one.wave);
  }
}

void ChannelPair::on_selected(Channel channel, kernel::Time start_delimiter) {
  for (const Received& one : received_) {
    if (one.channel == channel && std::ranges::count(one.start_delimiters, start_delimiter) > 0)
      give(one.wave);
  }
}

// Its end is when the MAC is told.
void ChannelPair::give(const line::Waveform& wave) {
  is_given_ = true;
  const kernel::Time due =
      std::max(segment_.now(), settled_at_ + mac_symbols(rules_, channels_.skew_symbols));
  line::Waveform late = wave;
  late.start += due - wave.end();
  told_.push_back({due, std::move(late), false});
}

// ---- time ----

kernel::Time ChannelPair::next_time() const {
  const kernel::Time told = told_.empty() ? kernel::kNever : told_.front().due;
  return is_silent() ? std::min(told, selection_.next_time()) : told;
}

void ChannelPair::on_time(kernel::Time now) {
  if (is_silent() && selection_.next_time() <= now) selection_.on_time(now);
  while (!told_.empty() && told_.front().due <= now) {
    const Told one = std::move(told_.front());
    told_.pop_front();
    if (one.wave) {
      segment_.deliver(mac_, 0, *one.wave);
    } else {
      segment_.tell_activity(mac_, 0, one.begins);
    }
  }
}

}  // namespace fieldproof::token_bus
