#include "protocols/token_bus/channel_watch.hpp"

#include <algorithm>

namespace fieldproof::token_bus {
namespace {

// The worse of both.
Carried together(Carried one, Carried two) {
  if (one == Carried::spoiled || two == Carried::spoiled) return Carried::spoiled;
  return one == Carried::clean ? two : one;
}

}  // namespace

void ChannelWatch::reset() {
  last_ = {};
  last_end_ = {};
  frame_.clear();
  before_ = Carried::clean;
}

bool ChannelWatch::is_start_delimiter() const {
  static const MacSymbols delimiter = token_bus::start_delimiter();
  return std::ranges::equal(last_, delimiter, {}, &Seen::symbol);
}

void ChannelWatch::take(MacSymbol symbol, kernel::Time begin_of_symbol, kernel::Time end_of_symbol,
                        ChannelSelection& selection) {
  if (symbol == MacSymbol::silence) return fall_silent(end_of_symbol, selection);
  std::ranges::rotate(last_, last_.begin() + 1);
  last_.back() = {symbol, begin_of_symbol};
  last_end_.take(symbol);
  if (symbol == MacSymbol::bad_signal) selection.on_bad_signal(channel_, end_of_symbol);
  if (is_start_delimiter()) return begin(end_of_symbol, selection);
  // Longer than any: it is known to be too long.
  if (!frame_.empty() && frame_.size() < 8 * (rules_.most_octets + 4)) frame_.push_back({symbol, 0});
  if (last_end_.is_seen()) end(end_of_symbol, selection);
}

void ChannelWatch::begin(kernel::Time when, ChannelSelection& selection) {
  if (!frame_.empty()) {
    frame_.resize(frame_.size() - std::min(frame_.size(), kDelimiterSymbols - 1));
    before_ = together(before_, carried_so_far());
  }
  start_delimiter_ = last_.front().begin;
  frame_.clear();
  for (const Seen& one : last_) frame_.push_back({one.symbol, 0});
  selection.on_start_delimiter(channel_, when);
}

Carried ChannelWatch::carried_so_far() const {
  return together(before_, carried_by(reader_.read(frame_)));
}

void ChannelWatch::fall_silent(kernel::Time when, ChannelSelection& selection) {
  last_ = {};
  last_end_ = {};
  end(when, selection);
}

void ChannelWatch::end(kernel::Time when, ChannelSelection& selection) {
  if (frame_.empty()) return;
  const Carried carried = carried_so_far();
  frame_.clear();
  before_ = Carried::clean;
  selection.on_end(channel_, carried, when);
}

}  // namespace fieldproof::token_bus
