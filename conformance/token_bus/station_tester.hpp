#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "conformance/sequence.hpp"
#include "conformance/token_bus/station_words.hpp"

// What the tester drives in a sequence: single transmissions in any form, and what stations around the one
// under test do when that drives something.
namespace fieldproof::conformance {

class TokenTester {
 public:
  explicit TokenTester(TokenBench& bench) : bench_(bench) {}

  // How the next transmission looks.
  void take_form(std::span<const std::int64_t> numbers);
  void send(Octets octets, const std::vector<SequenceFault>& faults = {});
  void send_noise(std::size_t symbols);
  // One of a series of what is no frame.
  void send_faulty(TokenSeries what);
  void talk(std::int64_t octets);

  // Who gets the token or a request does what is due, or is silent.
  void set_peer(bool does_act) { does_peer_act_ = does_act; }
  void take_reply(std::span<const std::int64_t> numbers);
  // True: something was driven.
  bool reply_to(const DrivenFrame& one);

 private:
  struct Form {
    unsigned preamble = 4;
    unsigned bits_lost = 0;
    TokenEnding ending = TokenEnding::right;
  };
  struct Reply {
    TokenReply with = TokenReply::nothing;
    std::int64_t after = 0;
    std::int64_t left = 0;
  };

  line::Levels shaped(Octets octets, const Form& form);
  line::Levels before(TokenEnding ending);
  // Data for the station.
  line::Levels data_around(bool is_damaged, FrameForm form);
  void do_what_is_due(const DrivenFrame& one, std::int64_t after);
  void reply(const DrivenFrame& one, TokenReply with);

  TokenBench& bench_;
  Form form_;
  bool does_peer_act_ = true;
  std::array<Reply, kTokenCues> replies_{};
};

}  // namespace fieldproof::conformance
