#include <fmt/format.h>

#include <algorithm>

#include "harness/config/nearest.hpp"
#include "harness/config/source.hpp"

namespace fieldproof::config {

ObjectReader::ObjectReader(const Value& value)
    : value_(value), members_(value.as_members()), read_(members_.size(), false) {
  if (value_.node_ == 0) (void)optional("$schema");  // the top level
  known_.clear();  // nobody misspells it, and errors list keys of the file's own language
}

std::optional<Value> ObjectReader::optional(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  for (std::size_t n = 0; n < members_.size(); ++n) {
    if (members_[n].key != key) continue;
    read_[n] = true;
    return members_[n].value;
  }
  return std::nullopt;
}

Value ObjectReader::required(std::string_view key) {
  if (const auto value = optional(key)) return *value;
  if (const auto* written = nearest_unread(key)) {
    fail(value_, fmt::format("key \"{}\" is missing; {} on line {} is near to it", key,
                             in_quotes(written->key), written->value.line()));
  }
  fail(value_, fmt::format("key \"{}\" is missing; add it", key));
}

const Member* ObjectReader::nearest_unread(std::string_view key) const {
  constexpr std::size_t kMost =
      1000;  // a person's file has fewer; a hostile one must not make the search slow
  std::vector<std::string_view> unread;
  for (std::size_t n = 0; n < std::min(members_.size(), kMost); ++n) {
    if (!read_[n]) unread.push_back(members_[n].key);
  }
  const auto near = misspelled(key, unread);
  if (!near) return nullptr;
  return &*std::find_if(members_.begin(), members_.end(), [&](const Member& m) { return m.key == *near; });
}

bool ObjectReader::has_unread() const {
  return std::find(read_.begin(), read_.end(), false) != read_.end();
}

void ObjectReader::finish() const {
  const auto unread = std::find(read_.begin(), read_.end(), false);
  if (unread == read_.end()) return;
  const Member& member = members_[static_cast<std::size_t>(unread - read_.begin())];
  const std::vector<std::string_view> known(known_.begin(), known_.end());
  if (const auto meant = misspelled(member.key, known)) {
    fail(member.value,
         fmt::format("key {} is not known here; did you mean \"{}\"?", in_quotes(member.key), *meant));
  }
  if (known.empty())
    fail(member.value, fmt::format("key {} is not known here; remove it", in_quotes(member.key)));
  fail(member.value,
       fmt::format("key {} is not known here; known are {}", in_quotes(member.key), fmt::join(known, ", ")));
}

}  // namespace fieldproof::config
