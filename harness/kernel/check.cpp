#include "harness/kernel/check.hpp"

#include <string_view>
#include <utility>

namespace fieldproof::kernel {
namespace {

thread_local CheckContext* innermost = nullptr;

// The path from the root of the project on: builds in different places tell the same.
std::string_view from_the_root(std::string_view file) {
  constexpr std::string_view own_name = "harness/kernel/check.cpp";
  const std::string_view own_file = __FILE__;
  const std::string_view root = own_file.substr(0, own_file.size() - own_name.size());
  return file.starts_with(root) ? file.substr(root.size()) : file;
}

}  // namespace

CheckContext::CheckContext(std::function<std::string()> describe)
    : describe_(std::move(describe)), outer_(std::exchange(innermost, this)) {}

CheckContext::~CheckContext() {
  innermost = outer_;
}

std::string CheckContext::describe_all() {
  std::string text;
  for (const CheckContext* context = innermost; context != nullptr; context = context->outer_) {
    text = text.empty() ? context->describe_() : context->describe_() + "; " + text;
  }
  return text;
}

void throw_broken_invariant(const char* expression, const std::string& sentence, const char* file, int line) {
  std::string text(from_the_root(file));
  text += ':' + std::to_string(line) + ": " + sentence + " (" + expression + " does not hold)";
  const std::string context = CheckContext::describe_all();
  if (!context.empty()) text += " [" + context + ']';
  throw BrokenInvariant(text);
}

}  // namespace fieldproof::kernel
