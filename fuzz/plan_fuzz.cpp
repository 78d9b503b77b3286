// The reader of fault plans fed with arbitrary octets. Invariants: every text is either read or refused with
// kernel::Error(configuration) that names its place; the canonical text of what was read gives the same plan
// and the same canonical text again; whatever was read can be installed and lets a few transmissions pass,
// and arrivals are in order and do not overlap.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/fault/telegram_fields.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace {

using namespace fieldproof;

const line::TelegramCode& code() {
  static const line::TelegramCode telegrams{line::TelegramLayout{}};
  return telegrams;
}

// Inverts every level of what it is asked about.
class Inverts final : public fault::Channel {
 public:
  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    line::Waveform& arrival = arrivals.add(sent);
    arrival.levels.invert(0, arrival.levels.size());
    return true;
  }
};

fault::DisturbanceModel read_inverts(const config::Value& value) {
  config::read_object(value, [](config::ObjectReader&) {});
  return {"inverts", "{}", [](const fault::StressPlace&) { return std::make_unique<Inverts>(); }};
}

const std::array<fault::DisturbanceKind, 1> kKinds{{{"inverts", read_inverts}}};

fault::Plan plan_of(std::string text) {
  const config::Document document = config::Document::parse(std::move(text), "fuzz.json");
  return fault::read_plan(document.root(), {&code(), kKinds});
}

void let_pass(const fault::Plan& plan) {
  trace::Trace trace;
  const trace::Channel place = trace.add_channel("rx");
  fault::InstalledPlan installed(plan, trace, kernel::Random(1));
  fault::Channel* channel = installed.channel_for(
      {"rx", place, 500'000}, std::make_unique<fault::TelegramFields>(line::TelegramLayout{}));
  if (channel == nullptr) return;
  line::Waveform sent;
  sent.rate = 500'000;
  for (std::uint8_t n = 0; n < 4; ++n) code().append(sent.levels, line::kDataTelegram, n);
  line::Waveforms arrivals;
  for (int n = 0; n < 4; ++n) {
    arrivals.clear();
    trace.observe(place, sent.start, "running");
    channel->pass(sent, arrivals);
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
      FIELDPROOF_CHECK(arrivals[i].start >= sent.start, "nothing arrives before it was sent");
      FIELDPROOF_CHECK(i == 0 || arrivals[i - 1].end() <= arrivals[i].start, "arrivals do not overlap");
    }
    sent.start = sent.end() + kernel::kMillisecond;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Plans with more rules than this only cost time.
  if (size > 4096) return 0;
  try {
    const fault::Plan plan = plan_of(std::string(data, data + size));
    const std::string text = fault::canonical_text(plan);
    const fault::Plan again = plan_of(text);
    FIELDPROOF_CHECK(again == plan, "the canonical text of a plan gives the plan again");
    FIELDPROOF_CHECK(fault::canonical_text(again) == text, "there is one canonical text");
    let_pass(plan);
  } catch (const kernel::Error& error) {
    FIELDPROOF_CHECK(error.kind() == kernel::ErrorKind::configuration, "a bad plan is a configuration error");
    FIELDPROOF_CHECK(std::string_view(error.what()).starts_with("fuzz.json:"),
                     "an error of a plan begins with its file");
  }
  return 0;
}
