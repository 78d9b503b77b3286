#include "reports/html_writer.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "harness/kernel/untrusted_text.hpp"
#include "reports/campaign_content.hpp"
#include "reports/diff.hpp"
#include "reports/embedded_page.hpp"
#include "reports/history.hpp"
#include "reports/joined_verdict.hpp"
#include "reports/json_writer.hpp"
#include "reports/packed_timeline.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;

constexpr std::string_view kReportSchema = "fieldproof/report/1";

// In the command of a case, where its id goes: the first of them, whatever the options hold.
constexpr const char* kAnyCase = "@CASE@";

// Stored documents may have comments.
Json parsed(const std::string& text) {
  return Json::parse(text, nullptr, true, true);
}

// A campaign has as many jobs as its user has time for.
Json shown(const PageDocument& document) {
  Json content = parsed(document.json);
  const bool is_campaign = content.at("schema").get<std::string>().starts_with("fieldproof/campaign/");
  return is_campaign ? campaign_content(std::move(content)) : content;
}

Json strings_json(const std::vector<std::string>& strings) {
  Json json = Json::array();
  for (const std::string& string : strings) json.push_back(as_utf8(string));
  return json;
}

// Of the stories those of cases that are on the page, of all cases how many each role has.
Json catalogue_json(const PageContent& content) {
  std::set<std::string> here;
  for (const PageRun& run : content.runs) {
    for (const judge::CaseResult& result : run.stored.run.cases) here.insert(result.id);
  }
  Json stories = Json::object();
  std::map<std::string, std::size_t> roles;
  for (const auto& [id, story] : content.catalogue.stories) {
    ++roles[as_utf8(id.substr(0, id.find('/', id.find('/') + 1)))];
    if (!here.contains(id)) continue;
    stories[as_utf8(id)] = {{"stimulus", as_utf8(story.stimulus)},
                            {"expected", as_utf8(story.expected)},
                            {"steps", strings_json(story.steps)},
                            {"catches", strings_json(story.catches)}};
  }
  return {{"suite_version", as_utf8(content.catalogue.suite_version)},
          {"stories", std::move(stories)},
          {"roles", roles}};
}

// The results of a run as results.json has them, but what many of them share stands once, in "shared", and a
// result has its number; empty members are left out. A hundred thousand results open at once so.
class PackedResults {
 public:
  static Json of(const Run& run) {
    PackedResults packed;
    Json results = parsed(results_json(run));
    for (Json& result : results["cases"]) {
      packed.share(result);
      for (Json& finding : result["findings"]) packed.share(finding);
      for (const char* key : {"reason", "findings", "measurements", "log"}) {
        if (result[key].empty() || result[key] == "") result.erase(key);
      }
    }
    results["shared"] = std::move(packed.shared_);
    return results;
  }

 private:
  void share(Json& part) {
    for (const char* key : {"purpose", "requirement", "reference"}) {
      const auto member = part.find(key);
      if (member == part.end()) continue;
      const auto [known, is_new] = numbers_.emplace(member->dump(), shared_.size());
      if (is_new) shared_.push_back(*member);
      *member = known->second;
    }
  }

  Json shared_ = Json::array();
  std::map<std::string, std::size_t> numbers_;
};

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
  Json json = {{"verdict", judge::name(joined.verdict)},    {"sentence", as_utf8(joined.sentence)},
               {"runs", parts_json(joined.runs)},           {"documents", parts_json(joined.documents)},
               {"histories", parts_json(joined.histories)}, {"caveats", Json::array()}};
  for (const JoinedCaveat& caveat : joined.caveats) {
    json["caveats"].push_back({{"text", as_utf8(caveat.text)}, {"names", strings_json(caveat.names)}});
  }
  return json;
}

Json comparison_json(const PageContent& content) {
  return parsed(diff_json(compare(content.runs.at(0).stored.run, content.runs.at(1).stored.run)));
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
                 {"catalogue", catalogue_json(content)},
                 {"runs", Json::array()},
                 {"documents", Json::array()}};
    if (content.cover != PageCover{}) json["cover"] = cover_json(content.cover);
    if (content.is_comparison) json["comparison"] = comparison_json(content);
    if (content.history) json["history"] = history_json(*content.history);
    for (const PageRun& run : content.runs) json["runs"].push_back(run_json(run));
    for (const PageDocument& document : content.documents) {
      json["documents"].push_back({{"name", as_utf8(document.name)}, {"content", shown(document)}});
    }
    return json;
  }

 private:
  Json run_json(const PageRun& run) {
    const StoredRun& stored = run.stored;
    Json manifest = parsed(manifest_json(stored.manifest, stored.run));
    manifest.erase("run");  // it stands in the results
    Json cases = Json::object();
    Json wall_times = Json::array();
    for (const judge::CaseResult& result : stored.run.cases) {
      wall_times.push_back(result.wall_time_us);
      if (Json more = case_json(run, result); !more.empty()) cases[as_utf8(result.id)] = std::move(more);
    }
    return {{"name", as_utf8(run.name)},
            {"command", as_utf8(run_command(stored.run.identity))},
            {"case_command", as_utf8(reproduce_command(stored.run.identity, kAnyCase))},
            {"journal_was_torn", stored.journal_was_torn},
            {"manifest", std::move(manifest)},
            {"results", PackedResults::of(stored.run)},
            {"wall_times_us", std::move(wall_times)},
            {"cases", std::move(cases)}};
  }

  // What the results do not hold; of most cases nothing.
  Json case_json(const PageRun& run, const judge::CaseResult& result) {
    Json json = Json::object();
    if (const std::string quoted = shell_quoted(result.id); quoted != result.id)
      json["quoted"] = as_utf8(quoted);
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
