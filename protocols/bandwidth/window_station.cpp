#include "protocols/bandwidth/window_station.hpp"

#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::bandwidth {

using kernel::Time;

// ---- the line ----

std::size_t WindowLineRules::data_octets(Packet packet) const {
  switch (packet) {
    case Packet::real_time:
      return real_time_octets;
    case Packet::periodic:
      return periodic_octets;
    case Packet::non_real_time:
      return non_real_time_octets;
    case Packet::none:
      break;
  }
  return 0;
}

kernel::Duration WindowLineRules::time_of(std::size_t octets) const {
  const std::size_t levels =
      line::DelimitedFrameCode::levels_of(octets + line::kFrameCheckOctets, preamble_octets);
  return gap() + kernel::levels_duration(static_cast<std::int64_t>(levels), 2 * bit_rate);
}

void WindowStation::receive(segment::PortIndex, const line::Waveform& reception) {
  for (const Octets& octets : line::checked_frames_in(reception, rules_.bit_rate)) {
    if (const auto frame = window_frame_of(octets)) on_frame(*frame, reception.end());
  }
}

Time WindowStation::drive(const WindowFrame& frame, Time now) {
  FIELDPROOF_CHECK(line_ != nullptr, "a station that drives has been wired");
  line::Levels half_bits;
  code_.append(half_bits, line::with_frame_check(octets_of(frame, rules_.data_octets(frame.packet))),
               rules_.preamble_octets);
  line::Waveform wave{now + rules_.gap(), 2 * rules_.bit_rate, std::move(half_bits)};
  const Time end = wave.end();
  line_->drive(wave);
  return end;
}

// ---- samplings ----

bool WindowSampler::control() {
  if (!newest_) return false;
  if (next_ >= counts_from_) {
    ++books_.samplings;
    if (arrived_ == 0) ++books_.vacant;
    if (arrived_ > 1) books_.lost += arrived_ - 1;
  }
  arrived_ = 0;
  return true;
}

void WindowSampler::sample_until(Time now) {
  for (; next_ <= now; next_ += setting_.period) {
    if (setting_.is_controller && !control()) continue;
    if (waits_ && next_ >= counts_from_) ++books_.replaced;
    waits_ = Datum{next_, setting_.is_controller ? *newest_ : next_};
  }
}

void WindowSampler::arrive(Time sample, Time now) {
  // What arrives at the instant of a sampling counts for it.
  sample_until(now - kernel::kPicosecond);
  newest_ = sample;
  ++arrived_;
}

WindowSampler::Datum WindowSampler::take() {
  const Datum datum = *waits_;
  waits_.reset();
  return datum;
}

// ---- a node ----

void WindowNode::on_frame(const WindowFrame& frame, Time now) {
  const bool is_for_me = frame.type != FrameType::answer && frame.destination == setting_.node;
  if (!is_for_me) return;
  if (frame.type == FrameType::data) {
    if (frame.packet == Packet::periodic && sampler_) sampler_->arrive(frame.sample, now);
    return;
  }
  visit_.emplace(setting_.node, frame.byte);
  is_answered_ = false;
  go_on(now);
}

void WindowNode::on_time(Time now) {
  wakes_at_ = kernel::kNever;
  if (!visit_) visit_.emplace(setting_.node, PeriodicByte{});
  go_on(now);
}

Waiting WindowNode::waiting(Time now) {
  Waiting waiting;
  waiting.real_time = queues_.has_real_time(setting_.node, now);
  look_until(now);
  waiting.periodic = sampler_ && sampler_->has_datum();
  waiting.non_real_time = !waiting.periodic && queues_.has_non_real_time(setting_.node, now);
  return waiting;
}

void WindowNode::go_on(Time now) {
  const Packet packet = visit_->next(waiting(now));
  if (packet == Packet::none) {
    end_visit(now, is_answered_);
    return;
  }
  is_answered_ = packet != Packet::real_time;
  WindowFrame frame{.type = FrameType::data,
                    .packet = packet,
                    .destination = setting_.node,
                    .source = setting_.node,
                    .byte = visit_->byte()};
  if (packet == Packet::periodic) {
    const WindowSampler::Datum datum = sampler_->take();
    frame.destination = sampler_->destination();
    frame.generated = datum.generated;
    frame.sample = datum.sample;
  }
  const Time end = drive(frame, now);
  queues_.on_packet(packet, setting_.node, end);
  wakes_at_ = end;
}

void WindowNode::end_visit(Time now, bool is_answered) {
  const PeriodicByte byte = visit_->byte();
  visit_.reset();
  if (!rules().is_polled) {
    drive({.type = FrameType::token, .destination = setting_.next, .byte = byte}, now);
  } else if (!is_answered) {
    drive({.type = FrameType::answer, .source = setting_.node, .byte = byte}, now);
  }
}

// ---- the master ----

void WindowMaster::on_time(Time now) {
  wakes_at_ = kernel::kNever;
  drive({.type = FrameType::poll, .destination = node_, .byte = byte_}, now);
}

void WindowMaster::on_frame(const WindowFrame& frame, Time now) {
  byte_ = frame.byte;
  const bool is_over = frame.type == FrameType::answer || frame.packet != Packet::real_time;
  if (!is_over) return;
  node_ = static_cast<std::uint8_t>((node_ + 1U) % nodes_);
  on_time(now);
}

}  // namespace fieldproof::bandwidth
