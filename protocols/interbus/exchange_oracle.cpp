#include "protocols/interbus/exchange_oracle.hpp"

namespace fieldproof::interbus {

ExchangeOracle::ExchangeOracle(MasterDevice& master, Ring& ring, kernel::Random random)
    : master_(master),
      ring_(ring),
      random_(random),
      sent_(ring.word_count()),
      at_terminals_(ring.word_count()),
      held_(ring.word_count()),
      put_out_(ring.word_count()) {
  for (int position = 1; position <= static_cast<int>(ring.size()); ++position) watch(position);
}

void ExchangeOracle::begin() {
  ledger_ = {};
  first_wrong_.reset();
  wrong_before_ = 0;
}

void ExchangeOracle::on_cycle_end(kernel::Time now, bool is_data, bool accepted, bool is_corrupted) {
  if (is_data) {
    ++ledger_.sent;
    if (is_corrupted) ++ledger_.corrupted;
    if (!accepted) {
      ++ledger_.detected;
      if (has_latched_) ++ledger_.partly_latched;
    }
  } else if (was_rejected_) {
    ++ledger_.repeated;
  }
  was_rejected_ = !accepted;
  judge_inputs(now, is_data && accepted);
  if (is_data && accepted) {
    judge_outputs();
    if (!has_missed_) ++good_cycles_;
  }
  if (ledger_.accepted_wrong() != wrong_before_) ++ledger_.wrong_cycles;
  wrong_before_ = ledger_.accepted_wrong();
  has_latched_ = false;
  exchange(now);
}

void ExchangeOracle::watch(int position) {
  const unsigned first = ring_.first_word(position);
  ring_.terminals(position).on_change([this, first](const TerminalBlock::Change& change) {
    const unsigned word = first + change.word;
    put_out_[word] = change.after;
    if (change.after == 0) {
      ++ledger_.cleared_outputs;  // the safe value, never sent
      return;
    }
    has_latched_ = true;
    if (change.after != sent_[word]) accept_wrong({true, word, sent_[word], change.after, change.when});
  });
}

// A good data cycle brings what was at the terminals when it began; nothing else changes the image. Outside
// of `run` an image may be empty.
void ExchangeOracle::judge_inputs(kernel::Time now, bool is_good_data) {
  const bool is_running = master_.status().state == MasterState::run;
  for (unsigned word = 0; word < held_.size(); ++word) {
    const std::uint16_t actual = master_.input(word);
    const std::uint16_t expected = is_good_data ? at_terminals_[word] : held_[word];
    if ((is_good_data || is_running) && actual != expected) {
      accept_wrong({false, word, expected, actual, now});
    }
    held_[word] = actual;
  }
}

void ExchangeOracle::accept_wrong(const WrongWord& wrong) {
  ++(wrong.is_output ? ledger_.accepted_wrong_outputs : ledger_.accepted_wrong_inputs);
  if (!first_wrong_) first_wrong_ = wrong;
}

// The words of a cycle that the master takes for good are at the outputs when it has ended.
void ExchangeOracle::judge_outputs() {
  has_missed_ = false;
  for (int position = 1; position <= static_cast<int>(ring_.size()); ++position) {
    for (unsigned n = 0; n < ring_.configuration(position).words; ++n) {
      const unsigned word = ring_.first_word(position) + n;
      if (put_out_[word] == sent_[word]) continue;
      ++ledger_.missed_outputs;
      has_missed_ = true;
    }
  }
}

void ExchangeOracle::exchange(kernel::Time now) {
  for (int position = 1; position <= static_cast<int>(ring_.size()); ++position) {
    const unsigned words = ring_.configuration(position).words;
    for (unsigned n = 0; n < words; ++n) {
      const unsigned word = ring_.first_word(position) + n;
      sent_[word] = static_cast<std::uint16_t>(random_.between(1, 0xFFFF));
      at_terminals_[word] = static_cast<std::uint16_t>(random_.between(1, 0xFFFF));
      master_.write_output(word, sent_[word], now);
      ring_.terminals(position).set_input(n, at_terminals_[word]);
    }
  }
}

}  // namespace fieldproof::interbus
