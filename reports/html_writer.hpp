// report.html: everything about some runs and documents as one page that needs nothing else.
//
// The page itself (reports/page, with uPlot) is put together when the program is built; this writer puts the
// data into it, as JSON that the page's script reads.
//
// Contract: equal contents give equal bytes. The file asks for nothing from anywhere: its own
// Content-Security-Policy forbids every request and every script but its own, by hash. Text of an
// implementation is data: '<' is written \u003c, so nothing can end the element that holds it, and the script
// shows text as text only. Time lines beyond kMostTimelineOctets in all are left out, and said to be.
#pragma once

#include <cstddef>
#include <string>

#include "reports/page_content.hpp"

namespace fieldproof::reports {

inline constexpr std::size_t kMostTimelineOctets = std::size_t{3} << 20;

std::string html_page(const PageContent& content);

// The JSON that the page holds.
std::string page_data(const PageContent& content);

}  // namespace fieldproof::reports
