#include "reports/publication.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/kernel/untrusted_text.hpp"
#include "reports/measurement_writer.hpp"
#include "reports/text_summary.hpp"
#include "reports/trace_json.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;

constexpr std::size_t kWhatWidth = 50;
constexpr std::size_t kPublishedWidth = 26;
constexpr std::size_t kReproducedWidth = 24;
constexpr std::size_t kTraceColumns = 100;
constexpr std::string_view kNoNumber = "(no number)";

std::string_view sign_of(const PublishedRow& row) {
  if (!row.agrees) return "";
  return *row.agrees ? "agrees" : "DIFFERS";
}

std::string row_text(const PublishedRow& row) {
  const std::string published = row.published.empty() ? std::string(kNoNumber) : escaped_line(row.published);
  std::string text =
      fmt::format("  {:<{}} {:<{}} {:<{}} {}", escaped_line(row.what), kWhatWidth, published, kPublishedWidth,
                  escaped_line(row.reproduced), kReproducedWidth, sign_of(row));
  text.erase(text.find_last_not_of(' ') + 1);
  if (!row.remark.empty()) text += fmt::format("\n      {}", escaped_line(row.remark));
  return text + "\n";
}

std::string section_text(const PublishedSection& section) {
  std::string text = fmt::format("\n{}\n", escaped_line(section.heading));
  if (!section.note.empty()) text += fmt::format("  {}\n", escaped_line(section.note));
  if (!section.rows.empty()) {
    text += fmt::format("  {:<{}} {:<{}} {}\n", "", kWhatWidth, "paper", kPublishedWidth, "reproduced");
  }
  for (const PublishedRow& row : section.rows) text += row_text(row);
  for (const PublishedTrace& one : section.traces) {
    text += fmt::format("\n{}, {}\n{}", escaped_line(one.name), kernel::describe(one.trace.length),
                        trace_text(one.trace, kTraceColumns));
  }
  return text;
}

Json figure_json(const PublishedCurves& figure) {
  Json curves = Json::array();
  for (const PublishedCurves::Curve& curve : figure.curves) {
    Json points = Json::array();
    for (const PublishedCurves::Point& point : curve.points)
      points.push_back({{"x", point.x}, {"y", point.y}});
    curves.push_back({{"name", as_utf8(curve.name)}, {"points", std::move(points)}});
  }
  return {{"name", as_utf8(figure.name)},
          {"x_label", as_utf8(figure.x_label)},
          {"y_label", as_utf8(figure.y_label)},
          {"curves", std::move(curves)}};
}

Json section_json(const PublishedSection& section) {
  Json json = {{"heading", as_utf8(section.heading)},
               {"note", as_utf8(section.note)},
               {"rows", Json::array()},
               {"traces", Json::array()},
               {"figures", Json::array()}};
  for (const PublishedRow& row : section.rows) {
    Json one = {{"what", as_utf8(row.what)},
                {"published", nullptr},
                {"reproduced", as_utf8(row.reproduced)},
                {"remark", as_utf8(row.remark)},
                {"agrees", nullptr}};
    if (!row.published.empty()) one["published"] = as_utf8(row.published);
    if (row.agrees) one["agrees"] = *row.agrees;
    json["rows"].push_back(std::move(one));
  }
  for (const PublishedTrace& one : section.traces) {
    json["traces"].push_back({{"name", as_utf8(one.name)}, {"trace", trace_json(one.trace)}});
  }
  for (const PublishedCurves& one : section.figures) json["figures"].push_back(figure_json(one));
  return json;
}

}  // namespace

bool is_reproduced(const Publication& publication) {
  return std::ranges::all_of(publication.sections, [](const PublishedSection& section) {
    return std::ranges::all_of(section.rows,
                               [](const PublishedRow& row) { return row.agrees.value_or(true); });
  });
}

std::string publication_text(const Publication& publication) {
  std::string text = fmt::format("{}\n", escaped_line(publication.title));
  for (const PublishedSection& section : publication.sections) text += section_text(section);
  return text + (is_reproduced(publication) ? "\nall that is published and compared here agrees\n"
                                            : "\nnot all that is published and compared here agrees\n");
}

std::string publication_json(const Publication& publication) {
  Json json = {{"schema", "fieldproof/publication/1"},
               {"title", as_utf8(publication.title)},
               {"seed", fmt::format("{}", publication.seed)},
               {"reproduced", is_reproduced(publication)},
               {"sections", Json::array()}};
  for (const PublishedSection& section : publication.sections)
    json["sections"].push_back(section_json(section));
  return json.dump(1) + "\n";
}

}  // namespace fieldproof::reports
