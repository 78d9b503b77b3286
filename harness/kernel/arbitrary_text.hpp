// For tests: any text that an implementation under test could send, rich in what breaks out of a format.
#pragma once

#include <rapidcheck.h>

#include <string>
#include <vector>

namespace fieldproof::kernel {

inline rc::Gen<std::string> arbitrary_text() {
  const auto piece =
      rc::gen::oneOf(rc::gen::arbitrary<std::string>(), rc::gen::string<std::string>(),
                     rc::gen::element<std::string>("]]>", "<!--", "&#0;", "\"", "'", "\x1b[31m", "\x9b",
                                                   "\xc3", "\xed\xa0\x80", "\xef\xbf\xbe", "\xf4\x90\x80\x80",
                                                   "\xe2\x80\xae", "grüß", "\xf0\x9f\x9a\x8c", "\n", "\r\n",
                                                   "\t", std::string(1, '\0'), "\\x41", "../", "</failure>"));
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(piece),
                      [](const std::vector<std::string>& pieces) {
                        std::string text;
                        for (const std::string& part : pieces) text += part;
                        return text;
                      });
}

}  // namespace fieldproof::kernel
