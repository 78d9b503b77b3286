#pragma once

#include "protocols/token_bus/dual_channel.hpp"

// Dual channel managers that answer the requests of their station otherwise.
namespace fieldproof::conformance::dual_channel_seeded_faults {

using namespace token_bus;

// ---- the manager: requests and answers ----

using Sends = bool (*)(const ChannelSelection& selection, Channel channel, bool is_management);

class SendsOtherwise final : public ChannelManager {
 public:
  SendsOtherwise(const ChannelManagerConfiguration& configuration, Sends sends)
      : ChannelManager(configuration), sends_(sends) {}

 private:
  bool sends_on(Channel channel, bool is_management) const override {
    return sends_(selection(), channel, is_management);
  }

  Sends sends_;
};
inline bool on_a_alone(const ChannelSelection&, Channel channel, bool) {
  return channel == Channel::a;
}
inline bool on_the_preferred_alone(const ChannelSelection& selection, Channel channel, bool) {
  return channel == selection.preferred();
}
inline bool on_clean_channels(const ChannelSelection& selection, Channel channel, bool) {
  return !selection.has_fault(channel);
}
inline bool commands_on_a_alone(const ChannelSelection&, Channel channel, bool is_management) {
  return !is_management || channel == Channel::a;
}

class ExchangesBitsOnB final : public ChannelManager {
  using ChannelManager::ChannelManager;
  std::uint64_t requested(Channel channel, std::uint64_t levels) const override {
    const bool is_bit = levels == levels_of(MacRequest{.symbol = MacSymbol::zero}) ||
                        levels == levels_of(MacRequest{.symbol = MacSymbol::one});
    constexpr std::uint64_t kOneOrZero = 8;
    return channel == Channel::b && is_bit ? levels ^ kOneOrZero : levels;
  }
};

class LateByMore final : public ChannelManager {
 public:
  // In symbols.
  LateByMore(const ChannelManagerConfiguration& configuration, unsigned requests, unsigned requests_of_b,
             unsigned indications)
      : ChannelManager(configuration),
        requests_(requests),
        requests_of_b_(requests_of_b),
        indications_(indications) {}

 private:
  kernel::Duration request_delay(Channel channel) const override {
    const unsigned more = channel == Channel::b ? requests_of_b_ : requests_;
    return ChannelManager::request_delay(channel) + mac_symbols(configuration().rules, more);
  }
  kernel::Duration indication_delay() const override {
    return ChannelManager::indication_delay() + mac_symbols(configuration().rules, indications_);
  }

  unsigned requests_;
  unsigned requests_of_b_;
  unsigned indications_;
};

using Gives = bool (*)(bool is_preferred, bool other_answers);

class AnswersFromElsewhere final : public ChannelManager {
 public:
  AnswersFromElsewhere(const ChannelManagerConfiguration& configuration, Gives gives)
      : ChannelManager(configuration), gives_(gives) {}

 private:
  bool gives_answer(Channel channel, bool other_answers) const override {
    return gives_(channel == selection().preferred(), other_answers);
  }

  Gives gives_;
};
inline bool no_answer(bool, bool) {
  return false;
}
inline bool any_answer(bool, bool) {
  return true;
}
inline bool of_the_preferred_alone(bool is_preferred, bool) {
  return is_preferred;
}
inline bool of_the_other_first(bool is_preferred, bool other_answers) {
  return !is_preferred || !other_answers;
}

}  // namespace fieldproof::conformance::dual_channel_seeded_faults
