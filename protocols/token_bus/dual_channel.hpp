#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>

#include "protocols/token_bus/channel_watch.hpp"
#include "protocols/token_bus/dual_channel_device.hpp"
#include "protocols/token_bus/service_units.hpp"

// The dual channel manager (DCM) of a control network with redundant media: between one MAC and two channels,
// each of which has a translator of its own. The paper names it and says no more; what it does is this
// project's choice.
//
// What is requested goes out on both channels. Of what they indicate, the MAC is given
//
//   a transmission, from its start delimiter to its end   of the channel that ChannelSelection selects
//   what else is on the line, a preamble too              of the preferred channel
//   answers of the management mode                        of the preferred channel; where it gives none, of
//                                                         the other
//
// Never the rest of a transmission whose begin was of the other channel. Everything indicated is late by one
// time, so that a selection comes before the start delimiter has to go out.
namespace fieldproof::token_bus {

class ChannelManager : public ChannelManagerDevice, private ChannelUser {
 public:
  explicit ChannelManager(const ChannelManagerConfiguration& configuration)
      : ChannelManager(configuration,
                       std::make_unique<ChannelSelection>(configuration.rules, configuration.channels)) {}
  ChannelManager(const ChannelManagerConfiguration& configuration,
                 std::unique_ptr<ChannelSelection> selection);

  void wire(segment::Port& mac, segment::Port& a, segment::Port& b, ChannelListener& listener) override;
  void set_power(bool is_on, kernel::Time now) override;

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

 protected:
  const ChannelManagerConfiguration& configuration() const { return configuration_; }
  const ChannelSelection& selection() const { return *selection_; }

  // ---- decisions ----
  // Where the MAC is indicated symbols from, if from anywhere.
  virtual std::optional<Channel> source() const;
  virtual bool sends_on(Channel /*channel*/, bool /*is_management*/) const { return true; }
  virtual kernel::Duration request_delay(Channel /*channel*/) const {
    return symbols(configuration_.delay_symbols);
  }
  virtual kernel::Duration indication_delay() const {
    return symbols(indication_delay_symbols(configuration_));
  }
  virtual std::uint64_t requested(Channel /*channel*/, std::uint64_t levels) const { return levels; }
  virtual std::uint64_t indicated(std::uint64_t levels) const { return levels; }
  virtual bool gives_symbols(Channel channel, std::optional<Channel> from) const { return from == channel; }
  virtual bool gives_answer(Channel channel, bool other_answers) const {
    return channel == selection_->preferred() || !other_answers;
  }

 private:
  // Of a channel, not indicated yet.
  struct Held {
    ServiceUnit unit;
    std::uint64_t levels;
    bool is_answer;
  };
  struct Side {
    explicit Side(Channel channel, const Rules& rules) : watch(channel, rules) {}

    ServiceInput input{};
    ServiceOutput requests{};
    ChannelWatch watch;
    std::deque<Held> held{};
    kernel::Time received_until{};
    bool is_silent = true;
    kernel::Time answered_until{};
  };
  // From then on.
  struct Source {
    kernel::Time from;
    std::optional<Channel> channel;
  };

  kernel::Duration symbols(std::int64_t count) const { return mac_symbols(configuration_.rules, count); }
  Side& side(Channel channel) { return sides_[static_cast<std::size_t>(channel)]; }
  const Side& side(Channel channel) const { return sides_[static_cast<std::size_t>(channel)]; }

  kernel::Time silent_at(const Side& side) const;
  void work_up_to(kernel::Time now);
  void follow_request();
  void follow_channel(Channel channel);
  void keep_source(kernel::Time when);
  void indicate_up_to(kernel::Time begin);
  void indicate(Channel channel, const Held& one);
  bool has_answer(Channel channel, const ServiceUnit& unit) const;
  void on_selected(Channel channel, kernel::Time start_delimiter) override;
  void on_channel_event(const ChannelEvent& event, kernel::Time when) override;

  ChannelManagerConfiguration configuration_;
  std::unique_ptr<ChannelSelection> selection_;
  ChannelListener* listener_ = nullptr;
  bool is_powered_ = false;
  kernel::Time now_{};
  ServiceInput requests_;
  ServiceOutput indications_;
  std::array<Side, 2> sides_;
  std::deque<Source> sources_;  // the first is in force
};

}  // namespace fieldproof::token_bus
