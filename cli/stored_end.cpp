#include "cli/stored_end.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "cli/exit_code.hpp"
#include "harness/judge/result_json.hpp"
#include "harness/kernel/error.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {

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

bool has_schema(const std::filesystem::path& file, std::string_view schema) {
  try {
    const config::Document document = config::Document::load(file);
    return config::read_open_object(document.root(), [schema](config::ObjectReader& reader) {
      const auto own = reader.optional("schema");
      return own && own->is_string() && own->as_string() == schema;
    });
  } catch (const kernel::Error&) {
    return false;
  }
}

int compared(Terminal& terminal, std::span<const StoredAndNow> members, bool is_other, int code) {
  if (is_other) {
    terminal.print("another implementation than the stored one: not compared\n");
    return code;
  }
  std::string names;
  std::string different;
  for (const StoredAndNow& one : members) {
    const std::string_view joint = &one == &members.back() ? " and " : ", ";
    names += fmt::format("{}{}", names.empty() ? "" : joint, one.what);
    if (one.stored != one.now) {
      different += fmt::format("differs: {} was '{}', is '{}'\n", one.what, reports::escaped_line(one.stored),
                               reports::escaped_line(one.now));
    }
  }
  if (different.empty()) {
    terminal.print(fmt::format("equal: {} are those of the stored run\n", names));
    return code;
  }
  terminal.print(different);
  return code == kInternal ? kInternal : kDiffers;
}

int compared(Terminal& terminal, const StoredEnd& stored, const judge::CaseResult& now, bool is_other,
             int code) {
  return compared(terminal,
                  std::array{StoredAndNow{"verdict", std::string(judge::name(stored.verdict)),
                                          std::string(judge::name(now.verdict))},
                             StoredAndNow{"reason", stored.reason, now.reason},
                             StoredAndNow{"fingerprint", judge::fingerprint_text(stored.fingerprint),
                                          judge::fingerprint_text(now.fingerprint)}},
                  is_other, code);
}

}  // namespace fieldproof::cli
