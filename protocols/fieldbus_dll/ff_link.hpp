#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>

#include "harness/fault/channel.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"

// Reference stations of FF-P on one line, for simulations of whole links: what the stations do is theirs,
// what happens to the line and to the stations is said from outside.
namespace fieldproof::fieldbus_dll {

// What one station drives; the instants are those of its frame.
struct FfDriven {
  const FfDlpdu& dlpdu;
  std::uint8_t node;
  kernel::Time begin;
  kernel::Time end;
};

// What stands between the line and the receiver of a station. Null: what was sent arrives.
using FfDisturb =
    std::function<std::unique_ptr<fault::Channel>(segment::Segment&, const segment::MediumPort& place)>;

// Each receiver loses each frame with the same probability.
FfDisturb losing_frames(double probability, const kernel::Random& random);

class FfLink {
 public:
  // `random` is split by the names of the places, not drawn from.
  FfLink(const FfRules& rules, const kernel::Random& random, FfDisturb disturb = {});

  // Stations begin at once. What their users learn they learn while the link runs; users outlive it.
  FfLas& add_master(const FfConfiguration& configuration, FfUser& user);
  FfStation& add_device(const FfConfiguration& configuration, FfUser& user);

  kernel::Time now() const { return segment_.now(); }
  void run_to(kernel::Time time) { segment_.run_until(time); }

  // What applications ask of a station of this link; false as FfDevice says.
  bool submit(std::uint8_t node, const FfRequest& request);
  bool write(std::uint8_t node, FfAddress address, const Octets& data);
  // From now on nothing that the station drives reaches the line; a frame that it has begun ends.
  void kill(std::uint8_t node);

  // Called for each DLPDU when a station gives it to the line.
  void on_driven(std::function<void(const FfDriven&)> listener) { listener_ = std::move(listener); }

 private:
  // Nothing that is driven from some instant on reaches the line.
  class MortalPort final : public segment::Port {
   public:
    explicit MortalPort(segment::Port& line) : line_(line) {}
    void die() { is_dead_ = true; }
    void drive(line::Waveform& wave) override;

   private:
    segment::Port& line_;
    bool is_dead_ = false;
  };
  class Ear final : public segment::Tap {
   public:
    Ear(FfLink& link, std::uint8_t node) : link_(link), node_(node) {}
    void on_wave(const line::Waveform& wave) override;

   private:
    FfLink& link_;
    std::uint8_t node_;
  };
  struct Seat {
    Seat(FfLink& link, FfStation& seated, std::size_t number_of_it, segment::Port& place)
        : station(seated), number(number_of_it), port(place), ear(link, seated.node()) {}

    FfStation& station;
    std::size_t number;
    MortalPort port;
    Ear ear;
  };

  Seat& seat_of(std::uint8_t node);
  void seat(FfStation& station, FfUser& user);

  FfRules rules_;
  segment::Segment segment_;
  segment::Medium line_;
  FfDisturb disturb_;
  std::function<void(const FfDriven&)> listener_;
  std::deque<FfLas> masters_;
  std::deque<FfStation> devices_;
  std::deque<Seat> seats_;
  std::deque<std::unique_ptr<fault::Channel>> channels_;
};

// An application that wants nothing.
class FfSilentUser : public FfUser {
 public:
  void on_data(const FfDlpdu&, kernel::Time) override {}
  void on_published(const FfDlpdu&, kernel::Time) override {}
  void on_event(const FfEvent&, kernel::Time) override {}
};

}  // namespace fieldproof::fieldbus_dll
