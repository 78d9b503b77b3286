#pragma once

#include "harness/field/custom.hpp"

// Members of Rules that are no numbers, in each view: the header of telegrams, the frame check, the table of
// length codes. Private to the tables of this folder.
namespace fieldproof::interbus {

extern const field::Custom kTelegramMember;     // line::TelegramLayout
extern const field::Custom kFrameCheckMember;   // std::string
extern const field::Custom kLengthCodesMember;  // std::vector<LengthCode>

}  // namespace fieldproof::interbus
