#pragma once

#include <string>

#include "protocols/fieldbus_dll/ff_dlpdu.hpp"
#include "protocols/fieldbus_dll/isa_dlpdu.hpp"

// The octets of a DLPDU in words, from the table that writes and reads them: "`1010 LFPP`, destination (2 or
// 4)".
namespace fieldproof::fieldbus_dll {

std::string layout_text(FfType type, const FfCodes& codes);
std::string layout_text(IsaType type, const IsaCodes& codes);

// "1010 LFPP" of A0 with these bits free: L 08, F 04, P 03.
std::string first_octet_text(unsigned code, unsigned free_bits);

}  // namespace fieldproof::fieldbus_dll
