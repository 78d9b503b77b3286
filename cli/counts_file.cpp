#include "cli/counts_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include "cli/burst_options.hpp"
#include "harness/kernel/error.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::array<std::string_view, 7> kColumns{"level_v", "repetition", "polarity",  "time_s",
                                                   "frames",  "frames_bad", "undetected"};
constexpr std::size_t kMostOctets = std::size_t{1} << 20;
constexpr std::uint64_t kMostFrames = 1'000'000'000'000;
constexpr double kLongestSeconds = 1e7;

class CountsReader {
 public:
  // Spreadsheets write a mark of their encoding in front.
  CountsReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    if (rest_.starts_with(kMark)) rest_.remove_prefix(kMark.size());
  }

  std::vector<emc::CountedFrames> read() {
    if (rest_.size() > kMostOctets) refuse("the file is larger than 1 MiB, and holds no counts");
    bool has_head = false;
    std::vector<emc::CountedFrames> rows;
    while (next_line()) {
      if (line_.starts_with('#')) continue;
      if (!has_head) {
        read_head();
        has_head = true;
        continue;
      }
      if (rows.size() == kMostCountRows) refuse(fmt::format("more than {} rows", kMostCountRows));
      rows.push_back(read_row());
    }
    if (!has_head) read_head();
    if (rows.empty()) refuse("no row follows the head");
    return rows;
  }

 private:
  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++number_;
    return true;
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}:{}: {}", name_, std::max<std::size_t>(number_, 1), why));
  }
  [[noreturn]] void refuse_value(std::size_t column, std::string_view value, std::string_view right) const {
    refuse(fmt::format("{}: '{}' is none; write {}", kColumns.at(column),
                       reports::escaped_line(std::string(value.substr(0, 40))), right));
  }

  static std::string head() {
    std::string text;
    for (const std::string_view column : kColumns) text += (text.empty() ? "" : ",") + std::string(column);
    return text;
  }

  void read_head() const {
    if (line_ == head() && number_ > 0) return;
    refuse(fmt::format("the first line must be '{}'", head()));
  }

  std::array<std::string_view, kColumns.size()> values() const {
    std::array<std::string_view, kColumns.size()> found;
    const auto commas = static_cast<std::size_t>(std::ranges::count(line_, ','));
    if (commas + 1 != found.size())
      refuse(fmt::format("{} values; write {}: {}", line_.empty() ? 0 : commas + 1, found.size(), head()));
    std::string_view rest = line_;
    for (std::string_view& value : found) {
      const std::size_t comma = rest.find(',');
      value = rest.substr(0, comma);
      rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    }
    return found;
  }

  double real(std::size_t column, std::string_view value, double least, double most) const {
    const std::optional<double> read = real_of(value);
    if (!read || !(*read >= least && *read <= most))
      refuse_value(column, value, fmt::format("a number from {:g} to {:g}", least, most));
    return *read;
  }

  std::uint64_t whole(std::size_t column, std::string_view value, std::uint64_t least,
                      std::uint64_t most) const {
    std::uint64_t read = 0;
    const auto [end, failure] = std::from_chars(value.data(), value.data() + value.size(), read);
    if (failure != std::errc{} || end != value.data() + value.size() || read < least || read > most)
      refuse_value(column, value, fmt::format("a whole number from {} to {}", least, most));
    return read;
  }

  template <typename Value, std::size_t N>
  Value word(std::size_t column, std::string_view value, const std::array<Value, N>& known) const {
    std::string all;
    for (const Value one : known) {
      if (value == word_of(one)) return one;
      all += (all.empty() ? "" : ", ") + std::string(word_of(one));
    }
    refuse_value(column, value, "one of " + all);
  }

  emc::CountedFrames read_row() const {
    const auto value = values();
    emc::CountedFrames row;
    row.volts = real(0, value[0], 1, emc::Level::kMostVolts);
    row.repetition = word(
        1, value[1],
        std::array{emc::Repetition::khz_5, emc::Repetition::khz_100, emc::Repetition::khz_2_5_edition_1});
    row.polarity = word(2, value[2], std::array{emc::Polarity::positive, emc::Polarity::negative});
    row.time_s = real(3, value[3], 1e-3, kLongestSeconds);
    row.frames = whole(4, value[4], 1, kMostFrames);
    row.bad = whole(5, value[5], 0, row.frames);
    row.undetected = whole(6, value[6], 0, row.bad);
    return row;
  }

  std::string_view rest_;
  const std::string& name_;
  std::string_view line_;
  std::size_t number_ = 0;
};

}  // namespace

std::vector<emc::CountedFrames> read_counts(std::string_view text, const std::string& name) {
  return CountsReader(text, name).read();
}

std::vector<emc::CountedFrames> load_counts(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  std::string text(kMostOctets + 1, '\0');
  if (!input || std::filesystem::is_directory(file)) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}: cannot be read; write a file of counts", file.string()));
  }
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(input.gcount()));
  return read_counts(text, file.string());
}

}  // namespace fieldproof::cli
