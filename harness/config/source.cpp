#include "harness/config/source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::config {

namespace {

// An octet that begins a character, so that a cut before it leaves valid UTF-8.
bool begins_character(char octet) {
  return (static_cast<unsigned char>(octet) & 0xC0U) != 0x80U;
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
  std::size_t used = std::min(limit, text.size());
  while (used < text.size() && !begins_character(text[used])) ++used;
  return kernel::escaped_line(text.substr(0, used)) + (used < text.size() ? "..." : "");
}

std::pair<std::size_t, std::size_t> Source::place(std::size_t offset) const {
  const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
  const auto line = static_cast<std::size_t>(after - line_starts.begin());
  return {line, offset - line_starts[line - 1] + 1};
}

std::string Source::pointer(std::uint32_t node) const {
  std::vector<std::uint32_t> path;
  for (; nodes[node].parent != kNoNode; node = nodes[node].parent) path.push_back(node);
  std::string pointer;
  for (auto step = path.rbegin(); step != path.rend(); ++step) {
    const Node& at = nodes[*step];
    pointer =
        at.key != kNoNode ? continued(pointer, strings[at.key]) : fmt::format("{}/{}", pointer, at.position);
  }
  return pointer;
}

std::string continued(const std::string& pointer, std::string_view key) {
  std::string longer = pointer + "/";
  for (const char octet : key) {
    if (octet == '~') {
      longer += "~0";
    } else if (octet == '/') {
      longer += "~1";
    } else {
      longer += octet;
    }
  }
  return longer;
}

std::string shown(const std::string& pointer) {
  return pointer.empty() ? "the top level" : printable(pointer, 400);
}

std::string in_quotes(std::string_view word) {
  return fmt::format("\"{}\"", printable(word, 60));
}

void fail_at(const Source& source, std::size_t offset, std::string_view sentence) {
  const auto [line, column] = source.place(offset);
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("{}:{}:{}: {}", source.name, line, column, sentence));
}

}  // namespace fieldproof::config
