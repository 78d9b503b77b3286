#include "harness/network/exchange_statistics.hpp"

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::network {

ErrorStatistics& ErrorStatistics::operator+=(const ErrorStatistics& other) {
  for (const auto member :
       {&ErrorStatistics::sent, &ErrorStatistics::corrupted, &ErrorStatistics::detected,
        &ErrorStatistics::missing, &ErrorStatistics::retried, &ErrorStatistics::repeated,
        &ErrorStatistics::accepted_wrong_inputs, &ErrorStatistics::accepted_wrong_outputs,
        &ErrorStatistics::wrong_exchanges, &ErrorStatistics::untouched, &ErrorStatistics::without_effect,
        &ErrorStatistics::refused, &ErrorStatistics::differed, &ErrorStatistics::missed_outputs,
        &ErrorStatistics::cleared_outputs, &ErrorStatistics::partly_latched}) {
    this->*member += other.*member;
  }
  return *this;
}

ExchangeStatistics::ExchangeStatistics(Network& network, kernel::Random random)
    : network_(network), random_(std::move(random)), words_(network.signals().size()) {
  for (std::size_t n = 0; n < words_.size(); ++n) {
    if (network.signals()[n].is_image) images_.push_back(n);
  }
}

void ExchangeStatistics::begin() {
  counts_ = {};
  first_wrong_.reset();
  wrong_before_ = 0;
}

void ExchangeStatistics::begin_recovery() {
  for (Word& word : words_) word.is_delivered = false;
  undelivered_ = words_.size();
}

void ExchangeStatistics::end() {
  if (counts_.accepted_wrong() == wrong_before_) return;
  ++counts_.sent;
  weigh(LineEffect::untouched, false);
}

void ExchangeStatistics::on_exchange(const Exchange& exchange, LineEffect effect) {
  FIELDPROOF_CHECK(exchange.first_signal + exchange.signal_count <= words_.size(),
                   "an exchange carries signals of its network");
  count(exchange, effect == LineEffect::changed);
  judge_images(exchange);
  const bool is_good = exchange.kind == ExchangeKind::data && exchange.outcome == Outcome::served;
  if (is_good) {
    judge_shown(exchange);
    if (!has_missed_) ++good_exchanges_;
  }
  if (exchange.kind == ExchangeKind::data) weigh(effect, is_good && !has_missed_ && exchange.retries == 0);
  has_taken_over_ = false;
  renew(exchange);
}

void ExchangeStatistics::count(const Exchange& exchange, bool is_corrupted) {
  const bool is_served = exchange.outcome == Outcome::served;
  if (exchange.kind == ExchangeKind::data) {
    ++counts_.sent;
    counts_.retried += exchange.retries;
    if (is_corrupted) ++counts_.corrupted;
    if (!is_served) {
      ++counts_.detected;
      if (exchange.outcome == Outcome::missing) ++counts_.missing;
      if (has_taken_over_) ++counts_.partly_latched;
    }
  } else if (was_unserved_) {
    ++counts_.repeated;
  }
  was_unserved_ = !is_served;
}

// A word that comes wrong in an exchange for service counts in the next one of data.
void ExchangeStatistics::weigh(LineEffect effect, bool is_whole) {
  if (counts_.accepted_wrong() != wrong_before_) {
    ++counts_.wrong_exchanges;
    ++counts_.differed;
  } else if (!is_whole) {
    ++counts_.refused;
    if (effect == LineEffect::changed) ++counts_.differed;
  } else {
    ++(effect == LineEffect::untouched ? counts_.untouched : counts_.without_effect);
  }
  wrong_before_ = counts_.accepted_wrong();
}

void ExchangeStatistics::on_shown(std::size_t signal, std::uint16_t shown, kernel::Time when) {
  Word& word = words_.at(signal);
  word.shown = shown;
  if (network_.signals()[signal].safe_value == shown) {
    ++counts_.cleared_outputs;
    return;
  }
  has_taken_over_ = true;
  if (shown == word.sent || std::ranges::find(word.before, shown) != word.before.end()) return;
  accept_wrong(signal, shown, when);
}

// A served exchange brings what was at the source when it began; nothing else changes an image. Before data
// are exchanged an image may be empty.
void ExchangeStatistics::judge_images(const Exchange& exchange) {
  const bool is_good = exchange.kind == ExchangeKind::data && exchange.outcome == Outcome::served;
  const bool is_exchanging = network_.state() == State::exchanging;
  for (const std::size_t signal : images_) {
    Word& word = words_[signal];
    const std::uint16_t actual = network_.image(signal);
    const bool is_carried = is_good && signal - exchange.first_signal < exchange.signal_count;
    const std::uint16_t expected = is_carried ? word.sent : word.shown;
    if (actual != expected && (is_carried || is_exchanging)) {
      accept_wrong(signal, actual, exchange.end);
    } else if (is_carried) {
      deliver(word);
    }
    word.shown = actual;
  }
}

void ExchangeStatistics::accept_wrong(std::size_t signal, std::uint16_t got, kernel::Time when) {
  ++(network_.signals()[signal].is_output ? counts_.accepted_wrong_outputs : counts_.accepted_wrong_inputs);
  if (!first_wrong_) first_wrong_ = WrongWord{signal, words_[signal].sent, got, when};
}

// The words of a served exchange are at the sinks when it has ended.
void ExchangeStatistics::judge_shown(const Exchange& exchange) {
  has_missed_ = false;
  for (std::size_t signal = exchange.first_signal; signal < exchange.first_signal + exchange.signal_count;
       ++signal) {
    if (network_.signals()[signal].is_image) continue;
    Word& word = words_[signal];
    if (word.shown == word.sent) {
      deliver(word);
      continue;
    }
    ++counts_.missed_outputs;
    has_missed_ = true;
  }
}

void ExchangeStatistics::deliver(Word& word) {
  if (std::exchange(word.is_delivered, true)) return;
  if (undelivered_ > 0) --undelivered_;
}

void ExchangeStatistics::renew(const Exchange& exchange) {
  for (std::size_t signal = exchange.first_signal; signal < exchange.first_signal + exchange.signal_count;
       ++signal) {
    const Signal& row = network_.signals()[signal];
    Word& word = words_[signal];
    if (row.admissible_words > 1) {
      if (word.before.size() + 1 == row.admissible_words) word.before.erase(word.before.begin());
      word.before.push_back(word.sent);
    }
    word.sent = static_cast<std::uint16_t>(random_.between(1, (1 << row.bits) - 1));
    network_.set_source(signal, word.sent);
  }
}

}  // namespace fieldproof::network
