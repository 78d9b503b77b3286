#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "fuzz/link_line.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// What a data link entity of the profile ISA-D does, from the frames that arrive at it and from what its user
// wants: what it says, octet by octet, and at which instant, and what its user is told.
//
// It may begin V(MID) behind the end of what was on the line, its own frames included, and begins then. An ET
// is for one frame, an ES for what ends within its duration, with all that must follow it; an EE returns
// both. Behind a CD of its own it waits for V(RR), and as long as others are active; behind one for it, it
// answers within V(FD), unless another DLPDU comes first. While it drives it hears nothing.
//
// Octets are read and written here by hand; which octets arrived says link_frames_in.
namespace fieldproof::fuzz {

struct IsaIndication {
  enum class Kind : std::uint8_t { data, reply_missing, token_dropped };
  Kind kind;
  kernel::Time when;
  LinkOctets octets{};  // of the DLPDU; else the node
  friend bool operator==(const IsaIndication&, const IsaIndication&) = default;
};

class IsaDleModel final : public segment::Tap {
 public:
  explicit IsaDleModel(const fieldbus_dll::IsaConfiguration& configuration) : configuration_(configuration) {}

  // The user wants this; false: it is refused.
  bool submit(const fieldbus_dll::IsaRequest& request);
  // Whether the user says of a reply that is not there that it is coming.
  void set_works_on_reply(bool works) { works_on_reply_ = works; }

  // Others begin to drive.
  void on_begin(kernel::Time now);
  // What arrived; they have ended.
  void on_wave(const line::Waveform& wave) override;
  // Nothing else has happened until now.
  void run_until(kernel::Time now);

  const std::vector<LinkSaid>& said() const { return said_; }
  const std::vector<IsaIndication>& told() const { return told_; }

 private:
  struct Request {
    bool compels;
    unsigned priority;
    std::uint8_t destination;
    LinkOctets data;
  };
  struct Token {
    std::uint8_t from;
    unsigned least;
    bool is_single;
    kernel::Time ends;  // kNever: of an ET
    bool is_used = false;
  };
  struct Awaited {
    std::uint8_t node;
    kernel::Time until;
  };
  struct Compelled {
    std::uint8_t by;
    unsigned least;
    kernel::Time until;
    bool waits_for_user = false;
  };
  using Queues = std::array<std::deque<Request>, 4>;  // by priority

  std::size_t most_data(unsigned priority) const;
  kernel::Duration times(std::int64_t octets) const;
  kernel::Duration frame_of(std::size_t octets_without_check) const;
  kernel::Time may_begin() const;
  kernel::Time next_action() const;
  void act(kernel::Time now);
  void use_token(kernel::Time now);
  void return_token(unsigned reason, kernel::Time now);
  bool fits(const Request& request, kernel::Time now) const;
  void reply(kernel::Time now);
  void say(const LinkOctets& octets, kernel::Time now);

  bool is_dlpdu(std::span<const std::uint8_t> octets) const;
  void hear(const LinkOctets& octets, kernel::Time end);
  void hear_while_waiting(const LinkOctets& octets, kernel::Time end);

  fieldbus_dll::IsaConfiguration configuration_;
  Queues to_send_;
  Queues replies_;
  bool works_on_reply_ = false;
  bool is_line_busy_ = false;
  kernel::Time heard_until_ = kernel::kStart;
  kernel::Time driven_until_ = kernel::kStart;
  kernel::Time clock_ = kernel::kStart;
  std::optional<Token> token_;
  std::optional<Awaited> awaited_;
  std::optional<Compelled> compelled_;
  std::vector<LinkSaid> said_;
  std::vector<IsaIndication> told_;
};

}  // namespace fieldproof::fuzz
