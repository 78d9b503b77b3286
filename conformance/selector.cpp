#include "conformance/selector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

std::vector<std::string_view> parts_of(std::string_view path) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t slash = path.find('/');
    parts.push_back(path.substr(0, slash));
    if (slash == std::string_view::npos) return parts;
    path.remove_prefix(slash + 1);
  }
}

// `*` and `?` within one part. After a mismatch only the last star is tried again, so the time is at most the
// product of the two lengths.
bool matches_part(std::string_view glob, std::string_view text) {
  std::size_t at = 0;
  std::size_t in_text = 0;
  std::size_t star = std::string_view::npos;
  std::size_t star_text = 0;
  while (in_text < text.size()) {
    if (at < glob.size() && glob[at] == '*') {
      star = at++;
      star_text = in_text;
    } else if (at < glob.size() && (glob[at] == '?' || glob[at] == text[in_text])) {
      ++at;
      ++in_text;
    } else if (star != std::string_view::npos) {
      at = star + 1;
      in_text = ++star_text;
    } else {
      return false;
    }
  }
  return glob.find_first_not_of('*', at) == std::string_view::npos;
}

std::string_view trimmed(std::string_view line) {
  line = line.substr(0, line.find('#'));
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

[[noreturn]] void refuse(const std::string& place, const std::string& sentence) {
  const auto kind = place.empty() ? kernel::ErrorKind::usage : kernel::ErrorKind::configuration;
  throw kernel::Error(kind, place.empty() ? sentence : fmt::format("{}: {}", place, sentence));
}

Selector parse_one(std::string_view text, const std::string& place) {
  Selector selector;
  selector.place = place;
  if (text.starts_with('!')) {
    selector.is_exclusion = true;
    text.remove_prefix(1);
  }
  if (text.starts_with('+')) {
    selector.kind = Selector::Kind::tag;
    text.remove_prefix(1);
  } else if (text.find_first_of("*?") != std::string_view::npos) {
    selector.kind = Selector::Kind::glob;
  }
  if (text.empty()) {
    refuse(place,
           "a selector is empty; write a path of case ids such as 'interbus/slave/**', or a tag such as "
           "'+must'");
  }
  selector.text = text;
  return selector;
}

// `open` holds the files that are being read, so that a file that includes itself is seen.
void parse_into(std::vector<Selector>& selectors, std::string_view text, const std::string& place,
                std::vector<std::string>& open) {
  if (!text.starts_with('@')) {
    selectors.push_back(parse_one(text, place));
    return;
  }
  const std::string file(text.substr(1));
  if (std::find(open.begin(), open.end(), file) != open.end()) {
    refuse(place, fmt::format("the selector file '{}' includes itself; remove that line", file));
  }
  std::ifstream input(file);
  if (!input) {
    refuse(
        place.empty() ? file : place,
        fmt::format("the selector file '{}' cannot be read; give a file with one selector per line", file));
  }
  open.push_back(file);
  std::string line;
  for (int number = 1; std::getline(input, line); ++number) {
    const std::string_view selector = trimmed(line);
    if (!selector.empty()) parse_into(selectors, selector, fmt::format("{}:{}", file, number), open);
  }
  open.pop_back();
}

}  // namespace

std::string Selector::written() const {
  return fmt::format("{}{}{}", is_exclusion ? "!" : "", kind == Kind::tag ? "+" : "", text);
}

std::vector<Selector> parse_selectors(std::span<const std::string> texts) {
  std::vector<Selector> selectors;
  std::vector<std::string> open;
  for (const std::string& text : texts) parse_into(selectors, text, "", open);
  return selectors;
}

bool matches_path(std::string_view glob, std::string_view path) {
  const std::vector<std::string_view> patterns = parts_of(glob);
  const std::vector<std::string_view> parts = parts_of(path);
  // reached[n]: the patterns so far can stand for the first n parts.
  std::vector<bool> reached(parts.size() + 1, false);
  reached[0] = true;
  for (const std::string_view pattern : patterns) {
    std::vector<bool> next(parts.size() + 1, false);
    const bool is_any = pattern == "**";
    for (std::size_t n = 0; n <= parts.size(); ++n) {
      if (is_any) {
        next[n] = reached[n] || (n > 0 && next[n - 1]);
      } else {
        next[n] = n > 0 && reached[n - 1] && matches_part(pattern, parts[n - 1]);
      }
    }
    reached = std::move(next);
  }
  return reached.back();
}

bool matches(const Selector& selector, const TestCase& test_case) {
  switch (selector.kind) {
    case Selector::Kind::exact:
      return selector.text == test_case.id;
    case Selector::Kind::tag:
      return has_tag(test_case, selector.text) && (selector.text == "canary" || !is_canary(test_case));
    case Selector::Kind::glob:
      return !is_canary(test_case) && matches_path(selector.text, test_case.id);
  }
  return false;
}

}  // namespace fieldproof::conformance
