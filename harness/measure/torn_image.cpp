#include "harness/measure/torn_image.hpp"

#include <algorithm>
#include <functional>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {

void TornImageCounter::on_word(std::size_t word, kernel::Time when, std::uint64_t edge) {
  FIELDPROOF_CHECK(!is_open_ || when_ <= when, "words of an image come in the order of their instants");
  if (is_open_ && when_ < when) finish();
  shown_.at(word) = edge;
  when_ = when;
  is_open_ = true;
}

void TornImageCounter::finish() {
  if (!is_open_) return;
  is_open_ = false;
  ++images_;
  if (std::ranges::adjacent_find(shown_, std::not_equal_to()) != shown_.end()) ++torn_images_;
}

}  // namespace fieldproof::measure
