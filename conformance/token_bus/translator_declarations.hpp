#pragma once

#include <vector>

#include "harness/judge/pics.hpp"
#include "protocols/token_bus/translator_device.hpp"

// What is declared of a translator in a PICS: its configuration, in the words of its settings.
namespace fieldproof::conformance {

std::vector<judge::PicsItem> translator_pics_items();
// Of the reference.
judge::Pics declared_translator();
token_bus::TranslatorConfiguration translator_declared_in(const judge::Pics& pics);

}  // namespace fieldproof::conformance
