#pragma once

#include <cstdint>
#include <optional>

#include "harness/line/checked_frame.hpp"
#include "harness/segment/station.hpp"
#include "protocols/bandwidth/window_frame.hpp"

// Stations on a line of IEC 61158-2 whose server is a token or a poll: nodes, and the master of polling.
// Quiet lines only: a server that is lost is not made again.
namespace fieldproof::bandwidth {

struct WindowLineRules {
  std::int64_t bit_rate = 1'000'000;
  unsigned preamble_octets = 1;
  unsigned gap_octets = 4;  // of silence before each frame
  bool is_polled = false;
  std::size_t real_time_octets = 8;  // of data in a packet
  std::size_t periodic_octets = 32;
  std::size_t non_real_time_octets = 200;

  kernel::Duration gap() const { return kernel::levels_duration(8 * std::int64_t{gap_octets}, bit_rate); }
  std::size_t data_octets(Packet packet) const;
  // Of a frame of so many octets and its check, with the gap before it.
  kernel::Duration time_of(std::size_t octets) const;
  kernel::Duration time_of_packet(Packet packet) const {
    return time_of(kDataHeaderOctets + data_octets(packet));
  }
};

// What drives and receives frames.
class WindowStation : public segment::Station {
 public:
  explicit WindowStation(const WindowLineRules& rules) : rules_(rules) {}
  void wire(segment::Port& line) { line_ = &line; }

  void receive(segment::PortIndex port, const line::Waveform& reception) override;

 protected:
  const WindowLineRules& rules() const { return rules_; }
  // Begins a gap after `now`; gives its end.
  kernel::Time drive(const WindowFrame& frame, kernel::Time now);
  virtual void on_frame(const WindowFrame& frame, kernel::Time now) = 0;

 private:
  WindowLineRules rules_;
  line::DelimitedFrameCode code_;
  segment::Port* line_ = nullptr;
};

// The sensor or the controller of a loop, whose samplings are looked at when the server comes.
class WindowSampler {
 public:
  struct Setting {
    bool is_controller = false;
    kernel::Time first{};  // sampling
    kernel::Duration period{};
    std::uint8_t destination = 0;  // of a sensor its controller, of a controller its own node: the actuator
  };
  struct Datum {
    kernel::Time generated{};
    kernel::Time sample{};
  };
  struct Books {
    std::uint64_t samplings = 0, vacant = 0, lost = 0, replaced = 0;
    friend bool operator==(const Books&, const Books&) = default;
  };

  // Samplings before `counts_from` are in no book.
  WindowSampler(const Setting& setting, kernel::Time counts_from)
      : setting_(setting), next_(setting.first), counts_from_(counts_from) {}

  void sample_until(kernel::Time now);  // and at it
  // A sensor datum at a controller.
  void arrive(kernel::Time sample, kernel::Time now);
  bool has_datum() const { return waits_.has_value(); }
  Datum take();
  std::uint8_t destination() const { return setting_.destination; }
  const Books& books() const { return books_; }

 private:
  bool control();

  Setting setting_;
  kernel::Time next_;
  kernel::Time counts_from_;
  std::optional<Datum> waits_{};
  std::optional<kernel::Time> newest_{};  // sample that has arrived
  unsigned arrived_ = 0;
  Books books_;
};

// What else a node has to send.
class OtherQueues {
 public:
  virtual ~OtherQueues() = default;
  virtual bool has_real_time(std::uint8_t node, kernel::Time now) = 0;
  virtual bool has_non_real_time(std::uint8_t node, kernel::Time now) = 0;
  // It is on the line, until `end`.
  virtual void on_packet(Packet packet, std::uint8_t node, kernel::Time end) = 0;
};

class WindowNode final : public WindowStation {
 public:
  struct Setting {
    std::uint8_t node = 0;
    std::uint8_t next = 0;  // to which the token goes
  };
  WindowNode(const WindowLineRules& rules, const Setting& setting, OtherQueues& queues,
             std::optional<WindowSampler> sampler)
      : WindowStation(rules), setting_(setting), queues_(queues), sampler_(std::move(sampler)) {}

  // It begins as the holder of the token.
  void begin(kernel::Time now) { wakes_at_ = now; }
  const std::optional<WindowSampler>& sampler() const { return sampler_; }
  void look_until(kernel::Time now) {
    if (sampler_) sampler_->sample_until(now);
  }

  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return wakes_at_; }

 private:
  void on_frame(const WindowFrame& frame, kernel::Time now) override;
  // The next packet of the visit, or its end.
  void go_on(kernel::Time now);
  void end_visit(kernel::Time now, bool is_answered);
  Waiting waiting(kernel::Time now);

  Setting setting_;
  OtherQueues& queues_;
  std::optional<WindowSampler> sampler_;
  std::optional<WindowVisit> visit_{};
  bool is_answered_ = false;
  kernel::Time wakes_at_ = kernel::kNever;
};

// Polls node after node, and keeps the periodic byte between them.
class WindowMaster final : public WindowStation {
 public:
  WindowMaster(const WindowLineRules& rules, unsigned nodes, std::uint8_t first)
      : WindowStation(rules), nodes_(nodes), node_(first) {}
  void begin(kernel::Time now) { wakes_at_ = now; }

  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return wakes_at_; }

 private:
  void on_frame(const WindowFrame& frame, kernel::Time now) override;

  unsigned nodes_;
  std::uint8_t node_;
  PeriodicByte byte_;
  kernel::Time wakes_at_ = kernel::kNever;
};

}  // namespace fieldproof::bandwidth
