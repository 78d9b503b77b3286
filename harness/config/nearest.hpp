// Finds what a misspelled word was meant to be: keys, names, units, selectors.
//
// The distance is the optimal string alignment distance (Damerau with adjacent transpositions, each
// substring edited at most once) over octets: insert, delete, replace, swap of two neighbours cost 1 each.
// Only the first 256 octets of a word count, so that hostile input cannot make the search slow.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::config {

std::size_t edit_distance(std::string_view a, std::string_view b);

// At most `max` candidates, nearest first; candidates of equal distance keep their order.
std::vector<std::string_view> nearest(std::string_view word, std::span<const std::string_view> candidates,
                                      std::size_t max);
std::vector<std::string_view> nearest(std::string_view word, std::span<const std::string> candidates,
                                      std::size_t max);

// The nearest candidate if it is near enough for a misspelling: at most a third of the longer word, at
// least 1, differs.
std::optional<std::string_view> misspelled(std::string_view word,
                                           std::span<const std::string_view> candidates);

}  // namespace fieldproof::config
