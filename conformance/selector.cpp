#include "conformance/selector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kMostOctets = std::size_t{1} << 20;  // of a selector file
constexpr std::size_t kMostLine = 4096;
constexpr std::size_t kMostSelectors = 100'000;

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
           "a selector is empty; write a path of case ids such as 'PROTOCOL/ROLE/**', or a tag such as "
           "'+must'");
  }
  selector.text = text;
  return selector;
}

// A directory opens like a file and cannot be read; a device may never end.
std::string content_of(const std::string& file, const std::string& place) {
  std::ifstream input(file, std::ios::binary);
  std::string content(kMostOctets + 1, '\0');
  std::error_code no_status;
  const bool is_folder = std::filesystem::is_directory(file, no_status);
  if (input && !is_folder) input.read(content.data(), static_cast<std::streamsize>(content.size()));
  if (is_folder || input.bad() || !input.is_open()) {
    refuse(place, fmt::format("the selector file '{}' cannot be read; give a file with one selector per line",
                              file));
  }
  content.resize(static_cast<std::size_t>(input.gcount()));
  if (content.size() > kMostOctets) {
    refuse(place,
           fmt::format("the selector file '{}' has more than {} octets; write globs", file, kMostOctets));
  }
  return content;
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
  open.push_back(file);
  const std::size_t before = selectors.size();
  const std::string content = content_of(file, place.empty() ? file : place);
  std::string_view rest = content;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    if (end > kMostLine) {
      refuse(fmt::format("{}:{}", file, number), fmt::format("the line has more than {} octets", kMostLine));
    }
    const std::string_view selector = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!selector.empty()) parse_into(selectors, selector, fmt::format("{}:{}", file, number), open);
    if (selectors.size() > kMostSelectors) {
      refuse(file, fmt::format("there are more than {} selectors; write globs", kMostSelectors));
    }
  }
  // Not everything, which no selector would mean: the person has one in mind.
  if (selectors.size() == before) refuse(file, "the selector file has no selector; write one per line");
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
