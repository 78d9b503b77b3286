#include "harness/trace/dissector.hpp"

#include <fmt/format.h>

#include <variant>

namespace fieldproof::trace {
namespace {

constexpr std::size_t kMostLevelsShown = 400;

class PlainTeller final : public Teller {
 public:
  Decoded tell(const line::Waveform& wave) override { return {PlainDissector().brief(wave), false}; }
};

// What stands after time and channel.
class LineWriter {
 public:
  explicit LineWriter(const Dissector& dissector) : dissector_(dissector) {}

  std::string operator()(const Transmission& transmission) const {
    const line::Waveform& wave = transmission.wave;
    std::string text = dissector_.brief(wave);
    if (wave.rate != dissector_.bit_rate()) text += fmt::format("  at {} levels/s", wave.rate);
    if (wave.levels.size() <= kMostLevelsShown) text += fmt::format("  [{}]", wave.levels.text());
    return text;
  }
  std::string operator()(const Fault& fault) const { return fmt::format("fault: {}", fault.text); }
  std::string operator()(const Observation& observation) const {
    return fmt::format("{} = {}", observation.what, observation.value);
  }

 private:
  const Dissector& dissector_;
};

}  // namespace

std::string PlainDissector::brief(const line::Waveform& wave) const {
  return fmt::format("{} levels", wave.levels.size());
}

std::unique_ptr<Teller> PlainDissector::teller() const {
  return std::make_unique<PlainTeller>();
}

std::vector<std::string> text_lines(const Recording& recording, const Dissector& dissector) {
  std::vector<std::string> lines;
  lines.reserve(recording.records.size() + recording.steps.size());
  const LineWriter writer(dissector);
  auto step = recording.steps.begin();
  const auto add_steps_until = [&](kernel::Time time) {
    for (; step != recording.steps.end() && step->time <= time; ++step) {
      lines.push_back(fmt::format("{}  step {}", kernel::describe(step->time), step->text));
    }
  };
  for (const Record& record : recording.records) {
    add_steps_until(time_of(record));
    lines.push_back(fmt::format("{}  {}  {}", kernel::describe(time_of(record)),
                                recording.channels.at(channel_of(record)), std::visit(writer, record)));
  }
  add_steps_until(kernel::kNever);
  return lines;
}

}  // namespace fieldproof::trace
