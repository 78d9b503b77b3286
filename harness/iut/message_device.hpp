#pragma once

#include <string>

#include "harness/iut/device.hpp"
#include "harness/iut/limits.hpp"
#include "harness/iut/message.hpp"
#include "harness/iut/peer.hpp"

// An implementation after messages, in lock step: each call is a message, and what the implementation does
// until its `done` happens within the call.
namespace fieldproof::iut {

// Asks a peer what it is; an empty role: which ones does it serve? Throws Misbehaviour for a peer that does
// not answer as it should, and kernel::Error(implementation) for one that speaks another version. One that
// refuses the role serves none.
PeerCapabilities hello(Peer& peer, const RoleName& role, std::chrono::milliseconds limit);

class MessageDevice final : public Device {
 public:
  static constexpr std::size_t kMostOctets = 8U << 20U;  // of the messages of one call

  // Says hello. Throws Misbehaviour for a peer that does not answer as it should, and
  // kernel::Error(implementation) for one that speaks another version.
  MessageDevice(Peer peer, const RoleName& role, const PeerLimits& limits);

  // An echo comes back, and an unknown case is refused: throws kernel::Error(implementation) when not.
  void test_itself();

  // What it calls itself: text of unknown origin.
  const std::string& own_name() const { return own_name_; }
  Peer& peer() { return peer_; }
  // It is there, and has said nothing that it was not asked for.
  bool is_quiet();

  UnitKind unit_kind() const override { return unit_kind_; }
  Capabilities capabilities() const override { return {.senses_activity = senses_activity_}; }
  bool begin(const CaseBegin& begin, Bench& bench) override;
  void set_power(bool is_on, kernel::Time now) override;
  void receive(unsigned port, std::span<const Character> characters, kernel::Time now) override;
  void receive(unsigned port, const line::Waveform& reception) override;
  void on_activity(unsigned port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return next_time_; }
  void end() override;

 private:
  enum class Refusal : std::uint8_t { none, allowed };
  // Sends the message and serves the implementation until it is done; false for `unsupported`, where that is
  // an answer.
  bool call(std::span<const std::uint8_t> message, Refusal refusal = Refusal::none);
  void serve(MessageReader& reader);
  std::span<const std::uint8_t> expect(std::span<const std::uint8_t> message, MessageType answer,
                                       std::chrono::milliseconds limit);
  [[noreturn]] void refuse(std::span<const std::uint8_t> message, const std::string& why);

  Peer peer_;
  PeerLimits limits_;
  std::string own_name_;
  UnitKind unit_kind_ = UnitKind::characters;
  bool senses_activity_ = false;
  MessageWriter writer_;
  Bench* bench_ = nullptr;
  Peer::Clock::time_point case_begin_ = Peer::Clock::now();
  kernel::Time next_time_ = kernel::kNever;
  line::Waveform wave_;
};

}  // namespace fieldproof::iut
