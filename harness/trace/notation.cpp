#include "harness/trace/notation.hpp"

#include <fmt/format.h>

#include <variant>

namespace fieldproof::trace {
namespace {

constexpr std::size_t kMostLevelsShown = 400;

class PlainTeller final : public Teller {
 public:
  Told tell(const line::Waveform& wave) override { return {PlainNotation().brief(wave), false}; }
};

// What stands behind time and channel.
class LineWriter {
 public:
  explicit LineWriter(const Notation& notation) : notation_(notation) {}

  std::string operator()(const Transmission& transmission) const {
    const line::Waveform& wave = transmission.wave;
    std::string text = notation_.brief(wave);
    if (wave.rate != notation_.bit_rate()) text += fmt::format("  at {} levels/s", wave.rate);
    if (wave.levels.size() <= kMostLevelsShown) text += fmt::format("  [{}]", wave.levels.text());
    return text;
  }
  std::string operator()(const Fault& fault) const { return fmt::format("fault: {}", fault.text); }
  std::string operator()(const Observation& observation) const {
    return fmt::format("{} = {}", observation.what, observation.value);
  }

 private:
  const Notation& notation_;
};

}  // namespace

std::string PlainNotation::brief(const line::Waveform& wave) const {
  return fmt::format("{} levels", wave.levels.size());
}

std::unique_ptr<Teller> PlainNotation::teller() const {
  return std::make_unique<PlainTeller>();
}

std::vector<std::string> text_lines(const Recording& recording, const Notation& notation) {
  std::vector<std::string> lines;
  lines.reserve(recording.records.size());
  const LineWriter writer(notation);
  for (const Record& record : recording.records) {
    lines.push_back(fmt::format("{}  {}  {}", kernel::describe(time_of(record)),
                                recording.channels.at(channel_of(record)), std::visit(writer, record)));
  }
  return lines;
}

}  // namespace fieldproof::trace
