#include "reports/html_writer.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "harness/kernel/untrusted_text.hpp"
#include "reports/embedded_page.hpp"
#include "reports/joined_verdict.hpp"
#include "reports/json_writer.hpp"
#include "reports/packed_timeline.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;

constexpr std::string_view kReportSchema = "fieldproof/report/1";

// Stored documents may have comments.
Json parsed(const std::string& text) {
  return Json::parse(text, nullptr, true, true);
}

Json strings_json(const std::vector<std::string>& strings) {
  Json json = Json::array();
  for (const std::string& string : strings) json.push_back(as_utf8(string));
  return json;
}

Json catalogue_json(const PageCatalogue& catalogue) {
  Json stories = Json::object();
  for (const auto& [id, story] : catalogue.stories) {
    stories[as_utf8(id)] = {{"stimulus", as_utf8(story.stimulus)},
                            {"expected", as_utf8(story.expected)},
                            {"steps", strings_json(story.steps)},
                            {"catches", strings_json(story.catches)}};
  }
  return {{"suite_version", as_utf8(catalogue.suite_version)}, {"stories", std::move(stories)}};
}

Json parts_json(const std::vector<JudgedPart>& parts) {
  Json json = Json::array();
  for (const JudgedPart& part : parts) {
    json.push_back({{"name", as_utf8(part.name)},
                    {"verdict", judge::name(part.verdict)},
                    {"sentence", as_utf8(part.sentence)}});
  }
  return json;
}

Json joined_json(const JoinedVerdict& joined) {
  Json json = {{"verdict", judge::name(joined.verdict)},
               {"sentence", as_utf8(joined.sentence)},
               {"runs", parts_json(joined.runs)},
               {"documents", parts_json(joined.documents)},
               {"caveats", Json::array()}};
  for (const JoinedCaveat& caveat : joined.caveats) {
    json["caveats"].push_back({{"text", as_utf8(caveat.text)}, {"names", strings_json(caveat.names)}});
  }
  return json;
}

Json cover_json(const PageCover& cover) {
  return {{"title", as_utf8(cover.title)},
          {"device", as_utf8(cover.device)},
          {"customer", as_utf8(cover.customer)},
          {"note", as_utf8(cover.note)}};
}

std::string run_command(const RunIdentity& identity) {
  std::string command = "fieldproof run";
  for (const std::string& selector : identity.selectors) command += " " + shell_quoted(selector);
  return identity.reproduce_options.empty() ? command : command + " " + identity.reproduce_options;
}

// Puts the data of the page together and keeps count of its time lines.
class DataWriter {
 public:
  Json write(const PageContent& content) {
    Json json = {{"schema", kReportSchema},
                 {"joined", joined_json(joined_verdict(content))},
                 {"catalogue", catalogue_json(content.catalogue)},
                 {"runs", Json::array()},
                 {"documents", Json::array()}};
    if (content.cover != PageCover{}) json["cover"] = cover_json(content.cover);
    for (const PageRun& run : content.runs) json["runs"].push_back(run_json(run));
    for (const PageDocument& document : content.documents) {
      json["documents"].push_back({{"name", as_utf8(document.name)}, {"content", parsed(document.json)}});
    }
    return json;
  }

 private:
  Json run_json(const PageRun& run) {
    const StoredRun& stored = run.stored;
    Json manifest = parsed(manifest_json(stored.manifest, stored.run));
    manifest.erase("run");  // it stands in the results
    Json cases = Json::object();
    for (const judge::CaseResult& result : stored.run.cases) {
      cases[as_utf8(result.id)] = case_json(run, result);
    }
    return {{"name", as_utf8(run.name)},
            {"command", as_utf8(run_command(stored.run.identity))},
            {"journal_was_torn", stored.journal_was_torn},
            {"manifest", std::move(manifest)},
            {"results", parsed(results_json(stored.run))},
            {"cases", std::move(cases)}};
  }

  // What the results do not hold.
  Json case_json(const PageRun& run, const judge::CaseResult& result) {
    Json json = {{"command", as_utf8(reproduce_command(run.stored.run.identity, result.id))},
                 {"wall_time_us", fmt::format("{}", result.wall_time_us)}};
    if (const auto files = run.files.find(result.id); files != run.files.end()) {
      json["folder"] = "cases/" + case_directory_name(result.id);
      json["files"] = strings_json(files->second);
    }
    if (const auto timeline = run.timelines.find(result.id); timeline != run.timelines.end()) {
      Json lines = packed_timeline(parsed(timeline->second));
      timeline_octets_ += lines.dump().size();
      if (timeline_octets_ <= kMostTimelineOctets) {
        json["timeline"] = std::move(lines);
      } else {
        json["timeline_left_out"] = true;
      }
    }
    return json;
  }

  std::size_t timeline_octets_ = 0;
};

std::string without_less_than(const std::string& json) {
  std::string text;
  text.reserve(json.size() + json.size() / 64);
  for (const char octet : json) {
    if (octet == '<') {
      text += "\\u003c";
    } else {
      text += octet;
    }
  }
  return text;
}

std::string joined(std::span<const std::string_view> pieces) {
  std::string text;
  for (const std::string_view piece : pieces) text += piece;
  return text;
}

}  // namespace

std::string page_data(const PageContent& content) {
  return without_less_than(DataWriter().write(content).dump());
}

std::string html_page(const PageContent& content) {
  return joined(page_before_data()) + page_data(content) + joined(page_after_data());
}

}  // namespace fieldproof::reports
