#include "conformance/covering_array.hpp"

#include <optional>
#include <utility>

namespace fieldproof::conformance {
namespace {

struct Value {
  std::size_t factor;
  std::size_t number;
};

// Which pairs of values have not stood in a row yet.
class OpenPairs {
 public:
  explicit OpenPairs(const std::vector<std::size_t>& values) : values_(values) {
    for (const std::size_t count : values) {
      first_.push_back(all_);
      all_ += count;
    }
    is_open_.assign(all_ * all_, false);
    for (std::size_t one = 0; one < values.size(); ++one)
      for (std::size_t other = one + 1; other < values.size(); ++other)
        for (std::size_t a = 0; a < values[one]; ++a)
          for (std::size_t b = 0; b < values[other]; ++b) set({one, a}, {other, b}, true);
  }

  std::size_t count() const { return count_; }
  bool is_open(Value one, Value other) const { return is_open_[place(one, other)]; }
  void close(Value one, Value other) {
    if (is_open(one, other)) set(one, other, false);
  }
  void close(const ValueRow& row) {
    for (std::size_t one = 0; one < row.size(); ++one)
      for (std::size_t other = one + 1; other < row.size(); ++other)
        close({one, row[one]}, {other, row[other]});
  }
  // The first one; there is one.
  std::pair<Value, Value> first() const {
    for (std::size_t one = 0; one < values_.size(); ++one)
      for (std::size_t other = one + 1; other < values_.size(); ++other)
        for (std::size_t a = 0; a < values_[one]; ++a)
          for (std::size_t b = 0; b < values_[other]; ++b)
            if (is_open({one, a}, {other, b})) return {{one, a}, {other, b}};
    return {};
  }

 private:
  std::size_t place(Value one, Value other) const {
    return (first_[one.factor] + one.number) * all_ + first_[other.factor] + other.number;
  }
  void set(Value one, Value other, bool is_open) {
    is_open_[place(one, other)] = is_open_[place(other, one)] = is_open;
    if (is_open)
      ++count_;
    else
      --count_;
  }

  const std::vector<std::size_t>& values_;
  std::vector<std::size_t> first_{};
  std::size_t all_ = 0;
  std::vector<bool> is_open_{};
  std::size_t count_ = 0;
};

// A row with the values of a pair. Of each other factor, in random order, it has the value that closes most
// pairs, any of them where several do; or any value at all.
class Filling {
 public:
  Filling(const std::vector<std::size_t>& values, const OpenPairs& open, kernel::Random& random)
      : values_(values), open_(open), random_(random) {}

  ValueRow row_with(const std::pair<Value, Value>& pair, bool is_at_random) {
    std::vector<Value> chosen{pair.first, pair.second};
    std::vector<std::size_t> others;
    for (std::size_t factor = 0; factor < values_.size(); ++factor)
      if (factor != pair.first.factor && factor != pair.second.factor) others.push_back(factor);
    while (!others.empty()) {
      const std::size_t next = random_.below(others.size());
      chosen.push_back({others[next], is_at_random
                                          ? static_cast<std::size_t>(random_.below(values_[others[next]]))
                                          : best_of(others[next], chosen)});
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(next));
    }
    ValueRow row(values_.size());
    for (const Value& one : chosen) row[one.factor] = one.number;
    return row;
  }

 private:
  std::size_t best_of(std::size_t factor, const std::vector<Value>& chosen) {
    std::size_t best = 0;
    std::size_t most = 0;
    std::size_t alike = 0;
    for (std::size_t number = 0; number < values_[factor]; ++number) {
      std::size_t closes = 0;
      for (const Value& one : chosen) closes += open_.is_open({factor, number}, one) ? 1U : 0U;
      if (alike == 0 || closes > most) {
        best = number;
        most = closes;
        alike = 1;
      } else if (closes == most && random_.below(++alike) == 0) {
        best = number;
      }
    }
    return best;
  }

  const std::vector<std::size_t>& values_;
  const OpenPairs& open_;
  kernel::Random& random_;
};

}  // namespace

CoveringArray covering_array(const std::vector<std::size_t>& values,
                             const std::function<bool(const ValueRow&)>& may_be, kernel::Random random) {
  OpenPairs open(values);
  Filling filling(values, open, random);
  CoveringArray array{.pairs = open.count()};
  while (open.count() > 0) {
    const auto pair = open.first();
    std::optional<ValueRow> row;
    for (unsigned tries = 0; !row && tries < kTriesOfPair; ++tries) {
      ValueRow one = filling.row_with(pair, tries % 2 == 1);
      if (may_be(one)) row = std::move(one);
    }
    if (row) {
      open.close(*row);
      array.rows.push_back(std::move(*row));
    } else {
      open.close(pair.first, pair.second);
      ++array.left_out;
    }
  }
  return array;
}

}  // namespace fieldproof::conformance
