#include "harness/network/word_exchanges.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::network {

std::uint16_t WordExchanges::sample(std::size_t signal, kernel::Time now) {
  Word& word = words_[signal];
  if (word.function) word.value = word.function(now);
  return word.value;
}

void WordExchanges::begin() {
  cancel();
  arrived_ = 0;
  for (Word& word : words_) word.has_arrived = false;
}

void WordExchanges::cancel() {
  last_call_.reset();
  for (Word& word : words_) {
    word.is_called = false;
    word.closes_at = kernel::kNever;
  }
}

void WordExchanges::begin_cycle(std::size_t kind, kernel::Time when) {
  if (watcher_ != nullptr) watcher_->on_cycle_begin(kind, when);
}

void WordExchanges::end_delay(std::size_t kind, kernel::Time from, kernel::Time to) {
  if (watcher_ != nullptr) watcher_->on_delay(kind, from, to);
}

void WordExchanges::call(std::size_t signal, kernel::Time begin, kernel::Time closes_at) {
  Word& word = words_[signal];
  FIELDPROOF_CHECK(!word.is_called, "a word has one call at a time");
  word.is_called = true;
  word.is_sent = word.is_got = false;
  word.retries = 0;
  word.closes_at = closes_at;
  last_call_ = begin;
}

void WordExchanges::call_again(std::size_t signal, kernel::Time begin, kernel::Time closes_at) {
  Word& word = words_[signal];
  FIELDPROOF_CHECK(word.is_called, "who is called again has been called");
  ++word.retries;
  word.closes_at = closes_at;
  last_call_ = begin;
}

void WordExchanges::on_got(std::size_t signal, std::uint16_t value, kernel::Time when) {
  Word& word = words_[signal];
  word.is_got = true;
  if (!std::exchange(word.has_arrived, true)) ++arrived_;
  if (watcher_ != nullptr) watcher_->on_shown(signal, value, when);
}

void WordExchanges::close(std::size_t signal, kernel::Time now) {
  Word& word = words_[signal];
  word.is_called = false;
  word.closes_at = kernel::kNever;
  if (watcher_ == nullptr) return;
  watcher_->on_exchange({.end = now,
                         .outcome = word.is_got    ? Outcome::served
                                    : word.is_sent ? Outcome::rejected
                                                   : Outcome::missing,
                         .retries = word.retries,
                         .first_signal = signal,
                         .signal_count = 1});
}

kernel::Time WordExchanges::next_close() const {
  kernel::Time next = kernel::kNever;
  for (const Word& word : words_) next = std::min(next, word.closes_at);
  return next;
}

}  // namespace fieldproof::network
