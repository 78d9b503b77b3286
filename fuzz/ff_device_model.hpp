#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "fuzz/link_line.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// What a basic device of the profile FF-P does, from the frames that arrive at it and from what its user
// wants: what it says, octet by octet, and at which instant, and what its user is told.
//
// It may begin V(MID) behind the end of what was on the line, its own frames included, and begins then. Under
// a token it sends the most urgent first, while what it sends ends within the duration; the last one has F,
// and a token that is not used is returned by RT. CD and PN are answered within V(MRD) x V(ST), unless
// another DLPDU comes first; what comes from a scheduler takes a token back. While it drives it hears
// nothing.
//
// Octets are read and written here by hand; which octets arrived says link_frames_in.
namespace fieldproof::fuzz {

struct FfIndication {
  enum class Kind : std::uint8_t { data, published, activated };
  Kind kind;
  kernel::Time when;
  LinkOctets octets{};  // of the DLPDU
  friend bool operator==(const FfIndication&, const FfIndication&) = default;
};

class FfDeviceModel final : public segment::Tap {
 public:
  explicit FfDeviceModel(const fieldbus_dll::FfConfiguration& configuration);

  // The user wants this; false: it is refused.
  bool submit(unsigned priority, std::uint32_t destination, const LinkOctets& data);
  bool write(std::uint32_t address, const LinkOctets& data);

  // Others begin to drive.
  void on_begin(kernel::Time now);
  // What arrived; they have ended.
  void on_wave(const line::Waveform& wave) override;
  // Nothing else has happened until now.
  void run_until(kernel::Time now);

  const std::vector<LinkSaid>& said() const { return said_; }
  const std::vector<FfIndication>& told() const { return told_; }
  bool is_live() const { return is_live_; }
  std::uint64_t link_time(kernel::Time now) const;

 private:
  struct Request {
    unsigned priority;
    std::uint32_t destination;
    LinkOctets data;
  };
  struct Token {
    unsigned least;
    kernel::Time ends;
  };
  struct Answer {
    LinkOctets octets;
    kernel::Time until;
  };
  struct Buffer {
    LinkOctets data;
    unsigned writes = 0;
    bool is_written = false;
  };

  std::size_t most_data(unsigned priority) const;
  kernel::Time may_begin() const;
  kernel::Time next_action() const;
  void act(kernel::Time now);
  void use_token(kernel::Time now);
  kernel::Time end_of(const LinkOctets& octets, kernel::Time begin) const;
  std::deque<Request>* next_queue();
  LinkOctets dt1_of(const Request& request, bool is_last) const;
  void say(const LinkOctets& octets, kernel::Time now);

  bool is_dlpdu(std::span<const std::uint8_t> octets) const;
  void hear(const LinkOctets& octets, kernel::Time end);
  void hear_cd(const LinkOctets& octets, kernel::Time end);
  void hear_dt1(const LinkOctets& octets, kernel::Time end);

  fieldbus_dll::FfConfiguration configuration_;
  std::array<std::deque<Request>, 4> queues_;  // by priority
  std::map<std::uint32_t, Buffer> buffers_;
  bool is_live_ = false;
  bool is_line_busy_ = false;
  kernel::Time heard_until_ = kernel::kStart;
  kernel::Time driven_until_ = kernel::kStart;
  std::optional<Token> token_;
  std::optional<Answer> answer_;
  std::uint64_t told_time_ = 0;
  kernel::Time told_at_ = kernel::kStart;
  std::vector<LinkSaid> said_;
  std::vector<FfIndication> told_;
};

}  // namespace fieldproof::fuzz
