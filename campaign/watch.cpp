#include "campaign/watch.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "harness/config/document.hpp"
#include "harness/iut/process.hpp"
#include "harness/judge/checked_lines.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::campaign {
namespace {

constexpr int kNothingJudged = 4;

}  // namespace

bool Watch::look() {
  bad_.clear();
  std::ifstream file(folder_.journal(), std::ios::binary);
  file.seekg(static_cast<std::streamoff>(read_));
  std::string text(kMostRead, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  const bool is_all = text.size() < kMostRead;
  // A line that is just being written is there at the next look; one that is longer than a look is left out.
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos) {
    if (!is_all) read_ += text.size();
    return is_all;
  }
  text.resize(end + 1);
  read_ += text.size();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t stop = text.find('\n', begin);
    take_line(std::string_view(text).substr(begin, stop - begin));
    begin = stop + 1;
  }
  return is_all;
}

void Watch::take_line(std::string_view line) {
  const auto result = judge::intact_result(line);
  if (!result) return;
  const auto json = nlohmann::json::parse(*result, nullptr, false);
  if (json.is_object() && json.contains("loss")) {
    ++losses_;
    return;
  }
  try {
    Outcome outcome = outcome_from_json(*result, folder_.journal().string());
    ++done_;
    if (outcome.exit_code == 0 || outcome.exit_code == kNothingJudged) return;
    ++failed_;
    bad_.push_back(std::move(outcome));
  } catch (const kernel::Error&) {
    // Whoever goes on with the campaign is told.
  }
}

bool Watch::is_running() const {
  const iut::Descriptor journal(::open(folder_.journal().c_str(), O_RDONLY | O_CLOEXEC));
  if (!journal) return false;
  return ::flock(journal.number(), LOCK_SH | LOCK_NB) != 0;
}

std::optional<Watch::End> Watch::end() const {
  std::error_code failure;
  if (!std::filesystem::exists(folder_.document(), failure)) return std::nullopt;
  const config::Document document =
      config::Document::load(folder_.document(), {.size = std::size_t{1} << 31});
  return config::read_open_object(document.root(), [](config::ObjectReader& object) {
    return End{object.required("exit_code").as_integer<int>(),
               std::string(object.required("incomplete_because").as_string())};
  });
}

}  // namespace fieldproof::campaign
