#pragma once

#include <optional>
#include <vector>

#include "conformance/fieldbus_dll/isa_seeded_faults.hpp"
#include "harness/line/delimited_frame.hpp"
#include "harness/line/frame_check.hpp"

// Data link entities that hear, read or write frames otherwise.
namespace fieldproof::conformance::isa_seeded_faults {

class ShortFramesNotChecked : public IsaDle {
  using IsaDle::IsaDle;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    constexpr std::size_t kToken = 5;
    for (line::DelimitedFrame& frame : line::delimited_frames_in(reception, rules().link.bit_rate)) {
      if (frame.end != line::FrameEnd::whole || frame.octets.size() != kToken) continue;
      frame.octets.resize(kToken - fieldbus_dll::kCheckOctets);
      return {{frame.octets, reception.start, reception.end()}};
    }
    return IsaDle::heard_in(reception);
  }
};

class CheckFromZeroToo : public IsaDle {
  using IsaDle::IsaDle;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    line::FrameCheckParameters parameters = line::frame_check_named("CRC-16/PROFIBUS");
    parameters.init = 0;
    for (line::DelimitedFrame& frame : line::delimited_frames_in(reception, rules().link.bit_rate)) {
      if (frame.end != line::FrameEnd::whole || frame.octets.size() <= fieldbus_dll::kCheckOctets) continue;
      const std::size_t size = frame.octets.size() - fieldbus_dll::kCheckOctets;
      const auto found = static_cast<unsigned>(frame.octets[size] << 8 | frame.octets[size + 1]);
      frame.octets.resize(size);
      const auto wanted = static_cast<unsigned>(line::FrameCheck(parameters).compute(frame.octets));
      if (found == wanted) return {{frame.octets, reception.start, reception.end()}};
    }
    return IsaDle::heard_in(reception);
  }
};

// A symbol without an edge in its middle is taken for what its first half says.
class ViolationsAreBits : public IsaDle {
  using IsaDle::IsaDle;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    constexpr std::size_t kDelimiter = 16;
    const auto frames = line::delimited_frames_in(reception, rules().link.bit_rate);
    if (frames.empty() || frames.front().end != line::FrameEnd::code_violation)
      return IsaDle::heard_in(reception);
    line::Waveform mended{reception.start, 2 * rules().link.bit_rate,
                          line::half_bits_of(reception, rules().link.bit_rate)};
    for (std::size_t at = frames.front().half_bit + kDelimiter; at + kDelimiter < mended.levels.size();
         at += 2)
      mended.levels.set(at + 1, !mended.levels[at]);
    return IsaDle::heard_in(mended);
  }
};

class StuckBehindViolation : public IsaDle {
  using IsaDle::IsaDle;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    for (const line::DelimitedFrame& frame : line::delimited_frames_in(reception, rules().link.bit_rate))
      is_stuck_ |= frame.end == line::FrameEnd::code_violation;
    return is_stuck_ ? std::vector<Arrived>{} : IsaDle::heard_in(reception);
  }
  bool is_stuck_ = false;
};

class ReservedBitIgnored : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    Octets other(octets.begin(), octets.end());
    if (!other.empty()) other[0] &= 0xF7;
    return IsaDle::understood(other);
  }
};

class PriorityZeroTaken : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    Octets other(octets.begin(), octets.end());
    if (!other.empty() && other[0] == rules().codes.et) other[0] |= 1;
    return IsaDle::understood(other);
  }
};

class LengthNotChecked : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    constexpr std::size_t kEt = 3;
    const bool is_et = octets.size() > kEt && (octets[0] & 0xF0) == rules().codes.et;
    return IsaDle::understood(is_et ? octets.first(kEt) : octets);
  }
};

class ZeroIsForEver : public IsaDle {
  using IsaDle::IsaDle;
  std::optional<IsaDlpdu> understood(Heard octets) const override {
    constexpr std::size_t kEs = 5;
    Octets other(octets.begin(), octets.end());
    const bool is_es = other.size() == kEs && (other[0] & 0xF0) == rules().codes.es;
    if (is_es && other[3] == 0 && other[4] == 0) other[3] = other[4] = 0xFF;
    return IsaDle::understood(other);
  }
};

class WantsOnePreambleOctet : public IsaDle {
  using IsaDle::IsaDle;
  std::vector<Arrived> heard_in(const line::Waveform& reception) override {
    constexpr std::size_t kOneOctet = 16;
    const auto frames = line::delimited_frames_in(reception, rules().link.bit_rate);
    if (!frames.empty() && frames.front().half_bit > kOneOctet) return {};
    return IsaDle::heard_in(reception);
  }
};

// What it drives differs from a frame.
class FrameOtherwise : public IsaDle {
 public:
  using IsaDle::IsaDle;

 private:
  virtual line::Levels half_bits(const Octets& octets) const = 0;
  Time put_on_line(const Octets& octets, Time now) override { return line().drive(half_bits(octets), now); }
};

inline line::Levels right_half_bits(const Octets& checked) {
  line::Levels levels;
  line::DelimitedFrameCode().append(levels, checked);
  return levels;
}

class SendsNoPreamble : public FrameOtherwise {
  using FrameOtherwise::FrameOtherwise;
  line::Levels half_bits(const Octets& octets) const override {
    const line::Levels all = right_half_bits(fieldbus_dll::with_check(octets));
    return all.slice(16, all.size() - 16);
  }
};

class EndDelimiterTurned : public FrameOtherwise {
  using FrameOtherwise::FrameOtherwise;
  line::Levels half_bits(const Octets& octets) const override {
    line::Levels all = right_half_bits(fieldbus_dll::with_check(octets));
    all.invert(all.size() - 16, all.size());
    return all;
  }
};

class LeastSignificantBitFirst : public FrameOtherwise {
  using FrameOtherwise::FrameOtherwise;
  line::Levels half_bits(const Octets& octets) const override {
    Octets turned = fieldbus_dll::with_check(octets);
    for (std::uint8_t& octet : turned) octet = static_cast<std::uint8_t>(line::reflect(octet, 8));
    return right_half_bits(turned);
  }
};

}  // namespace fieldproof::conformance::isa_seeded_faults
