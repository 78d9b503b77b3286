#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "harness/line/waveform.hpp"

// Where the fields of a frame lie in the levels of a transmission. This is a protocol's knowledge: the
// protocol gives one FieldMap per receiver, and the rules of a fault plan speak of its frames and fields by
// name.
//
// Contract: a map is stateful. It follows the frames on its line, so it is told every transmission exactly
// once, in order, with either `locate` or `follow`. It looks at what was sent, not at what a fault makes of
// it. It never fails: levels that are no frame of the
// protocol are in no span; a transmission without any span is one nameless field of a nameless frame 0.
namespace fieldproof::fault {

struct Span {
  std::string_view frame_kind;  // must outlive the map
  std::uint64_t frame = 1;      // number among the frames of this kind on this receiver, from 1
  std::uint32_t unit = 0;       // character or telegram within the frame, from 0
  std::string_view field;       // must outlive the map
  std::uint32_t first = 0;      // level in the waveform
  std::uint32_t count = 0;      // levels
};

class FieldMap {
 public:
  FieldMap() = default;
  FieldMap(const FieldMap&) = delete;
  FieldMap& operator=(const FieldMap&) = delete;
  virtual ~FieldMap() = default;

  // Appends the spans in order of `first`; they do not overlap. A frame may go on in the next transmission.
  virtual void locate(const line::Waveform& sent, std::vector<Span>& spans) = 0;

  // The same without an answer, for transmissions that no rule can hit.
  virtual void follow(const line::Waveform& sent) {
    ignored_.clear();
    locate(sent, ignored_);
  }

 private:
  std::vector<Span> ignored_;
};

// The map of a receiver whose protocol gave none: each transmission is one frame of the kind "transmission"
// with one unit and one field "levels".
class TransmissionFields final : public FieldMap {
 public:
  static constexpr std::string_view kFrameKind = "transmission";
  static constexpr std::string_view kField = "levels";

  void locate(const line::Waveform& sent, std::vector<Span>& spans) override {
    spans.push_back({kFrameKind, ++count_, 0, kField, 0, static_cast<std::uint32_t>(sent.levels.size())});
  }
  void follow(const line::Waveform&) override { ++count_; }

 private:
  std::uint64_t count_ = 0;
};

}  // namespace fieldproof::fault
