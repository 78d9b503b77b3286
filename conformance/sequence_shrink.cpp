#include "conformance/sequence_shrink.hpp"

#include <utility>

#include "conformance/minimise.hpp"

namespace fieldproof::conformance {
namespace {

class SequenceShrink {
 public:
  SequenceShrink(Sequence sequence, const SequenceVocabulary& vocabulary, const SequenceFails& still_fails)
      : best_(std::move(sequence)), vocabulary_(vocabulary), still_fails_(still_fails) {}

  Sequence run() {
    while (true) {
      const Sequence before = best_;
      shrink_settings();
      shrink_commands();
      shrink_faults();
      for (std::size_t n = 0; n < best_.commands.size(); ++n) shrink_octets(n);
      for (std::size_t n = 0; n < best_.commands.size(); ++n) simplify_numbers(n);
      if (best_ == before) return best_;
    }
  }

 private:
  // What fails is the best so far.
  bool is_better(Sequence candidate) {
    if (vocabulary_.objection_to(candidate.settings) || !still_fails_(candidate)) return false;
    best_ = std::move(candidate);
    return true;
  }

  // A setting as the bench has it anyway is none.
  void shrink_settings() {
    const Sequence shape = best_;
    (void)fewest(shape.settings,
                 [&](const field::Settings& settings) { return is_better({shape.commands, settings}); });
    for (std::size_t n = 0; n < best_.settings.size(); ++n) {
      const SequenceSetting* const setting = vocabulary_.find_setting(best_.settings[n].first);
      if (setting == nullptr || setting->is_likely_only) continue;
      (void)simplest(best_.settings[n].second, setting->simple, [&](std::int64_t value) {
        Sequence candidate = best_;
        candidate.settings[n].second = value;
        return value != setting->simple && is_better(std::move(candidate));
      });
    }
  }

  void shrink_commands() {
    const Sequence shape = best_;
    (void)fewest(shape.commands, [&](const std::vector<SequenceCommand>& commands) {
      return is_better({commands, shape.settings});
    });
  }

  void shrink_faults() {
    std::vector<std::pair<std::size_t, SequenceFault>> all;
    for (std::size_t n = 0; n < best_.commands.size(); ++n) {
      for (const SequenceFault& fault : best_.commands[n].faults) all.emplace_back(n, fault);
    }
    const Sequence shape = best_;
    (void)fewest(all, [&](const auto& faults) {
      Sequence candidate = shape;
      for (SequenceCommand& command : candidate.commands) command.faults.clear();
      for (const auto& [n, fault] : faults) candidate.commands[n].faults.push_back(fault);
      return is_better(std::move(candidate));
    });
  }

  void shrink_octets(std::size_t n) {
    if (best_.commands[n].octets.empty()) return;
    const Sequence shape = best_;
    (void)fewest(shape.commands[n].octets, [&](const std::vector<std::uint8_t>& octets) {
      Sequence candidate = shape;
      candidate.commands[n].octets = octets;
      return !octets.empty() && is_better(std::move(candidate));
    });
    for (std::size_t k = 0; k < best_.commands[n].octets.size(); ++k) {
      (void)simplest(int{best_.commands[n].octets[k]}, 0, [&](int octet) {
        Sequence candidate = best_;
        candidate.commands[n].octets[k] = static_cast<std::uint8_t>(octet);
        return is_better(std::move(candidate));
      });
    }
  }

  void simplify_numbers(std::size_t n) {
    const SequenceWord& word = vocabulary_.words[best_.commands[n].word];
    for (std::size_t k = 0; k < word.numbers.size(); ++k) {
      const SequenceNumber& number = word.numbers[k];
      const auto fails_with = [&](std::int64_t value) {
        Sequence candidate = best_;
        candidate.commands[n].numbers[k] = value;
        return is_better(std::move(candidate));
      };
      if (!number.is_likely_only) {
        (void)simplest(best_.commands[n].numbers[k], number.simple, fails_with);
      } else if (best_.commands[n].numbers[k] != number.simple) {
        (void)fails_with(number.simple);
      }
    }
  }

  Sequence best_;
  const SequenceVocabulary& vocabulary_;
  const SequenceFails& still_fails_;
};

}  // namespace

Sequence shrunk(Sequence sequence, const SequenceVocabulary& vocabulary, const SequenceFails& still_fails) {
  return SequenceShrink(std::move(sequence), vocabulary, still_fails).run();
}

}  // namespace fieldproof::conformance
