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

// Reads one octet more than allowed at most, so that an endless file ends, too.
std::string text_of(const std::filesystem::path& path, std::size_t limit) {
  std::error_code no_status;
  if (std::filesystem::is_directory(path, no_status)) fail_to_read(path, "it is a folder; name a file in it");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_to_read(path, std::generic_category().message(errno));
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  while (text.size() <= limit && file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) fail_to_read(path, std::generic_category().message(errno));
  return text;
}

}  // namespace

Document::Document(std::shared_ptr<const Source> source) : source_(std::move(source)) {}

Document Document::load(const std::filesystem::path& path, const Limits& limits) {
  return parse(text_of(path, limits.size), path.string(), limits);
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
