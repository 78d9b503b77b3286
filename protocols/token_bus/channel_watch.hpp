#pragma once

#include <array>
#include <vector>

#include "protocols/token_bus/channel_selection.hpp"

// What a channel shows to the selection, symbol by symbol: start delimiters, bad_signal, ends, and what
// frames there were between them.
namespace fieldproof::token_bus {

class ChannelWatch {
 public:
  ChannelWatch(Channel channel, const Rules& rules) : channel_(channel), rules_(rules), reader_(rules) {}
  ChannelWatch(const ChannelWatch&) = delete;
  ChannelWatch& operator=(const ChannelWatch&) = delete;

  void reset();
  void take(MacSymbol symbol, kernel::Time begin, kernel::Time end, ChannelSelection& selection);
  // Nothing is on.
  void fall_silent(kernel::Time when, ChannelSelection& selection);

  // Of the first symbol of the last start delimiter.
  kernel::Time start_delimiter() const { return start_delimiter_; }

 private:
  static constexpr std::size_t kDelimiterSymbols = 8;

  bool is_start_delimiter() const;
  void begin(kernel::Time end, ChannelSelection& selection);
  void end(kernel::Time when, ChannelSelection& selection);
  Carried carried_so_far() const;

  struct Seen {
    MacSymbol symbol = MacSymbol::silence;
    kernel::Time begin{};
  };

  Channel channel_;
  Rules rules_;
  FrameReader reader_;
  std::array<Seen, kDelimiterSymbols> last_{};  // the oldest first
  LastFrameEnd last_end_{};
  std::vector<Indication> frame_;    // from its start delimiter on
  Carried before_ = Carried::clean;  // the frames of this transmission before it
  kernel::Time start_delimiter_{};
};

}  // namespace fieldproof::token_bus
