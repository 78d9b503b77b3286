#include "conformance/reference_walks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <variant>

#include "conformance/sequence_check.hpp"
#include "conformance/walks.hpp"
#include "harness/iut/device_recording.hpp"
#include "harness/judge/checked_lines.hpp"
#include "harness/kernel/computed_once.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

// A sanitizer looks at what the code does, not at how many states there are.
constexpr std::size_t kCommandsOfWalks = kernel::kIsSanitized ? 8 : 16;
constexpr std::size_t kMostStatesIfSanitized = 6;

// What an implementation does, without when and without the data: counters and data make states without end,
// and what is in a frame is compared anyway.
std::string text_of(const iut::Act& act) {
  if (const auto* driver = std::get_if<iut::SwitchedDriver>(&act))
    return fmt::format("driver {} {};", driver->port, driver->is_on);
  if (const auto* sent = std::get_if<iut::Sent>(&act))
    return fmt::format("send {} {};", sent->port, sent->characters.size());
  if (const auto* drove = std::get_if<iut::DroveLevels>(&act))
    return fmt::format("drive {} {};", drove->port, drove->wave.levels.size());
  if (const auto* wrote = std::get_if<iut::Wrote>(&act)) return fmt::format("write {};", wrote->item);
  return {};
}

bool is_stimulus(iut::CallKind kind) {
  return kind == iut::CallKind::power || kind == iut::CallKind::characters || kind == iut::CallKind::levels ||
         kind == iut::CallKind::activity;
}

Sequence sequence_of(const WalkWord& word, const std::vector<SequenceCommand>& alphabet) {
  Sequence made;
  for (const std::size_t command : word) made.commands.push_back(alphabet[command]);
  return made;
}

// Runs words on benches of their own and remembers how far their beginnings came.
class ReferenceAnswers {
 public:
  ReferenceAnswers(const Suite& suite, const SequenceRole& role, const std::vector<SequenceCommand>& alphabet)
      : suite_(suite), role_(role), alphabet_(alphabet) {
    setup_.volume = Volume::quick;
    setup_.record = true;
    setup_.as_device = true;
    setup_.implementations = {{.role = role.test_case.role(), .position = 0, .uri = "ref"}};
  }

  std::uint64_t operator()(const WalkWord& word) {
    const Devices devices = run(word);
    if (!devices) return 0;  // it cannot be done
    const kernel::Time from = begin_of_last(trail_of(devices), trail_of_beginning(word));
    std::string text;
    for (const iut::RecordedDevice& device : devices->devices()) {
      for (const iut::RecordedCall& call : device.calls) {
        if (call.at < from) continue;
        for (const iut::Act& act : call.acts) text += text_of(act);
      }
      text += "|";
    }
    return judge::check_of(text);
  }

 private:
  struct Stimulus {
    std::size_t device;
    iut::CallKind kind;
    kernel::Time at;
    friend bool operator==(const Stimulus&, const Stimulus&) = default;
  };
  struct Trail {
    std::vector<Stimulus> stimuli;
    kernel::Time end = kernel::kStart;
  };
  using Devices = std::shared_ptr<const iut::DeviceRecording>;

  Devices run(const WalkWord& word) const {
    return run_sequence(suite_, role_, sequence_of(word, alphabet_), setup_).recording.devices;
  }

  static Trail trail_of(const Devices& devices) {
    Trail trail;
    if (!devices) return trail;
    for (std::size_t n = 0; n < devices->devices().size(); ++n) {
      for (const iut::RecordedCall& call : devices->devices()[n].calls) {
        trail.end = std::max(trail.end, call.at);
        if (is_stimulus(call.kind)) trail.stimuli.push_back({n, call.kind, call.at});
      }
    }
    std::ranges::stable_sort(trail.stimuli, {}, &Stimulus::at);
    return trail;
  }

  const Trail& trail_of_beginning(WalkWord word) {
    word.pop_back();
    const auto known = trails_.find(word);
    if (known != trails_.end()) return known->second;
    return trails_.emplace(word, trail_of(run(word))).first->second;
  }

  // Up to there both went the same way.
  static kernel::Time begin_of_last(const Trail& whole, const Trail& beginning) {
    const auto [first, other] = std::ranges::mismatch(whole.stimuli, beginning.stimuli);
    return first == whole.stimuli.end() ? beginning.end : first->at;
  }

  const Suite& suite_;
  const SequenceRole& role_;
  const std::vector<SequenceCommand>& alphabet_;
  Setup setup_;
  std::map<WalkWord, Trail> trails_;
};

struct RoleWalks {
  std::vector<SequenceCommand> alphabet;
  Walks walks;
};

WalkBounds bounds_of(const SequenceRole& role, Volume volume) {
  const std::size_t most =
      kernel::kIsSanitized ? std::min(role.most_states, kMostStatesIfSanitized) : role.most_states;
  return {.most_states = most, .more = volume == Volume::full ? 1U : 0U};
}

RoleWalks made_walks(const Suite& suite, const SequenceRole& role, Volume volume) {
  RoleWalks made{walk_alphabet(role.vocabulary, kCommandsOfWalks), {}};
  ReferenceAnswers answers(suite, role, made.alphabet);
  made.walks = explore(
      made.alphabet.size(), [&](const WalkWord& word) { return answers(word); }, bounds_of(role, volume));
  return made;
}

const RoleWalks& walks_of(const Suite& suite, const SequenceRole& role, Volume volume) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<kernel::ComputedOnce<RoleWalks>>> known;
  kernel::ComputedOnce<RoleWalks>* walks = nullptr;
  {
    const std::lock_guard lock(mutex);
    auto& one = known[fmt::format("{} {}", role.test_case.id, name(volume))];
    if (!one) {
      one = std::make_unique<kernel::ComputedOnce<RoleWalks>>(
          [&suite, &role, volume] { return made_walks(suite, role, volume); });
    }
    walks = one.get();
  }
  return walks->get();
}

}  // namespace

DerivedSequences walk_sequences(const Suite& suite, const SequenceRole& role, Volume volume, std::size_t most,
                                kernel::Random random) {
  const auto& [alphabet, walks] = walks_of(suite, role, volume);
  std::vector<std::function<Sequence()>> makers;
  for (const WalkWord& word : walks.words) {
    makers.push_back([&alphabet, &word] { return sequence_of(word, alphabet); });
  }
  DerivedSequences derived = taken_of(std::move(makers), most, random);
  derived.counts = {{"commands of the walks", alphabet.size()},
                    {walks.is_whole ? "states told apart" : "states told apart, of more", walks.states}};
  return derived;
}

std::vector<std::string> surprise_of(const Suite& suite, const SequenceRole& role) {
  const std::vector<SequenceCommand> alphabet = walk_alphabet(role.vocabulary, kCommandsOfWalks);
  ReferenceAnswers answers(suite, role, alphabet);
  const auto word = first_surprise(
      alphabet.size(), [&](const WalkWord& asked) { return answers(asked); }, bounds_of(role, Volume::quick));
  return word ? sequence_lines(sequence_of(*word, alphabet), role.vocabulary) : std::vector<std::string>();
}

}  // namespace fieldproof::conformance
