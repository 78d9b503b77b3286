#include "harness/config/document.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "harness/config/source.hpp"

namespace fieldproof::config {

namespace {

[[noreturn]] void fail_to_read(const std::filesystem::path& path, std::string_view reason) {
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("{}: the file cannot be read: {}", path.string(), reason));
}

}  // namespace

void read_blocks(const std::filesystem::path& path, const std::function<void(std::string_view)>& take) {
  std::error_code no_status;
  const auto kind = std::filesystem::status(path, no_status).type();
  if (kind == std::filesystem::file_type::directory) {
    fail_to_read(path, "it is a folder; name a file in it");
  }
  if (std::filesystem::exists(path, no_status) && kind != std::filesystem::file_type::regular) {
    fail_to_read(path, "it is no regular file; write what it gives into one");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_to_read(path, std::generic_category().message(errno));
  std::vector<char> block(std::size_t{1} << 16);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    take({block.data(), static_cast<std::size_t>(file.gcount())});
  }
  if (file.bad()) fail_to_read(path, std::generic_category().message(errno));
}

std::string read_text(const std::filesystem::path& path, std::size_t limit) {
  std::string text;
  // Files below /proc have no size, so what is read is counted.
  read_blocks(path, [&](std::string_view block) {
    text.append(block);
    if (text.size() <= limit) return;
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format("{}:1:1: the file has more than {} octets, which are the most that are read",
                    path.string(), limit));
  });
  return text;
}

Document::Document(std::shared_ptr<const Source> source) : source_(std::move(source)) {}

Document Document::load(const std::filesystem::path& path, const Limits& limits) {
  return parse(read_text(path, limits.size), path.string(), limits);
}

Document Document::parse(std::string text, std::string name, const Limits& limits) {
  auto source = std::make_shared<Source>();
  source->name = std::move(name);
  source->text = std::move(text);
  parse_into(*source, limits);
  return Document(std::move(source));
}

Value Document::root() const& {
  return {*source_, 0};
}
const std::string& Document::name() const {
  return source_->name;
}
const std::string& Document::text() const {
  return source_->text;
}

}  // namespace fieldproof::config
