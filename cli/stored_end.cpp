#include "cli/stored_end.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/exit_code.hpp"
#include "harness/judge/result_json.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

// One line each.
std::string differences(const StoredEnd& stored, const StoredEnd& now) {
  std::string text;
  const auto differ = [&text](std::string_view what, std::string_view before, std::string_view after) {
    if (before != after)
      text += fmt::format("differs: {} was '{}', is '{}'\n", what, reports::escaped_line(before),
                          reports::escaped_line(after));
  };
  differ("verdict", judge::name(stored.verdict), judge::name(now.verdict));
  differ("reason", stored.reason, now.reason);
  differ("fingerprint", judge::fingerprint_text(stored.fingerprint),
         judge::fingerprint_text(now.fingerprint));
  return text;
}

}  // namespace

StoredEnd end_of(const judge::CaseResult& result) {
  return {result.verdict, result.reason, result.fingerprint};
}

void add_end(nlohmann::ordered_json& file, const StoredEnd& end) {
  file["verdict"] = judge::name(end.verdict);
  file["reason"] = end.reason;
  file["fingerprint"] = judge::fingerprint_text(end.fingerprint);
}

StoredEnd end_from(config::ObjectReader& reader) {
  StoredEnd end;
  end.verdict = judge::verdict_from(reader.required("verdict"));
  end.reason = reader.required("reason").as_string();
  end.fingerprint = judge::unsigned_from(reader.required("fingerprint"), 16);
  return end;
}

int compared(Terminal& terminal, const StoredEnd& stored, const judge::CaseResult& now, bool is_other,
             int code) {
  if (is_other) {
    terminal.print("another implementation than the stored one: not compared\n");
    return code;
  }
  const std::string different = differences(stored, end_of(now));
  if (different.empty()) {
    terminal.print("equal: verdict, reason and fingerprint are those of the stored run\n");
    return code;
  }
  terminal.print(different);
  return code == kInternal ? kInternal : kDiffers;
}

}  // namespace fieldproof::cli
